"""Standing: loads, heights and what a slope does to them, for every vehicle of the catalogue."""

import numpy as np
import pytest

from studio.conventions import GRAVITY
from studio.vehicle.parameter import (
    ARB_F,
    ARB_R,
    BRAKE_MAX,
    IDLE,
    K_BRAKE,
    L_F,
    L_R,
    LINK_F,
    LINK_R,
    M_UF,
    MASS,
    MASS_S,
    RADIUS,
    UNASSISTED,
    H,
)  # fmt: skip
from studio.vehicle.state import F_X, F_Y, F_Z, PITCH, PSI, TRAVEL, X, Y, Z
from tests.proving_ground import MODELS, Ground

SLOPE = 0.15


@pytest.fixture(scope="module")
def standing():
    """One of each, on the level."""
    return Ground(MODELS, speed=0.0).run(3.0)


@pytest.fixture(scope="module", params=[SLOPE, -SLOPE], ids=["uphill", "downhill"])
def braked_on_a_slope(request):
    """One of each, braked on a slope."""
    ground = Ground(MODELS, speed=0.0, slope=request.param)
    return ground.command(brake=0.8 * ground.parameter[BRAKE_MAX]).run(20.0), request.param


@pytest.mark.parametrize("v", range(len(MODELS)), ids=MODELS)
def test_static_loads(standing, v):
    """An axle carries its part of the sprung mass and its own wheels, (m_s l_r/L + m_uf) g at the front, halved per wheel.

    Static camber shortens a wheel a little and moves some newton between the axles.
    """
    body = standing.models[v].values.body
    m_s = body.mass - body.unsprung_mass_front - body.unsprung_mass_rear
    l_f, l_r = body.front_distance, body.wheelbase - body.front_distance
    front = 0.5 * (m_s * l_r / body.wheelbase + body.unsprung_mass_front) * GRAVITY
    rear = 0.5 * (m_s * l_f / body.wheelbase + body.unsprung_mass_rear) * GRAVITY
    F_z = standing.wheel(F_Z, v)
    assert F_z == pytest.approx([front, front, rear, rear], rel=1e-4)
    assert F_z.sum() == pytest.approx(body.mass * GRAVITY, rel=1e-5)


@pytest.mark.parametrize("v", range(len(MODELS)), ids=MODELS)
def test_a_vehicle_is_put_on_the_road_at_rest(standing, v):
    """It neither sinks nor jumps, rolls nor turns: the springs are at rest; static camber lifts by less than a mm."""
    s = standing.state[:, v]
    assert s[Z] == pytest.approx(standing.parameter[H, v], abs=1e-3)
    assert abs(s[X]) < 1e-3 and s[Y] == 0.0 and s[PSI] == 0.0
    assert standing.wheel(TRAVEL, v) == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("v", range(len(MODELS)), ids=MODELS)
def test_loads_on_a_slope(braked_on_a_slope, v):
    """Across the road m g cos, along it m g sin; m g sin h/L moves to the axle below.

    The body pitches against the road by theta, which moves the centre of gravity by h, and the springs that carry m_s by R,
    towards that axle: another g theta (m h - m_s R)/L.
    """
    ground, slope = braked_on_a_slope
    p, F_z = ground.parameter[:, v], ground.wheel(F_Z, v)
    sine, cosine, L = slope / np.hypot(1, slope), 1 / np.hypot(1, slope), p[L_F] + p[L_R]
    theta = ground.state[PITCH, v] + np.arctan(slope)  # nose down against the road
    assert F_z.sum() == pytest.approx(p[MASS] * GRAVITY * cosine, rel=1e-3)
    assert ground.wheel(F_X, v).sum() == pytest.approx(p[MASS] * GRAVITY * sine, rel=1e-2)
    front = (p[MASS_S] * p[L_R] / L + 2.0 * p[M_UF]) * GRAVITY * cosine
    moved = (-p[MASS] * GRAVITY * sine * p[H] + GRAVITY * theta * (p[MASS] * p[H] - p[MASS_S] * p[RADIUS])) / L
    assert F_z[:2].sum() - front == pytest.approx(moved, rel=0.02)


@pytest.mark.parametrize("v", range(len(MODELS)), ids=MODELS)
def test_parameters_say_what_the_file_says(standing, v):
    """What is not a plain copy: bars per travel, levers of the links, brake, steering, idle."""
    p, values = standing.parameter[:, v], standing.models[v].values
    s, b = values.suspension, values.body
    # a body that rolls by phi at a track T moves its wheels by phi T: bar [Nm/rad] = force per difference · T · T
    assert p[[ARB_F, ARB_R]] * [b.front_track**2, b.rear_track**2] == pytest.approx([s.anti_roll_front, s.anti_roll_rear])
    m_s = b.mass - b.unsprung_mass_front - b.unsprung_mass_rear
    share = 1.0 - b.front_distance / b.wheelbase
    for link, part, m_u, height, track in (
        (p[LINK_F], share, b.unsprung_mass_front, s.roll_centre_front, b.front_track),
        (p[LINK_R], 1.0 - share, b.unsprung_mass_rear, s.roll_centre_rear, b.rear_track),
    ):
        lever = (part * m_s * height + m_u * values.wheels.radius) / (part * m_s + m_u)
        assert link == pytest.approx(2.0 * lever / track)
    assert p[K_BRAKE] * values.brakes.pressure_max == pytest.approx(values.brakes.torque_max)
    assert p[UNASSISTED] == pytest.approx(1.0 - values.steering.assistance)
    assert p[IDLE] == (0.0 if values.engine.kind == "electric" else values.engine.idle_speed)


def test_left_and_right_carry_the_same(standing):
    F_z, F_y = standing.wheels[F_Z].reshape(2, 2, -1), standing.wheels[F_Y].reshape(2, 2, -1)
    assert F_z[:, 0].tobytes() == F_z[:, 1].tobytes()
    assert (F_y[:, 0] == -F_y[:, 1]).all()
