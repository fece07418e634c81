"""Braking: hydraulics, load transfer, distances, locked wheels, and a road that grips on one side only."""

import numpy as np
import pytest

from studio.conventions import GRAVITY
from studio.model import tyre
from studio.vehicle import fleet
from studio.vehicle.command import RING, U_BRAKE
from studio.vehicle.contact import MU
from studio.vehicle.parameter import (
    BRAKE_MAX,
    BRAKE_SHARE,
    C_D,
    DELAY_BRAKE,
    J_WF,
    J_WR,
    K_BRAKE,
    L_F,
    L_R,
    MASS,
    MASS_S,
    RADIUS,
    TAU_BRAKE,
    H,
)  # fmt: skip
from studio.vehicle.state import (
    A_X,
    F_X,
    F_Z,
    KAPPA,
    OMEGA,
    PITCH,
    PRESSURE_F,
    PRESSURE_R,
    PSI,
    TORQUE_BRAKE,
    V_X,
    V_Y,
    YAW_RATE,
    X,
)  # fmt: skip
from tests.proving_ground import MODELS, Ground, heavier

# --- hydraulics ----------------------------------------------------------------------------------------------------------


def test_pressure_rises_after_its_dead_time_by_its_lag():
    """P = b (1 - exp(-(t - t_d)/tau)): a step of half the greatest torque at t = 0."""
    ground = Ground(MODELS, speed=20.0, tick=0.005)
    p = ground.parameter
    ground.fleet.commands[U_BRAKE] = 0.0

    def step_now(each):
        slot = each.k % RING * each.n
        each.fleet.commands[U_BRAKE, slot : slot + each.n] = 0.5 * p[BRAKE_MAX]

    torque = ground.history(1.0, lambda each: each.state[TORQUE_BRAKE].copy(), step_now)
    times = 0.005 * (1 + np.arange(len(torque)))
    for v, name in enumerate(MODELS):
        t = np.maximum(times - p[DELAY_BRAKE, v], 0.0)
        expected = 0.5 * p[BRAKE_MAX, v] * (1 - np.exp(-t / p[TAU_BRAKE, v]))
        assert torque[:, v] == pytest.approx(expected, abs=0.02 * p[BRAKE_MAX, v]), name
        assert (torque[times < p[DELAY_BRAKE, v] + 1e-9, v] == 0.0).all(), name
    assert ground.state[PRESSURE_F] == pytest.approx(ground.state[PRESSURE_R])
    assert ground.state[PRESSURE_F] * p[K_BRAKE] == pytest.approx(torque[-1])


def test_the_axles_share_the_torque():
    """A braked wheel on rollers: F_x R = T_b share/2 - J domega/dt, exactly; the steps of one tick at a time."""
    ground = Ground(MODELS, speed=20.0, resistances=False, tick=0.005)
    p = ground.parameter
    ground.command(applied_brake=0.2 * p[MASS] * GRAVITY * p[RADIUS]).run(1.0)
    before = ground.wheels[OMEGA].reshape(4, -1).copy()
    ground.run(0.005)
    spin = (ground.wheels[OMEGA].reshape(4, -1) - before) / 0.005
    share = np.array([p[BRAKE_SHARE], p[BRAKE_SHARE], 1 - p[BRAKE_SHARE], 1 - p[BRAKE_SHARE]])
    inertia = np.array([p[J_WF], p[J_WF], p[J_WR], p[J_WR]])
    balance = -0.5 * share * ground.state[TORQUE_BRAKE] - inertia * spin
    assert ground.wheels[F_X].reshape(4, -1) * p[RADIUS] == pytest.approx(balance, rel=1e-9)


# --- deceleration and loads ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("u", [1.0, 2.0, 4.0])
def test_wheels_take_their_share_of_the_torque(u):
    """Torque m R u gives u m/(m + sum J/R²); what slip takes is small. All vehicles."""
    ground = Ground(MODELS, speed=25.0, resistances=False)
    p = ground.parameter
    ground.command(applied_brake=u * p[MASS] * p[RADIUS]).run(1.0)
    before = ground.state[V_X].copy()
    ground.run(1.0)
    assert before - ground.state[V_X] == pytest.approx(u * p[MASS] / heavier(p), rel=2e-3)


