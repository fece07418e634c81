"""Streets with one lane a direction: what stands is passed on the oncoming lane, behind those who come there, and where one sees enough."""

import numpy as np
import pytest

from studio.assess.measure import measure_all
from studio.execution.simulation import simulation
from studio.road.ways.path import PATH_HEADING, PATH_HEIGHT, PATH_ROWS, PATH_X, PATH_Y
from studio.scenario.setup import complete
from studio.vehicle.state import A_Y, ACTIVE, V_X
from studio.world.build import build
from studio.world.passes.oncoming import TOP, VERGE, is_in_sight
from studio.world.setting import setting
from studio.world.snapshot import restore, snapshot
from studio.world.table.mind import ASIDE, OFFSET, OUT_BY, OUT_FROM, STATION, STOOD
from studio.world.tick import tick
from tests.road.plot import BERLIN, LONDON, cross, straight

LENGTH = 500.0  # [m] of the street
HOLD = {"kind": "hold", "speed": 0, "acceleration": 8, "duration": 600}
WORKS = {"works": {"do": {"kind": "close_lane", "road": "11", "lane": 0, "start": 200, "end": 230, "taper": 20}}}


def made(folder, east=(), west=(), *, stand=(), stand_west=(), changes=True, centre=BERLIN, seconds=100, **more):
    """Cars from both sides, each with its place [m] and speed [m/s]; and some that have broken down, by their places."""
    straight(folder / "map.osm", {}, centre=centre, length=LENGTH)
    vehicles, script = {}, dict(more.pop("script", {}))
    for way, cars, broken in (("east", east, stand), ("west", west, stand_west)):
        for i, (at, speed) in enumerate(cars):
            vehicles[f"{way}_{i}"] = {"route": way, "position": {"along": at}, "speed": speed, "lane_changes": changes}
        for i, at in enumerate(broken):
            vehicles[f"x_{way}_{i}"] = {"route": way, "position": {"along": at}, "speed": 0}
            script[f"{way}_{i}"] = {"do": HOLD | {"vehicle": f"x_{way}_{i}"}}
    ways = {"east": {"roads": ["11"]}, "west": {"roads": ["-11"]}}
    document = {"title": "a street", "map": {"file": "map.osm"}, "clock": {"duration": seconds}, "routes": ways}
    document |= {"vehicles": dict(sorted(vehicles.items())), "script": script} | more
    return setting(complete(document, "a street"), folder, "a street")


class Run:
    """Cars tick by tick."""

    def __init__(self, setting, seconds=60.0):
        self.world = world = build([setting])
        rows = {"station": STATION, "offset": OFFSET, "by": OUT_BY, "aside": ASIDE, "stood": STOOD}
        seen = {name: [] for name in (*rows, "speed", "across", "active", "out")}
        for _ in range(round(seconds / world.clock.tick)):
            tick(world)
            mind, state = world.vehicles.mind, world.vehicles.state
            for name, row in rows.items():
                seen[name].append(mind[row].copy())
            seen["speed"].append(state[V_X].copy())
            seen["across"].append(state[A_Y].copy())
            seen["active"].append(state[ACTIVE] > 0)
            seen["out"].append((mind[OUT_BY] != 0) & (mind[STATION] >= mind[OUT_FROM]))
        for name, values in seen.items():
            setattr(self, name, np.array(values).T)
        self.time = np.arange(self.speed.shape[1]) * world.clock.tick

    def arrives(self, name):
        """When; infinite where one does not."""
        gone = np.flatnonzero(~self.active[self.world.column(name)])
        return self.time[gone[0]] if gone.size else np.inf

    def braked(self, name):
        """How hard, at most, over a tenth of a second [m/s²]."""
        i = self.world.column(name)
        there, step = self.active[i], 5
        return float(-(np.diff(self.speed[i][there][::step]) / (step * self.world.clock.tick)).min())


