"""Where CELC is feasible: over speed and distance, for several latencies, losses and frictions, with the bounds that the sample allows.

uv run python -m docs.figures.feasibility            draws docs/pages/explanation/celc_feasible.svg, coarse, some minutes
uv run python -m docs.figures.feasibility --long     the same over a finer grid with 72 runs a place, some hours: prints a table too

Every run of a place has a seed of its own: B is 2.1 m behind A, give or take one, and sensors and radio have their noise and losses. A
run is solved when nobody has touched anybody. Of k solved ones among n, the share of all that would be is bounded as C. J. Clopper and
E. S. Pearson, Biometrika 26 (1934) 404, do: the bounds are those shares at which so many, or so few, would come with 2.5 %:

    lower = B(0.025; k, n - k + 1),   upper = B(0.975; k + 1, n - k)        B the quantile of the beta distribution

so n runs of which all are solved say no more than a share of 0.025^(1/n): 36 runs for 0.9, 72 for 0.95, 368 for 0.99, 3688 for 0.999.
"""

import io
import sys
from collections.abc import Callable
from itertools import product
from math import ceil, log
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import beta

from docs.figures.convoy import run
from docs.figures.situation import situation, survived

PAGES = Path(__file__).resolve().parent.parent / "pages" / "explanation"
DOUBT = 0.05  # of both bounds together
SEEN = {"confidence": 0.9, "recognition": 0.06}  # what recognition takes: four looks of 20 ms at a sensor that gains half of what lacks
SPREAD = 1.0  # [m] by which B is farther ahead or behind
BATCH = 96  # runs side by side
SLICES = {
    "20 ms, no loss, dry": {},
    "latency 100 ms": {"latency": 0.1},
    "latency 200 ms": {"latency": 0.2},
    "loss 0.3": {"loss": 0.3},
    "loss 0.6": {"loss": 0.6},
    "friction 0.6": {"friction": 0.6},
    "friction 0.3": {"friction": 0.3},
}
SURE, OPEN, FAILS = "#009e73", "#bbbbbb", "#d55e00"
FROM = "distance: A's front bumper to the obstacle's near edge when it becomes visible; recognition then takes 0.06 s and four looks"


class Grid(NamedTuple):
    """Places of a map, and how many runs each has."""

    speeds: tuple[float, ...]  # [km/h]
    distances: tuple[float, ...]  # [m]
    runs: int


COARSE = Grid((50.0, 70.0, 90.0, 110.0), (18.0, 24.0, 30.0, 36.0, 42.0, 48.0, 54.0, 60.0), 12)
FINE = Grid(tuple(np.arange(40.0, 121.0, 5.0)), tuple(np.arange(12.0, 73.0, 2.0)), 72)


def bounds(solved: int, runs: int, doubt: float = DOUBT) -> tuple[float, float]:
    """The share of all runs [1] that so many solved ones allow."""
    lower = float(beta.ppf(doubt / 2, solved, runs - solved + 1)) if solved else 0.0
    upper = float(beta.ppf(1.0 - doubt / 2, solved + 1, runs - solved)) if solved < runs else 1.0
    return lower, upper


def needed(share: float, doubt: float = DOUBT) -> int:
    """So many runs, all of them solved, bound the share of all from below by `share` [1]."""
    return ceil(log(doubt / 2) / log(share))


def tried(kmh: float, distance: float, seed: int, changes: dict[str, Any]) -> dict[str, Any]:
    """One run of a place."""
    document = situation(speed=kmh / 3.6, distance=distance, parameters=SEEN, seed=seed, **changes)
    document["vehicles"]["B"]["position"]["offset"] += float(np.random.default_rng(seed).uniform(-SPREAD, SPREAD))
    return document


def mapped(grid: Grid, changes: dict[str, Any]) -> np.ndarray:
    """How many runs of every place are solved, int64[distance, speed]."""
    places = product(grid.distances, grid.speeds, range(1, grid.runs + 1))
    documents = [tried(kmh, distance, seed, changes) for distance, kmh, seed in places]
    some = [documents[i : i + BATCH] for i in range(0, len(documents), BATCH)]
    fine = [survived(record) for each in some for record in run(each)]
    return np.reshape(fine, (len(grid.distances), len(grid.speeds), grid.runs)).sum(axis=2)


def colour(solved: int, runs: int) -> str:
    """More often solved than not, less often, or not known from so few runs."""
    lower, upper = bounds(solved, runs)
    return SURE if lower > 0.5 else FAILS if upper < 0.5 else OPEN


def draw_map(axes, title: str, grid: Grid, solved: np.ndarray) -> None:
    """One slice: a square a place, its colour what is known, its number how many of the runs are solved."""
    for (i, distance), (j, kmh) in product(enumerate(grid.distances), enumerate(grid.speeds)):
        axes.plot(kmh, distance, "s", color=colour(int(solved[i, j]), grid.runs), markersize=11.0)
        axes.annotate(f"{solved[i, j]}", (kmh, distance), ha="center", va="center", fontsize=6.0)
    step, aside = grid.distances[1] - grid.distances[0], grid.speeds[1] - grid.speeds[0]
    wide = grid.speeds[0] - 0.5 * aside, grid.speeds[-1] + 0.5 * aside
    axes.set(title=title, xlabel="speed [km/h]", xlim=wide, ylim=(grid.distances[0] - step, grid.distances[-1] + step))
    axes.set_xticks(grid.speeds)


def drawn(grid: Grid, found: dict[str, np.ndarray]) -> str:
    """The slices side by side, as SVG without a date."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    with rc_context({"svg.hashsalt": "studio", "font.size": 8.0}):
        figure = Figure(figsize=(9.0, 5.6), layout="constrained")
        axes = figure.subplots(2, 4, sharex=True, sharey=True)
        for each, (title, solved) in zip(axes.flat, found.items(), strict=False):
            draw_map(each, title, grid, solved)
        explain(axes.flat[-1], grid.runs)
        for each in axes[:, 0]:
            each.set_ylabel("distance [m]")
        figure.suptitle(FROM, fontsize=8.0)
        out = io.StringIO()
        FigureCanvasSVG(figure).print_svg(out, metadata={"Date": None})
    text = out.getvalue()
    return text[text.index("<svg") :]


def explain(axes, runs: int) -> None:
    """What the colours mean, and what so many runs can say."""
    all_, none = bounds(runs, runs)[0], bounds(0, runs)[1]
    said = (f"{runs} runs a place, 95 % bounds", f"all solved: a share above {all_:.2f}", f"none solved: a share below {none:.2f}")
    for colour_, text in ((SURE, "more often solved than not"), (OPEN, "not known from so few"), (FAILS, "less often")):
        axes.plot([], [], "s", color=colour_, label=text)
    axes.axis("off")
    axes.legend(title="\n".join(said), fontsize=7.0, title_fontsize=7.0, loc="center", frameon=False)


def main(write: Callable[[str], None] = print) -> None:
    """Draws; with --long prints every place with its bounds."""
    grid = FINE if "--long" in sys.argv else COARSE
    found = {title: mapped(grid, changes) for title, changes in SLICES.items()}
    (PAGES / "celc_feasible.svg").write_text(drawn(grid, found), encoding="utf-8")
    for title, solved in found.items():
        for (i, distance), (j, kmh) in product(enumerate(grid.distances), enumerate(grid.speeds)):
            lower, upper = bounds(int(solved[i, j]), grid.runs)
            write(f"{title}: {kmh:3.0f} km/h, {distance:2.0f} m: {solved[i, j]} of {grid.runs}, between {lower:.2f} and {upper:.2f}")


if __name__ == "__main__":
    main()
