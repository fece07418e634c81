"""Meetings: where the strands of a map come so near to each other that two who drive there are in each other's way.

Following on one lane needs none of them: they are for merging, crossing, parting, and for lanes that share their ground. They belong
to the map, and all worlds on it share them. On bridges one meets nobody below.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely

from studio.road import kept
from studio.road.network import Network, curve
from studio.road.network.index import once
from studio.road.ways.conflict import ACROSS, AGAINST, ALONG, EQUAL, GIVE, NONE, SHARED, SHARED_FIRST, SHARED_LAST, TAKE, zones
from studio.road.ways.path import PATH_HEADING, PATH_HEIGHT
from studio.road.ways.strand import WIDTH, Strands, strands_of

NARROW = 2.0  # [m] the same where one of the two is a lane: who keeps to his lane passes
HANDED_OVER = 3.0  # [m] where one strand ends and another begins beside or ahead of it, they share no more than this
OTHER_LEVEL = 3.0  # [m] of height between those who do not meet
SIDEWAYS, BACKWARDS = np.radians(45.0), np.radians(135.0)
Found = tuple[int, int, np.ndarray]


@dataclass(frozen=True, eq=False)
class Meetings:
    """Those of strand s stand from first[s] to first[s + 1], by their partners.

    `span` float64[4, m] is where they are entered and left on the strand and on its partner [m]; `shape` and `turn` as conflict.py
    names them.
    """

    first: np.ndarray
    partner: np.ndarray
    span: np.ndarray
    shape: np.ndarray
    turn: np.ndarray


@once
def meetings_of(network: Network) -> Meetings:
    """The meetings of a map; kept on disk."""
    return kept.of_map(network.digest, "meetings", Meetings, lambda: made(network), maker=__file__)


def made(network: Network) -> Meetings:
    """The same, made anew."""
    strands = strands_of(network)
    found = sorted((each for pair in near(strands) for each in meetings(network, strands, *pair)), key=lambda each: each[:2])
    own, partner = (np.array([each[i] for each in found], dtype=np.int64) for i in (0, 1))
    span = np.array([each[2] for each in found]).reshape(-1, 4).T.copy()
    places = list(zip(own.tolist(), partner.tolist(), span.T, strict=True))
    return Meetings(
        first=np.searchsorted(own, np.arange(strands.count.size + 1)),
        partner=partner,
        span=span,
        shape=np.array([shape(network, strands, *place) for place in places], dtype=np.int64),
        turn=np.array([turn(network, strands, a, b) for a, b, _ in places], dtype=np.int64),
    )


def near(strands: Strands) -> Iterator[tuple[int, int]]:
    """Pairs of strands that come near each other, each once."""
    used = np.flatnonzero(strands.count >= 2)
    lines = np.array([shapely.LineString(line(strands, strand)[:2].T) for strand in used.tolist()], dtype=object)
    for i, j in shapely.STRtree(lines).query(lines, predicate="dwithin", distance=WIDTH).T.tolist():
        if i < j:
            yield int(used[i]), int(used[j])


def line(strands: Strands, strand: int) -> np.ndarray:
    """The points of a strand."""
    first = strands.first[strand]
    return strands.points[:, first : first + strands.count[strand]]


def meetings(network: Network, strands: Strands, a: int, b: int) -> Iterator[Found]:
    """The meetings of a pair, from either side."""
    if follow_each_other(network, strands, a, b) or follow_each_other(network, strands, b, a):
        return
    width = NARROW if a < strands.lanes and not is_shared(network, strands, a, b) else WIDTH
    for span in zones(strands.points, strands.first[a], strands.count[a], strands.first[b], strands.count[b], width):
        metres = span * np.repeat(strands.spacing[[a, b]], 2)
        if hands_over(strands, a, b, metres) or hands_over(strands, b, a, metres[[2, 3, 0, 1]]):
            continue
        if is_one_level(network, strands, a, b, metres):
            yield a, b, metres
            yield b, a, metres[[2, 3, 0, 1]]


def follow_each_other(network: Network, strands: Strands, a: int, b: int) -> bool:
    """Whether one drives from one strand onto the other."""
    if a >= strands.lanes:
        return b == network.connections[a - strands.lanes].to_lane
    return b >= strands.lanes and a == network.connections[b - strands.lanes].from_lane


def hands_over(strands: Strands, a: int, b: int, span: np.ndarray) -> bool:
    """Whether one strand ends where the other begins, and that is all they share."""
    return span[0] > strands.length[a] - HANDED_OVER and span[3] < HANDED_OVER


def middle(strands: Strands, strand: int, span: np.ndarray) -> int:
    """The column of the point in the middle of a stretch [m]."""
    inside = np.clip(span, 0.0, strands.length[strand]).mean()
    return int(strands.first[strand] + round(inside / strands.spacing[strand]))


def height(strands: Strands, strand: int, span: np.ndarray) -> float:
    """Height in the middle of a stretch [m]."""
    return float(strands.points[PATH_HEIGHT, middle(strands, strand, span)])


def is_one_level(network: Network, strands: Strands, a: int, b: int, span: np.ndarray) -> bool:
    """Whether two strands are on one level where they come near to each other: by their heights, and by the levels that are mapped, but
    for those that lead to or from one junction."""
    if abs(height(strands, a, span[:2]) - height(strands, b, span[2:])) >= OTHER_LEVEL:
        return False
    if not junctions(network, strands, a).isdisjoint(junctions(network, strands, b)):
        return True
    return abs(level(network, strands, a, span[:2]) - level(network, strands, b, span[2:])) < 0.5


def junctions(network: Network, strands: Strands, strand: int) -> set[str]:
    """The junctions to which a strand leads, from which it comes, or in which it lies."""
    if strand < strands.lanes:
        road = network.roads[network.lanes[strand].road]
        return {road.from_junction, road.to_junction} - {""}
    start = network.lanes[network.connections[strand - strands.lanes].from_lane]
    return {network.roads[start.road].to_junction} - {""}


def level(network: Network, strands: Strands, strand: int, span: np.ndarray) -> float:
    """The level in the middle of a stretch [m]; in a junction that of the lane that leads into it."""
    is_lane = strand < strands.lanes
    lane = network.lanes[strand if is_lane else network.connections[strand - strands.lanes].from_lane]
    if not lane.level.size:
        return 0.0
    s = np.clip(span, 0.0, lane.length).mean() if is_lane else lane.length
    return float(np.interp(s, curve.stations(lane.centre), lane.level))


def shape(network: Network, strands: Strands, a: int, b: int, span: np.ndarray) -> int:
    """How one drives to the other where they meet."""
    if ends_in(network, strands, a) == ends_in(network, strands, b) >= 0:
        return ALONG
    here, there = (strands.points[PATH_HEADING, middle(strands, s, part)] for s, part in ((a, span[:2]), (b, span[2:])))
    apart = abs((here - there + np.pi) % (2.0 * np.pi) - np.pi)
    return ALONG if apart < SIDEWAYS else AGAINST if apart > BACKWARDS else ACROSS


def ends_in(network: Network, strands: Strands, strand: int) -> int:
    """The lane that a way through a junction leads to, -1 of a lane."""
    return network.connections[strand - strands.lanes].to_lane if strand >= strands.lanes else -1


def is_shared(network: Network, strands: Strands, a: int, b: int) -> bool:
    """Whether two strands are the lanes of both directions on one ground."""
    return a < strands.lanes and b < strands.lanes and network.lanes[a].facing == b


def turn(network: Network, strands: Strands, a: int, b: int) -> int:
    """Who goes first."""
    if is_shared(network, strands, a, b):
        return (SHARED, SHARED_FIRST, SHARED_LAST)[network.lanes[a].goes_first]
    if a < strands.lanes and b < strands.lanes:
        return NONE if network.lanes[a].road == network.lanes[b].road else EQUAL
    if a < strands.lanes or b < strands.lanes:
        return NONE
    i, j = a - strands.lanes, b - strands.lanes
    one, other = network.connections[i], network.connections[j]
    if one.from_lane == other.from_lane:
        return NONE
    gives, takes = j in one.yields, i in other.yields
    return EQUAL if gives == takes else GIVE if gives else TAKE
