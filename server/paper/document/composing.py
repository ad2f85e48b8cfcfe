"""All sections in their order."""

from collections.abc import Mapping, Sequence

from server.blocks import Document
from server.paper.document.against_truth import against_truth
from server.paper.document.calibration import calibration
from server.paper.document.closing import again, discussion
from server.paper.document.errors import errors
from server.paper.document.method import method
from server.paper.document.opening import opening
from server.paper.document.results import Results
from server.paper.document.rules import rules
from server.paper.document.sensitivity import sensitivity
from server.paper.document.walks import walks
from server.plots.plan import Plan
from server.plots.trace import Trace

TITLE = "Fuzzy adaptive motion models, reproduced"
LEAD = (
    "A reproduction report on *Sensor fusion of camera, GPS and IMU using fuzzy adaptive multiple motion models* (Bostanci, "
    "Bostanci, Kanwal and Clark): every equation rebuilt, every table and figure made again, and the truth beside them."
)


def compose(results: Results, examples: Mapping[int, Sequence[Trace]], plan: Plan = ()) -> Document:
    """Return the document.

    Args:
        results: What was measured; what is missing leaves out its section.
        examples: By dataset, one walk under the paper's four estimators.
        plan: What stands on the site.
    """
    sections = (
        opening(results),
        method(results),
        rules(results),
        calibration(results),
        errors(results),
        against_truth(results),
        sensitivity(results),
        walks(results, examples, plan),
        discussion(results),
        again(),
    )
    return Document(TITLE, LEAD, tuple(block for section in sections for block in section))
