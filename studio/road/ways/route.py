"""Ways through the network: from road to road over its lanes, in the least time."""

import math
from collections.abc import Collection, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely

from studio.errors import Problem, RouteError, nearest
from studio.road.network import Network, curve
from studio.road.network.graph import graph_of, search, without, without_turns
from studio.road.network.index import once
from studio.road.ways.lane_path import LanePath
from studio.road.ways.lock import GENTLE, MOST_ASIDE, is_drivable
from studio.road.ways.path import path

MOST_NAMED = 5  # turns in a message
MOST_TRIES = 12  # ways that are looked at where turns are too narrow
NEAREST = 2  # connections to the place where a vehicle leaves its lanes that are tried to do without
SHORTEST = 2.0  # [m] there is nothing to drive on a way that is shorter


class Arms(NamedTuple):
    """Roads that lead into the map and out of it, counter-clockwise from east."""

    entries: tuple[str, ...]
    exits: tuple[str, ...]


def arms(network: Network) -> Arms:
    """The roads at the map's border: entries that nothing leads to, exits that lead to nothing."""
    ahead = [c for c in network.connections if c.direction != "turn"]
    fed = {network.lanes[c.to_lane].road for c in ahead}
    feeding = {network.lanes[c.from_lane].road for c in ahead}
    roads = [road for road in network.roads.values() if not road.internal]
    entries = [road.id for road in roads if road.id not in fed]
    exits = [road.id for road in roads if road.id not in feeding]
    return Arms(
        tuple(sorted(entries, key=lambda road: bearing(network, road, 0))),
        tuple(sorted(exits, key=lambda road: bearing(network, road, -1))),
    )


def bearing(network: Network, road: str, end: int) -> float:
    """Direction from the map's centre to the start (0) or end (-1) of a road [rad]."""
    x, y = network.lanes_of(road)[0].centre[:, end]
    return math.atan2(y, x) % (2.0 * math.pi)


def all_routes(network: Network, lock: float = curve.LOCK) -> tuple[LanePath, ...]:
    """The quickest way from every entry to every exit for vehicles of a lock [1/m], where there is one; of a road without others every
    lane is a way."""
    entries, exits = arms(network)
    found = []
    for entry in entries:
        for end in exits:
            if entry == end:
                found += [LanePath((lane.id,)) for lane in network.lanes_of(entry) if lane.open and lane.length >= SHORTEST]
                continue
            try:
                found.append(connect(network, [entry, end], lock=lock))
            except RouteError:
                continue
    return tuple(found)


def connect(
    network: Network, roads: Sequence[str], *, start_lane: int | None = None, turn_back: bool = False, avoid: Collection[str] = (),
    lock: float = curve.LOCK,
) -> LanePath:  # fmt: skip
    """The quickest lanes through `roads` in this order; between two of them any road may be used.

    Args:
        network: the map.
        roads: road ids, at least one.
        start_lane: lane of the first road to start in, 0 at the kerb; left out, the quickest.
        turn_back: whether one may turn back at the end of a dead end; such a turn is narrower than a car can drive.
        avoid: roads that must not be entered.
        lock: the sharpest curve that the vehicle can drive [1/m]; every turn that is left in a map suits a car.

    Raises:
        RouteError: a road is not on the map, there is no way from one to the next, or only one over turns that are too narrow for the
            vehicle, or hardly any to drive.
    """
    check(network, roads, start_lane)
    lanes = network.roads[roads[0]].lanes
    starts = lanes if start_lane is None else (lanes[start_lane],)
    if start_lane is None and any(network.lanes[lane].open for lane in lanes):
        starts = tuple(lane for lane in lanes if network.lanes[lane].open)
    graph = without(graph_of(network), avoid)

    def wide(shut: tuple[int, ...]) -> tuple[tuple[int, ...], int, tuple[int, ...]]:
        """The quickest way without some connections and without those that are too narrow, how far one comes, and all that was left out."""
        way, reached = search(without_turns(graph, shut) if shut else graph, tuple(roads), starts, turn_back=turn_back)
        while way and (narrow := too_narrow(network, way, lock)):
            shut = (*shut, *narrow)
            way, reached = search(without_turns(graph, shut), tuple(roads), starts, turn_back=turn_back)
        return way, reached, shut

    waiting: list[tuple[int, ...]] = [()]
    refused: tuple[int, tuple[int, ...]] | None = None
    for _ in range(MOST_TRIES):
        way, reached, shut = wide(waiting.pop(0))
        if way:
            check_length(network, roads, sum(network.lanes[lane].length for lane in way))
            near = too_near(network, way, lock)
            if not near:
                return LanePath(way)
            waiting = [(*shut, each) for each in near] + waiting
        else:
            refused = refused or (reached, shut)
        if not waiting:
            break
    reached, shut = refused or (len(roads) - 1, waiting[0])
    raise too_narrow_a_way(network, tuple(roads), reached, shut, lock) if shut else no_way(network, tuple(roads), reached)


def too_narrow(network: Network, way: tuple[int, ...], lock: float) -> tuple[int, ...]:
    """The connections on a way that are too narrow for a vehicle of a lock [1/m]; none for a car, for which all are wide enough."""
    if lock >= curve.LOCK:
        return ()
    return tuple(each for each in passed_on(network, way) if not is_drivable(network, each, lock))


