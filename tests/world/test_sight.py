"""Who is seen behind whom: bearings of outlines, what covers them, houses between, and what is measured of what is seen."""

from collections import namedtuple
from dataclasses import replace
from math import atan2, degrees, hypot, inf, pi, radians

import numpy as np
import pytest

from studio.model import sight as model
from studio.road.network import Building, shadow
from studio.vehicle.parameter import FRONT, LENGTH, WIDTH
from studio.vehicle.state import PSI, V_X, X, Y
from studio.workshop.stage import stage
from studio.world.passes.sight import (
    HIGH,
    LONG,
    LOW,
    MIDDLE_X,
    MIDDLE_Y,
    SEEN_X,
    SEEN_Y,
    SHARE,
    SIGHT,
    TURNED_COS,
    TURNED_SIN,
    WHO,
    WIDE,
    cover_outline,
    frame,
    free,
    is_way_clear,
    look,
    open_to,
)
from studio.world.tick import gather, sense
from studio.world.view import View, about, looking

HALF, REACH = radians(20.0), 100.0
Eye = namedtuple("Eye", "eye_x eye_y eye_cosine eye_sine")
CARS = {"ahead": (20.0, 0.0), "far": (40.0, 0.5), "other": (45.0, 3.5), "behind": (30.0, 9.0), "beside": (12.0, 4.2)}


# -- bearings ------------------------------------------------------------------------------------------


def corners(x, y, heading, length, width):
    """Of an outline."""
    c, s = np.cos(heading), np.sin(heading)
    return [(x + a * c - b * s, y + a * s + b * c) for a in (-length / 2, length / 2) for b in (-width / 2, width / 2)]


@pytest.mark.parametrize("place", [(20.0, 0.0), (5.0, 5.0), (-3.0, 8.0), (-12.0, 0.4), (0.0, -4.0), (2.5, 0.5), (-2.4, -1.0)])
@pytest.mark.parametrize("heading", [0.0, 0.7, 2.0, -1.6])
def test_edges_are_the_outermost_corners(place, heading):
    """Against the middle, so that nothing jumps behind the sensor; those of a body around the sensor go all around."""
    x, y = place
    low, high = model.edges(x, y, np.cos(heading), np.sin(heading), 4.5, 1.8)
    if model.holds(x, y, np.cos(heading), np.sin(heading), 4.5, 1.8):
        assert (low, high) == (-pi, pi)
        return
    angles = [(atan2(b, a) - atan2(y, x) + pi) % (2 * pi) - pi for a, b in corners(x, y, heading, 4.5, 1.8)]
    assert -pi < low <= pi and low <= high
    assert high - low == pytest.approx(max(angles) - min(angles), abs=1e-12)
    assert (low - atan2(y, x) - min(angles) + pi) % (2 * pi) - pi == pytest.approx(0.0, abs=1e-12)


def test_the_nearest_point_and_where_a_line_meets_the_outline():
    """A car across the way, 10 m ahead of the sensor: 9.1 m to its side; at 20° its side is met at 9.1 m / cos 20°; at 40° it is missed."""
    c, s = 0.0, 1.0
    assert model.nearest(10.0, 0.0, c, s, 4.5, 1.8) == pytest.approx((9.1, 0.0), abs=1e-12)
    assert model.met(radians(10.0), 10.0, 0.0, c, s, 4.5, 1.8) == pytest.approx(9.1 / np.cos(radians(10.0)))
    assert model.met(radians(40.0), 10.0, 0.0, c, s, 4.5, 1.8) == inf


def room():
    """Nothing is covered."""
    return np.zeros((len(SIGHT), 16))


def test_covered_bearings_join_and_stay_in_order():
    sight, blocks = room(), 0
    for low, high in ((0.5, 0.6), (-0.2, 0.1), (0.0, 0.3), (0.9, 1.0), (0.6, 0.65)):
        blocks = cover_outline(low, high, sight, blocks)
    assert blocks == 3
    assert free(-1.0, 2.0, sight, blocks) == pytest.approx(3.0 - 0.5 - 0.15 - 0.1)
    assert free(0.2, 0.55, sight, blocks) == pytest.approx(0.2)
    assert free(-0.1, 0.2, sight, blocks) == 0.0


def test_bearings_behind_the_sensor():
    """An outline that goes beyond π is covered on both sides of the turn, and open to a field of a whole turn only."""
    sight = room()
    assert open_to(3.0, 3.3, pi, sight, 0) == pytest.approx(0.3)
    assert open_to(3.0, 3.3, 0.5 * pi, sight, 0) == 0.0
    blocks = cover_outline(3.0, 3.2, sight, 0)
    assert blocks == 2 and open_to(3.0, 3.3, pi, sight, blocks) == pytest.approx(0.1)


# -- cars in the field ---------------------------------------------------------------------------------


