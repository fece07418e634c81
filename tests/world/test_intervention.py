"""When a driver overrules an application: never by default, only for what is named, after his reaction time, until the need is over."""

from dataclasses import dataclass
from math import inf, nan

import numpy as np
import pytest
import yaml

from studio import job
from studio.execution.simulation import simulation
from studio.kind import registry
from studio.model.driver import NO_LIMIT
from studio.road.drawn.motorway import motorway
from studio.road.network.signals import RED, RED_AMBER
from studio.vehicle.command import RING, U
from studio.vehicle.parameter import FRONT, PARAMETER
from studio.vehicle.state import V_X, VEHICLE
from studio.world.build import build
from studio.world.passes.control import APP_ACCELERATION, APP_ACCELERATOR, APP_BRAKE, AUTHORS
from studio.world.passes.intervention import EMERGENCY, NEAREST, attended
from studio.world.snapshot import restore, snapshot
from studio.world.table.mind import (
    ACTS_WAY,
    APPLICATION,
    DRIVER,
    FOLLOWING,
    GAP,
    INTERVENING,
    MIND,
    MINDS_WAY,
    NEEDED_COLLISION,
    NEEDED_WAY,
    REACTION_TIME,
    RED_STATION,
    STATION,
    YIELDING,
)  # fmt: skip
from studio.world.tick import tick

TICK, SPEED = 0.02, 15.0
PARKED = '''
"""Stands where it stands."""
from studio.compiled import compiled
from studio.kind.driver import Driver, Wish

KIND = "driver"
TITLE = "Parked"


class Settings(Driver):
    """Nothing of its own."""


@compiled
def decide(settings, sees):
    return Wish(-1.0, 0.0)
'''


@pytest.fixture(scope="module")
def road(tmp_path_factory):
    """A straight road with a car on it, and one that stands 100 m ahead."""
    folder = tmp_path_factory.mktemp("standing")
    (folder / "parked.py").write_text(PARKED)
    registry.load_file(folder / "parked.py")
    (folder / "motorway.xodr").write_text(motorway(length=600.0, lanes=2), encoding="utf-8")
    document = {
        "version": 3,
        "title": "a standing car",
        "map": {"file": "motorway.xodr"},
        "clock": {"duration": 20},
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": SPEED}]}},
        "vehicles": {
            "car": {"route": "way", "position": {"along": 100}, "speed": SPEED},
            "standing": {"route": "way", "position": {"along": 200}, "speed": 0, "driver": {"kind": "parked"}},
        },
    }
    (folder / "standing.yaml").write_text(yaml.safe_dump(document))
    return folder / "standing.yaml"


def prepared(road, *reasons, reaction_time=1.0):
    """The road with a driver who minds these."""
    return job.prepare(job.load(road, {"vehicles.car.intervention": {"reasons": list(reasons), "reaction_time": reaction_time}}))


@dataclass
class Pushing:
    """An application that always commands the same."""

    commands: dict
    groups: tuple = ()
    cycles: int = 1
    is_compiled: bool = False

    def decide(self, time, tick, around):
        commands = around[-1]
        for (row, column), value in self.commands.items():
            commands[row, column], commands[AUTHORS + row, column] = value, APPLICATION
        return []


def commanding(world, row, value, column=0):
    """The world with such an application in a vehicle, which commanded something else before."""
    pushing = next((each for each in world.hosted if isinstance(each, Pushing)), Pushing({}))
    pushing.commands[row, column] = value
    world.hosted = [pushing]
    return world


def needs_braking(world):
    """Whether the driver has seen at the last tick that it is needed."""
    return np.isfinite(world.vehicles.mind[NEEDED_COLLISION, 0])


@pytest.mark.parametrize("reaction_time", [0.0, 0.3, 0.77])
def test_he_acts_after_his_reaction_time_to_the_tick(road, reaction_time):
    world = commanding(build([prepared(road, "collision", reaction_time=reaction_time)]), APP_ACCELERATION, 0.0)
    needed, acted = [], []
    for k in range(600):
        tick(world)
        asked = world.vehicles.commands[U, (k % RING) * world.size]
        needed += [k] if needs_braking(world) else []
        acted += [k] if world.vehicles.mind[INTERVENING, 0] == 1.0 else []
        assert asked < -EMERGENCY if acted == [k] else acted or asked == 0.0
    assert acted[0] == needed[0] + int(np.ceil(reaction_time / TICK - 1e-9))
    assert acted == list(range(acted[0], 600))


def test_the_need_is_the_closed_form(road):
    world = commanding(build([prepared(road, "collision", reaction_time=5.0)]), APP_ACCELERATION, 0.0)
    before = []
    while not needs_braking(world):
        before.append((world.vehicles.state[V_X, 0], world.vehicles.mind[GAP, 0]))
        tick(world)
    speed, gap = before[-1][0], world.vehicles.mind[GAP, 0]
    assert speed**2 / (2.0 * (gap - NEAREST)) > EMERGENCY > speed**2 / (2.0 * (gap + speed * TICK - NEAREST))