def too_near(network: Network, way: tuple[int, ...], lock: float) -> tuple[int, ...]:
    """Where a vehicle of a lock [1/m] leaves its lanes too far, since turns that it gets round one by one follow each other too closely:
    the nearest connections, any of which may be left out; none for a car, and where it keeps to its way."""
    passed = passed_on(network, way)
    if lock >= curve.LOCK or not any(network.connections[each].sharpest > GENTLE * lock for each in passed):
        return ()
    line = path(network, LanePath(way), lock=lock).points[:2]
    aside = away(line, [network.lanes[lane].centre for lane in way])
    if aside.max() <= MOST_ASIDE:
        return ()
    ends = {each: network.lanes[network.connections[each].from_lane].centre[:, -1] for each in passed}
    x, y = line[:, int(aside.argmax())]
    return tuple(sorted(ends, key=lambda each: math.hypot(ends[each][0] - x, ends[each][1] - y))[:NEAREST])


def away(points: np.ndarray, lines: list[np.ndarray]) -> np.ndarray:
    """How far points float64[2, n] are from the nearest of some lines [m]."""
    pieces = np.concatenate([np.stack([line[:, :-1].T, line[:, 1:].T], axis=1) for line in lines])
    tree = shapely.STRtree(shapely.linestrings(pieces))
    (place, _), far = tree.query_nearest(shapely.points(points.T), return_distance=True, all_matches=False)
    return far[np.argsort(place)]


def passed_on(network: Network, way: tuple[int, ...]) -> list[int]:
    """The numbers of the connections on a way, but for turning back."""
    number, roads = numbers(network), [lane for lane in way if not network.lanes[lane].internal]
    passed = (number[pair] for pair in pairwise(roads) if pair in number)
    return [each for each in passed if network.connections[each].direction != "turn"]


@once
def numbers(network: Network) -> dict[tuple[int, int], int]:
    """The numbers of the connections by the lanes that they join."""
    return {(each.from_lane, each.to_lane): i for i, each in enumerate(network.connections)}


def too_narrow_a_way(network: Network, roads: tuple[str, ...], reached: int, shut: tuple[int, ...], lock: float) -> RouteError:
    """The error that names the turns for which a vehicle finds no way between two roads."""
    turns = [network.connections[each] for each in shut]
    named = dict.fromkeys(f"{network.lanes[each.from_lane].road!r} to {network.lanes[each.to_lane].road!r}" for each in turns)
    return RouteError(
        f"{network.name}: there is no way from road {roads[reached - 1]!r} to road {roads[reached]!r} for a vehicle that turns no sharper "
        f"than with a radius of {1.0 / lock:.1f} m",
        [Problem(f"roads[{reached}]", "is only reached over turns that are too narrow for it", repr(roads[reached]),
                 remedy=f"too narrow: {', '.join(list(named)[:MOST_NAMED])}; name other roads, or a vehicle that turns more sharply")],
    )  # fmt: skip


def check_length(network: Network, roads: Sequence[str], length: float) -> None:
    """Refuses a way on which there is nothing to drive: maps have roads of a few centimetres between their junctions."""
    if length < SHORTEST:
        raise RouteError(
            f"{network.name}: the route is too short to be driven",
            [Problem("roads", "are too short together", f"{length:.2f} m of {', '.join(map(repr, roads))}", f"at least {SHORTEST:g} m",
                     "name a road before or behind")],
        )  # fmt: skip


def check(network: Network, roads: Sequence[str], start_lane: int | None) -> None:
    """Refuses roads and lanes that are not on the map."""
    if not roads:
        raise RouteError("a route needs at least one road")
    unknown = [(i, road) for i, road in enumerate(roads) if road not in network.roads or network.roads[road].internal]
    if unknown:
        known = [road.id for road in network.roads.values() if not road.internal]
        raise RouteError(
            f"{network.name}: the route names a road that is not on the map",
            [Problem(f"roads[{i}]", "no such road", repr(road), remedy=nearest(road, known)) for i, road in unknown],
        )
    count = len(network.roads[roads[0]].lanes)
    if start_lane is not None and start_lane not in range(count):
        raise RouteError(
            f"{network.name}: the route cannot start there",
            [Problem("start_lane", f"no such lane of road {roads[0]!r}", repr(start_lane), f"0 to {count - 1}")],
        )


def no_way(network: Network, roads: tuple[str, ...], reached: int) -> RouteError:
    """The error that names the pair of roads without a way, and where one can go instead."""
    start, end = roads[reached - 1], roads[reached]
    lanes = set(network.roads[start].lanes)
    ahead = [c for c in network.connections if c.from_lane in lanes and c.direction != "turn"]
    following = {network.lanes[c.to_lane].road for c in ahead}
    remedy = f"after {start!r} come: {', '.join(sorted(following))}" if following else f"{start!r} leads out of the map"
    return RouteError(
        f"{network.name}: there is no way from road {start!r} to road {end!r}",
        [Problem(f"roads[{reached}]", "cannot be reached from the road before it", repr(end), remedy=remedy)],
    )
