"""The lanes of a map as plain arrays, made once for every Network: what compiled code asks, also within a tick.

    points  float64[7, p]    all centre lines, lane after lane: x, y, arc length, direction of what follows, mitre, heading
    point_lane int64[p]      whose point it is
    lanes   float64[3, n]    length, half width, speed limit
    spans   int64[9, n]      first point and count, first step and count, road, kerb side, middle side, signal, kind
    steps   int64[5, c]      how one leaves a lane, the straightest way first: next lane, road's lane reached, via, back
    via     int64[v]         the lanes through junctions of all steps
    lights                   cycle and offset, first phase and count per signal; ends and states of the phases
    grid                     over all pieces of centre lines; its items are the columns of `points` where a piece starts

`Index` is a tuple of arrays, so a compiled function takes it as one argument. Several maps can be joined into one index:
lanes of the second map then count from where those of the first end, and the map's number picks its part of the grid.
"""

import functools
import weakref
from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from studio.portable import arctan2, tan, turn
from studio.road.network import Connection, Network, grid
from studio.road.network.grid import Grid

P_X, P_Y, P_S, P_EAST, P_NORTH, P_MITRE, P_HEADING = range(7)
LANE_LENGTH, LANE_HALF_WIDTH, LANE_SPEED = range(3)
POINT_FIRST, POINT_COUNT, STEP_FIRST, STEP_COUNT, ROAD, KERB_SIDE, MIDDLE_SIDE, LIGHT, KIND = range(9)
STEP_NEXT, STEP_TO, VIA_FIRST, VIA_COUNT, STEP_BACK = range(5)
CYCLE, OFFSET = range(2)
PHASE_FIRST, PHASE_COUNT = range(2)
INTERNAL, OPEN = 1, 2  # bits of a lane's kind

NONE = -1  # no such lane or signal
CELL = 16.0  # [m] of the grid: a few lanes in each cell
SHARPEST_CORNER = np.radians(120.0)  # a centre line that turns back has no mitre
SHORTEST = 1e-6  # [m] a piece shorter than this has no direction
Made = TypeVar("Made")


class Index(NamedTuple):
    """All lanes of one or several maps."""

    points: np.ndarray
    point_lane: np.ndarray
    lanes: np.ndarray
    spans: np.ndarray
    steps: np.ndarray
    via: np.ndarray
    light_time: np.ndarray
    light_span: np.ndarray
    phase_end: np.ndarray
    phase_state: np.ndarray
    grid: Grid


def once(make: Callable[[Network], Made]) -> Callable[[Network], Made]:
    """`make`, called once for every map; what it made goes when its map goes."""
    made: weakref.WeakKeyDictionary[Network, Made] = weakref.WeakKeyDictionary()

    @functools.wraps(make)
    def remembered(network: Network) -> Made:
        if network not in made:
            made[network] = make(network)
        return made[network]

    return remembered


@once
def index_of(network: Network) -> Index:
    """The index of a map."""
    lines = [centre_points(lane.centre) for lane in network.lanes]
    points = np.concatenate(lines, axis=1)
    counts = np.array([line.shape[1] for line in lines], dtype=np.int64)
    point_lane = np.repeat(np.arange(len(lines)), counts)
    steps, step_counts, via = steps_of(network)
    signals = network.signals
    return Index(
        points=points,
        point_lane=point_lane,
        lanes=lane_rows(network, lines),
        spans=span_rows(network, counts, step_counts),
        steps=steps,
        via=via,
        light_time=np.array([signals.cycle, signals.offset], dtype=float).reshape(2, -1),
        light_span=np.array([signals.first, signals.count], dtype=np.int64).reshape(2, -1),
        phase_end=signals.phase_end,
        phase_state=signals.phase_state,
        grid=pieces(points, point_lane),
    )


def joined(indices: Sequence[Index]) -> Index:
    """Several maps as one index; their order is the number of a map."""
    points, lanes, steps, via, lights, phases = (
        np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int64)
        for sizes in np.array([(i.points.shape[1], i.lanes.shape[1], i.steps.shape[1], i.via.size, i.light_time.shape[1], i.phase_end.size)
                               for i in indices]).T
    )  # fmt: skip
    roads = np.concatenate([[0], np.cumsum([i.spans[ROAD].max(initial=NONE) + 1 for i in indices])[:-1]])
    spans = [
        i.spans + shifts({POINT_FIRST: p, STEP_FIRST: s, ROAD: r}, 9) + (i.spans >= 0) * shifts({KERB_SIDE: n, MIDDLE_SIDE: n, LIGHT: k}, 9)
        for i, p, s, r, n, k in zip(indices, points, steps, roads, lanes, lights, strict=True)
    ]
    onward = [i.steps + shifts({STEP_NEXT: n, STEP_TO: n, VIA_FIRST: v}, 5) for i, n, v in zip(indices, lanes, via, strict=True)]
    return Index(
        points=np.concatenate([i.points for i in indices], axis=1),
        point_lane=np.concatenate([i.point_lane + n for i, n in zip(indices, lanes, strict=True)]),
        lanes=np.concatenate([i.lanes for i in indices], axis=1),
        spans=np.concatenate(spans, axis=1),
        steps=np.concatenate(onward, axis=1),
        via=np.concatenate([i.via + n for i, n in zip(indices, lanes, strict=True)]),
        light_time=np.concatenate([i.light_time for i in indices], axis=1),
        light_span=np.concatenate([i.light_span + shifts({PHASE_FIRST: f}, 2) for i, f in zip(indices, phases, strict=True)], axis=1),
        phase_end=np.concatenate([i.phase_end for i in indices]),
        phase_state=np.concatenate([i.phase_state for i in indices]),
        grid=grid.joined([i.grid for i in indices], points.tolist()),
    )


