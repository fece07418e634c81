"""Turns that a map draws narrower than a car's lock, driven one by one: everybody keeps to the line that swings out, and arrives."""

from pathlib import Path

import numpy as np
import pytest

from studio.road import load
from studio.road.network import curve
from studio.road.ways.approach import Approaches
from studio.road.ways.lane_path import LanePath
from studio.road.ways.lock import is_drivable
from studio.road.ways.path import PATH_CURVATURE, PATH_SPEED, path
from studio.scenario import catalogue, figures
from studio.scenario.schema import Gps, Intervention, Scenario
from studio.vehicle.state import A_Y, ACTIVE
from studio.world.build import build
from studio.world.car import Car
from studio.world.setting import Setting
from studio.world.table.mind import OFFSET
from studio.world.tick import tick
from studio.world.way import Works

MAPS = Path(__file__).parents[1] / "reference" / "maps"
RUN_UP = 60.0  # [m] before and behind the turn
LONGEST_TIME = 240.0  # [s] with a light on the way
BESIDE = {"suv": 0.4, "truck": 1.0}  # [m] from the line that is to be driven: the front axle goes wide by L² kappa/8
SHORTEST = 40.0  # [m] there is little to drive on a way into a dead end of less
ACROSS = 3.2  # [m/s²], of 2.5 m/s² that the line is drawn for
TEXT = {"title": "turn", "map": {"file": "x"}, "routes": {"way": {"roads": ["x"]}},
        "vehicles": {"car": {"route": "way", "position": {"along": 0}, "speed": 0}}}  # fmt: skip


def way_over(network, connection):
    """The lanes over a turn, with roads before and behind."""
    known, lanes = Approaches(network), [connection.from_lane, *connection.via, connection.to_lane]
    room = network.lanes[lanes[0]].length
    while room < RUN_UP and (each := known.before.get(lanes[0])) and each.from_lane not in lanes:
        lanes[:0] = [each.from_lane, *each.via]
        room += network.lanes[each.from_lane].length
    room = network.lanes[lanes[-1]].length
    while room < RUN_UP and (each := known.behind.get(lanes[-1])) and each.to_lane not in lanes:
        lanes += [*each.via, each.to_lane]
        room += network.lanes[each.to_lane].length
    return LanePath(tuple(lanes))


def setting(network, line, model):
    """One vehicle alone on a line, slowly under way."""
    scenario, begin = Scenario.model_validate(TEXT), 8.0
    speed = float(min(3.0, line.points[PATH_SPEED, int(begin) : int(begin) + 15].min()))
    car = Car("car", model, line, begin, speed, scenario.vehicles["car"].driver, Intervention(), "#2f6fde", Gps())
    return Setting(scenario, network, (car,), (), Works(()), {})


def driven(network, lines, model):
    """What comes of all of them, each in a world of its own: who arrives, most beside the line [m], most across [m/s²]."""
    world = build([setting(network, each, model) for each in lines])
    beside, across = np.zeros(len(lines)), np.zeros(len(lines))
    while world.vehicles.state[ACTIVE].any() and world.clock.time < LONGEST_TIME:
        tick(world)
        on = world.vehicles.state[ACTIVE] > 0.0
        beside = np.maximum(beside, np.where(on, np.abs(world.vehicles.mind[OFFSET]), 0.0))
        across = np.maximum(across, np.where(on, np.abs(world.vehicles.state[A_Y]), 0.0))
    return world.vehicles.state[ACTIVE] == 0.0, beside, across


@pytest.fixture(scope="module", params=["berlin_mitte", "munich_olympiapark", "perth_peanut_roundabout_lht", "manchester_kingsway_lht"])
def place(request):
    network = load(next(MAPS.glob(f"{request.param}.*")))
    return network, [i for i, each in enumerate(network.connections) if each.sharpest > curve.LOCK and each.direction != "turn"]


@pytest.mark.parametrize("name", ["suv", "truck"])
def test_every_turn_that_is_offered_is_driven(place, name):
    """By the car of the catalogue that turns least, and by the truck where it may be sent. Where one narrow turn follows on the other
    within a few metres, as in two of the places, it is tried with the car alone."""
    network, narrow = place
    if name == "truck":
        narrow = [i for i in narrow if network.name.startswith(("berlin", "manchester"))]
    model = catalogue.find_vehicle(name)
    lock = min(curve.LOCK, figures.lock(model.values))
    lines = [path(network, way_over(network, network.connections[i]), lock=lock) for i in narrow if is_drivable(network, i, lock)]
    lines = [each for each in lines if each.length > SHORTEST]
    sharpest = [float(np.abs(each.points[PATH_CURVATURE]).max()) for each in lines]
    assert name == "truck" or (lines and max(sharpest) <= lock)
    lines = [each for each, sharp in zip(lines, sharpest, strict=True) if sharp <= lock]
    if lines:
        arrived, beside, across = driven(network, lines, model)
        assert arrived.all()
        assert beside.max() < BESIDE[name] and across.max() < ACROSS
