"""Two lanes that run so close for some metres that one car gets through at a time: who stands beside whom, and who comes beside a queue."""

import numpy as np
import pytest

from studio.scenario.setup import complete
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import V_X
from studio.world.build import build
from studio.world.passes.queue import station_on
from studio.world.setting import setting
from studio.world.table.mind import STATION
from studio.world.table.web import ENTER, START
from studio.world.tick import tick

WIDE, CLOSE = 3.5, 2.2  # [m] widths of both lanes, and how far their middles are apart: two nearer than 2.4 m are in each other's way
FROM, OVER, TO = 100.0, 20.0, 130.0  # [m] they come closer from here over so much, and part again from there
NEAR, BEYOND = 1.5, -15.0  # [m] so near to the place both stand; so far one has driven when he is through
AWAY, ROOM, AT_PLACE = 8.0, 6.3, 3.0  # [m] before the place one begins; bumper to bumper with a car; so near one may stand
MORE = (CLOSE - WIDE) / OVER


def street(curvature):
    """A street of two lanes in a bend [1/m], as OpenDRIVE."""
    shape = f'<arc curvature="{curvature}"/>' if curvature else "<line/>"
    widths = ((0.0, WIDE, 0.0), (FROM, WIDE, MORE), (FROM + OVER, CLOSE, 0.0), (TO, CLOSE, -MORE), (TO + OVER, WIDE, 0.0))
    width = "".join(f'<width sOffset="{s}" a="{a}" b="{b}" c="0" d="0"/>' for s, a, b in widths)
    lanes = "".join(f'<lane id="{i}" type="driving">{width}</lane>' for i in (-1, -2))
    plan = f'<geometry s="0" x="0" y="0" hdg="0" length="300">{shape}</geometry>'
    return (
        '<OpenDRIVE><header name="Close" vendor="us"/><road id="1" length="300" junction="-1"><planView>'
        f'{plan}</planView><lanes><laneSection s="0"><right>{lanes}</right></laneSection></lanes></road></OpenDRIVE>'
    )


def made(folder, curvature, cars, script=None):
    """Cars in a world, as (lane from the right, way along the lane [m], speed [m/s])."""
    (folder / "close.xodr").write_text(street(curvature), encoding="utf-8")
    document = {
        "title": "close", "map": {"file": "close.xodr"}, "clock": {"duration": 120}, "routes": {"way": {"roads": ["1"]}},
        "vehicles": {
            f"car_{i}": {"route": "way", "position": {"road": "1", "lane": lane, "offset": offset}, "speed": speed}
            for i, (lane, offset, speed) in enumerate(cars)
        },
        "script": script or {},
    }  # fmt: skip
    return build([setting(complete(document, "close"), folder, "close")])


def strip_of(world, i):
    """The drive of a car on the lane beside its own."""
    r = world.roads
    (d,) = (d for d in range(r.drive_first[i] + 1, r.drive_first[i] + r.drive_count[i]) if r.web.drive[START, d] > 0.0)
    return d


def to_strip(world, i):
    """From the front of a car to where it comes onto the lane beside its own [m]."""
    return world.roads.web.drive[ENTER, strip_of(world, i)] - world.vehicles.mind[STATION, i] - world.vehicles.parameter[FRONT, i]


def leads(world):
    """How far each of two cars is ahead of the other [m], on the lane of the other."""
    r, station = world.roads, world.vehicles.mind[STATION]
    return np.array(
        [station_on(strip_of(world, i), station[i], r.web) - station_on(r.drive_first[1 - i], station[1 - i], r.web) for i in range(2)]
    )


def both(folder, curvature, before):
    """Two cars that stand so far before the place [m]; below zero so far on it."""
    first = made(folder, curvature, [(0, 90.0, 0.0), (1, 90.0, 0.0)])
    tick(first)
    offsets = [90.0 + to_strip(first, i) - before for i in range(2)]
    world = made(folder, curvature, [(i, float(each), 0.0) for i, each in enumerate(offsets)])
    tick(world)
    return world


def through(world, seconds):
    """When each of two cars is through [s]; infinite when never."""
    passed = np.full(2, np.inf)
    while world.clock.time < seconds and not np.isfinite(passed).all():
        tick(world)
        is_through = np.array([to_strip(world, i) for i in range(2)]) < BEYOND
        passed = np.where(is_through, np.minimum(passed, world.clock.time), passed)
    return passed


@pytest.mark.parametrize("radius", [82.0, 106.0, -50.0, -98.0])
def test_of_two_who_stand_beside_each_other_one_goes(tmp_path, radius):
    """In these bends the stations of the two lanes agree so little that each is behind the other on the lane of the other."""
    world = both(tmp_path, 1 / radius, NEAR)
    assert (leads(world) < 0.0).all()
    first, last = sorted(through(world, 60.0))
    assert first + 1.0 < last < 30.0 and world.events.hits_found == 0


def test_of_two_who_have_come_onto_it_at_once_one_goes_after_a_while(tmp_path):
    """Each has its nose on the lane of the other, and finds it ahead: where there is room beside the other, one goes after a minute."""
    world = both(tmp_path, 1 / 82, -0.3)
    assert (leads(world) < 0.0).all()
    first, last = sorted(through(world, 100.0))
    assert 60.0 < first < last < 90.0 and world.events.hits_found == 0


@pytest.mark.parametrize("speed", [2.0, 3.0, 4.0])
def test_who_comes_beside_a_moving_queue_drives_up_to_the_place(tmp_path, speed):
    """Those who pass beside him do not make him stand anew: he stands no more until he is at the place, where one of them lets him in."""
    first = made(tmp_path, 0.0, [(0, 90.0, 0.0), (1, 90.0, 0.0)])
    tick(first)
    at, gap = 90.0 + to_strip(first, 1) - AWAY, ROOM + speed
    queue = [(0, at + 12.0 - gap * i, speed) for i in range(10)]
    script = {"slow": {"do": {"kind": "hold", "vehicle": "car_1", "speed": speed, "acceleration": 2, "duration": 600}}}
    world = made(tmp_path, 0.0, [(1, at, 0.0), *queue], script)
    has_driven, stands_again, let_in = False, 0, np.inf
    while world.clock.time < 60.0 and let_in == np.inf:
        tick(world)
        v, left = world.vehicles.state[V_X, 0], to_strip(world, 0)
        has_driven |= v > 0.3
        stands_again += has_driven and v < 0.05 and left > AT_PLACE
        let_in = world.clock.time if left < BEYOND else np.inf
    others = world.vehicles.mind[STATION, 1:]
    assert stands_again == 0 and world.events.hits_found == 0
    assert let_in < 30.0 and (others < world.vehicles.mind[STATION, 0]).sum() > 6
