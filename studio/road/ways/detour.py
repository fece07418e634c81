"""Lines beside the usual ones: along one lane, which part of a path lies beside a stretch of it, and paths led around.

A path that is led around goes over to another line on a taper with neither slope nor curvature at its ends (`ease`), and
back on another. Before the taper it is the path as it was, point by point; behind it, the same line.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from studio.road.network import Lane, Network, curve
from studio.road.ways.path import (
    CORRIDOR,
    GRAIN,
    PATH_CURVATURE,
    PATH_HEADING,
    PATH_ROWS,
    PATH_SPACING,
    PATH_SPEED,
    PATH_X,
    PATH_Y,
    WAVELENGTH,
    Path,
    Station,
    curvature_of,
    ease,
    heading_of,
    sampled,
)

ARM = 1.3  # [m] from the middle of a car to what it keeps clear of: half its width, and room
SIDEWAYS = 2.5  # [m/s²] that the speed of a led path allows
STEEPEST = 10.0 / 3.0**0.5  # largest second derivative of `ease`: a taper T over a width D bends with STEEPEST D/T² [1/m]


@dataclass(frozen=True, eq=False)
class Work:
    """One lane's stretch [m] of its `line` with a `taper` on either side, closed or shifted.

    Closed: paths go over to `target`, which lies `side` (1 left, -1 right) of it; they stop where there is none.
    Shifted: paths move `offset` [m] to the left.
    """

    line: Path
    start: float
    end: float
    taper: float
    width: float
    target: Path | None = None
    side: float = 0.0
    offset: float = 0.0

    def share(self, stations: np.ndarray) -> np.ndarray:
        """How far a path has gone over at stations of the line, 0 to 1; 0 where they are not a number."""
        on = ease((stations - self.start) / self.taper + 1.0)
        off = ease((self.end - stations) / self.taper + 1.0)
        return np.where(np.isnan(stations), 0.0, on * off)

    def reach(self, stations: np.ndarray) -> np.ndarray:
        """Distance [m] of the target from the line."""
        assert self.target is not None  # nothing is asked of a shifted lane's
        return np.abs(aside(self.line, stations, self.target))

    def edge(self, stations: np.ndarray) -> np.ndarray:
        """Where the closed ground ends towards the target [m], to the left of the line: half a lane beside the led path."""
        return self.side * (self.reach(stations) * self.share(stations) - 0.5 * self.width)


def lane_line(network: Network, lane: Lane) -> Path:
    """The line along one lane, smooth as a path."""
    fine = curve.resampled(lane.centre, GRAIN)
    corridor = np.full(fine.shape[1], CORRIDOR)
    height = np.interp(np.linspace(0.0, lane.length, fine.shape[1]), curve.stations(lane.centre), lane.height)
    points = sampled(curve.smoothed(fine, spacing=GRAIN, wavelength=WAVELENGTH, corridor=corridor), height)
    points[PATH_SPEED] = lane.speed
    return Path(points, (), (Station(lane.road, lane.index, 0.0),))


def roads_at(path: Path) -> np.ndarray:
    """The road of every point, the way through a junction with the road before it."""
    first = np.searchsorted([station.s for station in path.stations], np.arange(path.points.shape[1]) * PATH_SPACING, side="right")
    return np.array([station.road for station in path.stations])[np.clip(first - 1, 0, None)]


def beside(line: Path, start: float, end: float, path: Path) -> np.ndarray:
    """For every point of a path the station [m] on the line that it lies beside; not a number outside the stretch.

    Only what is on the same road counts: a bridge above, or the other direction, does not.
    """
    found = np.full(path.points.shape[1], np.nan)
    on_line, on_path = roads_at(line), roads_at(path)
    low, high = int(start / PATH_SPACING), int(np.ceil(end / PATH_SPACING)) + 1
    for road in unique(on_line[low:high]):
        columns = np.flatnonzero(on_path == road)
        part = low + np.flatnonzero(on_line[low:high] == road)
        if columns.size:
            station = stations_beside(line.points[:, part], part * PATH_SPACING, path.points[:, columns])
            inside = (station >= start) & (station <= end)
            found[columns[inside]] = station[inside]
    return found


def stations_beside(line: np.ndarray, stations: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Station [m] of the nearest place of a line for every point, beyond its ends counted on straight ahead."""
    apart = points[[PATH_X, PATH_Y], :, None] - line[[PATH_X, PATH_Y], None, :]
    near = np.hypot(*apart).argmin(axis=1)
    rows = np.arange(points.shape[1])
    heading = line[PATH_HEADING, near]
    return stations[near] + apart[0, rows, near] * np.cos(heading) + apart[1, rows, near] * np.sin(heading)