def collisions(setting, row=APP_ACCELERATION, value=0.0, seconds=12.0):
    """How many there are when an application always commands the same, and the world at the end."""
    world = commanding(build([setting]), row, value)
    for _ in range(round(seconds / TICK)):
        tick(world)
    return world.events.hits_found, world


def test_by_default_an_application_drives_into_what_stands_there(road):
    hits, world = collisions(job.prepare(job.load(road)))
    assert hits == 1 and world.vehicles.mind[INTERVENING, 0] == 0.0


@pytest.mark.parametrize("reasons", [("red_light",), ("right_of_way",), ("red_light", "right_of_way")])
def test_what_is_not_named_is_not_minded(road, reasons):
    assert collisions(prepared(road, *reasons, reaction_time=0.0))[0] == 1


@pytest.mark.parametrize("reaction_time", [0.0, 0.3, 0.6])
def test_a_driver_who_is_quick_enough_stops(road, reaction_time):
    """v²/(2 EMERGENCY) = 28 m before the last metre he sees the need; what his reaction leaves must do for a stop with 9 m/s²."""
    assert SPEED**2 / (2 * EMERGENCY) - SPEED * reaction_time > SPEED**2 / (2 * 9.0)
    hits, world = collisions(prepared(road, "collision", reaction_time=reaction_time))
    assert hits == 0 and abs(world.vehicles.state[V_X, 0]) < 0.1 and world.vehicles.mind[INTERVENING, 0] == 1.0


@pytest.mark.parametrize("reaction_time", [1.2, 2.0])
def test_a_driver_who_is_not_hits(road, reaction_time):
    assert SPEED**2 / (2 * EMERGENCY) - SPEED * reaction_time < SPEED**2 / (2 * 10.0)
    assert collisions(prepared(road, "collision", reaction_time=reaction_time))[0] == 1


@pytest.mark.parametrize(("row", "value"), [(APP_ACCELERATION, 1.0), (APP_ACCELERATOR, 0.4)])
def test_a_driver_holds_against_an_application_that_pushes_on(road, row, value):
    """He does not let go while the car ahead stands, whatever is commanded."""
    hits, world = collisions(prepared(road, "collision", reaction_time=0.3), row, value, seconds=20.0)
    assert hits == 0 and abs(world.vehicles.state[V_X, 0]) < 0.1


def test_an_application_that_brakes_enough_is_left_alone(road):
    """It begins before the driver would, 40 m away, and stops harder: he has nothing to overrule."""
    world = commanding(build([prepared(road, "collision", reaction_time=0.0)]), APP_ACCELERATION, 0.0)
    for _ in range(400):
        tick(world)
        if world.vehicles.mind[GAP, 0] < 40.0:
            commanding(world, APP_ACCELERATION, -9.0)
        assert world.vehicles.mind[INTERVENING, 0] == 0.0
    assert world.events.hits_found == 0


def test_an_application_may_brake_harder(road):
    """The brake torque that it commands counts, where it is more than what the driver asks for."""
    world = commanding(build([prepared(road, "collision", reaction_time=0.3)]), APP_ACCELERATION, 0.0)
    while world.vehicles.mind[INTERVENING, 0] == 0.0:
        tick(world)
    commanding(world, APP_ACCELERATION, -10.0)
    tick(world)
    assert world.vehicles.commands[U, ((world.clock.k - 1) % RING) * world.size] == -10.0


def test_without_an_application_nothing_is_overruled(road):
    """The driver drives as ever; and once an application lets go of the pedals, the driver has them."""
    alone, named = build([prepared(road)]), build([prepared(road, "collision", "red_light", reaction_time=0.0)])
    for _ in range(500):
        tick(alone)
        tick(named)
    assert named.vehicles.mind[INTERVENING, 0] == 0.0
    assert named.vehicles.state.tobytes() == alone.vehicles.state.tobytes()
    acting = collisions(prepared(road, "collision", reaction_time=0.0))[1]
    commanding(acting, APP_ACCELERATION, nan)
    tick(acting)
    assert acting.vehicles.mind[INTERVENING, 0] == 0.0 and acting.vehicles.mind[NEEDED_COLLISION, 0] == inf


def test_it_is_an_event_and_a_channel(road):
    running = simulation(prepared(road, "collision", reaction_time=0.3))
    commanding(running.world, APP_ACCELERATION, 0.0)
    running.advance(500)  # it rolls still: where it stands the driver asks for no less than this application, which has no name
    record = running.record()
    (told,) = record.happenings
    assert (told.vehicle, told.kind, told.text) == ("car", "driver_takes_over", "driver takes over: collision")
    trace = record.trace("car.intervening")
    assert set(trace) == {0.0, 1.0} and record.time[trace == 1.0][0] == pytest.approx(told.time)
    assert not record.trace("standing.intervening").any()


# -- lights and right of way ----------------------------------------------------------------------------


