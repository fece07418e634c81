"""Two roads cross, one on a bridge: no car is braked for, seen or hit on another level, and all of that on the same."""

import numpy as np
import pytest

from studio.scenario.setup import complete
from studio.vehicle.parameter import FRONT, LENGTH, PARAMETER, WIDTH
from studio.vehicle.state import V_X, VEHICLE, X, Z
from studio.world.build import build
from studio.world.passes.collision import touching
from studio.world.setting import setting
from studio.world.tick import tick

ROAD = (
    '<road id="{id}" length="400" junction="-1"><type s="0" type="rural"><speed max="72" unit="km/h"/></type><planView><geometry s="0" '
    'x="{x}" y="{y}" hdg="{heading}" length="400"><line/></geometry></planView><elevationProfile><elevation s="0" a="{height}" b="0" c="0" '
    'd="0"/></elevationProfile><lanes><laneSection s="0"><right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/>'
    "</lane></right></laneSection></lanes></road>"
)
SPEED = 15.0


def place(tmp_path, height):
    """A car to the east and one to the north that come to where their roads cross at the same time."""
    roads = (
        ROAD.format(id="east", x=-200, y=0, heading=0, height=0),
        ROAD.format(id="north", x=0, y=-200, heading=np.pi / 2, height=height),
    )
    (tmp_path / "map.xodr").write_text(f"<OpenDRIVE><header/>{''.join(roads)}</OpenDRIVE>")
    cars = {name: {"route": name, "position": {"along": 150}, "speed": SPEED} for name in ("east", "north")}
    cars["east"]["sensors"] = {"front": {"kind": "front_radar", "preset": "long_range_radar"}}
    document = {
        "title": "levels", "map": {"file": "map.xodr"}, "vehicles": cars,
        "routes": {name: {"roads": [name], "speeds": [{"at": 0, "speed": SPEED}]} for name in ("east", "north")},
    }  # fmt: skip
    return build([setting(complete(document, "levels"), tmp_path, "levels")])


def driven(world):
    """The least speed of both [m/s] until both have crossed."""
    least = np.full(2, np.inf)
    while world.clock.time < 6.0:
        tick(world)
        least = np.minimum(least, world.vehicles.state[V_X])
    return least


@pytest.mark.parametrize("height", [6.0, -6.0])
def test_nobody_brakes_for_one_on_another_level(tmp_path, height):
    assert driven(place(tmp_path, height)).min() > 0.95 * SPEED


def test_on_the_same_level_one_of_them_does(tmp_path):
    assert driven(place(tmp_path, 0.0)).min() < 0.8 * SPEED


@pytest.mark.parametrize(("height", "hits"), [(0.0, True), (1.0, True), (5.0, False), (-5.0, False)])
def test_who_is_above_another_does_not_hit_him(height, hits):
    """Two bodies of 4 m by 2 m, a metre apart in the plane; centres of gravity differ by less than a metre from vehicle to vehicle."""
    state, parameter = np.zeros((len(VEHICLE), 2)), np.zeros((len(PARAMETER), 2))
    parameter[LENGTH], parameter[WIDTH], parameter[FRONT] = 4.0, 2.0, 2.0
    state[X, 1], state[Z, 1] = 1.0, height
    assert touching(0, 1, state, parameter) == hits