def unique(names: Iterable[str]) -> list[str]:
    """Names in their order, each once."""
    return list(dict.fromkeys(names))


def slowed(limit: np.ndarray, deceleration: float = 1.5) -> np.ndarray:
    """A limit [m/s] per metre, and before it what can be slowed down from in time."""
    speed = limit.copy()
    for i in range(len(speed) - 2, -1, -1):
        speed[i] = min(speed[i], np.sqrt(speed[i + 1] ** 2 + 2.0 * deceleration * PATH_SPACING))
    return speed


def limited(path: Path, line: Path, start: float, end: float, speed: float) -> np.ndarray:
    """What a limit on a stretch of a line allows on a path [m/s]; infinite where it says nothing.

    A metre more on either side: between the points of a path the speed is interpolated.
    """
    here = np.isfinite(beside(line, max(start - PATH_SPACING, 0.0), end + PATH_SPACING, path))
    return slowed(np.where(here, speed, np.inf))


def place_at(line: Path, stations: np.ndarray) -> np.ndarray:
    """float64[3, n]: x, y [m] and heading [rad] at stations of a line [m]."""
    grid = np.arange(line.points.shape[1]) * PATH_SPACING
    return np.array([np.interp(stations, grid, line.points[row]) for row in (PATH_X, PATH_Y, PATH_HEADING)])


def aside(line: Path, stations: np.ndarray, other: Path) -> np.ndarray:
    """How far to the left of a line another one lies at stations of the first [m]."""
    x, y, heading = place_at(line, stations)
    there = place_at(other, stations_on(other, np.array([x, y])))
    return (there[1] - y) * np.cos(heading) - (there[0] - x) * np.sin(heading)


def stations_on(line: Path, places: np.ndarray) -> np.ndarray:
    """Stations [m] of a line nearest to places float64[2, n]."""
    points = np.zeros((PATH_ROWS, places.shape[1]))
    points[[PATH_X, PATH_Y]] = places
    return stations_beside(line.points, np.arange(line.points.shape[1]) * PATH_SPACING, points)


def passing(path: Path, work: Work) -> np.ndarray:
    """Stations of the work's line for every point of a path that it concerns; not a number elsewhere.

    Whether it does: a closed lane concerns who would come onto it or too near to its edge, a shifted one who drives on it.
    """
    stations = beside(work.line, work.start - work.taper, work.end + work.taper, path)
    columns = np.flatnonzero(stations <= work.end)
    x, y, heading = place_at(work.line, stations[columns])
    left = (path.points[PATH_Y, columns] - y) * np.cos(heading) - (path.points[PATH_X, columns] - x) * np.sin(heading)
    on_lane = (np.abs(left) < 0.5 * work.width) & (stations[columns] >= work.start)
    if work.target is not None:
        before_edge = work.side * (left - work.edge(stations[columns])) < ARM
        on_lane = before_edge & (work.side * left > -0.5 * work.width - 0.5)
    return stations if on_lane.any() else np.full_like(stations, np.nan)


