"""The relief: what crosses others on another level is off the land by what lies between them, all else is on it, on any hills."""

import numpy as np
import pytest

from studio.road import load
from studio.road.assembly.storey import STOREY
from studio.road.network import Connection, Network, Road, Scenery
from studio.road.network.signals import signals
from studio.road.ways.relief import APART, relief_of
from tests.road.conftest import lane
from tests.road.plot import plot


@pytest.fixture(autouse=True)
def cache(own_cache):
    return own_cache


def flyover(target, tags, *, ele=None):
    """A street to the east of which the middle 100 m have tags, one that crosses below, and one far away that leads to nobody."""
    places = {1: (-400, 0), 2: (-50, 0), 3: (50, 0), 4: (400, 0), 5: (0, -300), 6: (0, 300), 7: (-400, 250), 8: (-200, 250)}
    nodes = {name: (*at, {"ele": str(ele(*at))} if ele else {}) for name, at in places.items()}
    ways = {11: ([1, 2], {}), 12: ([2, 3], tags), 13: ([3, 4], {}), 14: ([5, 6], {}), 15: ([7, 8], {})}
    return load(plot(target, nodes, ways))


def hill(x, y):
    """The height of a land that rises by 5 % to the east and 3 % to the north [m]."""
    return 100.0 + 0.05 * x + 0.03 * y


@pytest.mark.parametrize(("tags", "level"), [({"bridge": "yes"}, 1), ({"bridge": "yes", "layer": "2"}, 2), ({"tunnel": "yes"}, -1)])
@pytest.mark.parametrize("ele", [None, hill])
def test_a_storey_is_the_lift_on_any_land(tmp_path, tags, level, ele):
    network = flyover(tmp_path / "map.osm", tags, ele=ele)
    relief = relief_of(network)
    assert relief is not None
    for each in network.lanes:
        station, place, lift = relief.of_lane(each.id)
        assert station[0] == 0.0 and station[-1] == pytest.approx(each.length, abs=0.01) and place.shape == (2, lift.size)
        if "12" in each.road:
            assert np.median(lift) == pytest.approx(STOREY * level, abs=0.1)
        if each.road.strip("-") in ("14", "15"):
            assert not lift.any()


@pytest.mark.parametrize("tags", [{}, {"bridge": "no"}, {"cutting": "yes"}])
def test_a_hill_without_crossings_is_land(tmp_path, tags):
    nodes = {1: (-400, 0, {"ele": "80"}), 2: (0, 0, {"ele": "100"}), 3: (400, 0, {"ele": "90"})}
    assert relief_of(load(plot(tmp_path / "map.osm", nodes, {11: ([1, 2], tags), 12: ([2, 3], {})}))) is None


def drawn(lanes, connections=()):
    """A network of lanes with heights."""
    roads = {each.road: Road(each.road, "", (each.id,), "", "", each.speed, each.length, False) for each in lanes}
    links = tuple(Connection(a, b, (), -1, "straight") for a, b in connections)
    return Network("hand", "", (0.0, 0.0), (-900.0, -900.0, 900.0, 900.0), "", tuple(lanes), roads, links, (),
                   signals((), {}, (), frozenset()), Scenery((), (), np.empty((2, 0))))  # fmt: skip


def raised(number, road, centre, height):
    """A lane that lies so high at its points."""
    made = lane(number, road, 0, centre)
    object.__setattr__(made, "height", np.asarray(height, dtype=float))
    return made


@pytest.mark.parametrize("base", [0.0, 250.0])
@pytest.mark.parametrize("apart", [APART + 0.5, 6.0, 9.0])
def test_heights_alone_tell_a_bridge(base, apart):
    """As OpenDRIVE has them: nobody tells a level. A deck between ramps of 4 % over a straight road."""
    half = apart / 0.04
    x = np.array([-600.0, -30.0 - half, -30.0, 30.0, 30.0 + half, 600.0])
    over = raised(0, "over", [x, 0.0 * x], base + np.array([0.0, 0.0, apart, apart, 0.0, 0.0]))
    y = np.linspace(-500.0, 500.0, 11)
    relief = relief_of(drawn([over, raised(1, "under", [0.0 * y, y], base + 0.0 * y)]))
    station, (east, _), lift = relief.of_lane(0)
    assert lift[np.abs(east) < 25.0] == pytest.approx(apart, abs=0.1) and not lift[np.abs(east) > 45.0 + half].any()
    assert np.abs(np.diff(lift) / np.diff(station)).max() < 0.05
    assert not relief.of_lane(1)[2].any()


def test_a_ramp_goes_on_over_connected_lanes_and_not_over_others():
    x = np.linspace(0.0, 150.0, 16)
    up, down = raised(0, "up", [x - 150.0, 0.0 * x], 0.04 * x), raised(1, "down", [x, 0.0 * x], 6.0 - 0.04 * x)
    other = raised(2, "beside", [x, 0.0 * x + 30.0], 0.0 * x)
    y = np.linspace(-300.0, 300.0, 7)
    relief = relief_of(drawn([up, down, other, raised(3, "under", [0.0 * y + 5.0, y], 0.0 * y)], [(0, 1)]))
    assert relief.of_lane(0)[2][-1] == pytest.approx(relief.of_lane(1)[2][0], abs=0.05) == pytest.approx(6.0, abs=0.1)
    assert not relief.of_lane(2)[2].any()


def test_lanes_that_are_nearer_than_that_are_one_ground():
    x = np.linspace(-200.0, 200.0, 9)
    crossing = [raised(0, "a", [x, 0.0 * x], 0.0 * x + APART - 0.5), raised(1, "b", [0.0 * x, x], 0.0 * x)]
    assert relief_of(drawn(crossing)) is None


def test_the_lift_of_a_place_is_that_of_the_lane_of_its_height():
    x = np.linspace(-300.0, 300.0, 61)
    over = raised(0, "over", [x, 0.0 * x], np.clip(9.0 - 0.05 * np.abs(x), 0.0, 6.0))
    relief = relief_of(drawn([over, raised(1, "under", [0.0 * x, x], 0.0 * x)]))
    lift, slope = relief.at(np.array([0.0, 0.0, 101.0]), np.zeros(3), np.array([6.0, 0.0, 9.0 - 5.05]))
    assert lift == pytest.approx([6.0, 0.0, 9.0 - 5.05], abs=0.05) and slope[0] == pytest.approx([0.0, 0.0, -0.05], abs=0.005)
