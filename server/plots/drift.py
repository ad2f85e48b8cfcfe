"""What calibration and averaging do to the drift at rest: the paper's half a degree a minute."""

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from server.plots.style import BETTER, FAINT, INK, house_style, new_figure

WAYS = {
    "raw": "raw samples",
    "mean": "mean of four",
    "offsets": "offsets removed",
    "both": "both, as in the paper",
    "agora": "Agora's tracker",
    "vqf": "VQF",
    "imufusion": "imufusion",
}


def drift_figure(seeds: Sequence[Mapping[str, float]], printed_deg_min: float) -> Figure:
    """Draw the drift at rest by every way, one dot a seed and a bar at the mean.

    Args:
        seeds: Degrees a minute by way (a key of `WAYS`), for each seed.
        printed_deg_min: The paper's figure.
    """
    ways = [way for way in WAYS if any(way in seed for seed in seeds)]
    with house_style():
        figure = new_figure(0.75 + 0.28 * len(ways))
        axes = figure.subplots()
        for place, way in enumerate(ways):
            rates = [seed[way] for seed in seeds if way in seed]
            axes.plot(rates, [place] * len(rates), "o", color=BETTER, markersize=4.0, alpha=0.35, markeredgewidth=0.0)
            axes.plot(sum(rates) / len(rates), place, "|", color=INK, markersize=15.0, markeredgewidth=2.0)
        axes.axvline(printed_deg_min, color=FAINT, linestyle="--", linewidth=1.0)
        axes.text(printed_deg_min, -0.75, " the paper's mean", color=FAINT, ha="left", va="center", fontsize=8.0)
        axes.set_yticks(range(len(ways)), [WAYS[way] for way in ways])
        axes.set(xscale="log", xlabel="drift at rest, degrees a minute", ylim=(len(ways) - 0.5, -1.1))
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    return figure


def drift_caption(seeds: Sequence[Mapping[str, float]], printed_deg_min: float) -> str:
    """Give the means before and after."""
    means = {way: sum(s[way] for s in seeds if way in s) / max(1, sum(way in s for s in seeds)) for way in WAYS}
    told = ", ".join(f"{WAYS[way]} {means[way]:.3f}" for way in WAYS if any(way in seed for seed in seeds))
    return (
        f"Drift of the attitude at rest, over {len(seeds)} seeds of simulated Phidget noise. Dots are seeds, bars their mean, in "
        f"degrees a minute: {told}. The paper prints {printed_deg_min:g}. Removing the offsets does nearly all of it; the mean of "
        "four samples changes little, since a gyroscope's white noise averages out in the integration anyway."
    )