@pytest.mark.parametrize(("centre", "side"), [(BERLIN, 1.0), (LONDON, -1.0)])
def test_who_stands_is_passed_on_the_oncoming_lane(tmp_path, centre, side):
    run = Run(made(tmp_path, [(60, 13)], stand=[200], centre=centre))
    (i, out) = run.world.column("east_0"), run.out[run.world.column("east_0")]
    assert run.arrives("east_0") < 40 and run.world.events.hits_found == 0
    assert np.abs(run.across[i][run.active[i]]).max() < 3.0
    beside = out & (np.abs(run.station[i] - 200) < 4)
    assert beside.any() and (side * run.offset[i][beside]).min() > 1.9  # the cars are 1.8 m wide
    assert np.abs(run.offset[i][run.station[i] > 260]).max() < 0.3  # back in the middle of the own lane
    assert np.abs(run.offset[i] - run.aside[i])[run.active[i]].max() < 0.35  # and on the way that is meant all along


def test_who_does_not_change_lanes_stays_behind(tmp_path):
    run = Run(made(tmp_path, [(60, 13)], stand=[200], changes=False))
    assert run.station[run.world.column("east_0"), -1] < 200 and not run.by.any()


def test_who_comes_has_the_right_of_way(tmp_path):
    """One waits for two who come, who do not brake for it, and goes then."""
    run = Run(made(tmp_path, [(60, 13)], [(60, 13), (100, 13)], stand=[200]))
    first_out = run.time[np.flatnonzero(run.out[run.world.column("east_0")])[0]]
    last_past = run.time[np.flatnonzero(run.station[run.world.column("west_0")] > LENGTH - 190)[0]]
    assert last_past < first_out < last_past + 5.0
    assert run.world.events.hits_found == 0 and max(run.braked(f"west_{i}") for i in range(2)) < 0.5
    assert run.arrives("east_0") < np.inf


@pytest.mark.parametrize("gap", [25, 35, 60])
def test_where_cars_stand_on_both_lanes_all_get_through(tmp_path, gap):
    """One behind the other, as those who drive see it: the ways around the two are in each other's way."""
    run = Run(made(tmp_path, [(60, 13), (30, 13)], [(60, 13), (30, 13)], stand=[240], stand_west=[LENGTH - 240 - 5 - gap]), 110)
    assert max(run.arrives(f"{way}_{i}") for way in ("east", "west") for i in range(2)) < np.inf
    assert run.world.events.hits_found == 0
    out = run.out[[run.world.column(f"east_{i}") for i in range(2)]].any(axis=0)
    assert not (out & run.out[[run.world.column(f"west_{i}") for i in range(2)]].any(axis=0)).any()


def test_several_that_stand_are_passed_at_once_by_several(tmp_path):
    run = Run(made(tmp_path, [(60, 13), (40, 13), (20, 13)], stand=[200, 208, 216]))
    assert max(run.arrives(f"east_{i}") for i in range(3)) < np.inf
    assert run.world.events.hits_found == 0 and max(run.braked(f"east_{i}") for i in range(3)) < 4.0


def test_a_closed_lane_is_passed(tmp_path):
    run = Run(made(tmp_path, [(60, 13)], [(100, 13)], script=WORKS))
    assert run.arrives("east_0") < np.inf and run.arrives("west_0") < np.inf and run.world.events.hits_found == 0
    assert run.braked("west_0") < 0.5


@pytest.mark.parametrize("seed", [1, 2])
def test_in_a_stream_nobody_is_hit_and_nobody_leaves_the_road(tmp_path, seed):
    flow = {"headways": "random", "rate": 350}
    flows = {"one": {"route": "east"} | flow, "other": {"route": "west"} | flow}
    made_ = made(tmp_path, [(20, 13)], stand=[240], seconds=240, seed=seed, traffic={"lane_changes": True, "flows": flows})
    running = simulation(made_)
    while not running.is_over:
        running.advance(500)
    found = {name: float(each.value or 0.0) for name, each in measure_all(running.record(), None, print).items()}
    assert (found["collisions"], found["left_road"], found["longest_deadlock"]) == (0, 0, 0)
    assert found["arrivals"] > 20


def crossing(folder, vehicles, middle, seconds=60, **more):
    """Cars on a way of 200 m to a crossing, and over it."""
    cross(folder / "cross.osm", middle=middle)
    document = {
        "title": "crossing",
        "map": {"file": "cross.osm"},
        "clock": {"duration": seconds},
        "routes": {"way": {"roads": ["11", "12"]}},
    }
    for each in vehicles.values():
        each["route"] = "way"
    return setting(complete(document | {"vehicles": vehicles} | more, "crossing"), folder, "crossing")


