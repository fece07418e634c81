"""Lines beside the usual ones: along one lane, and which part of a path lies beside a stretch of such a line."""

from collections.abc import Iterable

import numpy as np

from studio.road import curve
from studio.road.network import Lane, Network
from studio.road.path import (
    CORRIDOR,
    GRAIN,
    PATH_HEADING,
    PATH_SPACING,
    PATH_SPEED,
    PATH_X,
    PATH_Y,
    WAVELENGTH,
    Path,
    Station,
    sampled,
)


def lane_line(network: Network, lane: Lane) -> Path:
    """The line along one lane, smooth as a path."""
    fine = curve.resampled(lane.centre, GRAIN)
    corridor = np.full(fine.shape[1], CORRIDOR)
    points = sampled(curve.smoothed(fine, spacing=GRAIN, wavelength=WAVELENGTH, corridor=corridor))
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
