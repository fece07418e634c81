"""Light vehicles: closed forms of their lags, bends and frictions; against full ones; the same bits in any company."""

import numpy as np
import pytest

from studio.conventions import AIR_DENSITY, GRAVITY
from studio.scenario import catalogue
from studio.vehicle import broken, fleet
from studio.vehicle.command import RING, U_DRIVE, U_STEER
from studio.vehicle.contact import MU
from studio.vehicle.fleet import Start
from studio.vehicle.light import ACROSS, ALONG, EFFECTIVE_MASS, REAR_SLIP, TRACTION, UNDERSTEER
from studio.vehicle.parameter import (
    AREA,
    C_D,
    C_ROLL,
    DELAY_BRAKE,
    DELAY_DRIVE,
    L_F,
    L_R,
    MASS,
    RADIUS,
    TAU_DRIVE,
    TAU_STEER,
)  # fmt: skip
from studio.vehicle.state import A_X, A_Y, BEND, DELTA, OMEGA, PITCH, PSI, TORQUE_DRIVE, V_X, V_Y, VEHICLE, YAW_RATE, X, Y, Z
from tests.proving_ground import FIGURES, MODELS, TICK, Ground, heavier

RAD = 0.03  # [rad] a mean bend
ICE = 0.1


def light(models=MODELS, **given):
    """Light cars on the open plane, in neutral, without resistances unless they are asked for."""
    return Ground(models, light=True, **{"resistances": False} | given)


def row(ground, place):
    """A row of what light vehicles are."""
    return ground.fleet.lightness[place]


# --- lags ----------------------------------------------------------------------------------------------------------------


def test_the_wheels_turn_by_their_lag():
    """delta = delta_0 (1 - exp(-t/tau)), far from the greatest rate."""
    ground = light().command(steering=0.002)
    seen = ground.history(0.5, lambda each: each.state[DELTA].copy())
    t = TICK * (1 + np.arange(len(seen)))[:, None]
    np.testing.assert_allclose(seen, 0.002 * (1.0 - np.exp(-t / ground.parameter[TAU_STEER])), rtol=1e-9)


def test_the_drive_comes_after_its_dead_time_by_its_lag():
    """A step of the torque: T = T_0 (1 - exp(-(t - t_d)/tau)), the dead time to the half of a tick."""
    ground = light(powertrain=True, speed=10.0).command(gear=1.0)
    ground.fleet.commands[U_DRIVE] = 0.0
    p, T = ground.parameter, 100.0

    def step_now(each):
        slot = each.k % RING * each.n
        each.fleet.commands[U_DRIVE, slot : slot + each.n] = T

    seen = ground.history(1.0, lambda each: each.state[TORQUE_DRIVE].copy(), step_now)
    t = TICK * (1 + np.arange(len(seen)))[:, None]
    early, late = (np.maximum(1.0 - np.exp(-(t - p[DELAY_DRIVE] + half) / p[TAU_DRIVE]), 0.0) for half in (0.51 * TICK, -0.51 * TICK))
    assert (seen <= T * early + 1e-9).all() and (seen >= T * late - 1e-9).all()


# --- bends ---------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("v", [0.5, 5.0, 15.0])
def test_a_steady_bend_has_the_radius_of_the_single_track(v):
    """kappa = tan(delta)/(L + EG v²); the rear axle slips by S_r v² kappa; the centre of gravity goes round in a circle of v/r."""
    ground = light(speed=v).command(steering=RAD).run(8.0)
    p = ground.parameter
    L = p[L_F] + p[L_R]
    kappa = np.tan(RAD) / (L + row(ground, UNDERSTEER) * v * v)
    np.testing.assert_allclose(ground.state[YAW_RATE], v * kappa, rtol=1e-9)
    slip = row(ground, REAR_SLIP) * v * v * kappa
    np.testing.assert_allclose(ground.state[V_Y], p[L_R] * v * kappa - v * slip, atol=1e-9)
    np.testing.assert_allclose(ground.state[A_Y], v * v * kappa, rtol=1e-9)
    places = ground.history(3.0, lambda each: each.state[[X, Y]].copy())
    middle = ground.state[[X, Y]] + np.array([-np.sin(c := course(ground)), np.cos(c)]) * radius(ground)
    np.testing.assert_allclose(np.hypot(*np.moveaxis(places - middle, 1, 0)), np.tile(radius(ground), (len(places), 1)), rtol=3e-5)


