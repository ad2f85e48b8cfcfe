"""One list of blocks as Markdown and as a page: the same numbers, links that lead somewhere, nothing from outside."""

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from server.blocks import Code, Document, Grid, Heading, Items, Shown, Text, numbers
from server.markdown import markdown, write_markdown
from server.page import html
from server.plots.style import Picture

PICTURE = Picture("path", "svg", b"<svg xmlns='http://www.w3.org/2000/svg'/>", "A path. It is *long*.")
DOCUMENT = Document(
    "On <walks> & errors",
    "What **we** found, see [[path]].",
    (
        Heading("What we did, at first"),
        Text("See [[sizes]] and `a | b < c`; 2 * 3 * 4 stays, [a link](other.md) leads on."),
        Heading("Path"),
        Items(("One `x*y*z`.", "Two, as in [[path]].")),
        Grid("sizes", "Sizes of all. In metres.", ("name", "m"), (("a|b", "1.0"), ("c", "2.0"))),
        Shown(PICTURE),
        Heading("Again"),
        Code("make paper  # <again>"),
    ),
)


class _Page(HTMLParser):
    """Collects ids, links and images, and checks that tags are closed in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.images: list[dict[str, str | None]] = []
        self.tags: list[str] = []
        self._open: list[str] = []
        self.feed(text)
        assert self._open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = dict(attrs)
        self.tags.append(tag)
        self.ids += [value for key, value in attrs if key == "id" and value]
        self.links += [value for key, value in attrs if key == "href" and value]
        self.images += [found] if tag == "img" else []
        if tag not in {"meta", "img"}:
            self._open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag


def test_figures_and_tables_are_counted_apart() -> None:
    assert numbers(DOCUMENT.blocks) == {"sizes": "Table 1", "path": "Figure 1"}
    with pytest.raises(ValueError, match="two figures or tables are named path"):
        numbers([Shown(PICTURE), Shown(PICTURE)])


def test_markdown() -> None:
    text = markdown(DOCUMENT, "paper")
    assert text.startswith("# On <walks> & errors\n\nWhat **we** found, see [Figure 1](#figure-path).\n")
    assert "| a\\|b | 1.0 |" in text
    assert "| --- | ---: |" in text
    assert "![A path](paper/path.svg)" in text
    assert "**Figure 1.** A path. It is *long*." in text
    for name in re.findall(r"\(#([^)]+)\)", text):
        assert f'<a id="{name}"></a>' in text


def test_figures_lie_beside_the_markdown(tmp_path: Path) -> None:
    written = write_markdown(DOCUMENT, tmp_path / "docs" / "paper.md", "paper")
    assert written == [tmp_path / "docs" / "paper.md", tmp_path / "docs" / "paper" / "path.svg"]
    assert written[1].read_bytes() == PICTURE.data


def test_a_page_that_needs_nothing_else() -> None:
    """Every link leads to an id of the page or a file that the text named; every picture is inside and has words for it."""
    text = html(DOCUMENT)
    page = _Page(text)
    assert [link[1:] for link in page.links if link.startswith("#") and link[1:] not in page.ids] == []
    assert [link for link in page.links if not link.startswith("#")] == ["other.md"]
    assert [str(image["src"]).partition(",")[0] for image in page.images] == ["data:image/svg+xml;base64"]
    assert [image["alt"] for image in page.images] == ["A path"]
    assert not {"script", "link", "iframe"} & set(page.tags)
    assert len(page.ids) == len(set(page.ids))


def test_marks_and_what_only_looks_like_them() -> None:
    text = html(DOCUMENT)
    assert "<title>On &lt;walks&gt; &amp; errors</title>" in text
    assert "<code>a | b &lt; c</code>" in text
    assert "2 * 3 * 4 stays" in text
    assert "<code>x*y*z</code>" in text
    assert "It is <em>long</em>." in text
    assert "What <b>we</b> found" in text
    assert "make paper  # &lt;again&gt;" in text


def test_what_refers_to_nothing_is_a_mistake() -> None:
    wrong = Document("t", "l", (Text("see [[nothing]]"),))
    for render in (html, lambda document: markdown(document, "paper")):
        with pytest.raises(ValueError, match="no figure or table has that name"):
            render(wrong)
    with pytest.raises(ValueError, match="rows of 2 cells"):
        Grid("t", "c", ("a", "b"), (("1",),))
