"""The files that docs/scale.md shows."""

import re
from pathlib import Path

_GUIDE = (Path(__file__).parents[3] / "docs" / "scale.md").read_text(encoding="utf-8")


def shown(kind: str, begins: str) -> str:
    """Return a block of the guide by its kind and its first word."""
    (block,) = re.findall(rf"```{kind}\n({begins}.*?)```", _GUIDE, re.DOTALL)
    return str(block)
