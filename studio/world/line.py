"""Lines: every path that a vehicle of a batch of worlds may take, in one array of points, with what stands along it.

lines_of(settings)   →  Lines      the usual path of every vehicle, and those that lead it around works
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from studio.road.ways.aside import Side, sides
from studio.road.ways.path import Path
from studio.world.setting import Setting
from studio.world.way import MOST_WORKS, Way
from studio.world.world import Detours, Worlds


class Laid(NamedTuple):
    """A path of a world, and the column of its first point."""

    world: int
    path: Path
    first: int


class Block(NamedTuple):
    """The lines of one way, one for every choice among its works; the number of the first, the world, and which side it is on, if any."""

    line: int
    way: Way
    world: int
    side: Side | None


@dataclass(frozen=True, eq=False)
class Lines:
    """All lines in blocks; the block of every vehicle along its usual lanes, behind which those of lanes beside stand; all points."""

    laid: list[Laid]
    blocks: list[Block]
    home: list[range]  # of every vehicle
    points: np.ndarray

    @property
    def base(self) -> np.ndarray:
        """The usual line of every vehicle."""
        return np.array([self.blocks[each.start].line for each in self.home])


def lines_of(settings: Sequence[Setting]) -> Lines:
    """The lines of all vehicles. Those on one path share its points, within a world whose roads change, else in the batch."""
    laid: list[Laid] = []
    blocks: list[Block] = []
    known: dict[tuple[int, int, bool], range] = {}
    points: list[np.ndarray] = []
    first_of: dict[tuple[int, int], int] = {}

    def lay(w: int, path: Path) -> None:
        key = (w if settings[w].changes_roads else -1, id(path))
        if key not in first_of:
            first_of[key] = sum(each.shape[1] for each in points)
            points.append(path.points)
        laid.append(Laid(w, path, first_of[key]))

    def add(w: int, way: Way, side: Side | None) -> None:
        blocks.append(Block(len(laid), way, w, side))
        for path in way.paths:
            lay(w, path)

    home = []
    for w, each in enumerate(settings):
        for car in each.cars:
            key = w, id(car.path), car.changes_lanes
            if key not in known:
                first = len(blocks)
                add(w, each.works.way(car.path), None)
                for side in sides(each.network, car.path) if car.changes_lanes else ():
                    if len((way := each.works.way(side.path)).works) <= MOST_WORKS:
                        add(w, way, side)
                known[key] = range(first, len(blocks))
            home.append(known[key])
    return Lines(laid, blocks, home, np.concatenate(points, axis=1))


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
    """The vehicles of which a line passes works, all on their usual one."""
    vehicles = np.array([v for v, home in enumerate(lines.home) if any(lines.blocks[b].way.works for b in home)], dtype=np.int64)
    return Detours(
        vehicle=vehicles,
        choice=np.zeros(vehicles.size, dtype=np.int64),
        work=works_of(settings, lines)[:, [lines.home[v].start for v in vehicles]],
        base=lines.base[vehicles],
        lines=table,
        span=spans_of(lines, table),
        held=np.zeros(sum(len(each.sites) for each in settings) if any(each.changes_roads for each in settings) else 0, dtype=np.int64),
    )


def works_of(settings: Sequence[Setting], lines: Lines) -> np.ndarray:
    """int64[MOST_WORKS, block]: the entries of the script that the works of every block belong to, -1 for none."""
    first, found = starts(np.array([len(each.sites) for each in settings])), np.full((MOST_WORKS, len(lines.blocks)), -1)
    for i, block in enumerate(lines.blocks):
        of = settings[block.world].works.of
        found[: len(block.way.works), i] = np.array([of[number] for number in block.way.works]) + first[block.world]
    return found


def spans_of(lines: Lines, table: np.ndarray) -> np.ndarray:
    """float64[2 · MOST_WORKS, line]: where every line enters and leaves its works."""
    found = np.full((2 * MOST_WORKS, table.shape[1]), np.nan)
    for block in lines.blocks:
        found[: 2 * len(block.way.works), block.line : block.line + len(block.way.paths)] = block.way.spans.reshape(
            len(block.way.paths), -1
        ).T
    return found
