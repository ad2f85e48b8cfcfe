"""A document as one HTML page that needs nothing else: figures inside it, no scripts, light or dark, and fit to be printed."""

import re
from base64 import b64encode
from collections.abc import Mapping
from html import escape
from itertools import groupby

from server.blocks import Block, Code, Document, Grid, Heading, Items, Shown, Text, anchor, numbers, referring
from server.plots.style import Picture

_MIME = {"svg": "image/svg+xml", "png": "image/png"}

#: A cell with more letters than this may be broken into lines.
_LONG_CELL = 44

_STYLE = """
:root {
  color-scheme: light dark;
  --ink: #1c2126; --faint: #59626b; --paper: #fdfcfa; --line: #d9dde1; --link: #1f5fa8; --band: #f3f1ec;
}
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e7ea; --faint: #a0a8b0; --paper: #15181b; --line: #363c42; --link: #86b8ee; --band: #1e2226; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.55 system-ui, "Segoe UI", Roboto, sans-serif; }
main { max-width: 60rem; margin: 0 auto; padding: 2.5rem 1.25rem 5rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .75rem; text-wrap: balance; }
h2 { font-size: 1.35rem; margin: 3rem 0 .75rem; padding-top: .75rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.08rem; margin: 2rem 0 .5rem; }
p, li { max-width: 46rem; }
.lead { font-size: 1.1rem; color: var(--faint); }
a { color: var(--link); }
code { font: .88em ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
code { background: var(--band); padding: .08em .3em; border-radius: 3px; }
pre { background: var(--band); padding: .8rem 1rem; overflow-x: auto; border-radius: 5px; }
pre code { padding: 0; }
nav { background: var(--band); padding: 1rem 1.25rem; border-radius: 6px; margin: 1.75rem 0; columns: 2 18rem; column-gap: 2rem; }
nav ul { margin: 0; padding-left: 1.1rem; }
nav li { break-inside: avoid; font-size: .94rem; }
figure { margin: 1.75rem 0; }
figure.picture img { display: block; width: 100%; height: auto; background: #fff; }
figure.picture img { padding: .6rem; border: 1px solid var(--line); border-radius: 5px; }
figcaption { font-size: .92rem; color: var(--faint); margin-top: .5rem; max-width: 52rem; }
figcaption b { color: var(--ink); }
figure.table figcaption { margin: 0 0 .5rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums; }
th, td { padding: .28rem .65rem; text-align: right; white-space: nowrap; }
th { border-bottom: 2px solid var(--line); vertical-align: bottom; white-space: normal; }
td { border-bottom: 1px solid var(--line); }
.left { text-align: left; }
.long { white-space: normal; min-width: 16rem; }
.long code { overflow-wrap: anywhere; }
@media (max-width: 40rem) { figure.picture img { width: 38rem; max-width: none; } }
@media print {
  @page { margin: 16mm; }
  :root { --ink: #000; --faint: #333; --paper: #fff; --line: #bbb; --link: #000; --band: #fff; }
  body { font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  nav { display: none; }
  h2, h3 { break-after: avoid; }
  figure, tr { break-inside: avoid; }
}
"""


def html(document: Document) -> str:
    """Return a document as a page."""
    names = numbers(document.blocks)
    body = "\n".join(_block(block, names) for block in document.blocks)
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(document.title)}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n<main>\n"
        f'<h1>{_inline(document.title, names)}</h1>\n<p class="lead">{_inline(document.lead, names)}</p>\n'
        f"{_contents(document, names)}\n{body}\n{_list_of_figures(document, names)}\n</main>\n</body>\n</html>\n"
    )


def _block(block: Block, names: Mapping[str, str]) -> str:
    match block:
        case Heading(text, level):
            return f'<h{level} id="{block.anchor}">{_inline(text, names)}</h{level}>'
        case Text(text):
            return f"<p>{_inline(text, names)}</p>"
        case Items(items):
            return "<ul>" + "".join(f"<li>{_inline(item, names)}</li>" for item in items) + "</ul>"
        case Code(text):
            return f"<pre><code>{escape(text)}</code></pre>"
        case Grid():
            return _grid(block, names)
        case Shown(picture):
            return _picture(picture, names)


