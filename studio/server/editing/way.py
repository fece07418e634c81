"""Ways by clicking: from points near roads to the roads that a route names.

At a point both directions of a street may be meant: of the roads near it the one is taken that one gets to soonest from where one is.
"""

from math import inf

import numpy as np
import shapely

from studio.errors import Problem, RouteError
from studio.road.network import Network
from studio.road.network.curve import LOCK
from studio.road.ways import path as road_path
from studio.road.ways.path import Path
from studio.road.ways.route import connect
from studio.server.editing.answer import Way
from studio.server.editing.figure import from_station, handles

REACH = 12.0  # [m] a click may lie beside the middle of a lane
ASIDE = 8.0  # [m] roads so much farther than the nearest may be meant too
ONWARDS = 400.0  # [m] that a way goes on
MOST_ROADS = 40  # that are added for it


def way(network: Network, points: list[tuple[float, float]], *, onwards: bool, before: list[str], lock: float = LOCK) -> Way:
    """The way through points, behind roads that are given, for vehicles of a lock [1/m].

    Raises RouteError that says which point cannot be reached, and why.
    """
    roads = list(before)
    for number, point in enumerate(points, start=1):
        roads = reached(network, roads, point, number, lock)
    if onwards:
        roads = extended(network, roads, lock)
    line = driven(network, roads, lock)
    return Way(roads=roads, line=from_station(line, 0.0), length=round(line.length, 1), handles=handles(roads, network))


def reached(network: Network, roads: list[str], point: tuple[float, float], number: int, lock: float) -> list[str]:
    """The roads with the one at a point behind them."""
    near, wrong = roads_near(network, point), None
    if roads and roads[-1] in near:
        return roads
    best, least = None, inf
    for each in near:
        try:
            length = driven(network, [*roads, each], lock).length
        except RouteError as error:
            wrong = wrong or error
            continue
        if length < least - ASIDE:
            best, least = each, length
    if best is None:
        raise unreachable(point, number, wrong)
    return [*roads, best]


def unreachable(point: tuple[float, float], number: int, wrong: RouteError | None) -> RouteError:
    """Why a point cannot be a part of the way."""
    where = f"point {number}"
    if wrong is None:
        place = f"{point[0]:.0f} m east, {point[1]:.0f} m north"
        return RouteError(
            "No road is there.", [Problem(where, "lies on no road", place, f"within {REACH:g} m of a lane", "click on a road")]
        )
    why = wrong.problems[0] if wrong.problems else Problem(where, wrong.message)
    return RouteError("No way leads there.", [Problem(where, "cannot be reached from the road before it", why.value, remedy=why.remedy)])


def roads_near(network: Network, point: tuple[float, float]) -> list[str]:
    """The roads that a point may mean, the nearest first."""
    at, found = shapely.Point(point), {}
    for road in network.roads.values():
        if road.internal:
            continue
        lanes = [lane for lane in network.lanes_of(road.id) if lane.open]
        away = min((shapely.LineString(lane.centre[:2].T).distance(at) for lane in lanes), default=inf)
        if away <= REACH:
            found[road.id] = away
    least = min(found.values(), default=inf)
    return sorted((road for road, away in found.items() if away <= least + ASIDE), key=found.__getitem__)


def driven(network: Network, roads: list[str], lock: float) -> Path:
    """The line along roads of a vehicle of a lock [1/m]; raises RouteError."""
    return road_path.path(network, connect(network, roads, lock=lock), lock=lock)


def extended(network: Network, roads: list[str], lock: float) -> list[str]:
    """The roads with those behind them onto which one goes straightest, until they are long enough or the map ends."""
    found = list(roads)
    for _ in range(MOST_ROADS):
        if (
            sum(network.lanes_of(road)[0].length for road in found[-MOST_ROADS:]) >= ONWARDS
            or (after := straightest(network, found[-1])) is None
        ):
            break
        if after in found:
            break
        found.append(after)
    return [*roads, found[-1]] if len(found) > len(roads) and leads(network, [*roads, found[-1]], lock) else roads


def leads(network: Network, roads: list[str], lock: float) -> bool:
    """Whether roads connect for a vehicle of a lock [1/m]."""
    try:
        driven(network, roads, lock)
    except RouteError:
        return False
    return True


def straightest(network: Network, road: str) -> str | None:
    """The road behind another whose direction differs least; None at the end of the map."""
    lanes = set(network.roads[road].lanes)
    after = {network.lanes[each.to_lane].road for each in network.connections if each.from_lane in lanes and each.direction != "turn"}
    after = {each for each in after if not network.roads[each].internal}
    end = bearing(network.lanes_of(road)[0].centre[:2, -2:])
    return min(sorted(after), key=lambda each: abs(turned(bearing(network.lanes_of(each)[0].centre[:2, :2]) - end)), default=None)


def bearing(piece: np.ndarray) -> float:
    """Direction of a piece of a line [rad]."""
    dx, dy = piece[:, 1] - piece[:, 0]
    return float(np.arctan2(dy, dx))


def turned(angle: float) -> float:
    """An angle between -pi and pi."""
    return float((angle + np.pi) % (2.0 * np.pi) - np.pi)
