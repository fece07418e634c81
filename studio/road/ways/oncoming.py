"""Oncoming lanes: where a street has one lane a direction, which lane comes towards one, and where one may go over to it.

oncoming_of(network)   →  Oncoming      for every strand of the map

Both lanes are the only ones of their directions for cars, lie side by side, and neither is part of a ring. One goes over no sooner than
`BEHIND` a junction, and is back `CLEAR` before one where others are met or a light stands.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from studio.road.network import Lane, Network
from studio.road.network.index import once
from studio.road.ways.meeting import meetings_of
from studio.road.ways.path import PATH_HEADING
from studio.road.ways.ring import rings
from studio.road.ways.strand import Strands, beside, strands_of

APART = (2.4, 5.5)  # [m] from the middle of one lane to that of the other
AGAINST = -0.9  # cosine of the angle between them
BEHIND, CLEAR, NEAR_END = 3.0, 25.0, 5.0  # [m] behind a junction, before one, and before the end of a lane that simply goes on
LEAST = 40.0  # [m] a shorter stretch is none


@dataclass(frozen=True, eq=False)
class Oncoming:
    """Per strand: the lane that comes towards it, -1 for none; from where to where on the own strand, and where on the other that is [m];
    how far from the own line the other lane ends [m], left positive. `into` are the strands that lead to each, and where each begins."""

    lane: np.ndarray
    span: np.ndarray
    room: np.ndarray
    length: np.ndarray
    into_first: np.ndarray
    into: np.ndarray


@once
def oncoming_of(network: Network) -> Oncoming:
    """Of all strands of a map."""
    strands = strands_of(network)
    n = strands.count.size
    lane, span, room = np.full(n, -1), np.zeros((4, n)), np.zeros(n)
    for own, other in pairs(network):
        found = side_by_side(network, strands, own, other)
        if found is not None:
            lane[own.id], (span[:, own.id], room[own.id]) = other.id, found
    leading = into(network, n)
    counts = np.array([len(each) for each in leading], dtype=np.int64)
    return Oncoming(
        lane=lane,
        span=span,
        room=room,
        length=strands.length,
        into_first=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        into=np.array([one for each in leading for one in each], dtype=np.int64),
    )


def pairs(network: Network) -> Iterator[tuple[Lane, Lane]]:
    """Lanes that are alone in their directions, with those between the same junctions the other way."""
    single = [lane for lane in map(only_lane, network.roads.values(), [network] * len(network.roads)) if lane is not None]
    ends: dict[tuple[str, str], list[Lane]] = {}
    for lane in single:
        road = network.roads[lane.road]
        ends.setdefault((road.from_junction, road.to_junction), []).append(lane)
    for lane in single:
        road = network.roads[lane.road]
        for other in ends.get((road.to_junction, road.from_junction), []):
            if other.road != lane.road:
                yield lane, other


def only_lane(road, network: Network) -> Lane | None:
    """The lane next to the middle of a road, where it is the only one for cars and has its ground for itself."""
    if road.internal or road.id in rings(network) or not road.lanes:
        return None
    lanes = [network.lanes[number] for number in road.lanes]
    is_alone = [lane.open for lane in lanes] == [False] * (len(lanes) - 1) + [True]
    return lanes[-1] if is_alone and lanes[-1].facing < 0 else None


def side_by_side(network: Network, strands: Strands, own: Lane, other: Lane) -> tuple[np.ndarray, float] | None:
    """The longest stretch on which another lane comes towards one beside it, and how far it reaches; none where there is no such."""
    count, begin = strands.count[own.id], strands.first[own.id]
    if count < 2 or strands.count[other.id] < 2:
        return None
    at, aside = np.empty(count), np.empty(count)
    beside(strands.points, begin, strands.points, strands.first[other.id], strands.count[other.id], at, aside)
    heading = strands.points[PATH_HEADING, begin : begin + count]
    its = strands.points[PATH_HEADING, strands.first[other.id] + np.clip(np.round(at).astype(int), 0, strands.count[other.id] - 1)]
    side = 1.0 if network.drive_side == "right" else -1.0
    is_beside = (side * aside > APART[0]) & (side * aside < APART[1]) & (np.cos(heading - its) < AGAINST)
    is_beside &= (at > 0.0) & (at < strands.count[other.id] - 1)
    columns = np.flatnonzero(is_beside)
    if not columns.size:
        return None
    run = max(np.split(columns, np.flatnonzero(np.diff(columns) > 1) + 1), key=len)
    return stretch(network, strands, own, other, run, at, aside)


def stretch(network: Network, strands: Strands, own: Lane, other: Lane, run, at, aside) -> tuple[np.ndarray, float] | None:
    """The same without what lies near junctions."""
    stations, there = run * strands.spacing[own.id], at[run] * strands.spacing[other.id]
    before = CLEAR if is_met(network, own) else NEAR_END
    low = max(stations[0], BEHIND)
    high = min(stations[-1], strands.length[own.id] - before)
    if high - low < LEAST:
        return None
    ends = np.interp([low, high], stations, there)
    widest = np.abs(aside[run]).min() + 0.5 * other.width
    return np.array([low, high, *ends]), float(np.sign(aside[run[0]]) * widest)


def is_met(network: Network, lane: Lane) -> bool:
    """Whether others are met, or a light stands, where a lane ends."""
    met = meetings_of(network)
    ways = [(len(network.lanes) + i, each) for i, each in enumerate(network.connections) if each.from_lane == lane.id]
    return any(each.link >= 0 or met.first[strand + 1] > met.first[strand] for strand, each in ways)


def into(network: Network, count: int) -> list[list[int]]:
    """The strands that lead to each: to a lane the ways onto it, to a way its lane."""
    found: list[list[int]] = [[] for _ in range(count)]
    for i, each in enumerate(network.connections):
        found[each.to_lane].append(len(network.lanes) + i)
        found[len(network.lanes) + i].append(each.from_lane)
    return found
