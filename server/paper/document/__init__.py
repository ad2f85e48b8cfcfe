"""docs/paper.md: the reproduction report, written from the numbers of the study, the sweep and the attitude measurements."""

from pathlib import Path

from assets.site import load_site
from server.markdown import write_markdown
from server.page import html
from server.paper.cases import ROOT, SITE
from server.paper.document.composing import compose
from server.paper.document.examples import examples
from server.paper.document.results import Results
from server.paper.tasks import FOLDER, progress_bar
from server.plots.plan import plan_of
from tracker.estimator import Origin

DOCUMENT = ROOT / "docs" / "paper.md"
FIGURES = "paper"


def write_document(path: Path = DOCUMENT, folder: Path = FOLDER) -> list[Path]:
    """Write the document beside the measurements that it is made of, and its HTML twin; return what was written.

    Args:
        path: The Markdown file; JSON files are read from, and figures written to, the folder of its name beside it.
        folder: Where example runs are kept and the HTML goes.
    """
    site = load_site(SITE)
    origin = Origin(site.origin.lat_deg, site.origin.lon_deg, site.origin.h_ellipsoid_m)
    with progress_bar("examples") as bar:
        walks = examples(folder, bar)
    document = compose(Results.read(path.parent / FIGURES), walks, plan_of(site, origin))
    page = folder / "index.html"
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(html(document), encoding="utf-8")
    return [*write_markdown(document, path, FIGURES), page]
