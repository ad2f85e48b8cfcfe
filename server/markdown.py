"""A document as Markdown, with its figures as files beside it."""

import textwrap
from collections.abc import Mapping
from pathlib import Path

from server.blocks import Block, Code, Document, Grid, Heading, Items, Shown, Text, anchor, numbers, referring

_WIDTH = 140


def write_markdown(document: Document, path: Path, folder: str) -> list[Path]:
    """Write a document and its figures; return what was written.

    Args:
        document: What to write.
        path: The Markdown file.
        folder: Where figures go, beside the file; what else lies there is left alone.
    """
    (path.parent / folder).mkdir(parents=True, exist_ok=True)
    written = [path]
    for picture in document.pictures():
        file = path.parent / folder / f"{picture.name}.{picture.kind}"
        file.write_bytes(picture.data)
        written.append(file)
    path.write_text(markdown(document, folder), encoding="utf-8")
    return written


def markdown(document: Document, folder: str) -> str:
    """Return a document's Markdown."""
    names = numbers(document.blocks)
    parts = [f"# {document.title}", _wrapped(_told(document.lead, names))]
    parts += [_block(block, names, folder) for block in document.blocks]
    return "\n\n".join(parts) + "\n"


def _block(block: Block, names: Mapping[str, str], folder: str) -> str:
    match block:
        case Heading(text, level):
            return f"{'#' * level} {text}"
        case Text(text):
            return _wrapped(_told(text, names))
        case Items(items):
            return "\n".join(_wrapped(_told(item, names), "- ", "  ") for item in items)
        case Code(text):
            return f"```\n{text}\n```"
        case Grid():
            return _grid(block, names)
        case Shown(picture):
            caption = _wrapped(f"**{names[picture.name]}.** {_told(picture.caption, names)}")
            alt = picture.alt.replace("[", "(").replace("]", ")")
            place = anchor(picture.name, names[picture.name])
            return f'<a id="{place}"></a>\n![{alt}]({folder}/{picture.name}.{picture.kind})\n\n{caption}'


def _grid(grid: Grid, names: Mapping[str, str]) -> str:
    rule = ["---" if place < grid.left else "---:" for place in range(len(grid.head))]
    rows = [grid.head, tuple(rule), *grid.rows]
    table = "\n".join("| " + " | ".join(_cell(_told(cell, names)) for cell in row) + " |" for row in rows)
    caption = _wrapped(f"**{names[grid.name]}.** {_told(grid.caption, names)}")
    return f'<a id="{anchor(grid.name, names[grid.name])}"></a>\n{caption}\n\n{table}'


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _told(text: str, names: Mapping[str, str]) -> str:
    return referring(text, names, lambda name, number: f"[{number}](#{anchor(name, number)})")


def _wrapped(text: str, first: str = "", others: str = "") -> str:
    return textwrap.fill(
        text,
        _WIDTH,
        initial_indent=first,
        subsequent_indent=others,
        break_long_words=False,
        break_on_hyphens=False,
    )