def led(path: Path, work: Work, stations: np.ndarray) -> tuple[Path, np.ndarray]:
    """A path that goes around a work, and where on it every point of the old one has come to lie [m].

    stations [m] as from `passing`.
    """
    share = work.share(stations)
    moved = path.points[[PATH_X, PATH_Y]] + share * (goals(path, work, stations) - path.points[[PATH_X, PATH_Y]])
    inside = np.flatnonzero(share > 0.0)
    return bent(path, moved, inside[0], inside[-1])


def bent(path: Path, moved: np.ndarray, first: int, last: int) -> tuple[Path, np.ndarray]:
    """A path whose points from the `first` to the `last` have `moved`, float64[2, n], and where on it every old one has come to lie [m]."""
    a, b = first - 1, min(last + 1, path.points.shape[1] - 1)
    from scipy.interpolate import CubicSpline  # takes a third of a second, and is needed for this only

    low, high = max(a - 4, 0), min(b + 5, path.points.shape[1])
    chord = curve.stations(moved[:, low:high])
    fine = CubicSpline(chord, moved[:, low:high], axis=1)(np.linspace(0.0, chord[-1], round(chord[-1] / GRAIN) + 1))
    own = curve.stations(fine)
    at = np.arange(path.points.shape[1], dtype=float) * PATH_SPACING
    at[low:high] = low * PATH_SPACING + np.interp(chord, np.linspace(0.0, chord[-1], own.size), own)
    at[high:] += at[high - 1] - (high - 1) * PATH_SPACING
    at[: a + 1] = np.arange(a + 1) * PATH_SPACING
    points = resampled(path, at, a, own + low * PATH_SPACING, fine)
    bend = np.sqrt(SIDEWAYS / np.maximum(np.abs(points[PATH_CURVATURE]), 1e-6))
    led_here = (np.arange(points.shape[1]) >= at[max(a, 0)]) & (np.arange(points.shape[1]) <= at[b])
    points[PATH_SPEED] = np.minimum(points[PATH_SPEED], slowed(np.where(led_here, bend, np.inf)))
    stops = tuple((float(np.interp(s, np.arange(at.size), at)), link) for s, link in path.stop_lines)
    begun = tuple(replace(each, s=float(np.interp(each.s, np.arange(at.size), at))) for each in path.stations)
    return Path(points, stops, begun), at


def goals(path: Path, work: Work, stations: np.ndarray) -> np.ndarray:
    """Where every point of a path would lie on the other line, float64[2, n] [m]."""
    places = path.points[[PATH_X, PATH_Y]].copy()
    here = np.flatnonzero(np.isfinite(stations))
    if work.target is not None:
        places[:, here] = place_at(work.target, stations_on(work.target, places[:, here]))[:2]
    elif work.offset:
        heading = path.points[PATH_HEADING, here]
        places[:, here] += work.offset * np.array([-np.sin(heading), np.cos(heading)])
    return places


def resampled(path: Path, at: np.ndarray, last: int, own: np.ndarray, fine: np.ndarray) -> np.ndarray:
    """Points a metre apart: as they were up to the `last` (-1: none), then on the fine curve with stations `own`, then on the old line."""
    new = np.arange(last + 1, int(np.floor(at[-1] + 1e-9)) + 1) * PATH_SPACING
    rows = np.array([np.interp(new, at, row) for row in path.points])
    on_fine = new <= own[-1]
    kinds = ((PATH_X, fine[0]), (PATH_Y, fine[1]), (PATH_HEADING, heading_of(fine)), (PATH_CURVATURE, curvature_of(fine)))
    for row, values in kinds:
        turns = 2.0 * np.pi * np.round((path.points[row, max(last, 0)] - values[0]) / (2.0 * np.pi)) if row == PATH_HEADING else 0.0
        rows[row, on_fine] = np.interp(new[on_fine], own, values + turns)
    return np.concatenate([path.points[:, : last + 1], rows], axis=1)
