"""Where a simulated visitor walks on a site: its data in the words of the tracker."""

from assets.errors import SiteError
from assets.site import Site
from tracker.choreography import Tour


def tour_of(site: Site) -> Tour:
    """Return the site's first way as the ring, its last as the loop, and its sights.

    Raises:
        SiteError: It has no way, or nothing to look at.
    """
    if not site.ways or not site.sights:
        raise SiteError(
            f"{site.folder / 'site.toml'}: a simulated walk needs at least one of 'ways' and one of 'sights'."
        )
    return Tour(ring_en_m=site.ways[0], loop_en_m=site.ways[-1], sights_m=site.sights)
