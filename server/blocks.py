"""A document as a list of blocks, written once and rendered twice: as Markdown for the repository, as one HTML page for a browser.

Texts may hold `code`, **bold**, *italic* and [links](href), and [[name]] where a figure or table of that name is referred to.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from server.plots.style import Picture

_REFERENCE = re.compile(r"\[\[([a-z0-9-]+)\]\]")


@dataclass(frozen=True)
class Heading:
    """A section's title; level 2 under the document's own, 3 under that."""

    text: str
    level: int = 2

    @property
    def anchor(self) -> str:
        """What a link to it says after the #, as GitHub makes it."""
        return re.sub(r"[^\w\- ]", "", self.text.lower()).replace(" ", "-")


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    text: str


@dataclass(frozen=True)
class Items:
    """A list of sentences."""

    items: tuple[str, ...]


@dataclass(frozen=True)
class Code:
    """Commands, as they are typed."""

    text: str


@dataclass(frozen=True)
class Grid:
    """A table with a caption; the first column is left, the others right, unless `left` says how many are left."""

    name: str
    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    left: int = 1

    def __post_init__(self) -> None:
        wrong = [row for row in self.rows if len(row) != len(self.head)]
        if wrong:
            raise ValueError(f"table {self.name}: expected rows of {len(self.head)} cells, got {wrong[0]}")


@dataclass(frozen=True)
class Shown:
    """A figure."""

    picture: Picture


Block: TypeAlias = Heading | Text | Items | Code | Grid | Shown


@dataclass(frozen=True)
class Document:
    """A title, what it is about in a sentence or two, and what follows."""

    title: str
    lead: str
    blocks: tuple[Block, ...]

    def pictures(self) -> Iterator[Picture]:
        """Yield the figures in their order."""
        return (block.picture for block in self.blocks if isinstance(block, Shown))


def numbers(blocks: Sequence[Block]) -> dict[str, str]:
    """Return `Figure 3` or `Table 2` for each name, counted in order of appearance.

    Raises:
        ValueError: Two blocks have the same name.
    """
    found: dict[str, str] = {}
    figures = tables = 0
    for block in blocks:
        match block:
            case Shown(picture):
                figures += 1
                name, number = picture.name, f"Figure {figures}"
            case Grid(name=name):
                tables += 1
                number = f"Table {tables}"
            case _:
                continue
        if name in found:
            raise ValueError(f"two figures or tables are named {name}")
        found[name] = number
    return found


def anchor(name: str, number: str) -> str:
    """Return where a link to a figure or table leads: `figure-path`, which no heading is called."""
    return f"{number.partition(' ')[0].lower()}-{name}"


def referring(text: str, names: Mapping[str, str], link: Callable[[str, str], str]) -> str:
    """Return a text with each [[name]] replaced by a link to what it names.

    Args:
        text: Markdown.
        names: From `numbers`.
        link: Makes a link of a name and its number.

    Raises:
        ValueError: Nothing has that name.
    """

    def replaced(match: re.Match[str]) -> str:
        name = match.group(1)
        if name not in names:
            raise ValueError(f"a text refers to {name}, and no figure or table has that name")
        return link(name, names[name])

    return _REFERENCE.sub(replaced, text)
