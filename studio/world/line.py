"""Lines: every path that a vehicle of a batch of worlds may take, in one array of points, with what stands along it.

lines_of(settings)   →  Lines      the usual path of every vehicle, and those that lead it around works
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from studio.road.ways.path import Path
from studio.world.setting import Setting
from studio.world.way import MOST_WORKS, Way
from studio.world.world import Detours, Worlds


class Laid(NamedTuple):
    """A path of a world, and the column of its first point."""

    world: int
    path: Path
    first: int


@dataclass(frozen=True, eq=False)
class Lines:
    """All lines; the number of the usual one and the way of every vehicle; all points [row, point]."""

    laid: list[Laid]
    base: np.ndarray
    ways: list[Way]
    points: np.ndarray


def lines_of(settings: Sequence[Setting]) -> Lines:
    """The lines of all vehicles. Those on one path share its points, within a world whose roads change, else in the batch."""
    laid: list[Laid] = []
    numbers: dict[tuple[int, int], int] = {}
    points: list[np.ndarray] = []
    first_of: dict[tuple[int, int], int] = {}

    def lay(w: int, path: Path) -> None:
        key = (w if settings[w].changes_roads else -1, id(path))
        if key not in first_of:
            first_of[key] = sum(each.shape[1] for each in points)
            points.append(path.points)
        laid.append(Laid(w, path, first_of[key]))

    base, ways = [], []
    for w, each in enumerate(settings):
        for car in each.cars:
            way = each.works.way(car.path)
            if (w, id(car.path)) not in numbers:
                numbers[w, id(car.path)] = len(laid)
                for path in way.paths:
                    lay(w, path)
            base.append(numbers[w, id(car.path)])
            ways.append(way)
    return Lines(laid, np.array(base), ways, np.concatenate(points, axis=1))


def stops_of(lines: Lines, link_base: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How many stop lines each line has; station and link of all."""
    stops = [[(s, link + link_base[w]) for s, link in path.stop_lines] for w, path, _ in lines.laid]
    flat = np.array([stop for each in stops for stop in each]).reshape(-1, 2)
    return np.array([len(each) for each in stops]), flat[:, 0].copy(), flat[:, 1].astype(np.int64)


def table_of(lines: Lines, stop_counts: np.ndarray, object_counts: np.ndarray, drive_counts: np.ndarray) -> np.ndarray:
    """int64[LINE, line]."""
    counts = [each.path.points.shape[1] for each in lines.laid]
    along = [row for each in (stop_counts, object_counts, drive_counts) for row in (starts(each), each)]
    return np.array([[each.first for each in lines.laid], counts, *along])


def starts(counts: np.ndarray) -> np.ndarray:
    """Where each of several parts that stand one after another begins."""
    return np.concatenate([[0], np.cumsum(counts)[:-1]])


def detours_of(settings: Sequence[Setting], worlds: Worlds, lines: Lines, table: np.ndarray) -> Detours:
    """The vehicles whose path passes works, all on their usual path."""
    vehicles = np.array([v for v, way in enumerate(lines.ways) if way.works], dtype=np.int64)
    first = starts(np.array([len(each.sites) for each in settings]))
    work = np.full((MOST_WORKS, vehicles.size), -1)
    span = np.full((2 * MOST_WORKS, table.shape[1]), np.nan)
    for j, v in enumerate(vehicles):
        way = lines.ways[v]
        count, number = len(way.works), lines.base[v]
        of = settings[worlds.of[v]].works.of
        work[:count, j] = np.array([of[number] for number in way.works]) + first[worlds.of[v]]
        span[: 2 * count, number : number + len(way.paths)] = way.spans.reshape(len(way.paths), -1).T
    return Detours(
        vehicle=vehicles,
        choice=np.zeros(vehicles.size, dtype=np.int64),
        work=work,
        base=lines.base[vehicles],
        lines=table,
        span=span,
        held=np.zeros(sum(len(each.sites) for each in settings) if any(each.changes_roads for each in settings) else 0, dtype=np.int64),
    )
