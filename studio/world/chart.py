"""The chart: what a map says of the road under every point of a path, for sensors that read markings, signs and maps.

chart_of(lines, settings)   →  float64[row, point]      beside the points of all paths
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from studio.road.network import Network, curve
from studio.road.ways.path import PATH_CURVATURE, PATH_SPACING, Path
from studio.world.line import Lines
from studio.world.setting import Setting
from studio.world.table.chart import CHART

NOWHERE = 1e6  # [m] to a junction that does not come


class Piece(NamedTuple):
    """A stretch of a path on one lane, and where on the path the junction behind it begins; infinite where there is none."""

    begin: float
    lane: int
    junction: float


def chart_of(lines: Lines, settings: Sequence[Setting]) -> np.ndarray:
    """Of the points of all lines; lines that share their points share what is under them."""
    chart = np.zeros((len(CHART), lines.points.shape[1]))
    for w, path, first in {each.first: each for each in lines.laid}.values():
        chart[:, first : first + path.points.shape[1]] = under(path, settings[w].network)
    return chart


def under(path: Path, network: Network) -> np.ndarray:
    """What is under the points of one path."""
    found = pieces(path, network)
    stations = np.arange(path.points.shape[1]) * PATH_SPACING
    number = np.maximum(np.searchsorted([each.begin for each in found], stations, side="right") - 1, 0)
    lane = np.array([lane_rows(network, each.lane) for each in found]).T[:, number]
    ends = np.array([each.junction for each in found])
    coming = np.minimum.accumulate(ends[::-1])[::-1][number]  # of this piece, or of one that comes
    junction, bent = np.clip(coming - stations, 0.0, NOWHERE), np.cumsum(path.points[PATH_CURVATURE])
    return np.concatenate([lane, [junction, levels(found, number, stations, network), bent]])


def levels(found: list[Piece], number: np.ndarray, stations: np.ndarray, network: Network) -> np.ndarray:
    """The level of the lane at every point; behind its end, within a junction, that of its end."""
    level = np.zeros(stations.size)
    for i, each in enumerate(found):
        lane = network.lanes[each.lane]
        if lane.level.size:
            level[number == i] = np.interp(stations[number == i] - each.begin, curve.stations(lane.centre), lane.level)
    return level


def lane_rows(network: Network, number: int) -> list[float]:
    """Width, lanes beside and limit of a lane."""
    lane = network.lanes[number]
    beside = len(network.roads[lane.road].lanes) - 1 - lane.index, lane.index
    left, right = beside if network.drive_side == "right" else beside[::-1]
    return [lane.width, left, right, lane.speed]


def pieces(path: Path, network: Network) -> list[Piece]:
    """The lanes that a path is on, in order."""
    lanes = [network.roads[each.road].lanes[each.lane_index] for each in path.stations]
    behind = [*map(float, junctions(path, lanes, network)), np.inf]
    return [Piece(each.s, lane, end) for each, lane, end in zip(path.stations, lanes, behind, strict=True)]


def junctions(path: Path, lanes: list[int], network: Network) -> Iterator[float]:
    """Where the junction between each lane and the next begins; infinite where the next lane follows at once."""
    inside = {(each.from_lane, each.to_lane): sum(network.lanes[i].length for i in each.via) for each in network.connections}
    for one, other, behind in zip(lanes, lanes[1:], path.stations[1:], strict=False):
        length = inside.get((one, other), 0.0)
        yield behind.s - length if length > 0.0 else np.inf
