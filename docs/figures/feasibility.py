"""Where CELC is feasible: over speed and distance, for several latencies, losses and frictions, with the bounds that the sample allows.

uv run python -m docs.figures.feasibility                   draws docs/pages/explanation/celc_feasible.svg, coarse
uv run python -m docs.figures.feasibility --width 0.2       with as many runs a place as bounds take that are no farther apart
uv run python -m docs.figures.feasibility --width 0.2 --fine    and over 17 speeds and 34 distances: many hours
uv run python -m docs.figures.feasibility --tell            runs nothing; draws, and prints every place that was run, with its bounds

Whatever is run is kept at once, in docs/figures/feasibility.csv or in `--keep FILE`: a command that was ended goes on where it was, and one
that wants more runs a place adds to those that are there. A file is of one state of the studio; after a change, begin another one.

Every run of a place has a seed of its own: B is 2.1 m behind A, give or take one, and sensors and radio have their noise and losses. A
run is solved when nobody has touched anybody. Of k solved ones among n, the share of all that would be is bounded as C. J. Clopper and
E. S. Pearson, Biometrika 26 (1934) 404, do: the bounds are those shares at which so many, or so few, would come with 2.5 %:

    lower = B(0.025; k, n - k + 1),   upper = B(0.975; k + 1, n - k)        B the quantile of the beta distribution

`sample` is the least n whose bounds are nowhere farther apart than a width; they are farthest apart for k = n/2: 17 runs for 0.5, 21 for
0.45, 27 for 0.4, 47 for 0.3, 104 for 0.2, 402 for 0.1. It is chosen before: who goes on until he likes what he sees has other bounds than
these. n runs of which all are solved say no more than a share of 0.025^(1/n): 36 runs for 0.9, 72 for 0.95, 368 for 0.99, 3688 for 0.999.
"""

import argparse
import csv
import io
from collections.abc import Callable, Iterator
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
KEPT = Path(__file__).with_suffix(".csv")
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


COARSE = Grid((50.0, 70.0, 90.0, 110.0), tuple(range(12, 79, 6)), 12)
FINE = Grid(tuple(range(40, 121, 5)), tuple(range(12, 79, 2)), 12)


class Part(NamedTuple):
    """Some runs of one place: seeds `first` to `last`, and how many of them are solved."""

    slice: str
    kmh: float
    distance: float
    first: int
    last: int
    solved: int = 0


def bounds(solved: int, runs: int, doubt: float = DOUBT) -> tuple[float, float]:
    """The share of all runs [1] that so many solved ones allow."""
    lower = float(beta.ppf(doubt / 2, solved, runs - solved + 1)) if solved else 0.0
    upper = float(beta.ppf(1.0 - doubt / 2, solved + 1, runs - solved)) if solved < runs else 1.0
    return lower, upper


def needed(share: float, doubt: float = DOUBT) -> int:
    """So many runs, all of them solved, bound the share of all from below by `share` [1]."""
    return ceil(log(doubt / 2) / log(share))