def course(ground):
    """Where the centres of gravity go."""
    return ground.state[PSI] + np.arctan2(ground.state[V_Y], ground.state[V_X])


def radius(ground):
    """Of the circles on which they go."""
    return np.hypot(ground.state[V_X], ground.state[V_Y]) / ground.state[YAW_RATE]


def test_it_goes_the_same_circle_backwards():
    """At walking pace, where nothing slips."""
    forth, back = (light(speed=v).command(steering=0.3).run(5.0) for v in (1.0, -1.0))
    np.testing.assert_allclose(back.state[YAW_RATE], -forth.state[YAW_RATE], rtol=0.01)


def test_its_wheels_roll():
    ground = light(speed=12.0)
    assert (ground.run(1.0).wheels[OMEGA] == np.tile(12.0 / ground.parameter[RADIUS], 4)).all()


# --- along ---------------------------------------------------------------------------------------------------------------


def test_coasting():
    """m_eff dv/dt = -(a v² + b), so that v = √(b/a) tan(atan(v_0 √(a/b)) - √(a b) t/m_eff)."""
    ground = light(speed=30.0, resistances=True).run(20.0)
    p = ground.parameter
    a, b = 0.5 * AIR_DENSITY * p[C_D] * p[AREA], p[C_ROLL] * p[MASS] * GRAVITY
    expected = np.sqrt(b / a) * np.tan(np.arctan(30.0 * np.sqrt(a / b)) - np.sqrt(a * b) * 20.0 / heavier(p))
    np.testing.assert_allclose(ground.state[V_X], expected, rtol=1e-3)


def test_the_brake_stops_and_holds():
    """u on the level, with all wheels turning; then it stands, and nothing moves it."""
    ground = light(speed=15.0)
    p = ground.parameter
    ground.command(brake=3.0 * heavier(p) * p[RADIUS]).run(2.0)
    np.testing.assert_allclose(ground.state[A_X], -3.0, rtol=1e-3)
    there = ground.run(9.0).state[[X, Y]].copy()
    assert (ground.state[V_X] == 0.0).all()
    assert (ground.run(5.0).state[[X, Y]] == there).all()


def test_it_rolls_down_a_slope_and_is_held_on_it():
    """Without a brake by g sin(slope) m/m_eff; with one it stands; it stands level with the road, above it."""
    ground = light(speed=0.0, slope=-0.05)
    p, sine = ground.parameter, 0.05 / np.hypot(1.0, 0.05)
    held = light(speed=0.0, slope=-0.05).command(brake=2.0 * p[MASS] * p[RADIUS]).run(3.0)
    there = held.state[X].copy()
    assert (there < 0.3).all() and (held.state[V_X] == 0.0).all() and (held.run(3.0).state[X] == there).all()
    ground.run(2.0)
    np.testing.assert_allclose(ground.state[V_X], 2.0 * GRAVITY * sine * p[MASS] / heavier(p), rtol=1e-6)
    np.testing.assert_allclose(ground.state[PITCH], np.arctan(0.05), rtol=1e-6)
    np.testing.assert_allclose(np.diff(ground.history(0.1, lambda each: each.state[Z] + 0.05 * each.state[X]), axis=0), 0.0, atol=1e-9)


def test_reverse():
    """By the pedal in reverse it goes back, the brake stops it; nobody changes into reverse at speed."""
    ground = light(speed=0.0, powertrain=True).command(pedal=0.3, gear=-1.0).run(2.0)
    assert (ground.state[V_X] < -0.3).all() and (ground.state[TORQUE_DRIVE] < 0.0).all()
    ground.command(pedal=0.0, brake=2.0 * ground.parameter[MASS] * ground.parameter[RADIUS]).run(5.0)
    assert (ground.state[V_X] == 0.0).all()
    fast = light(speed=10.0, powertrain=True).command(pedal=0.3, gear=1.0).run(0.1)
    assert (fast.command(gear=-1.0).run(1.0).state[TORQUE_DRIVE] > 0.0).all()


# --- friction ------------------------------------------------------------------------------------------------------------


def test_on_ice_it_brakes_by_what_there_is():
    """All of it, and no more: mu_x g m/m_eff."""
    ground = light(speed=15.0, friction=ICE)
    p = ground.parameter
    ground.command(brake=9000.0 + 3.0 * p[MASS] * p[RADIUS]).run(2.0)
    np.testing.assert_allclose(ground.state[A_X], -row(ground, ALONG) * ICE * GRAVITY * p[MASS] / heavier(p), rtol=1e-6)