def _picture(picture: Picture, names: Mapping[str, str]) -> str:
    data = b64encode(picture.data).decode("ascii")
    caption = f"<b>{names[picture.name]}.</b> {_inline(picture.caption, names)}"
    return (
        f'<figure class="picture" id="{anchor(picture.name, names[picture.name])}"><div class="scroll">'
        f'<img alt="{escape(picture.alt)}" '
        f'src="data:{_MIME[picture.kind]};base64,{data}"></div><figcaption>{caption}</figcaption></figure>'
    )


def _grid(grid: Grid, names: Mapping[str, str]) -> str:
    def row(cells: tuple[str, ...], tag: str) -> str:
        sides = (_side(cell, place < grid.left) for place, cell in enumerate(cells))
        return (
            "<tr>"
            + "".join(f"<{tag}{side}>{_inline(cell, names)}</{tag}>" for cell, side in zip(cells, sides, strict=True))
            + "</tr>"
        )

    body = "\n".join(row(cells, "td") for cells in grid.rows)
    caption = f"<b>{names[grid.name]}.</b> {_inline(grid.caption, names)}"
    return (
        f'<figure class="table" id="{anchor(grid.name, names[grid.name])}"><figcaption>{caption}</figcaption>'
        f'<div class="scroll"><table>\n'
        f"<thead>{row(grid.head, 'th')}</thead>\n<tbody>\n{body}\n</tbody></table></div></figure>"
    )


def _side(cell: str, left: bool) -> str:
    if not left:
        return ""
    return ' class="left long"' if len(cell) > _LONG_CELL else ' class="left"'


def _contents(document: Document, names: Mapping[str, str]) -> str:
    """Return links to the sections; a page of one or two needs none."""
    headings = [block for block in document.blocks if isinstance(block, Heading) and block.level == 2]
    if len(headings) < 3:
        return ""
    links = "".join(f'<li><a href="#{h.anchor}">{_inline(h.text, names)}</a></li>' for h in headings)
    return f'<nav aria-label="Contents"><ul>{links}</ul></nav>'


def _list_of_figures(document: Document, names: Mapping[str, str]) -> str:
    """Return the table of figures and tables, each by the first sentence of its caption."""
    named = [(picture.name, picture.alt) for picture in document.pictures()]
    named += [(b.name, b.caption.partition(". ")[0].rstrip(".")) for b in document.blocks if isinstance(b, Grid)]
    if not named:
        return ""
    parts = ['<h2 id="figures-and-tables">Figures and tables</h2>']
    for _, group in groupby(named, key=lambda entry: names[entry[0]].partition(" ")[0]):
        entries = (
            f'<li><a href="#{anchor(name, names[name])}">{names[name]}</a>: {_inline(title, names)}</li>'
            for name, title in group
        )
        parts.append("<ul>" + "".join(entries) + "</ul>")
    return "\n".join(parts)


def _inline(text: str, names: Mapping[str, str]) -> str:
    """Return a text's Markdown as HTML: code first, so that nothing inside it is taken for more."""
    linked = referring(text, names, lambda name, number: f"[{number}](#{anchor(name, number)})")
    pieces = re.split(r"(`[^`]+`)", linked)
    return "".join(
        f"<code>{escape(piece[1:-1])}</code>" if piece.startswith("`") and len(piece) > 2 else _marked(piece)
        for piece in pieces
    )


def _marked(text: str) -> str:
    out = escape(text, quote=False).replace(" %", "\u00a0%")
    out = re.sub(r"\[([^\]]+)\]\(([^)\s]+)\)", lambda m: f'<a href="{escape(m[2])}">{m[1]}</a>', out)
    out = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", out)
    return re.sub(r"(?<![\w*])\*([^*\s][^*]*)\*(?![\w*])", r"<em>\1</em>", out)
