"""docs/paper.md: the reproduction report, written from the numbers of the study, the sweep and the attitude measurements."""