def passed_lights(sample, *reasons, reaction_time=1.0):
    """What the lights showed that a car passed whose application holds the accelerator down."""
    vehicle = {"route": "way", "position": {"along": 100}, "speed": 13}
    vehicle["intervention"] = {"reasons": list(reasons), "reaction_time": reaction_time}
    changes = {
        "traffic.count": 0, "script": {}, "applications": {}, "goals": {}, "vehicles": {"car": vehicle},
        "routes": {"way": {"roads": ["340498991", "206170873#1"]}},
    }  # fmt: skip
    world = commanding(build([job.prepare(job.load(sample, changes))]), APP_ACCELERATOR, 0.4)
    roads, vehicles, passed = world.roads, world.vehicles, []

    def bumper():
        return vehicles.mind[STATION, 0] + vehicles.parameter[FRONT, 0]

    for _ in range(4500):
        before = bumper()
        tick(world)
        lines = roads.stop_station[: roads.stop_count[0]]
        passed += [int(roads.shown[roads.stop_link[i]]) for i in np.flatnonzero((before < lines) & (lines <= bumper()))]
    return set(passed)


def test_red_lights(sample):
    """Passed by default; a driver who minds them stops for each, and goes on when it is green."""
    assert passed_lights(sample) & {RED, RED_AMBER}
    minding = passed_lights(sample, "red_light")
    assert minding and not minding & {RED, RED_AMBER}


def mind_of(**rows):
    """One driver's mind and what he is like: nobody around, no light."""
    mind, drivers = np.zeros((len(MIND), 1)), np.ones((len(DRIVER), 1))
    mind[[GAP, RED_STATION, NEEDED_WAY, YIELDING, FOLLOWING], 0] = nan, inf, inf, NO_LIMIT, NO_LIMIT
    drivers[:, 0] = [float(rows.get(row.name, 0.0)) for row in DRIVER]
    return mind, drivers


def test_right_of_way_is_minded_after_an_unbroken_need_and_until_nobody_goes_first():
    """-2 m/s² are needed: for half a second nothing; a break of one tick begins anew; then held until the way is free.

    When the other is there and drives ahead, he is followed until he is far enough.
    """
    mind, drivers = mind_of(minds_right_of_way=1.0, reaction_time=0.5)
    assert drivers[MINDS_WAY, 0] == 1.0 and drivers[REACTION_TIME, 0] == 0.5
    state, parameter = np.zeros((len(VEHICLE), 1)), np.zeros((len(PARAMETER), 1))
    needs = [-2.0] * 20 + [0.5] + [-2.0] * 30 + [0.5] * 10 + [NO_LIMIT] * 5
    found = []
    for k, permitted in enumerate(needs):
        mind[YIELDING, 0], mind[FOLLOWING, 0] = permitted, -1.0 if k in (61, 62) else NO_LIMIT
        found.append(attended(0, k * TICK, 1.0, state, parameter, drivers, mind))
    acts = 21 + round(0.5 / TICK)
    assert found[:acts] == [NO_LIMIT] * acts
    assert found[acts:51] == [-2.0] * (51 - acts) and found[51:61] == [0.5] * 10
    assert found[61:] == [-1.0] * 2 + [NO_LIMIT] * 3 and mind[ACTS_WAY, 0] == 0.0


# -- state ----------------------------------------------------------------------------------------------


def test_a_world_does_not_know_its_batch(road):
    """Drivers who mind nothing, are quick, are slow: side by side as alone."""
    each = [prepared(road), *(prepared(road, "collision", reaction_time=span) for span in (0.3, 1.0))]

    def run(*settings):
        world = build(settings)
        for number in range(len(settings)):
            commanding(world, APP_ACCELERATION, 0.0, int(world.worlds.first[number]))
        for _ in range(400):
            tick(world)
        return [world.digest(number) for number in range(len(settings))]

    together = run(*each)
    assert together == [digest for one in each for digest in run(one)] and len(set(together)) == 3


@pytest.mark.parametrize("after", [0.1, 0.6])
def test_a_snapshot_holds_how_long_it_has_been_needed(road, after):
    """Taken while he reacts, or while he acts: it goes on with the same bits."""
    world = commanding(build([prepared(road, "collision", reaction_time=0.4)]), APP_ACCELERATION, 0.0)
    while not needs_braking(world):
        tick(world)
    for _ in range(round(after / TICK)):
        tick(world)
    kept = snapshot(world)
    digests = []
    for _ in range(2):
        restore(world, kept)
        for _ in range(100):
            tick(world)
        digests.append(world.digest())
    fresh = commanding(build([prepared(road, "collision", reaction_time=0.4)]), APP_ACCELERATION, 0.0)
    restore(fresh, kept)
    for _ in range(100):
        tick(fresh)
    assert digests == [fresh.digest()] * 2 and fresh.vehicles.mind[INTERVENING, 0] == 1.0


def test_a_brake_torque_of_an_application_does_not_let_the_car_go(road):
    """It commands too little brake; the driver's counts once he acts."""
    assert collisions(prepared(road, "collision", reaction_time=0.3), APP_BRAKE, 50.0)[0] == 0