@pytest.mark.parametrize("u", [0.5, 3.0])
def test_load_transfer_to_the_front(u):
    """dF_front L = m a h + sum J a/R + g theta (m h - m_s R): inertia, the wheels' own, and the body that pitches by theta.

    Within 0.2 % at 0.5 m/s², and 1 % at 3 m/s², where the front sinks and the lever with it.
    """
    rolling, ground = (Ground(MODELS, speed=25.0, resistances=False) for _ in range(2))
    p = ground.parameter
    rolling.run(4.0)
    ground.command(applied_brake=u * p[MASS] * p[RADIUS]).run(4.0)
    a, theta = -ground.state[A_X], ground.state[PITCH] - rolling.state[PITCH]
    inertia = p[MASS] * a * p[H] + 2.0 * (p[J_WF] + p[J_WR]) * a / p[RADIUS]
    shift = GRAVITY * theta * (p[MASS] * p[H] - p[MASS_S] * p[RADIUS])
    front = (ground.wheels[F_Z] - rolling.wheels[F_Z]).reshape(4, -1)[:2].sum(axis=0)
    assert (theta > 0).all()
    assert front * (p[L_F] + p[L_R]) == pytest.approx(inertia + shift, rel=2e-3 if u < 1 else 1e-2)


def test_stopping_distance_at_a_constant_torque():
    """v²/(2 a), from 27.78 m/s, within what building up slip and pitch takes."""
    ground = Ground(MODELS, speed=27.78, resistances=False)
    p = ground.parameter
    ground.command(applied_brake=4.0 * heavier(p) * p[RADIUS]).run(14.0)
    assert ground.state[V_X] == pytest.approx(0.0, abs=1e-3)
    assert ground.state[X] == pytest.approx(27.78**2 / 8.0, rel=5e-3)


@pytest.mark.parametrize(("kmh", "mu", "distance"), [(100, 0.85, 46.27), (50, 0.85, 11.57), (100, 0.3, 131.1)])
def test_stopping_distance_by_the_book(kmh, mu, distance):
    """v²/(2 mu g), within what building up slip and pitch takes."""
    ground = Ground(MODELS, speed=kmh / 3.6, resistances=False, friction=2.0)  # no tyre is at its limit
    p = ground.parameter
    ground.command(applied_brake=mu * GRAVITY * heavier(p) * p[RADIUS]).run(14.0)
    assert ground.state[X] == pytest.approx(distance, abs=0.05 + 2e-3 * distance)


def test_stopping_distance_with_a_ramp():
    """Full at 0.3 s: 50.40 m from 100 km/h with 0.85 g."""
    ground = Ground(MODELS, speed=100 / 3.6, resistances=False, friction=2.0, step=0.001, tick=0.001)
    full = 0.85 * GRAVITY * heavier(ground.parameter) * ground.parameter[RADIUS]
    for k in range(300):
        ground.command(applied_brake=full * (k + 0.5) / 300).run(0.001)
    ground.command(applied_brake=full).run(5.0)
    assert ground.state[X] == pytest.approx(50.40, rel=5e-3)


# --- the limit of the tyres ------------------------------------------------------------------------------------------------


