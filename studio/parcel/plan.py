"""Plans of a run from above, for its report: the paths that its vehicles drove, and a film strip of moments.

All of it comes from what was recorded, x to the east and y to the north [m]: where others drove shows where the roads are. The moments are
the beginning, the least gap that a vehicle of the scenario had, and the end.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from studio.errors import UnknownError
from studio.store import trace
from studio.store.runs import Row, Runs

PLACE = ("x", "y", "heading")
WIDTH, STRIP = 7.2, (7.2, 2.9)  # [in] of a plan, and of a film strip
HEIGHTS = (1.8, 6.0)  # [in] that a plan may have
LEGEND, HEAD = 1.6, 0.6  # [in] beside and around what a plan shows
AROUND = 12.0  # [m] around whom a picture shows
LEAST = 60.0  # [m] from edge to edge of a picture at least
TRAIL = 3.0  # [s] that a trail reaches back
POINTS = 600  # of a path that is drawn
OTHERS, OWN_LIMIT = "0.8", 10  # colour of traffic; how many vehicles have colours of their own


class Drive(NamedTuple):
    """Who drove where: time [s], and of every vehicle x, y [m], heading [rad]; the names of the scenario's own come first."""

    time: np.ndarray
    places: dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]]
    own: tuple[str, ...]
    bodies: dict[str, Any]
    gaps: dict[str, np.ndarray]


class Moment(NamedTuple):
    """A picture of the strip: which sample, what it is, and around whom."""

    sample: int
    title: str
    around: tuple[str, ...]


def drive(runs: Runs, row: Row) -> Drive | None:
    """What is known of where everybody was; nothing of a run that recorded no places."""
    try:
        about = trace.about_of(runs.parquet(row.run))
    except UnknownError:
        return None
    recorded = {each["name"] for each in runs.channels(row.run)}
    known = [name for name in about["vehicles"] if all(f"{name}.{each}" in recorded for each in PLACE)]
    own = tuple(name for name in runs.document(row)["vehicles"] if name in known)
    if not own:
        return None
    gaps = [name for name in own if f"{name}.gap" in recorded]
    columns = runs.trace(row.run, [f"{name}.{each}" for name in known for each in PLACE] + [f"{name}.gap" for name in gaps])
    order = (*own, *(each for each in known if each not in own))
    places = {name: (columns[f"{name}.x"], columns[f"{name}.y"], columns[f"{name}.heading"]) for name in order}
    return Drive(columns["time"], places, own, about["bodies"], {name: columns[f"{name}.gap"] for name in gaps})


def colour(found: Drive, name: str) -> str:
    """Of a vehicle: its own, or that of traffic."""
    return f"C{found.own.index(name)}" if name in found.own[:OWN_LIMIT] else OTHERS if name not in found.own else "0.4"


# -- the plan --------------------------------------------------------------------------------------------