def sample(width: float) -> int:
    """So many runs a place have bounds that are nowhere farther apart than `width` [1]."""

    def widest(n: int) -> float:
        return max(upper - lower for lower, upper in (bounds(k, n) for k in (n // 2, (n + 1) // 2)))

    return next(n for n in range(1, 100_000) if widest(n) <= width)


def tried(kmh: float, distance: float, seed: int, changes: dict[str, Any]) -> dict[str, Any]:
    """One run of a place."""
    document = situation(speed=kmh / 3.6, distance=distance, parameters=SEEN, seed=seed, **changes)
    document["vehicles"]["B"]["position"]["offset"] += float(np.random.default_rng(seed).uniform(-SPREAD, SPREAD))
    return document


def missing(grid: Grid, parts: list[Part]) -> Iterator[Part]:
    """What has not been run of a grid, every second distance first: an end leaves a coarser map, not half of one."""
    done: dict[tuple[str, float, float], int] = {}
    for part in parts:
        done[part[:3]] = max(done.get(part[:3], 0), part.last)
    for distance, kmh, title in product(grid.distances[::2] + grid.distances[1::2], grid.speeds, SLICES):
        first = done.get((title, kmh, distance), 0) + 1
        if first <= grid.runs:
            yield Part(title, kmh, distance, first, grid.runs)


def batches(parts: Iterator[Part]) -> Iterator[list[Part]]:
    """As many together as run side by side."""
    some: list[Part] = []
    for part in parts:
        if some and sum(each.last - each.first + 1 for each in (*some, part)) > BATCH:
            yield some
            some = []
        some.append(part)
    if some:
        yield some


def tested(some: list[Part]) -> list[Part]:
    """The same with what came of them; all side by side."""
    seeds = [(part, seed) for part in some for seed in range(part.first, part.last + 1)]
    records = run([tried(part.kmh, part.distance, seed, SLICES[part.slice]) for part, seed in seeds])
    fine = [part[:3] for (part, _), record in zip(seeds, records, strict=True) if survived(record)]
    return [part._replace(solved=fine.count(part[:3])) for part in some]


def kept(file: Path) -> list[Part]:
    """What has been run."""
    if not file.exists():
        return []
    with file.open(encoding="utf-8", newline="") as lines:
        return [Part(row[0], float(row[1]), float(row[2]), *map(int, row[3:])) for row in list(csv.reader(lines))[1:]]


def keep(file: Path, some: list[Part]) -> None:
    """Adds to what has been run."""
    is_new = not file.exists()
    with file.open("a", encoding="utf-8", newline="") as lines:
        writer = csv.writer(lines, lineterminator="\n")
        writer.writerows(([Part._fields] if is_new else []) + [(*part[:1], *(f"{each:g}" for each in part[1:])) for part in some])


def mapped(grid: Grid, file: Path) -> None:
    """Runs what is missing of a grid, and keeps it batch by batch."""
    for some in batches(missing(grid, kept(file))):
        keep(file, tested(some))


def found(file: Path) -> dict[str, dict[tuple[float, float], tuple[int, int]]]:
    """Of every slice, by speed [km/h] and distance [m], how many are solved of how many runs."""
    places: dict[str, dict[tuple[float, float], tuple[int, int]]] = {title: {} for title in SLICES}
    for part in kept(file):
        solved, runs = places[part.slice].get((part.kmh, part.distance), (0, 0))
        places[part.slice][part.kmh, part.distance] = solved + part.solved, runs + part.last - part.first + 1
    return places


def colour(solved: int, runs: int) -> str:
    """More often solved than not, less often, or not known from so few runs."""
    lower, upper = bounds(solved, runs)
    return SURE if lower > 0.5 else FAILS if upper < 0.5 else OPEN


def draw_map(axes, title: str, places: dict[tuple[float, float], tuple[int, int]]) -> None:
    """One slice: a square a place, its colour what is known, its number how many of the runs are solved."""
    for (kmh, distance), (solved, runs) in places.items():
        axes.plot(kmh, distance, "s", color=colour(solved, runs), markersize=11.0)
        axes.annotate(f"{solved}", (kmh, distance), ha="center", va="center", fontsize=6.0)
    axes.set(title=title, xlabel="speed [km/h]")
    axes.set_xticks(sorted({kmh for kmh, _ in places}))
    axes.margins(0.12, 0.06)


def drawn(maps: dict[str, dict[tuple[float, float], tuple[int, int]]]) -> str:
    """The slices side by side, as SVG without a date."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    with rc_context({"svg.hashsalt": "studio", "font.size": 8.0}):
        figure = Figure(figsize=(9.0, 7.2), layout="constrained")
        axes = figure.subplots(2, 4, sharex=True, sharey=True)
        for each, (title, places) in zip(axes.flat, maps.items(), strict=False):
            draw_map(each, title, places)
        explain(axes.flat[-1], [runs for places in maps.values() for _, runs in places.values()])
        for each in axes[:, 0]:
            each.set_ylabel("distance [m]")
        figure.suptitle(FROM, fontsize=8.0)
        out = io.StringIO()
        FigureCanvasSVG(figure).print_svg(out, metadata={"Date": None})
    text = out.getvalue()
    return text[text.index("<svg") :]


def explain(axes, runs: list[int]) -> None:
    """What the colours mean, what was run, and what so many runs can say."""
    n = min(runs)
    (all_, _), (_, none), (low, high) = bounds(n, n), bounds(0, n), bounds(n // 2, n)
    often = f"{n}" if n == max(runs) else f"{n} to {max(runs)}"
    said = (
        f"{len(runs)} places, {often} runs each, {sum(runs)} in all", "95 % bounds of Clopper and Pearson",
        f"all solved: a share above {all_:.2f}", f"none solved: a share below {none:.2f}", f"half: between {low:.2f} and {high:.2f}",
    )  # fmt: skip
    for colour_, text in ((SURE, "more often solved than not"), (OPEN, "not known from so few"), (FAILS, "less often")):
        axes.plot([], [], "s", color=colour_, label=text)
    axes.axis("off")
    axes.legend(title="\n".join(said), fontsize=7.0, title_fontsize=7.0, loc="center", frameon=False)


def told(maps: dict[str, dict[tuple[float, float], tuple[int, int]]]) -> Iterator[str]:
    """Every place with its bounds."""
    for title, places in maps.items():
        for (kmh, distance), (solved, runs) in places.items():
            lower, upper = bounds(solved, runs)
            yield f"{title}: {kmh:3.0f} km/h, {distance:2.0f} m: {solved} of {runs}, between {lower:.2f} and {upper:.2f}"


def asked() -> argparse.Namespace:
    """What the command line wants."""
    parser = argparse.ArgumentParser(prog="docs.figures.feasibility")
    parser.add_argument("--width", type=float, help="how far apart the bounds of a place may be")
    parser.add_argument("--fine", action="store_true", help="17 speeds and 34 distances")
    parser.add_argument("--tell", action="store_true", help="runs nothing, prints what was run")
    parser.add_argument("--keep", type=Path, default=KEPT, help="where what was run is kept")
    return parser.parse_args()


def main(write: Callable[[str], None] = print) -> None:
    """Runs what is missing, and draws."""
    wanted = asked()
    grid = FINE if wanted.fine else COARSE
    if not wanted.tell:
        mapped(grid._replace(runs=sample(wanted.width)) if wanted.width else grid, wanted.keep)
    if not kept(wanted.keep):
        write(f"{wanted.keep}: nothing has been run yet")
        return
    maps = found(wanted.keep)
    (PAGES / "celc_feasible.svg").write_text(drawn(maps), encoding="utf-8")
    for line in told(maps) if wanted.tell else ():
        write(line)


if __name__ == "__main__":
    main()