def shifts(rows: dict[int, int], count: int) -> np.ndarray:
    """A column that adds these numbers to these rows."""
    column = np.zeros((count, 1), dtype=np.int64)
    for row, by in rows.items():
        column[row] = by
    return column


# -- centre lines ----------------------------------------------------------------------------------


def centre_points(centre: np.ndarray) -> np.ndarray:
    """The rows of `points` for one centre line; doubled points are left out."""
    fresh = np.append(True, np.hypot(*np.diff(centre)) > SHORTEST)
    line = centre[:, fresh]
    if line.shape[1] < 2:
        line = np.column_stack([centre[:, 0], centre[:, 0] + (0.5 * SHORTEST, 0.0)])
    step = np.diff(line)
    pieces = np.hypot(*step)
    heading = np.unwrap(arctan2(step[1], step[0]))
    corner = np.diff(heading)
    points = np.zeros((7, line.shape[1]))
    points[[P_X, P_Y]] = line
    points[P_S, 1:] = np.cumsum(pieces)
    points[[P_EAST, P_NORTH], :-1] = step / pieces
    points[[P_EAST, P_NORTH], -1] = points[[P_EAST, P_NORTH], -2]
    points[P_MITRE, 1:-1] = tan(0.5 * np.clip(corner, -SHARPEST_CORNER, SHARPEST_CORNER))
    points[P_HEADING] = np.concatenate([heading[:1], 0.5 * (heading[1:] + heading[:-1]), heading[-1:]])
    return points


def lane_rows(network: Network, lines: list[np.ndarray]) -> np.ndarray:
    """Length, half width and speed limit of every lane."""
    return np.array([(line[P_S, -1], 0.5 * lane.width, lane.speed) for lane, line in zip(network.lanes, lines, strict=True)]).T.copy()


def pieces(points: np.ndarray, point_lane: np.ndarray) -> Grid:
    """The grid over all straight pieces of the centre lines but those of lanes without length, which have no direction."""
    start = np.flatnonzero((point_lane[:-1] == point_lane[1:]) & (np.diff(points[P_S]) > SHORTEST))
    lines = np.concatenate([points[:2, start], points[:2, start + 1]])
    found = grid.over_lines(lines, size=CELL)
    return found._replace(item=start[found.item])


# -- what leads where ------------------------------------------------------------------------------


def span_rows(network: Network, point_counts: np.ndarray, step_counts: np.ndarray) -> np.ndarray:
    """The whole numbers of every lane."""
    number = {road: i for i, road in enumerate(network.roads)}
    light = {lane: i for i, lane in enumerate(network.signals.link_lane.tolist())}
    spans = np.full((9, len(network.lanes)), NONE, dtype=np.int64)
    spans[[POINT_COUNT, STEP_COUNT]] = point_counts, step_counts
    spans[[POINT_FIRST, STEP_FIRST]] = np.cumsum(point_counts) - point_counts, np.cumsum(step_counts) - step_counts
    for lane in network.lanes:
        beside = network.roads[lane.road].lanes
        spans[ROAD, lane.id] = number[lane.road]
        if lane.index > 0 and not lane.internal:
            spans[KERB_SIDE, lane.id] = beside[lane.index - 1]
        if lane.index + 1 < len(beside) and not lane.internal:
            spans[MIDDLE_SIDE, lane.id] = beside[lane.index + 1]
        spans[LIGHT, lane.id] = light.get(lane.id, NONE)
        spans[KIND, lane.id] = INTERNAL * lane.internal + OPEN * lane.open
    return spans


def steps_of(network: Network) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The steps of all lanes one after another, how many each lane has, and the lanes they go over."""
    leaving: list[dict[tuple, None]] = [{} for _ in network.lanes]
    for connection in sorted(network.connections, key=lambda each: (each.direction == "turn", corner(network, each))):
        way, back = (*connection.via, connection.to_lane), int(connection.direction == "turn")
        for i, lane in enumerate((connection.from_lane, *connection.via)):
            leaving[lane][(way[i], connection.to_lane, way[i:-1], back)] = None
    steps, via = [], []
    for onto, reached, through, back in (step for each in leaving for step in each):
        steps.append((onto, reached, len(via), len(through), back))
        via += through
    counts = np.array([len(each) for each in leaving], dtype=np.int64)
    return np.array(steps, dtype=np.int64).reshape(-1, 5).T.copy(), counts, np.array(via, dtype=np.int64)


def corner(network: Network, connection: Connection) -> float:
    """How far one turns from the end of a lane to the start of the lane reached, to either side [rad]."""
    before, after = network.lanes[connection.from_lane].centre, network.lanes[connection.to_lane].centre
    return abs(turn(before[:, -1] - before[:, -2], after[:, 1] - after[:, 0]))
