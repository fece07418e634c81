"""Standing still, on hills for a minute and after a stop; and rolling off by gravity alone."""

import numpy as np
import pytest

from studio.conventions import GRAVITY
from studio.vehicle import shift
from studio.vehicle.contact import SLOPE_X, SLOPE_Y
from studio.vehicle.parameter import BRAKE_MAX, C_ROLL, MASS, RADIUS
from studio.vehicle.state import F_Y, OMEGA, PITCH_RATE, PSI, ROLL_RATE, V_X, V_Y, YAW_RATE, X, Y, Z
from tests.proving_ground import MODELS, Ground, heavier

HILL = 0.15
STILL = [V_X, V_Y, ROLL_RATE, PITCH_RATE, YAW_RATE]


def facing(heading, *, speed=0.0, slope=HILL):
    """One of each on a hill that rises to the east, facing `heading` [rad], the brakes closed already."""
    ground = Ground(MODELS, speed=speed)
    f = ground.fleet
    f.ground[SLOPE_X], f.ground[SLOPE_Y] = slope, 0.0
    for v in range(ground.n):
        shift.start(v, 0.0, 0.0, heading, speed, f.state, f.wheels, f.ground, f.parameter, f.gears)
    return ground.command(gear=0.0, brake=0.8 * ground.parameter[BRAKE_MAX])


@pytest.mark.parametrize("degrees", [0, 180], ids=["uphill", "downhill"])
def test_a_parked_car_stays(degrees):
    """60 s on 15 %, with the brakes closing from rest: it sinks into springs and tyres by less than a centimetre and stands."""
    ground = facing(np.radians(degrees))
    start = ground.state[[X, Y]].copy()
    after = ground.run(2.0).state[[X, Y, Z]].copy()
    ground.run(58.0)
    assert np.hypot(*(ground.state[[X, Y]] - start)).max() < 0.01
    assert np.abs(ground.state[[X, Y, Z]] - after).max() < 1e-3
    before = ground.state[[X, Y, Z, PSI]].copy()
    ground.run(1.0)
    assert np.abs(ground.state[[X, Y, Z, PSI]] - before).max() < 1e-9  # it neither creeps nor shakes
    assert np.abs(ground.state[STILL]).max() < 1e-9 and (ground.wheels[OMEGA] == 0.0).all()


@pytest.mark.parametrize("degrees", [90, 45, -120], ids=["across", "askew", "backwards"])
def test_a_car_parked_across_a_hill_leans_and_stays(degrees):
    """Side forces hold it as well. The body leans downhill over its contact patches, a truck by 3 cm; then nothing moves."""
    ground = facing(np.radians(degrees)).run(20.0)
    before = ground.state[[X, Y, Z, PSI]].copy()
    assert np.hypot(*before[:2]).max() < 0.04
    ground.run(40.0)
    assert np.abs(ground.state[[X, Y, Z, PSI]] - before).max() < 1e-6
    assert np.abs(ground.state[STILL]).max() < 1e-9
    sine, F_y = HILL / np.hypot(1.0, HILL), ground.wheels[F_Y].reshape(4, -1).sum(axis=0)
    uphill = -np.sin(np.radians(degrees))  # seen from the car, to its left
    assert F_y == pytest.approx(ground.parameter[MASS] * GRAVITY * sine * uphill, rel=0.02)


@pytest.mark.parametrize("speed", [0.3, 5.0, 20.0])
@pytest.mark.parametrize("degrees", [0, 180], ids=["uphill", "downhill"])
def test_a_car_that_stops_on_a_hill_stays(degrees, speed):
    """Rolled in and braked to a stop: it rocks back once, less than 5 cm, and then stands for a minute."""
    ground = facing(np.radians(degrees), speed=speed)
    way = ground.history(14.0, lambda each: each.state[X].copy())
    end = ground.state[[X, Y, Z]].copy()
    ground.run(60.0)
    assert np.abs(ground.state[[X, Y, Z]] - end).max() < 1e-5
    assert np.abs(ground.state[STILL]).max() < 1e-9
    furthest = np.abs(way).max(axis=0)
    assert (furthest - np.abs(way[-1])).max() < 0.05


def test_a_stopped_car_does_not_shake():
    """Full braking from 10 m/s on the level: 3 s after the stop nothing moves faster than a hair, whatever the car."""
    ground = Ground(MODELS, speed=10.0)
    ground.command(brake=ground.parameter[BRAKE_MAX]).run(6.0)
    rest = ground.history(1.0, lambda each: each.state[STILL].copy())
    assert np.abs(rest).max() < 2e-3
    ground.run(10.0)
    assert np.abs(ground.state[STILL]).max() < 1e-8


@pytest.mark.parametrize("speed", [0.0, 5.0])
@pytest.mark.parametrize("slope", [0.05, -0.05, -0.15])
def test_gravity_alone(slope, speed):
    """Rolling freely: a = -g sin m/(m + sum J/R²) = -g sin/(1 + 4 J/(m R²)), from rest or speed, up or down."""
    ground = Ground(MODELS, speed=speed, slope=slope, resistances=False).run(1.0)
    before = ground.state[V_X].copy()
    ground.run(2.0)
    expected = -GRAVITY * np.sin(np.arctan(slope)) * ground.parameter[MASS] / heavier(ground.parameter)
    assert (ground.state[V_X] - before) / 2.0 == pytest.approx(expected, rel=1e-3)


def test_a_brake_holds_up_to_its_torque_and_then_slips():
    """15 % need m g sin R: with half of it the car rolls down with the other half of gravity, with a fifth more it stands."""
    slips, holds = facing(0.0), facing(0.0)
    p, sine = slips.parameter, HILL / np.hypot(1.0, HILL)
    p[C_ROLL] = holds.parameter[C_ROLL] = 0.0
    needed = p[MASS] * GRAVITY * sine * p[RADIUS]
    slips.command(brake=0.0, applied_brake=0.5 * needed).run(1.0)
    holds.command(brake=0.0, applied_brake=1.2 * needed).run(10.0)
    before = slips.state[V_X].copy()
    slips.run(2.0)
    expected = -0.5 * GRAVITY * sine * p[MASS] / heavier(p)
    assert (slips.state[V_X] - before) / 2.0 == pytest.approx(expected, rel=0.01)
    assert np.abs(holds.state[V_X]).max() < 1e-6
