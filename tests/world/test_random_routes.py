"""Two hundred ways drawn by lot through a real place, each driven by one car alone: nobody leaves the lane, limits and bends are
kept, red is obeyed, everybody arrives."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from studio.errors import RouteError
from studio.road import load
from studio.road.network import Network, curve
from studio.road.network.curve import LOCK
from studio.road.network.signals import RED, RED_AMBER
from studio.road.ways import path as road_path
from studio.road.ways.lane_path import LanePath
from studio.road.ways.lock import MOST_ASIDE
from studio.road.ways.path import PATH_CURVATURE, PATH_SPEED
from studio.road.ways.route import connect
from studio.scenario import catalogue
from studio.scenario.schema import Gps, Intervention, Scenario
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import ACTIVE, V_X, X, Y
from studio.world.build import build
from studio.world.car import Car
from studio.world.setting import Setting
from studio.world.table.mind import OFFSET, STATION
from studio.world.tick import tick
from studio.world.way import Works

ROOT = Path(__file__).parents[2]
PLACES = {
    "grosser_stern": ROOT / "scenarios" / "maps" / "berlin_siegessaeule_grosser_stern.osm.gz",
    "berlin_mitte": ROOT / "tests" / "reference" / "maps" / "berlin_mitte.osm.gz",
}
ROUTES = 200
SHORTEST = 300.0  # [m]
LONGEST_TIME = 900.0  # [s] for 4 km through a city with its lights
SETTLED = 3.0  # [s] after the start
LATERAL = 2.5  # [m/s²] that paths allow in bends
SAMPLE = 10  # ticks between two looks at where the cars are
NEARBY = 40.0  # [m] along the way, by which its parts may be longer or shorter than their lanes


@dataclass
class Driven:
    """One way with what its car did: where it was now and then, the most over the limit, lateral acceleration,
    from its path, red lights."""

    lanes: LanePath
    path: road_path.Path
    places: list
    over: float = 0.0
    lateral: float = 0.0
    beside: float = 0.0
    red: int = 0
    arrived: bool = False


def drawn(network: Network) -> list[Driven]:
    """Ways between roads drawn by lot, all different."""
    chance = np.random.default_rng(4)
    roads = sorted(road.id for road in network.roads.values() if not road.internal)
    found: dict[tuple[str, str], Driven] = {}
    for _ in range(200 * ROUTES):
        start, end = (str(each) for each in chance.choice(roads, 2, replace=False))
        try:
            lanes = connect(network, [start, end])
        except RouteError:
            continue
        path = road_path.path(network, lanes)
        if path.length >= SHORTEST:
            found[start, end] = Driven(lanes, path, [])
        if len(found) == ROUTES:
            return list(found.values())
    raise AssertionError("there are not so many ways")


def setting(network: Network, driven: Driven) -> Setting:
    """One car alone at the start of its way."""
    text = {"title": "way", "map": {"file": "x"}, "routes": {"way": {"roads": ["x"]}},
            "vehicles": {"car": {"route": "way", "position": {"along": 0}, "speed": 0}}}  # fmt: skip
    near_light = any(s < 40.0 for s, _ in driven.path.stop_lines)
    speed = 0.0 if near_light else float(min(8.0, driven.path.points[PATH_SPEED, 3:20].min()))
    scenario = Scenario.model_validate(text)
    driver, model = scenario.vehicles["car"].driver, catalogue.find_vehicle("bmw_320i")
    car = Car("car", model, driven.path, 3.0, speed, driver, Intervention(), "#2f6fde", Gps())
    return Setting(scenario, network, (car,), (), Works(()), {})


def drive(network: Network, ways: list[Driven]) -> None:
    """All ways at once, each in a world of its own."""
    world = build([setting(network, each) for each in ways])
    v, r = world.vehicles, world.roads
    before = v.mind[STATION].copy()
    while v.state[ACTIVE].any() and world.clock.time < LONGEST_TIME:
        active, shown = v.state[ACTIVE] > 0.0, r.shown.copy()
        tick(world)
        s = v.mind[STATION]
        at = np.clip(s.astype(int), 0, r.path_count - 1) + r.path_first
        speed = v.state[V_X]
        over = speed - np.maximum(r.points[PATH_SPEED, at], r.points[PATH_SPEED, np.minimum(at + 1, r.path_first + r.path_count - 1)])
        lateral = np.abs(r.points[PATH_CURVATURE, at]) * speed**2
        for i in np.flatnonzero(active):
            way = ways[i]
            way.arrived = v.state[ACTIVE, i] == 0.0
            if world.clock.time > SETTLED:
                way.over, way.lateral = max(way.over, over[i]), max(way.lateral, lateral[i])
                way.beside = max(way.beside, abs(v.mind[OFFSET, i]))
            stops = range(r.stop_first[i], r.stop_first[i] + r.stop_count[i])
            passed = [k for k in stops if before[i] + v.parameter[FRONT, i] < r.stop_station[k] <= s[i] + v.parameter[FRONT, i]]
            way.red += sum(shown[r.stop_link[k]] in (RED, RED_AMBER) for k in passed)
            if world.clock.k % SAMPLE == 0 and not way.arrived:
                way.places.append((*v.state[[X, Y], i], s[i]))
        before = s.copy()


def offset(network: Network, way: Driven) -> float:
    """Largest distance of the car from the lanes of its way [m], lane changes apart; of other parts of the way it may be near."""
    stretches = road_path.stretches(network, way.lanes)
    *places, station = np.array(way.places).T
    ends = np.cumsum([np.mean([lane.length for lane in used]) for used in stretches])
    away = np.array([np.min([curve.distances(np.array(places), lane.centre) for lane in used], axis=0) for used in stretches])
    starts = np.concatenate([[0.0], ends[:-1]])
    here = (station > starts[:, None] - NEARBY) & (station < ends[:, None] + NEARBY)
    away = np.where(here, away, np.inf)
    alone = np.array([len(used) == 1 for used in stretches])
    return float(away.min(axis=0)[alone[away.argmin(axis=0)]].max(initial=0.0))


def is_drivable(network: Network, way: Driven) -> bool:
    """Whether no turn on the way is narrower than a car can drive."""
    onto = set(zip(way.lanes.lanes, way.lanes.lanes[1:], strict=False))
    used = [c for c in network.connections if c.via and (c.from_lane, c.via[0]) in onto and (c.via[-1], c.to_lane) in onto]
    return max((c.sharpest for c in used), default=0.0) <= LOCK


@pytest.fixture(scope="module", params=PLACES)
def place(request):
    network = load(PLACES[request.param])
    ways = drawn(network)
    drive(network, ways)
    return request.param, network, ways


def test_random_ways_are_driven_as_the_road_is_built(place):
    name, network, ways = place
    drivable = [way for way in ways if is_drivable(network, way)]
    swinging = [way for way in ways if way not in drivable]  # over a turn that the map draws narrower than a car's lock
    assert len(drivable) >= 0.95 * ROUTES
    assert all(way.arrived and way.beside < 0.4 and offset(network, way) < MOST_ASIDE + 0.4 for way in swinging)
    offsets = np.array([offset(network, way) for way in drivable])
    print(f"{name}: {len(drivable)} of {ROUTES} ways, {sum(way.path.length for way in drivable) / 1000:.0f} km; "
          f"offset {np.median(offsets):.2f} m, at most {offsets.max():.2f} m; "
          f"from the path at most {max(way.beside for way in drivable):.2f} m; over the limit at most "
          f"{max(way.over for way in drivable):.2f} m/s; "
          f"lateral acceleration at most {max(way.lateral for way in drivable):.2f} m/s²")  # fmt: skip
    assert all(way.arrived for way in drivable)
    assert sum(way.red for way in drivable) == 0
    assert offsets.max() < 0.5
    assert max(way.beside for way in drivable) < 0.3  # 0.38 m where the front axle drives the path
    assert max(way.over for way in drivable) < 0.6
    assert max(way.lateral for way in drivable) < 1.2 * LATERAL
