"""The roads of a map as a graph whose prices are times, and the cheapest way through it.

    node     a lane that has been entered; once more for every way to have got there that a ban remembers
    edge     along the road, by lane changes if need be, and through the junction onto the next road's lane
    price    seconds: length over what limit and bends allow, lane changes, the mean wait at a light or for others

Mean wait at a light: who comes at any time waits r²/(2 C) for a red of r [s] in a cycle of C [s] (F. V. Webster, Traffic
signal settings, Road Research Technical Paper 39, 1958, first term of Eq. 4 for little traffic).
"""

import heapq
from collections import defaultdict
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from studio.compiled import compiled
from studio.road.network import Connection, Lane, Network
from studio.road.network.curve import LOCK
from studio.road.network.index import (
    LANE_LENGTH,
    LANE_SPEED,
    P_HEADING,
    P_S,
    POINT_COUNT,
    POINT_FIRST,
    Index,
    index_of,
    once,
)
from studio.road.network.signals import GREEN, Signals

CHANGE_TIME = 2.0  # [s] a lane change is taken only if it saves a detour of this duration
CHANGE_ROOM = 12.0  # [m] of road that one lane change needs at the very least
CHANGE_EASE = 50.0  # [m] of road on which a lane change is comfortable
CLOSED_TIME = 75.0  # [s] a lane that cars keep out of is used only where nothing else leads on
YIELD_TIME = 1.5  # [s] mean wait for others: the default of SUMO's router, weights.minor-penalty
NARROW_TIME = 75.0  # [s] a turn over which one swings out is driven only where all else is a long detour
BACK_TIME = 15.0  # [s] a turn back
BEND_REACH = 6.0  # [m] before and behind a place, on which its curvature is taken
LATERAL = 2.5  # [m/s²] in bends, as the paths have it
SLOWEST = 2.0  # [m/s] the sharpest bend is still driven
STRIDE = 2.0  # [m] of a lane that is driven at one speed


class Edge(NamedTuple):
    """From a lane to the lane `to` of another road over a connection: price [s], the lanes on the way, whether it turns back."""

    to: int
    price: float
    way: tuple[int, ...]
    back: bool
    connection: int


@dataclass(frozen=True, eq=False)
class Graph:
    """Edges of node i are first[i] to first[i + 1]. The first nodes are the lanes; `road` is the number of a node's road, `connection`
    that of an edge's connection."""

    first: np.ndarray
    to: np.ndarray
    price: np.ndarray
    back: np.ndarray
    road: np.ndarray
    connection: np.ndarray
    ways: tuple[tuple[int, ...], ...]
    number: dict[str, int]  # of the roads


@once
def graph_of(network: Network) -> Graph:
    """The graph of a map."""
    edges = edges_of(network)
    number = {road: i for i, road in enumerate(network.roads)}
    lane_of, leaving = nodes(network, edges)
    flat = [each for own in leaving for each in own]
    return Graph(
        first=np.concatenate([[0], np.cumsum([len(own) for own in leaving])]).astype(np.int64),
        to=np.array([node for node, _ in flat], dtype=np.int64),
        price=np.array([edge.price for _, edge in flat], dtype=float),
        back=np.array([edge.back for _, edge in flat], dtype=bool),
        road=np.array([number[network.lanes[lane].road] for lane in lane_of], dtype=np.int64),
        connection=np.array([edge.connection for _, edge in flat], dtype=np.int64),
        ways=tuple(edge.way for _, edge in flat),
        number=number,
    )


def search(graph: Graph, roads: tuple[str, ...], starts: tuple[int, ...], *, turn_back: bool) -> tuple[tuple[int, ...], int]:
    """The lanes of the quickest way through the roads in this order, none if there is no way; and how many were reached."""
    wanted = np.array([graph.number[road] for road in roads], dtype=np.int64)
    first_lanes = np.array(starts, dtype=np.int64)
    edges, start, reached = cheapest(graph.first, graph.to, graph.price, graph.back, graph.road, first_lanes, wanted, turn_back)
    return (() if start < 0 else (int(start), *(lane for edge in edges for lane in graph.ways[edge]))), reached


def without(graph: Graph, avoid: Collection[str]) -> Graph:
    """The graph in which nothing leads onto some roads."""
    shut = [graph.number[road] for road in avoid if road in graph.number]
    return replace(graph, price=np.where(np.isin(graph.road[graph.to], shut), np.inf, graph.price)) if shut else graph