def peaks(t, mu) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Loads [N], and slip and force [N] of the peak of a straight-running tyre that brakes under them."""
    loads, slips = np.linspace(0.1, 2.5, 25) * t.FNOMIN, -np.linspace(0.01, 0.4, 196)
    forces = np.array([[tyre.longitudinal_pure(t, slip, 0.0, F_z, mu) for slip in slips] for F_z in loads])
    return loads, slips[forces.argmin(axis=1)], -forces.min(axis=1)


@pytest.mark.parametrize("friction", [1.0, 0.3])
@pytest.mark.parametrize("model", ["bmw_320i", "smart_fortwo", "truck"])
def test_shortest_stopping_distance(model, friction):
    """(v0² - v²)/(2 mu g), mu from the peaks of the tyres at the loads they have, each axle held there by a slip controller.

    Within 1 % at 1 ms, measured after the half second in which slip builds up.
    """
    ground = Ground(model, speed=18.0, resistances=False, friction=friction, step=0.001, tick=0.001)
    p, tables = ground.p, [peaks(t, friction) for t in fleet.tyres_of(ground.models[0])]
    held = []

    def regulate(each):
        F_z, slip = each.wheel(F_Z)[[0, 2]], each.wheel(KAPPA)[[0, 2]]
        best = np.array([[np.interp(F, loads, row) for row in rows] for F, (loads, *rows) in zip(F_z, tables, strict=True)])
        torques = 2.0 * p[RADIUS] * best[:, 1] * np.clip(2.0 - slip / best[:, 0], 0.0, 1.5)  # less when it slips more
        each.parameter[BRAKE_SHARE] = torques[0] / torques.sum()
        each.command(applied_brake=torques.sum())
        held.append(2.0 * best[:, 1].sum())

    ground.run(0.5, regulate)
    begin, v0, held[:] = ground[X], ground[V_X], []
    while ground[V_X] > 5.0:
        ground.run(0.02, regulate)
    expected = (v0**2 - ground[V_X] ** 2) / (2.0 * np.mean(held) / p[MASS])
    assert ground[X] - begin == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("step", [0.001, 0.005])
def test_no_tyre_gives_more_than_its_peak(step):
    """Brakes that close ever more until the wheels lock: F_x/F_z of the BMW's tyre reaches PDX1 and never passes it."""
    ground = Ground("bmw_320i", speed=30.0, resistances=False, step=step, tick=step)
    t, p = fleet.tyres_of(ground.models[0])[0], ground.p

    def close(each):
        each.command(applied_brake=0.8 * p[MASS] * GRAVITY * p[RADIUS] + 2500.0 * each.time)

    share = ground.history(1.6, lambda each: (each.wheel(F_X) / each.wheel(F_Z)).copy(), close)
    assert (ground.wheels[OMEGA] == 0.0).all()
    assert -share.min() / t.PDX1 == pytest.approx(1.0, abs=1e-6)


def locked(models, *, friction, speed=20.0):
    ground = Ground(models, speed=speed, friction=friction)
    ground.parameter[C_D] = 0.0
    return ground.command(applied_brake=1e6)


@pytest.mark.parametrize("friction", [1.0, 0.1])
def test_locked_wheels_slide(friction):
    """All wheels locked: m a = sum of the tyres' forces at slip -1 at the loads they have, on the road and on ice."""
    ground = locked(MODELS, friction=friction).run(1.2)
    assert (ground.wheels[OMEGA] == 0.0).all()
    for v, model in enumerate(ground.models):
        front, rear = fleet.tyres_of(model)
        F_z = ground.wheel(F_Z, v)
        loads = zip((front, front, rear, rear), F_z, strict=True)
        sliding = sum(tyre.longitudinal_pure(t, -1.0, 0.0, load, friction) for t, load in loads)
        assert ground.state[A_X, v] == pytest.approx(sliding / ground.parameter[MASS, v], rel=0.01), MODELS[v]


def test_ice_takes_ten_times_the_way():
    """A tenth of the friction, from 10 m/s with locked wheels: at least ten times the way, straight ahead, and then at rest.

    More than ten times, because beyond its peak a Magic Formula of little friction falls further until the wheel locks.
    """
    road, ice = (locked(MODELS, friction=friction, speed=10.0).run(40.0) for friction in (1.0, 0.1))
    for ground in (road, ice):
        assert np.abs(ground.state[[V_X, V_Y, YAW_RATE]]) == pytest.approx(0.0, abs=1e-6)
        assert np.abs(ground.state[PSI]) == pytest.approx(0.0, abs=1e-9)
    assert (ice.state[X] > 10.0 * road.state[X]).all()


@pytest.mark.parametrize("model", MODELS)
def test_a_car_turns_to_the_side_that_grips(model):
    """Ice under the right wheels: braking yaws to the left, and the left wheels carry nearly all of the force."""
    ground = Ground(model, speed=20.0)
    for corner in (1, 3):
        ground.put(MU, corner, 0.1)
    ground.command(applied_brake=0.6 * ground.p[MASS] * GRAVITY * ground.p[RADIUS]).run(0.5)
    assert ground[YAW_RATE] > 0.02 and ground[PSI] > 0.0
    F_x = ground.wheel(F_X)
    assert F_x[[0, 2]].sum() < 4.0 * F_x[[1, 3]].sum() < 0.0
    mirrored = Ground(model, speed=20.0)
    for corner in (0, 2):
        mirrored.put(MU, corner, 0.1)
    mirrored.command(applied_brake=0.6 * ground.p[MASS] * GRAVITY * ground.p[RADIUS]).run(0.5)
    assert mirrored[YAW_RATE] == pytest.approx(-ground[YAW_RATE], rel=1e-6)
