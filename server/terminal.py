"""What commands print on."""

from rich.console import Console


def terminal(*, stderr: bool = False, width: int | None = None) -> Console:
    """Return a terminal that shows texts as they are: no number is coloured, and no `:AB:` of a fingerprint becomes a picture."""
    return Console(stderr=stderr, width=width, highlight=False, emoji=False)