def without_turns(graph: Graph, shut: Collection[int]) -> Graph:
    """The graph without some connections."""
    return replace(graph, price=np.where(np.isin(graph.connection, list(shut)), np.inf, graph.price))


@compiled
def cheapest(first, to, price, back, road, starts, wanted, turn_back):
    """Edges of the cheapest way (Dijkstra 1959) from one of the start nodes through the wanted roads, that start node, and how
    many of the roads were reached at most; the start is -1 when there is no way."""
    nodes, stages = road.size, wanted.size
    cost = np.full(nodes * stages, np.inf)
    came = np.full(nodes * stages, -1)
    before = np.full(nodes * stages, -1)
    waiting = [(0.0, 0)]
    waiting.pop()
    for node in starts:
        cost[node * stages] = 0.0
        heapq.heappush(waiting, (0.0, node * stages))
    reached = 1
    while len(waiting) > 0:
        spent, state = heapq.heappop(waiting)
        if spent > cost[state]:
            continue
        node, stage = state // stages, state % stages
        reached = max(reached, stage + 1)
        if stage == stages - 1:
            return trail(came, before, state), origin(before, state) // stages, reached
        for edge in range(first[node], first[node + 1]):
            if back[edge] and not turn_back:
                continue
            further = stage + 1 if road[to[edge]] == wanted[stage + 1] else stage
            onto = to[edge] * stages + further
            total = spent + price[edge]
            if total < cost[onto]:
                cost[onto], came[onto], before[onto] = total, edge, state
                heapq.heappush(waiting, (total, onto))
    return np.empty(0, np.int64), -1, reached


@compiled
def origin(before, state):
    """Where the way to a state began."""
    while before[state] >= 0:
        state = before[state]
    return state


@compiled
def trail(came, before, state):
    """The edges of the way to a state, in driving order."""
    count, at = 0, state
    while before[at] >= 0:
        count, at = count + 1, before[at]
    edges = np.empty(count, np.int64)
    while before[state] >= 0:
        count -= 1
        edges[count], state = came[state], before[state]
    return edges


# -- nodes -----------------------------------------------------------------------------------------


def nodes(network: Network, edges: list[list[Edge]]) -> tuple[list[int], list[list[tuple[int, Edge]]]]:
    """The lane of every node, and its edges with the nodes that they lead to.

    A node is a lane and the bans whose beginning has just been driven; what would complete a ban has no edge.
    """
    begun = {lane.id: begin(lane.road, network.bans) for lane in network.lanes}
    known = {(lane, begun[lane]): lane for lane in begun}
    waiting, leaving = list(known), []
    for lane, memory in waiting:  # grows while it is gone through
        own = []
        for edge in edges[lane]:
            road = network.lanes[edge.to].road
            passed = frozenset((ban, stage + 1) for ban, stage in memory if network.bans[ban][stage] == road)
            if any(stage == len(network.bans[ban]) for ban, stage in passed):
                continue
            key = (edge.to, passed | begun[edge.to])
            if key not in known:
                known[key] = len(known)
                waiting.append(key)
            own.append((known[key], edge))
        leaving.append(own)
    return [lane for lane, _ in waiting], leaving


def begin(road: str, bans: tuple[tuple[str, ...], ...]) -> frozenset[tuple[int, int]]:
    """The bans that begin on a road, with the number of their roads that have been driven."""
    return frozenset((i, 1) for i, ban in enumerate(bans) if ban[0] == road)


# -- edges and their prices ------------------------------------------------------------------------


def edges_of(network: Network) -> list[list[Edge]]:
    """The edges that leave each lane."""
    exits = defaultdict(list)
    for connection in network.connections:
        exits[connection.from_lane].append(connection)
    number = {id(connection): i for i, connection in enumerate(network.connections)}
    times, waits = lane_times(index_of(network)), mean_waits(network.signals)
    found: list[list[Edge]] = [[] for _ in network.lanes]
    for lane in network.lanes:
        if not lane.internal:
            for price, used in changes(network, lane):
                for each in exits[used[-1]]:
                    if each.direction == "turn" and not is_dead_end(network, lane, exits):
                        continue
                    through = price + times[lane.id] + times[list(each.via)].sum() + wait(each, waits) + unwanted(network, each)
                    lanes = *used[1:], *each.via, each.to_lane
                    found[lane.id].append(Edge(each.to_lane, float(through), lanes, each.direction == "turn", number[id(each)]))
    return found