def field(places, *, half=HALF, reach=REACH, least=0.01, most=8, buildings=None, size=(4.5, 1.8)):
    """Shares of the cars that a sensor at the origin sees, by their names, the nearest first, and the columns that hold them."""
    run = stage(vehicles={"own": {"sensors": {"front": {"kind": "front_radar"}}}})
    world = run.world
    state, parameter = world.vehicles.state, world.vehicles.parameter
    parameter[LENGTH], parameter[WIDTH], parameter[FRONT] = size[0], size[1], size[0] / 2.0
    state[[X, Y, PSI]] = np.array([[-500.0 - 20.0 * i for i in range(6)], [0.0] * 6, [0.0] * 6])
    own = world.column("own")
    state[[X, Y], own] = -size[0] / 2.0, 0.0  # the front bumper is at the origin
    for name, place in places.items():
        state[[X, Y], world.column(name)] = place[:2]
        state[PSI, world.column(name)] = place[2] if len(place) > 2 else 0.0
    if buildings is not None:
        world.roads = replace(world.roads, shadow=shadow.shadow(buildings))
    gather(world)
    sense(world)
    view = View(0, 0.0, *world.view)
    settings = type("Mounting", (), {"forward": 0.0, "left": 0.0, "yaw": 0.0})
    me = looking.py_func(about(view, world.units.number("own"), 0, 0, 3, 1.0), 0, settings)
    found = look(view, me, reach, half, least, most, False)
    columns = [int(each) for each in world.units.sight[SIGHT_ORDER, :found]]
    names = [world.names[0][int(world.units.sight[WHO, i])] for i in columns]
    return dict(zip(names, world.units.sight[:, columns].T, strict=True))


SIGHT_ORDER = [row.name for row in SIGHT].index("in_order")


def test_the_visible_share_of_the_whole_bearing():
    """Five cars, field 40°, 100 m: 1, 0, 1, 0, 0.4776 of their bearings; that of the last is cut by the edge of the field."""
    found = field(CARS)
    shares = [found[name][SHARE] if name in found else 0.0 for name in CARS]
    np.testing.assert_allclose(shares, [1.0, 0.0, 1.0, 0.0, 0.4776], atol=0.01)
    assert list(found) == ["beside", "ahead", "other"]


def test_the_threshold_decides():
    assert "beside" in field(CARS, least=0.47) and "beside" not in field(CARS, least=0.48)
    assert set(field(CARS, least=0.0)) == set(CARS)


def test_no_more_than_are_wanted_and_none_beyond_the_reach():
    assert list(field(CARS, most=1)) == ["beside"]
    assert list(field(CARS, reach=30.0)) == ["beside", "ahead"]


def test_a_crossing_car_is_measured_where_it_is_nearest():
    """It stands across the way: its side at 9.1 m; half behind another one, the nearest point that is left."""
    across = field({"ahead": (10.0, 0.0, pi / 2)})["ahead"]
    assert (across[SEEN_X], across[SEEN_Y]) == pytest.approx((9.1, 0.0), abs=1e-9)
    both = field({"ahead": (20.0, 0.0, pi / 2), "other": (10.0, 0.0)})
    edge = 0.9 / 7.75  # tangent of the bearing of the near one's corner
    x, y = both["ahead"][SEEN_X], both["ahead"][SEEN_Y]
    assert x == pytest.approx(19.1, abs=1e-6) and abs(y) == pytest.approx(19.1 * edge, rel=1e-6)
    whole = 2.0 * atan2(2.25, 19.1)
    assert both["ahead"][SHARE] == pytest.approx(1.0 - 2.0 * atan2(0.9, 7.75) / whole, abs=1e-9)


def house(x, y, length, width, base=0.0, height=10.0):
    """A house with its middle at x, y [m]."""
    return Building(np.array(corners(x, y, 0.0, length, width))[[0, 2, 3, 1]].T.copy(), (), height, base, "")


def test_houses_hide():
    """One before a car hides it; one behind it, or that hangs above, does not; one beside hides what its bearings cover."""
    place = {"ahead": (60.0, 0.0, pi / 2)}
    assert list(field(place, buildings=[house(40.0, 0.0, 10.0, 12.0)])) == []
    for free_one in (house(80.0, 0.0, 10.0, 40.0), house(40.0, 0.0, 10.0, 12.0, base=4.0), house(40.0, 0.0, 10.0, 12.0, height=1.0)):
        assert field(place, buildings=[free_one])["ahead"][SHARE] == pytest.approx(1.0)
    half = field(place, buildings=[house(40.0, 10.0, 10.0, 20.0)])["ahead"]
    assert half[SHARE] == pytest.approx(0.5, abs=1e-9)
    assert half[SEEN_Y] <= 1e-6


