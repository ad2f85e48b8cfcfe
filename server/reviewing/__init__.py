"""What a replay's page shows of a walk beside its pictures: events, thumbnails, estimators' courses; and a walk as one page."""