def test_on_ice_the_driven_axle_gives_its_part():
    ground = light(speed=3.0, friction=ICE, powertrain=True).command(gear=1.0, pedal=1.0).run(2.0)
    p = ground.parameter
    expected = row(ground, TRACTION) * row(ground, ALONG) * ICE * GRAVITY * p[MASS] / heavier(p)
    np.testing.assert_allclose(ground.state[A_X], expected, rtol=1e-6)


@pytest.mark.parametrize("brakes", [False, True])
def test_on_ice_it_runs_wide(brakes):
    """Steered for more than there is, it bends by what there is; braking takes its share of the ellipse."""
    ground = light(speed=25.0, friction=ICE).command(steering=0.1)
    p, across = ground.parameter, row(ground, ACROSS) * ICE * GRAVITY
    along = row(ground, ALONG) * ICE * GRAVITY * p[MASS] / row(ground, EFFECTIVE_MASS)
    if brakes:
        ground.command(brake=0.5 * along * heavier(p) * p[RADIUS])
    seen = ground.history(4.0, lambda each: each.state[[V_X, BEND]].copy())
    v, kappa = np.moveaxis(seen, 1, 0)
    v_y = np.diff(v, axis=0) / TICK  # along the body, without what a turning body adds
    used = np.hypot(v_y / along, (v * v * kappa / across)[1:])
    assert used.max() < 1.02 and used[-1].min() > 0.98
    assert (np.abs(v_y[-1] / along) < 0.6).all() if brakes else (v_y == 0.0).all()


def test_ice_that_begins_takes_the_bend_at_once():
    ground = light(speed=20.0).command(steering=0.02).run(2.0)
    before = ground.state[BEND].copy()
    ground.fleet.ground[MU] = ICE
    ground.run(TICK)
    assert (20.0**2 * ground.state[BEND] <= row(ground, ACROSS) * ICE * GRAVITY * 1.0001).all() and (before > ground.state[BEND]).all()


# --- against full ones ---------------------------------------------------------------------------------------------------


def both(**given):
    """Full and light cars of all models."""
    return [Ground(MODELS, light=each, powertrain=True, **given).command(gear=np.nan) for each in (False, True)]


def times_to(ground, v, seconds):
    """When every car is as fast as v at full pedal [s]."""
    speeds = ground.command(pedal=1.0).history(seconds, lambda each: each.state[V_X].copy())
    return np.array([TICK * np.argmax(each > v) for each in speeds.T])


def test_it_speeds_up_as_the_full_one():
    """From rest: cars to 100 km/h within 5 %, all to 72 km/h within 12 %: it needs no time to get off, and loses none in single shifts."""
    full, light_ = (times_to(ground, 20.0, 30.0) for ground in both(speed=0.0))
    cars = np.array([name != "truck" for name in MODELS])
    fast = [times_to(ground, 100.0 / 3.6, 20.0)[cars] for ground in both(speed=0.0)]
    told = ", ".join(f"{name} {a:.2f} and {b:.2f}" for name, a, b in zip(np.array(MODELS)[cars], *fast, strict=True))
    FIGURES.append(f"light vehicles: 0 to 100 km/h full and light: {told} s")
    assert (np.abs(light_ / full - 1.0) < 0.12).all()
    assert (np.abs(fast[1] / fast[0] - 1.0) < 0.05).all()


def test_it_brakes_as_the_full_one():
    """From 100 km/h with 3 and 6 m/s²: way within 4 % of the full one's; that one's engine drags less than its drag at idle."""
    for a in (3.0, 6.0):
        ways = []
        for ground in both(speed=100.0 / 3.6):
            ground.command(gear=0.0)
            p = ground.parameter
            ways.append(ground.command(brake=a * p[MASS] * p[RADIUS]).run(100.0 / 3.6 / a + 2.0).state[X].copy())
            assert (np.abs(ground.state[V_X]) < 0.01).all()
        np.testing.assert_allclose(ways[1], ways[0], rtol=0.04)


def steered(ground, v, a_y):
    """Road wheel angle for a lateral acceleration by the linear single track, float64[vehicle]."""
    p, of = ground.parameter, [fleet.light_rows_of(model)[2][UNDERSTEER] for model in ground.models]
    return a_y / v**2 * (p[L_F] + p[L_R] + np.array(of) * v**2)