def test_a_house_hides_less_the_farther_a_car_has_come_out_behind_it():
    """Its corner at (50, 2) is the last that hides: of a car across, 60 m away, is seen what lies to the right of that bearing."""
    shares = []
    for y in (6.0, 5.0, 4.0, 3.0, 2.0, 0.0):
        found = field({"ahead": (60.0, y, pi / 2)}, buildings=[house(45.0, 12.0, 10.0, 20.0)])
        shares.append(found["ahead"][SHARE] if "ahead" in found else 0.0)
        low, high = atan2(y - 2.25, 59.1), atan2(y + 2.25, 59.1)
        low, high = min(low, atan2(y - 2.25, 60.9)), max(high, atan2(y + 2.25, 59.1))
        expected = min(max((atan2(2.0, 50.0) - low) / (high - low), 0.0), 1.0)
        assert shares[-1] == pytest.approx(expected if expected > 0.01 else 0.0, abs=1e-6), (y, degrees(low), hypot(60.0, y))
    assert shares == sorted(shares)


def test_a_pillar_between_hides_its_part():
    found = field({"ahead": (30.0, 0.0, pi / 2)}, buildings=[house(15.0, 0.0, 0.5, 0.5)])["ahead"]
    low, high = found[LOW], found[HIGH]
    assert found[SHARE] == pytest.approx(1.0 - 2.0 * atan2(0.25, 14.75) / (high - low), abs=1e-6)


def test_the_front_radar_measures_a_crossing_car_where_it_is_nearest():
    """Its rear is far beside the way; its side is 9.1 m away, and the range rate is that of closing upon it."""
    run = stage(vehicles={"own": {"sensors": {"front": {"kind": "front_radar", "range_noise": 0, "rate_noise": 0}}}})
    world = run.world
    state, parameter, own, other = world.vehicles.state, world.vehicles.parameter, world.column("own"), world.column("ahead")
    state[X] = -1000.0 - 50.0 * np.arange(6)
    state[[X, Y, PSI, V_X], own] = -parameter[FRONT, own], 0.0, 0.0, 10.0
    half = parameter[LENGTH, other] / 2.0
    middle = parameter[FRONT, other] - half
    state[[X, Y, PSI, V_X], other] = 10.0, 2.0 - middle, pi / 2, 5.0
    gather(world)
    sense(world)
    (each,) = world.units.mounted
    near_y = 2.0 - half
    x, y = 10.0 - parameter[WIDTH, other] / 2.0, max(near_y, 0.0)
    assert each.out[0, 0] == 1.0
    assert each.out[0, 1] == pytest.approx(hypot(x, y), abs=1e-6)
    assert each.out[0, 2] == pytest.approx((-10.0 * x + 5.0 * y) / hypot(x, y), abs=1e-5)


def test_no_building_is_on_a_way_that_is_called_clear():
    """Against the walks through cells: to both edges, as far as the middle, and to the nearest point; of both answers there are many.

    Houses stand at the corners of streets that run askew, and bodies lie anywhere around the sensor, also around it and behind it.
    """
    rng, streets = np.random.default_rng(3), [(x, y) for x in (-60.0, -20.0, 20.0, 60.0) for y in (-50.0, 0.0, 50.0)]
    found, sight = shadow.shadow([house(x + 0.2 * y, y - 0.2 * x, 14.0, 11.0) for x, y in streets]), np.zeros((len(SIGHT), 4))
    grid, clear = found.grid.frame, []
    for _ in range(2000):
        eye_x, eye_y, turn, heading = *rng.uniform(-80.0, 80.0, 2), *rng.uniform(-pi, pi, 2)
        me = Eye(eye_x, eye_y, np.cos(turn), np.sin(turn))
        x, y, c, s = *rng.uniform(-60.0, 60.0, 2), np.cos(heading), np.sin(heading)
        x, y = (0.03 * x, 0.03 * y) if rng.random() < 0.1 else (x, y)
        length, width = (12.0, 2.5) if rng.random() < 0.5 else (4.5, 1.8)
        sight[[MIDDLE_X, MIDDLE_Y, TURNED_COS, TURNED_SIN, LONG, WIDE], 0] = x, y, c, s, length, width
        sight[[SEEN_X, SEEN_Y], 0] = model.nearest(x, y, c, s, length, width)
        frame(0, sight)
        clear.append(is_way_clear(found, 0, me, 0, hypot(x, y), sight))
        ends = [hypot(x, y) * np.array([np.cos(sight[edge, 0]), np.sin(sight[edge, 0])]) for edge in (LOW, HIGH)]
        for ahead, left in (*ends, sight[[SEEN_X, SEEN_Y], 0]):
            to = eye_x + ahead * me.eye_cosine - left * me.eye_sine, eye_y + ahead * me.eye_sine + left * me.eye_cosine
            open_ = shadow.walk(grid, found.mass, 0, eye_x, eye_y, *to, False) == shadow.OPEN
            assert open_ or not clear[-1]
    assert 300 < sum(clear) < 1700