def plan(found: Drive):
    """The paths of all, those of the scenario's own vehicles in colours, with their beginnings."""
    left, right, bottom, top = extent([found.places[name][:2] for name in found.own])
    high = (WIDTH - LEGEND) * (top - bottom) / (right - left) + HEAD
    figure, (axes,) = sheet((WIDTH, min(max(high, HEIGHTS[0]), HEIGHTS[1])), 1)
    every = max(found.time.size // POINTS, 1)
    for name, (x, y, _) in reversed(found.places.items()):
        is_own = name in found.own
        axes.plot(x[::every], y[::every], color=colour(found, name), linewidth=1.4 if is_own else 0.7, label=name if is_own else None)
        if is_own and (there := np.flatnonzero(np.isfinite(x))).size:
            axes.plot(x[there[0]], y[there[0]], "o", color=colour(found, name), markersize=3.5)
    show(axes, left, right, bottom, top)
    axes.set(xlabel="east [m]", ylabel="north [m]")
    axes.legend(*ordered(axes, found.own), fontsize="x-small", loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    return figure


def ordered(axes, own: Sequence[str]) -> tuple[list, list]:
    """The legend in the order of the scenario."""
    known = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    return [known[name] for name in own], list(own)


def extent(paths: Sequence[Sequence[np.ndarray]]) -> tuple[float, float, float, float]:
    """What holds these paths, with some room around: least and greatest x, least and greatest y [m]."""
    x, y = (np.concatenate([np.atleast_1d(path[axis]) for path in paths]) for axis in (0, 1))
    x, y = x[np.isfinite(x)], y[np.isfinite(y)]
    return (*reach(x), *reach(y)) if x.size and y.size else (0.0, LEAST, 0.0, LEAST)


def squared(left: float, right: float, bottom: float, top: float) -> tuple[float, float, float, float]:
    """The same with sides of one length, about its middle: pictures beside each other are equally large."""
    half, x, y = 0.5 * max(right - left, top - bottom), 0.5 * (left + right), 0.5 * (bottom + top)
    return x - half, x + half, y - half, y + half


def reach(values: np.ndarray) -> tuple[float, float]:
    """From where to where a side of a picture goes."""
    low, high = float(values.min()) - AROUND, float(values.max()) + AROUND
    more = max(LEAST - (high - low), 0.0) / 2.0
    return low - more, high + more


def show(axes, left: float, right: float, bottom: float, top: float) -> None:
    """Shows a part of the plane, a metre as long one way as the other."""
    axes.set(xlim=(left, right), ylim=(bottom, top))
    axes.set_aspect("equal", adjustable="box")
    axes.grid(alpha=0.3)


# -- the film strip --------------------------------------------------------------------------------------


def strip(found: Drive):
    """Pictures of the moments side by side: cars as they stand, with where they were before."""
    chosen = moments(found)
    figure, rows = sheet(STRIP, len(chosen))
    for axes, moment in zip(rows, chosen, strict=True):
        still(axes, found, moment)
    return figure


def moments(found: Drive) -> list[Moment]:
    """The beginning, the least gap, the end; one that is another's is shown once."""
    first, last = 0, found.time.size - 1
    made = [Moment(first, "beginning", found.own)]
    if (least := least_gap(found)) is not None:
        sample, name = least
        gap = found.gaps[name][sample]
        made.append(Moment(sample, f"least gap, {gap:.3g} m,\n{name}", (name,)))
    made.append(Moment(last, "end", found.own))
    return [each for i, each in enumerate(made) if each.sample not in {other.sample for other in made[:i]}]


def least_gap(found: Drive) -> tuple[int, str] | None:
    """When the gap of one of the scenario's own was least, and whose; none where none had anybody ahead."""
    known = {name: gap for name, gap in found.gaps.items() if np.isfinite(gap).any()}
    lows = {name: int(np.nanargmin(gap)) for name, gap in known.items()}
    name = min(lows, key=lambda each: known[each][lows[each]], default=None)
    return None if name is None else (lows[name], name)


def still(axes, found: Drive, moment: Moment) -> None:
    """One picture."""
    now = moment.sample
    since = int(np.searchsorted(found.time, found.time[now] - TRAIL))
    for name, (x, y, heading) in reversed(found.places.items()):
        axes.plot(x[since : now + 1], y[since : now + 1], color=colour(found, name), linewidth=0.9, alpha=0.6)
        if np.isfinite(x[now]):
            axes.fill(*outline(x[now], y[now], heading[now], found.bodies[name]), color=colour(found, name), linewidth=0.0)
    there = [name for name in moment.around if np.isfinite(found.places[name][0][now])] or list(found.own)
    show(axes, *squared(*extent([tuple(each[now : now + 1] for each in found.places[name][:2]) for name in there])))
    axes.set_title(told(found, moment), fontsize="small")
    axes.tick_params(labelsize="x-small")


def told(found: Drive, moment: Moment) -> str:
    """A moment in words."""
    return f"{found.time[moment.sample]:.2f} s: {moment.title}"


def captions(found: Drive) -> str:
    """All moments in a line."""
    return "; ".join(told(found, each).replace("\n", " ") for each in moments(found))


def outline(x: float, y: float, heading: float, body) -> tuple[np.ndarray, np.ndarray]:
    """The corners of a car about its centre of gravity [m]."""
    ahead = np.array([body.front, body.front, body.front - body.length, body.front - body.length])
    left = np.array([0.5, -0.5, -0.5, 0.5]) * body.width
    c, s = np.cos(heading), np.sin(heading)
    return x + c * ahead - s * left, y + s * ahead + c * left


def sheet(size: tuple[float, float], count: int):
    """A figure with so many pictures side by side."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    return figure, list(figure.subplots(1, count, squeeze=False)[0])
