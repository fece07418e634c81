"""Strands: what traffic drives along on a map. Every lane is one, and every way through a junction.

strands_of(network)        →  Strands   their lines, drawn as paths are, with points at equal distances of a metre or less
driven(network, path)      →  Drives    on which strands a path drives, and where; on two at once while it changes lanes
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import NamedTuple

import numpy as np

from studio.compiled import compiled
from studio.road import kept
from studio.road.network import Connection, Lane, Network, curve
from studio.road.network.index import once
from studio.road.ways.approach import Approaches, resampled
from studio.road.ways.lock import fitting
from studio.road.ways.path import (
    PATH_HEADING,
    PATH_HEIGHT,
    PATH_ROWS,
    PATH_X,
    PATH_Y,
    Path,
    Station,
    heading_of,
    project,
    smooth,
)

WIDTH = 2.4  # [m] two that drive on lines nearer than this are in each other's way
NEARLY = 1.5  # [m] from a strand's end, a path that comes so near to it drives on it to the end
SLACK = 1e-6  # [m]


@dataclass(frozen=True, eq=False)
class Strands:
    """Points float64[PATH_ROWS, n] of all lines; where each begins, how many it has, how far they are apart [m].

    The first strands are the lanes by their numbers, those inside junctions without any points; then come the connections by theirs.
    """

    points: np.ndarray
    first: np.ndarray
    count: np.ndarray
    spacing: np.ndarray
    lanes: int  # number of lanes

    @property
    def length(self) -> np.ndarray:
        """Length of every strand [m]; 0 of one that nobody drives on."""
        return np.maximum(self.count - 1, 0) * self.spacing


class Drive(NamedTuple):
    """From `enter` to `leave` [m] on a path one drives on a strand, from `start` to `end` [m] on its line."""

    strand: int
    enter: float
    leave: float
    start: float
    end: float


@once
def strands_of(network: Network) -> Strands:
    """The strands of a map; kept on disk."""
    return kept.of_map(network.digest, "strands", Strands, lambda: drawn(network), maker=__file__)


def drawn(network: Network) -> Strands:
    """The same, made anew."""
    approaches = Approaches(network)
    lines = [*(lane_points(lane) for lane in network.lanes), *(way_points(approaches, each) for each in network.connections)]
    counts = np.array([line.shape[1] for line in lines], dtype=np.int64)
    lengths = np.array([curve.length(line[:2]) if line.shape[1] else 0.0 for line in lines])
    return Strands(
        points=np.concatenate([np.zeros((PATH_ROWS, 0)), *lines], axis=1),
        first=np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.int64),
        count=counts,
        spacing=lengths / np.maximum(counts - 1, 1),
        lanes=len(network.lanes),
    )


def lane_points(lane: Lane) -> np.ndarray:
    """The line of a lane; none of one inside a junction, which belongs to ways through it."""
    return np.zeros((PATH_ROWS, 0)) if lane.internal else spaced(*resampled(lane))


def way_points(approaches: Approaches, connection: Connection) -> np.ndarray:
    """The line of a way through a junction, smoothed with what is driven before and behind; none where there is no way between."""
    if not connection.via:
        return np.zeros((PATH_ROWS, 0))
    draft, first, last = fitting(approaches, connection, curve.LOCK)
    fine, height = smooth(draft)
    begin, end = nearest(fine, draft.starts[first].place), nearest(fine, draft.starts[last].place)
    return spaced(fine[:, begin : end + 1], height[begin : end + 1]) if end > begin else np.zeros((PATH_ROWS, 0))


def nearest(line: np.ndarray, place: np.ndarray) -> int:
    """The point of a line that is nearest to a place."""
    return int(np.hypot(*(line - place[:, None])).argmin())


def spaced(fine: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Points at equal distances, of a metre at most."""
    s = curve.stations(fine)
    at = np.linspace(0.0, s[-1], max(2, int(np.ceil(s[-1] - SLACK)) + 1))
    points = np.zeros((PATH_ROWS, at.size))
    for row, values in ((PATH_X, fine[0]), (PATH_Y, fine[1]), (PATH_HEADING, heading_of(fine)), (PATH_HEIGHT, height)):
        points[row] = np.interp(at, s, values)
    return points


