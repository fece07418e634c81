"""Changing lanes where no route asks for it: who stands is passed, who waits is not, and a run goes on from a snapshot."""

from itertools import groupby

import numpy as np
import pytest

from studio.model.driver import NO_LIMIT
from studio.road.drawn.motorway import motorway
from studio.scenario.setup import complete
from studio.vehicle.state import A_Y, ACTIVE, V_X, VEHICLE
from studio.world.build import build
from studio.world.passes.lane import idles
from studio.world.setting import setting
from studio.world.snapshot import restore, snapshot
from studio.world.table import mind as rows
from studio.world.table.mind import CHANGING, FOLLOWING, MIND, OFFSET, RED_STATION, STATION, STOPPING, WAY_STATION, YIELDING
from studio.world.tick import tick

STANDS = {"broken": {"do": {"kind": "hold", "vehicle": "broken", "speed": 0, "acceleration": 8, "duration": 600}}}


def made(folder, lane, traffic=None, **more):
    """Somebody who has broken down on a lane of three, and a car that comes 350 m behind."""
    (folder / "three.xodr").write_text(motorway(length=2500.0, lanes=3), encoding="utf-8")
    at = {"road": "motorway", "lane": lane}
    document = {
        "title": "broken down",
        "map": {"file": "three.xodr"},
        "clock": {"duration": 60},
        "routes": {"way": {"roads": ["motorway"]}},
        "vehicles": {
            "own": {"route": "way", "position": at | {"offset": 250}, "speed": 25, "lane_changes": True} | more,
            "broken": {"route": "way", "position": at | {"offset": 600}, "speed": 0},
        },
        "script": STANDS,
        "traffic": traffic or {},
    }
    return setting(complete(document, "broken down"), folder, "broken down")


def driven(world, seconds):
    """Station, offset, lateral acceleration and the block of the first car at every tick."""
    seen = []
    for _ in range(round(seconds / world.clock.tick)):
        tick(world)
        m, s = world.vehicles.mind, world.vehicles.state
        seen.append((m[STATION, 0], m[OFFSET, 0], s[A_Y, 0], s[V_X, 0], world.lanes.block[0]))
    return np.array(seen).T


@pytest.mark.parametrize("lane", [0, 1, 2])
def test_who_has_broken_down_is_passed(tmp_path, lane):
    world = build([made(tmp_path, lane)])
    station, offset, across, speed, block = driven(world, 25)
    assert station[-1] > 620 and world.events.hits_found == 0
    assert (np.diff(block) != 0).sum() >= 1 and np.abs(across).max() < 3.0
    apart = np.abs(np.diff(offset[:-1]))
    assert np.sort(apart)[-1] > 3.0 and abs(offset[-1]) < 0.3  # on the new line at once, and in its middle in the end
    changed = np.flatnonzero(np.diff(block))
    assert (np.diff(changed) * world.clock.tick >= 2.0).all() and speed.min() > 10.0


def test_who_keeps_to_his_lanes_stops_behind(tmp_path):
    world = build([made(tmp_path, 1, lane_changes=False)])
    station, _, _, speed, block = driven(world, 25)
    assert station[-1] < 600 and speed[-1] < 1.0 and not np.diff(block).any()


def test_a_run_goes_on_from_a_snapshot_while_somebody_changes(tmp_path):
    world = build([made(tmp_path, 1)])
    while world.vehicles.mind[CHANGING, 0] == 1.0:
        tick(world)
    kept = snapshot(world)
    driven(world, 3)
    first = world.digest()
    restore(world, kept)
    driven(world, 3)
    assert world.digest() == first


BUSY = {"count": 40, "lane_changes": True, "spacing": 30, "speed": 25}


def test_who_changes_lanes_does_so_in_any_company(tmp_path):
    """The same bits alone, beside worlds of other sizes in which nobody or everybody changes lanes, and in any order of these."""
    variants = [made(tmp_path, 1, traffic=BUSY), made(tmp_path, 0), made(tmp_path, 1, traffic=BUSY | {"count": 25}, lane_changes=False)]
    worlds = [build([each]) for each in variants]
    for world in worlds:
        for _ in range(round(12 / world.clock.tick)):
            tick(world)
    assert all(world.lanes.apart().any() for world in worlds)
    alone = [world.digest(0) for world in worlds]
    for order in ([0, 1, 2], [2, 1, 0]):
        together = build([variants[i] for i in order])
        for _ in range(round(12 / together.clock.tick)):
            tick(together)
        assert [together.digest(order.index(i)) for i in range(3)] == alone


@pytest.mark.parametrize("changes", [False, True])
def test_where_one_of_two_lanes_is_closed_they_are_driven_in_turn(tmp_path, changes):
    """Zipper (StVO § 7 (4)): 700 cars an hour on each lane. Chance would take half of them from the same lane again."""
    (tmp_path / "two.xodr").write_text(motorway(length=2000.0, lanes=2), encoding="utf-8")
    shut = {"kind": "close_lane", "road": "motorway", "lane": 0, "start": 1200, "end": 1600, "taper": 60}
    flow = {"route": "way", "rate": 700, "headways": "even"}
    document = {
        "title": "one closed",
        "map": {"file": "two.xodr"},
        "clock": {"duration": 300},
        "routes": {"way": {"roads": ["motorway"]}},
        "vehicles": {"own": {"route": "way", "position": {"road": "motorway", "lane": 1, "offset": 5}, "speed": 25}},
        "script": {"shut": {"do": shut}},
        "traffic": {"lane_changes": changes, "flows": {"kerb": flow | {"lane": 0}, "left": flow | {"lane": 1}}},
    }
    made = setting(complete(document, "one closed"), tmp_path, "one closed")
    world, came = build([made]), []
    of = np.array(["" if car.source is None else made.sources[car.source].stream[:4] for car in made.cars])
    within = np.zeros(of.size, dtype=bool)
    for _ in range(round(300 / world.clock.tick)):
        tick(world)
        now = (world.vehicles.mind[STATION] > 1300) & (world.vehicles.state[ACTIVE] > 0)
        came += of[now & ~within].tolist()
        within |= now
    came = came[1:]  # the named one
    runs = [len(list(group)) for _, group in groupby(came)]
    assert len(came) > 60 and world.events.hits_found == 0
    assert max(runs) <= 6 and (len(runs) - 1) / (len(came) - 1) > 0.65
    assert min(came.count("kerb"), came.count("left")) > 0.35 * len(came)


def standing(**said):
    """What the mind of one says who stands."""
    mind = np.zeros((len(MIND), 1))
    mind[[FOLLOWING, YIELDING, STOPPING]], mind[[RED_STATION, WAY_STATION]] = NO_LIMIT, np.inf
    for row, value in said.items():
        mind[getattr(rows, row)] = value
    return mind


def test_who_waits_is_no_obstacle():
    state = np.zeros((len(VEHICLE), 1))
    assert not idles(0, state, standing())
    state[ACTIVE] = 1.0
    assert idles(0, state, standing())
    for waits in ({"RED_STATION": 90.0}, {"WAY_STATION": 90.0}, {"FOLLOWING": 0.0}, {"YIELDING": -1.0}, {"STOPPING": 0.1}):
        assert not idles(0, state, standing(**waits)), waits
    state[V_X] = 2.0
    assert not idles(0, state, standing())
