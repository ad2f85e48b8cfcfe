"""What follows from it, and how to make it again."""

from server.blocks import Block, Code, Heading, Items, Text
from server.paper.document.results import Results
from server.paper.document.words import count


def discussion(results: Results) -> list[Block]:
    """Return the discussion."""
    rows = results.against("filter_error_m")
    ate = results.against("ate_m")
    points = [
        "**The measure decides.** The filter error rewards a filter for agreeing with its receiver. A receiver's error wanders by "
        "a metre or two over a minute, so the filter that follows it most closely has the smallest filter error and the same, or a "
        "little more, error against the truth.",
        "**Nine models, two thresholds.** With the strongest rule winning outright, FAMM is an automaton. Doubling a velocity is "
        "never what a visitor does; it works as a larger gain for one update. What a filter needs for that, a process noise that "
        "follows the motion, costs no rules.",
        "**Low keeps the model.** Nothing leads from P1 back to P0 but a High innovation, so a rig that has moved is never taken "
        "to rest by standing still. The paper's stationary P0R0 needs a start at rest and innovations that stay Low.",
        "**The camera's translation has no length.** Its direction is worth having where there is parallax, and its rotation is "
        "worth less than the gyroscope's from one keyframe to the next. Applied to every keyframe, it adds the noise that the "
        "paper saw; used only where the parallax supports it, it adds none, finds north, and knows when nothing moves.",
    ]
    if rows and ate:
        better = sum(row["ratio_median"] < 1.0 for row in ate)
        points.insert(
            1,
            f"**It shows in the cells.** FAMM has the lower filter error in {count(sum(r['difference_mean'] < 0.0 for r in rows))} "
            f"of {count(len(rows))} cells and the lower error against the truth, by the median, in {count(better)}.",
        )
    return [Heading("Discussion"), Items(tuple(points))]


def again() -> list[Block]:
    """Return how the document is made."""
    return [
        Heading("How to make it again"),
        Text(
            "Everything here, prose that states a number included, is written by these commands. What was interrupted goes on "
            "where it was; results are kept under `build/paper` by the content of the sources that they depend on."
        ),
        Code(
            "make paper                       # study, sweep, attitude, readings, ablation, this document and its twin\n"
            "python -m server.paper --only document\n"
            "agora evaluate LOG --report DIR  # the same figures of any walk"
        ),
        Text("The HTML twin is `build/paper/index.html`; the numbers are in `docs/paper/*.json`."),
    ]