def neutral(speed):
    """Full and light ones that roll."""
    return [Ground(MODELS, light=each, speed=speed, resistances=False) for each in (False, True)]


def test_it_takes_up_a_bend_as_the_full_one():
    """A step at 20 m/s to 1 m/s² across: steady yaw rate within 13 %, which tyres do not quite reach; 63 % of it to 0.06 s as late."""
    ends, rises = [], []
    for ground in neutral(20.0):
        rates = ground.command(steering=steered(ground, 20.0, 1.0)).history(3.0, lambda each: each.state[YAW_RATE].copy())
        ends.append(rates[100])
        rises.append(TICK * (rates > 0.63 * rates[100]).argmax(axis=0))
    np.testing.assert_allclose(ends[1], ends[0], rtol=0.13)
    np.testing.assert_allclose(rises[1], rises[0], atol=0.061)


def test_it_changes_lanes_as_the_full_one():
    """A period of a sine of 3 s at 20 m/s, 2 m/s² at its peak: the offset within 15 %, and as straight again."""
    ends = []
    for ground in neutral(20.0):
        angle = steered(ground, 20.0, 2.0)
        ground.run(4.0, lambda each, angle=angle: each.command(steering=angle * np.sin(2.0 * np.pi * min(each.time, 3.0) / 3.0)))
        ends.append(ground.state[[Y, PSI]].copy())
    np.testing.assert_allclose(ends[1][0], ends[0][0], rtol=0.15)
    np.testing.assert_allclose(ends[1][1], ends[0][1], atol=0.003)


# --- steps, company, faults ----------------------------------------------------------------------------------------------


def swerve(tick):
    """Where light cars are after a swerve and a braking, with delays that are whole ticks."""
    ground = light(speed=25.0, tick=tick)
    p = ground.parameter
    p[[DELAY_BRAKE, DELAY_DRIVE]] = 0.04
    angle = steered(ground, 25.0, 3.0)
    ground.run(3.0, lambda each: each.command(steering=angle * np.sin(2.0 * np.pi * each.time / 3.0)))
    ground.command(steering=0.0, brake=3.0 * p[MASS] * p[RADIUS]).run(3.0)
    return ground.state[[X, Y, V_X]].copy()


def test_halving_the_step_halves_what_is_wrong():
    """A tick of 20 ms is one step: it is centimetres in 130 m and a swerve of 4 m beside one of 5 ms, whose commands are finer too."""
    coarse, half, fine = (swerve(tick) for tick in (0.02, 0.01, 0.005))
    assert np.abs(coarse - fine).max() < 0.12
    assert (np.abs(half - fine).max(axis=1) < 0.6 * np.abs(coarse - fine).max(axis=1) + 1e-6).all()


def mixed(order, *, among=0):
    """State of light and full cars after some bends, of each by its number; `among` others stand in between."""
    found = [catalogue.find_vehicle(name) for name in MODELS]
    starts = [(i, Start(found[i % len(found)], 0.0, 0.0, 0.1 * i, 10.0 + i, i % 2 == 0)) for i in range(12)]
    others = [(-1, Start(found[0], 5.0, 0.0, 0.0, 7.0, i % 3 == 0)) for i in range(among)]
    placed = [each for i in order for each in (*others, starts[i])]
    made = fleet.fleet([start for _, start in placed])
    numbers = np.array([number for number, _ in placed])
    made.commands[U_STEER] = np.tile(0.002 * numbers, RING)
    for k in range(100):
        fleet.advance(made, k, TICK, 0.005)
    return {number: made.state[:, column].tobytes() for column, number in enumerate(numbers) if number >= 0}


def test_the_same_bits_in_any_company():
    alone = {number: state for i in range(12) for number, state in mixed([i]).items()}
    assert mixed(range(12)) == mixed(reversed(range(12))) == mixed(range(12), among=3) == alone


def test_what_is_not_finite_is_named_and_stays_as_it_was():
    ground = light(["bmw_320i", "suv"], speed=10.0).run(0.1)
    before = ground.state.copy()
    ground.parameter[TAU_STEER, 1] = np.nan
    ground.run(TICK)
    assert broken.columns(ground.fleet).tolist() == [1]
    assert (ground.state[:, 1] == before[:, 1]).all() and (ground.state[:, 0] != before[:, 0]).any()
    assert broken.first(ground.fleet, 1, k=ground.k - 1, tick=TICK, step=0.005) == ("steering", TICK)
    assert len(before) == len(VEHICLE)