# -- on a path -------------------------------------------------------------------------------------


def driven(network: Network, path: Path) -> list[Drive]:
    """The strands of a path in the order in which it comes to them."""
    strands, number = strands_of(network), ways(network)
    roads = [list(group) for _, group in groupby(path.stations, key=lambda station: station.road)]
    ends = [*(group[0].s for group in roads[1:]), path.length]
    found: list[Drive] = []
    for i, (group, end) in enumerate(zip(roads, ends, strict=True)):
        if i:
            found += through(network, strands, number, path, roads[i - 1][-1], group[0])
        lanes = network.roads[group[0].road].lanes
        found += [each for lane in lanes for each in pieces(strands, lane, path, group[0].s - NEARLY, end)]
    return sorted(found, key=lambda each: each.enter)


@once
def ways(network: Network) -> dict[tuple[int, int], int]:
    """The strand of the way from a lane to another."""
    return {(each.from_lane, each.to_lane): len(network.lanes) + i for i, each in enumerate(network.connections)}


def through(network: Network, strands: Strands, number, path: Path, last: Station, first: Station) -> list[Drive]:
    """The way through a junction that a path takes, up to where its next road begins."""
    pair = network.roads[last.road].lanes[last.lane_index], network.roads[first.road].lanes[first.lane_index]
    strand = number.get(pair, -1)
    if strand < 0 or strands.count[strand] == 0:
        return []
    length = float(strands.length[strand])
    usual = Drive(strand, max(first.s - length, 0.0), first.s, 0.0, length)
    found = list(pieces(strands, strand, path, first.s - 1.2 * length - NEARLY, first.s + NEARLY))
    return [usual._replace(enter=found[0].enter, start=found[0].start)] if found else [usual]


def pieces(strands: Strands, strand: int, path: Path, low: float, high: float) -> Iterator[Drive]:
    """Where between two stations of a path [m] it is on a strand."""
    first, count, length = strands.first[strand], strands.count[strand], float(strands.length[strand])
    columns = np.arange(max(int(low), 0), min(int(np.ceil(high)) + 1, path.points.shape[1]))
    if count < 2 or not columns.size:
        return
    at, aside = np.empty(columns.size), np.empty(columns.size)
    beside(path.points, columns[0], strands.points, first, count, at, aside)
    at *= strands.spacing[strand]
    inside = (np.abs(aside) < WIDTH) & (at > SLACK) & (at < length - SLACK)
    for is_on, run in groupby(range(columns.size), key=inside.__getitem__):
        if is_on:
            here = list(run)
            yield completed(strand, length, float(columns[here[0]]), float(columns[here[-1]]), at[here[0]], at[here[-1]], path.length)


def completed(strand: int, length: float, enter: float, leave: float, start: float, end: float, last: float) -> Drive:
    """A piece that all but reaches an end of its strand does reach it."""
    if start < NEARLY:
        enter, start = enter - start, 0.0
    if length - end < NEARLY:
        leave, end = leave + length - end, length
    return Drive(strand, max(enter, 0.0), min(leave, last), float(start), float(end))


@compiled
def beside(points, column, lines, first, count, at, aside):
    """Where on a line the points of a path lie, from a column on, in steps of the line, and how far aside [m]."""
    best, guess = np.inf, 0
    for i in range(count):
        dx, dy = lines[PATH_X, first + i] - points[PATH_X, column], lines[PATH_Y, first + i] - points[PATH_Y, column]
        if dx * dx + dy * dy < best:
            best, guess = dx * dx + dy * dy, i
    s = float(guess)
    for k in range(at.size):
        s, aside[k] = project(lines, first, count, points[PATH_X, column + k], points[PATH_Y, column + k], s)
        at[k] = s
