"""Two roads cross, one on a bridge: no car is braked for, seen or hit on another level, and all of that on the same."""

import numpy as np
import pytest

from studio.errors import ScenarioError
from studio.road import load
from studio.scenario.setup import complete
from studio.vehicle.parameter import FRONT, LENGTH, PARAMETER, WIDTH
from studio.vehicle.state import V_X, VEHICLE, X, Z
from studio.world.build import build
from studio.world.passes.collision import touching
from studio.world.setting import setting
from studio.world.table.street import O_HEIGHT, O_LEVEL, O_LIFT, O_X
from studio.world.tick import tick
from tests.road.plot import plot

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


# -- where no height is known ----------------------------------------------------------------------


def bridged(tmp_path, over, under, along=100.0):
    """A street to the east, 400 m long and with tags, and one to the north that cross in their middles; somebody all but stands where they
    do on the one to the north, and one with a radar comes on the other."""
    nodes = {1: (-200, 0), 2: (200, 0), 3: (0, -200), 4: (0, 200)}
    plot(tmp_path / "map.osm", nodes, {11: ([1, 2], {"oneway": "yes"} | over), 12: ([3, 4], {"oneway": "yes"} | under)})
    cars = {
        "east": {"route": "east", "position": {"along": along}, "speed": SPEED},
        "north": {"route": "north", "position": {"along": 199}, "speed": 0.5},
    }
    cars["east"]["sensors"] = {"front": {"kind": "front_radar", "preset": "long_range_radar"}}
    document = {
        "title": "levels", "map": {"file": "map.osm"}, "vehicles": cars,
        "routes": {"east": {"roads": ["11"]}, "north": {"roads": ["12"], "speeds": [{"at": 0, "speed": 0.5}]}},
    }  # fmt: skip
    return build([setting(complete(document, "levels"), tmp_path, "levels")])


APART = [({"bridge": "yes", "layer": "1"}, {}), ({"layer": "1"}, {}), ({}, {"tunnel": "yes"}), ({"bridge": "yes"}, {"layer": "-1"})]


def looked(world, seconds=8.0):
    """Whether the radar has seen anybody, and the least speed of the one who comes [m/s]."""
    seen, least = False, np.inf
    (each,) = world.units.mounted
    while world.clock.time < seconds:
        tick(world)
        seen |= bool(each.out[0, 0])
        least = min(least, float(world.vehicles.state[V_X, world.column("east")]))
    return seen, least


@pytest.mark.parametrize(("over", "under"), APART)
def test_without_heights_levels_alone_part_them(tmp_path, over, under):
    """Above somebody who stands: not seen by radar, not braked for, not hit."""
    world = bridged(tmp_path, over, under)
    seen, least = looked(world)
    assert not seen and least > 0.7 * SPEED and world.events.hits_found == 0
    east, north = (world.column(name) for name in ("east", "north"))
    assert world.vehicles.state[X, east] > world.vehicles.state[X, north] + 10.0  # he has passed


def test_on_one_level_he_is_seen_and_braked_for(tmp_path):
    seen, least = looked(bridged(tmp_path, {}, {}))
    assert seen and least < 0.5 * SPEED


def test_on_a_ramp_who_is_ahead_is_seen(tmp_path):
    """Two on the same street, which climbs onto a bridge: level by level each sees the other, on the ramp as well."""
    nodes = {1: (-400, 0), 2: (-50, 0), 3: (50, 0), 4: (400, 0), 5: (0, -200), 6: (0, 200)}
    ways = {11: ([1, 2], {}), 12: ([2, 3], {"bridge": "yes", "layer": "1"}), 13: ([3, 4], {}), 14: ([5, 6], {})}
    plot(tmp_path / "map.osm", nodes, {way: (line, {"oneway": "yes"} | tags) for way, (line, tags) in ways.items()})
    cars = {name: {"route": "r", "position": {"along": at}, "speed": SPEED} for name, at in (("own", 100.0), ("ahead", 140.0))}
    cars["own"]["sensors"] = {"front": {"kind": "front_radar", "preset": "long_range_radar"}}
    document = {"title": "ramp", "map": {"file": "map.osm"}, "vehicles": cars, "routes": {"r": {"roads": ["11"]}}}
    world = build([setting(complete(document, "ramp"), tmp_path, "ramp")])
    (each,) = world.units.mounted
    seen, height = [], []
    while world.clock.time < 18.0:
        tick(world)
        seen.append(bool(each.out[0, 0]))
        height.append(float(world.vehicles.state[Z, 0]))
    assert max(height) - height[0] > 3.0 and np.mean(seen) > 0.99


# -- who walks, and what stands --------------------------------------------------------------------