@pytest.mark.parametrize(("at", "is_passed"), [(100, True), (160, False)])
def test_nobody_passes_right_before_a_junction(tmp_path, at, is_passed):
    cars = {
        "own": {"position": {"along": 20}, "speed": 13, "lane_changes": True},
        "x": {"position": {"along": at}, "speed": 0},
    }
    run = Run(crossing(tmp_path, cars, {}, script={"x": {"do": HOLD | {"vehicle": "x"}}}), 40)
    assert run.world.lanes.any_facing and run.by.any() == is_passed
    assert (run.station[run.world.column("own"), -1] > at) == is_passed


def test_a_queue_at_a_light_is_not_passed(tmp_path):
    cars = {f"car_{i}": {"position": {"along": 40 + 25 * i}, "speed": 8, "lane_changes": True} for i in range(5)}
    run = Run(crossing(tmp_path, cars, {"highway": "traffic_signals"}))
    assert run.world.lanes.any_facing and not run.by.any()
    assert (run.stood.max(axis=1) > 3.0).sum() >= 2  # there was a queue


# -- sight -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def street(tmp_path_factory):
    return build([made(tmp_path_factory.mktemp("street"), [(0, 0)])])


def sees(world, needed, x, y, heading, height):
    """Whether one sees so far [m] along a line that begins where he is."""
    points = np.zeros((PATH_ROWS, x.size))
    points[[PATH_X, PATH_Y, PATH_HEADING, PATH_HEIGHT]] = x, y, heading, height
    v, r = world.vehicles, world.roads
    state, mind = v.state.copy(), v.mind.copy()
    state[[0, 1], 0], mind[STATION, 0] = 0.0, 0.0
    return is_in_sight(0, needed, state, np.asfortranarray(points), 0, x.size, 0, r.shadow, v.drivers, mind)


def test_over_a_crest_one_sees_as_far_as_two_heights_reach(street):
    """On a crest of radius R one sees somebody as high as oneself at 2 √(2 R h)."""
    s, radius = np.arange(400.0), 1000.0
    sight = 2 * np.sqrt(2 * radius * TOP)
    seen = [sees(street, far, s, 0 * s, 0 * s, -s * s / (2 * radius)) for far in (sight - 15, sight + 15)]
    assert seen == [True, False] and sees(street, 300.0, s, 0 * s, 0 * s, 0 * s)


def test_in_a_bend_one_sees_no_farther_than_its_inner_side(street):
    s, radius = np.arange(400.0), 200.0
    angle = s / radius
    sight = radius * np.arccos(1 - VERGE / radius)
    seen = [sees(street, far, radius * np.sin(angle), radius * (1 - np.cos(angle)), angle, 0 * s) for far in (sight - 12, sight + 12)]
    assert seen == [True, False]


# -- batches, snapshots ------------------------------------------------------------------------------


def test_who_passes_does_so_in_any_company(tmp_path):
    variants = [
        made(tmp_path, [(60, 13)], [(100, 13)], stand=[200]),
        made(tmp_path, [(60, 13), (30, 13)], stand=[220], changes=False),
        made(tmp_path, [(60, 13)], [(60, 13)], stand=[250], stand_west=[220]),
    ]

    def run(settings):
        world = build(settings)
        for _ in range(round(25 / world.clock.tick)):
            tick(world)
        return world

    worlds = [run([each]) for each in variants]
    assert worlds[0].vehicles.mind[STATION, worlds[0].column("east_0")] > 200
    alone = [world.digest(0) for world in worlds]
    for order in ([0, 1, 2], [2, 1, 0]):
        together = run([variants[i] for i in order])
        assert [together.digest(order.index(i)) for i in range(3)] == alone


def test_a_run_goes_on_from_a_snapshot_while_somebody_passes(tmp_path):
    world = build([made(tmp_path, [(60, 13)], stand=[200])])
    i = world.column("east_0")
    while world.vehicles.mind[ASIDE, i] < 1.0:
        tick(world)
    kept, digests = snapshot(world), []
    for _ in range(2):
        restore(world, kept)
        for _ in range(300):
            tick(world)
        digests.append(world.digest())
    assert digests[0] == digests[1]
