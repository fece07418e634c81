"""Figures of a validation, as SVG: time histories with their zones, positions over distance, the paper's kinds of figures."""

import io
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from studio.log.quantity import QUANTITIES
from studio.validation import path
from studio.validation.judge import Comparison
from studio.validation.maneuver import oval
from studio.validation.zone import Confidence, zone

SIZE = (7.2, 2.6)  # [in]
THEIRS, OURS, AVERAGED = "#1f5fa8", "#b3261e", "#e08a00"
BAND = {"two-sided": "95 % interval, two-sided", "one-sided": "95 % bounds, one-sided"}


def figures(compared: Comparison, confidence: Confidence) -> list[tuple[str, str]]:
    """Titles and pictures of a maneuver."""
    if compared.kind == "oval":
        return [
            ("position", drawn(lambda axes: plan(axes, compared))),
            ("deviation", drawn(lambda axes: deviation(axes, compared, confidence))),
        ]
    if not compared.module.REPEATS and len(compared.theirs) > 1:
        return [picture for each in alone(compared) for picture in figures(each, confidence)]
    shown = [name for name in compared.module.JUDGED if name in compared.theirs[0].signals]
    return [(name, drawn(lambda axes, name=name: history(axes, compared, name, confidence))) for name in shown]


def alone(compared: Comparison) -> list[Comparison]:
    """Every run by itself, where they do not repeat each other."""
    runs = zip(compared.theirs, compared.ours, compared.marks, strict=True)
    return [replace(compared, theirs=[theirs], ours=[ours], averaged=ours, marks=[marks]) for theirs, ours, marks in runs]


def drawn(draw: Callable) -> str:
    """One picture; it holds no date, so that the same result gives the same bytes."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    with rc_context({"svg.hashsalt": "studio"}):
        figure = Figure(figsize=SIZE, layout="constrained")
        axes = figure.add_subplot()
        draw(axes)
        axes.grid(alpha=0.3)
        axes.legend(fontsize="x-small", loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
        out = io.StringIO()
        FigureCanvasSVG(figure).print_svg(out, metadata={"Date": None})
    text = out.getvalue()
    return text[text.index("<svg") :]


def history(axes, compared: Comparison, name: str, confidence: Confidence) -> None:
    """A signal over time after the reference: the zone of the recorded runs, the mean of the simulations, that of the averaged input."""
    time, around, mean = compared.zone(name, confidence)
    count = len(compared.theirs)
    if count > 1:
        axes.fill_between(time, around.low, around.high, color=THEIRS, alpha=0.25, linewidth=0, label=f"recorded: {BAND[confidence]}")
    axes.plot(time, around.mean, color=THEIRS, linewidth=1.0, label=f"recorded: mean of {count} runs" if count > 1 else "recorded")
    axes.plot(time, mean, color=OURS, linewidth=1.0, label="simulated: mean" if count > 1 else "simulated")
    if count > 1:
        axes.plot(*compared.of_average(name), color=AVERAGED, linewidth=1.0, linestyle="--", label="simulated: averaged input")
    quantity = QUANTITIES[name]
    axes.set(xlabel="time after the reference [s]", ylabel=f"{name.replace('_', ' ')} [{quantity.unit}]")
    axes.margins(x=0.0)


def plan(axes, compared: Comparison) -> None:
    """Positions from above."""
    for i, each in enumerate(compared.theirs):
        points = oval.line(each).points
        axes.plot(points[:, 0], points[:, 1], color=THEIRS, linewidth=0.6, alpha=0.5, label="recorded" if i == 0 else None)
    for i, (mine, real) in enumerate(zip(compared.ours, compared.theirs, strict=True)):
        points = oval.placed(mine, real).points
        axes.plot(points[:, 0], points[:, 1], color=OURS, linewidth=0.6, alpha=0.7, label="simulated" if i == 0 else None)
    axes.set(xlabel="east [m]", ylabel="north [m]", aspect="equal")


def deviation(axes, compared: Comparison, confidence: Confidence) -> None:
    """Deviation to the left over travelled distance, in the zone of the recorded runs."""
    lines = [oval.line(each) for each in compared.theirs]
    base = path.averaged(lines)
    around = zone([path.offsets(base, each) for each in lines], confidence)
    ours = [path.deviations(base, oval.placed(mine, real)) for mine, real in zip(compared.ours, compared.theirs, strict=True)]
    axes.fill_between(base.distance, around.low, around.high, color=THEIRS, alpha=0.25, linewidth=0, label=f"recorded: {BAND[confidence]}")
    axes.plot(base.distance, np.mean(ours, axis=0), color=OURS, linewidth=1.0, label="simulated, mean")
    axes.set(xlabel="travelled distance [m]", ylabel="deviation to the left [m]")
    axes.margins(x=0.0)
