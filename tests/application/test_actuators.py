"""Every actuator that an application can command arrives at the car; what it leaves alone stays the driver's."""

from math import isnan

import pytest

from studio import job
from studio.application.contract import accelerate, also, brake, drive, leave, press, shift, steer, steer_by, turn_engine
from studio.kind import registry
from studio.scenario.setup import complete
from studio.vehicle.command import RING, U_BRAKE, U_DRIVE, U_STEER, U
from studio.vehicle.state import A_X, ACCELERATOR, DELTA, GEAR, RATIO, T_ENGINE, TORQUE_BRAKE, TORQUE_DRIVE, V_X
from studio.world.build import build
from studio.world.setting import setting
from studio.world.tick import tick

SOURCE = '''
"""Commands {actuator}."""
from typing import Annotated, NamedTuple
from studio.application.contract import GEAR, Command, shift
from studio.compiled import compiled
from studio.kind.settings import Part

KIND = "application"
TITLE = "One actuator"
COMMANDS = GEAR

class Parameters(Part):
    pass

class Memory(NamedTuple):
    n: Annotated[float, "1"] = 0.0

class Sees(NamedTuple):
    pass

class Does(NamedTuple):
    command: Command

{decorator}
def decide(parameters, memory, sees):
    return Memory(memory.n + 1.0), Does(shift(3.0))
'''


def always(hosted, command):
    """Has an application command the same at every tick."""

    def run(fixed, now, commands, unit, column, *rest):
        for i, value in enumerate(command[1:]):
            if int(command.mask) >> i & 1:
                commands[i, column] = value
        return 0

    hosted.run = run


def driven(sample, command, seconds=3.0, speed=13.0, model="bmw_320i"):
    """A car on the sample's road whose application always returns `command`."""
    document = {
        "title": "alone",
        "map": {"file": "maps/berlin_siegessaeule_grosser_stern.osm.gz"},
        "routes": {"way": {"roads": ["340498991", "206170873#1"]}},
        "vehicles": {"car": {"model": model, "route": "way", "position": {"along": 100}, "speed": speed}},
        "applications": {"mine": {"application": "acc", "units": ["car"]}},
    }
    world = build([setting(complete(document, "alone"), sample.parent, "alone")])
    (hosted,) = world.hosted

    always(hosted, command)
    for _ in range(round(seconds / 0.02)):
        tick(world)
    return world


def row(world, number):
    """A row of the car's commands of the last tick."""
    return world.vehicles.commands[number, (world.clock.k - 1) % RING]


def test_the_accelerator(sample):
    gentle, full = (driven(sample, press(pedal)) for pedal in (0.3, 1.0))
    assert full.vehicles.state[ACCELERATOR, 0] == pytest.approx(1.0)
    assert gentle.vehicles.state[ACCELERATOR, 0] == pytest.approx(0.3, abs=1e-6)
    assert full.vehicles.state[V_X, 0] > gentle.vehicles.state[V_X, 0] + 2.0


def test_the_engine_torque(sample):
    world = driven(sample, turn_engine(60.0))
    assert world.vehicles.state[T_ENGINE, 0] == pytest.approx(60.0, abs=0.1)


def test_the_drive_torque(sample):
    """At the wheels, less what the gearbox loses; negative as far as the engine brakes."""
    world = driven(sample, drive(300.0), model="electric_compact")
    assert world.vehicles.state[TORQUE_DRIVE, 0] == pytest.approx(300.0, rel=0.1)
    slowing = driven(sample, drive(-800.0), model="electric_compact")
    assert slowing.vehicles.state[TORQUE_DRIVE, 0] < -500.0 and slowing.vehicles.state[A_X, 0] < -0.8


def test_the_brake_torque(sample):
    world = driven(sample, brake(900.0), seconds=1.0)
    assert world.vehicles.state[TORQUE_BRAKE, 0] == pytest.approx(900.0, rel=1e-3)
    assert world.vehicles.state[A_X, 0] < -1.0


def test_the_gear(sample):
    """Third instead of what the schedule takes; reverse is not engaged while driving."""
    third = driven(sample, shift(3.0))
    assert third.vehicles.state[GEAR, 0] == 3.0
    back = driven(sample, shift(-1.0))
    assert back.vehicles.state[GEAR, 0] >= 1.0 and back.vehicles.state[RATIO, 0] > 0.0


def test_the_steering_torque(sample):
    """A torque to the left turns the wheels to the left, and replaces the angle."""
    left, right = (driven(sample, steer_by(torque), seconds=0.5) for torque in (2.0, -2.0))
    assert left.vehicles.state[DELTA, 0] > 0.005 and right.vehicles.state[DELTA, 0] < -0.005


def test_the_angle_and_the_acceleration(sample):
    world = driven(sample, also(accelerate(-1.0), steer(0.01)), seconds=1.5)
    assert world.vehicles.state[DELTA, 0] == pytest.approx(0.01, rel=1e-3)
    assert world.vehicles.state[A_X, 0] == pytest.approx(-1.0, abs=0.15)


def test_what_is_left_stays_the_drivers(sample):
    """Nothing commanded is the driver alone; a gear commanded leaves pedals and wheel to the driver."""
    alone, shifted = driven(sample, leave(), seconds=1.0), driven(sample, shift(2.0), seconds=0.02)
    assert not isnan(row(alone, U_DRIVE)) and not isnan(row(alone, U_STEER))
    for number in (U, U_BRAKE, U_STEER):
        assert row(shifted, number) == row(driven(sample, leave(), seconds=0.02), number)


@pytest.mark.parametrize("compiled", [True, False])
def test_a_file_may_return_actuators(sample, tmp_path, compiled):
    """Compiled or not, the command of a user's own file arrives."""
    path = tmp_path / f"shifter_{compiled}.py".lower()
    path.write_text(SOURCE.format(actuator="the gear", decorator="@compiled" if compiled else ""))
    registry.load_file(path)
    changes = {"applications.platoon.application": path.stem, "traffic.count": 0}
    world = build([job.prepare(job.load(sample, changes))])
    for _ in range(100):
        tick(world)
    assert (world.vehicles.state[GEAR, 1:5] == 3.0).all()
    assert (world.hosted[0].memory == 100.0).all()