FLYOVER = {1: (-400, 0), 2: (-50, 0), 3: (50, 0), 4: (400, 0), 5: (0, -200), 6: (0, 200)}
STREETS = {11: ([1, 2], {}), 12: ([2, 3], {"bridge": "yes"}), 13: ([3, 4], {}), 14: ([5, 6], {})}


def beset(tmp_path, do, vehicle="east", along=365.0):
    """A street that climbs onto a bridge over another one, what the script brings, by where they cross, and a car with a radar, on either,
    that comes there."""
    path = plot(tmp_path / "map.osm", FLYOVER, {way: (line, {"oneway": "yes"} | tags) for way, (line, tags) in STREETS.items()})
    network = load(path)
    at = (float(network.lanes_of("14")[0].centre[0].mean()), float(network.lanes_of("11")[0].centre[1].mean()))
    script = {f"it_{number}": {"do": each} for number, each in enumerate(do(*at))}
    car = {"route": vehicle, "position": {"along": along}, "speed": 8.0, "sensors": {"front": {"kind": "front_radar"}}}
    document = {
        "title": "levels", "map": {"file": "map.osm"}, "vehicles": {"east": car}, "clock": {"duration": 10},
        "routes": {"east": {"roads": ["11"]}, "north": {"roads": ["14"]}}, "script": script,
    }  # fmt: skip
    return build([setting(complete(document, "levels"), tmp_path, "levels")])


def walker(**more):
    return lambda x, y: [{"kind": "mover", "who": "pedestrian", "line": [[x, y]], "speed": 0} | more]


def box(**more):
    return lambda x, y: [{"kind": "object", "x": x, "y": y} | more]


def barriers(x, y):
    return [{"kind": "objects", "route": "east", "start": 395, "end": 400, "what": "barriers"}]


@pytest.mark.parametrize(("do", "height"), [
    (walker(), 0.0), (walker(level=1), 5.5), (box(level=0), 0.0), (box(level=1), 5.5), (barriers, 5.5),
    (walker(route="east", line=[[400, 0]]), 5.5), (walker(route="north", line=[[200, 0]]), 0.0),
])  # fmt: skip
def test_who_stands_where_roads_cross_stands_on_one_of_them(tmp_path, do, height):
    """On that he is seen, braked for, and drawn; who drives on the other one passes."""
    for vehicle, along in (("east", 365.0), ("north", 165.0)):
        world = beset(tmp_path, do, vehicle, along)
        assert world.obstacles.table[O_HEIGHT] == pytest.approx(height, abs=0.3)
        assert world.obstacles.table[O_LIFT] == pytest.approx(height, abs=0.3)
        seen, least = looked(world, 4.5)
        is_his = (vehicle == "east") == (height > 1.0)
        assert (seen, least < 5.0, world.events.hits_found) == (is_his, is_his, 0)


def test_who_walks_up_a_ramp_comes_onto_the_bridge(tmp_path):
    """Along the street, which climbs over 350 m from its end to the bridge, and on the same line 12 m beside it, on the land."""

    def both(x, y):
        return [{"kind": "mover", "line": [[x - 300.0, each], [x + 300.0, each]], "speed": 30.0} for each in (y, y + 12.0)]

    world = beset(tmp_path, both, along=5.0)
    middle, found = float(world.obstacles.table[O_X, 0]) + 300.0, []
    while world.clock.time < 19.9:
        tick(world)
        found.append(world.obstacles.table[[O_X, O_HEIGHT, O_LIFT, O_LEVEL]].copy())
    x, height, lift, level = np.array(found).transpose(1, 2, 0)
    x -= middle
    deck = np.abs(x[0]) < 40.0
    assert height[0, deck] == pytest.approx(5.5, abs=0.3) and (level[0, deck] == 1.0).all()
    assert height[0, [0, -1]] == pytest.approx(5.5 * 100.0 / 350.0, abs=0.15) and np.abs(np.diff(height[0])).max() < 0.1
    assert lift[0] == pytest.approx(height[0], abs=0.1)
    assert height[1, np.abs(x[1]) > 8.0] == pytest.approx(0.0, abs=0.1)


def test_a_level_that_there_is_not_is_refused(tmp_path):
    with pytest.raises(ScenarioError, match=r"script\.it_0\.do\.level.*2.*0 or 1"):
        beset(tmp_path, box(level=2))


def test_what_lies_below_a_bridge_keeps_nobody_from_starting_on_it(tmp_path):
    assert beset(tmp_path, box(), along=400.0).events.hits_found == 0
    with pytest.raises(ScenarioError, match="it_0"):
        beset(tmp_path, box(level=1), along=400.0)