def changes(network: Network, lane: Lane) -> Iterator[tuple[float, tuple[int, ...]]]:
    """How the road may be left that was entered on `lane`: what lane changes cost [s] and the lanes used, from this one on."""
    lanes = network.roads[lane.road].lanes
    yield 0.0, (lane.id,)
    for side in (-1, 1):
        used, index = (lane.id,), lane.index + side
        while 0 <= index < len(lanes) and len(used) * CHANGE_ROOM <= lane.length:
            hurry = 1.0 + (len(used) * CHANGE_EASE / lane.length) ** 2
            price = CHANGE_TIME * len(used) * hurry + closed(network.lanes[lanes[index]])
            used = (*used, lanes[index])
            yield price, used
            index += side


def closed(lane: Lane) -> float:
    """What it costs to drive onto a lane that is not for cars [s]."""
    return 0.0 if lane.open else CLOSED_TIME


def is_dead_end(network: Network, lane: Lane, exits: dict[int, list[Connection]]) -> bool:
    """Whether nothing but a turn back leads on from a road."""
    return all(each.direction == "turn" for other in network.roads[lane.road].lanes for each in exits[other])


def wait(connection: Connection, waits: np.ndarray) -> float:
    """Mean wait before a connection [s]: at its light, or for those that go first."""
    if connection.direction == "turn":
        return BACK_TIME
    if connection.link >= 0:
        return float(waits[connection.link])
    return YIELD_TIME if connection.yields else 0.0


def unwanted(network: Network, connection: Connection) -> float:
    """What it costs to use a connection that is there, but not for a car [s]."""
    return closed(network.lanes[connection.to_lane]) + (NARROW_TIME if connection.sharpest > LOCK else 0.0)


def mean_waits(signals: Signals) -> np.ndarray:
    """Mean wait at every light of who comes at any time [s]."""
    return np.array([mean_wait(*programme_of(signals, link)) for link in range(len(signals))])


def programme_of(signals: Signals, link: int) -> tuple[np.ndarray, np.ndarray]:
    """Ends of the phases within the cycle [s], and what is shown."""
    phases = slice(signals.first[link], signals.first[link] + signals.count[link])
    return signals.phase_end[phases], signals.phase_state[phases]


def mean_wait(ends: np.ndarray, states: np.ndarray) -> float:
    """The sum of r²/(2 C) over all stretches without green; without any green half a cycle."""
    reds, cycle = [], float(ends[-1])
    for duration, state in zip(np.diff(ends, prepend=0.0).tolist(), states.tolist(), strict=True):
        if state == GREEN:
            reds.append(0.0)
        elif reds:
            reds[-1] += duration
        else:
            reds.append(duration)
    if not (states == GREEN).any():
        return 0.5 * cycle
    if states[0] != GREEN and states[-1] != GREEN:  # one stretch, over the end of the cycle
        reds[0] += reds.pop()
    return sum(red**2 for red in reds) / (2.0 * cycle)


def lane_times(index: Index) -> np.ndarray:
    """How long it takes to drive along every lane [s], at its limit and as its bends allow."""
    times = np.empty(index.lanes.shape[1])
    drive(index.points, index.lanes, index.spans, times)
    return times


@compiled
def drive(points, lanes, spans, times):
    """Writes the time along every lane [s]."""
    for lane in range(times.size):
        first, count, length = spans[POINT_FIRST, lane], spans[POINT_COUNT, lane], lanes[LANE_LENGTH, lane]
        strides = max(1, int(round(length / STRIDE)))
        step, total = length / strides, 0.0
        for i in range(strides):
            total += step / min(lanes[LANE_SPEED, lane], bend_speed(points, first, count, length, (i + 0.5) * step))
        times[lane] = total


@compiled
def bend_speed(points, first, count, length, s):
    """Speed [m/s] that the bend at arc length s [m] allows: v² = a/kappa."""
    low, high = max(s - BEND_REACH, 0.0), min(s + BEND_REACH, length)
    turned = abs(direction(points, first, count, high) - direction(points, first, count, low))
    return max(np.sqrt(LATERAL * (high - low) / max(turned, 1e-9)), SLOWEST)


@compiled
def direction(points, first, count, s):
    """Heading of a centre line at arc length s [m], without jumps [rad]."""
    i = first
    while i < first + count - 2 and points[P_S, i + 1] < s:
        i += 1
    u = min(max((s - points[P_S, i]) / (points[P_S, i + 1] - points[P_S, i]), 0.0), 1.0)
    return (1.0 - u) * points[P_HEADING, i] + u * points[P_HEADING, i + 1]
