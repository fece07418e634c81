"""The rigid body: rotations against another library's, Euler's equations against their invariants and a closed form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from studio.model import body

parts = st.floats(-1, 1)
vectors = st.tuples(*[st.floats(-10, 10)] * 3)
four = st.tuples(*[parts] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)
quaternions = four.map(lambda q: np.array(q) / np.linalg.norm(q))


def of_scipy(q) -> Rotation:
    """scipy puts the scalar last."""
    return Rotation.from_quat([q[1], q[2], q[3], q[0]])


@given(quaternions, vectors)
def test_rotations_are_those_of_scipy(q, x):
    R = body.rotation(*q)
    assert np.array(R).reshape(3, 3) == pytest.approx(of_scipy(q).as_matrix(), abs=1e-12)
    assert body.to_world(R, *x) == pytest.approx(of_scipy(q).apply(x), abs=1e-9)
    assert body.to_body(R, *body.to_world(R, *x)) == pytest.approx(x, abs=1e-9)


@given(vectors, vectors)
def test_cross_product(a, b):
    assert body.cross(*a, *b) == pytest.approx(np.cross(a, b), abs=1e-9)


def turned(q, rates, dt, steps):
    for _ in range(steps):
        q = body.turned(*q, *rates, dt)
    return q


def test_constant_rates_turn_about_their_axis():
    """rotvec = rates t, rates in the body's axes; the error is of second order: half the step, a quarter of it."""
    rates, start = np.array([0.3, -0.5, 0.8]), of_scipy([0.8, 0.1, 0.5, 0.3])
    q = start.as_quat()[[3, 0, 1, 2]]
    exact = start * Rotation.from_rotvec(rates)  # after 1 s
    errors = [(of_scipy(turned(q, rates, dt, round(1.0 / dt))) * exact.inv()).magnitude() for dt in (0.01, 0.005)]
    assert errors[0] < 1e-5 and errors[0] / errors[1] == pytest.approx(4.0, rel=0.01)


@given(quaternions, vectors)
def test_orientation_keeps_unit_length(q, rates):
    assert np.linalg.norm(body.turned(*q, *rates, 0.005)) == pytest.approx(1.0, abs=1e-14)


@given(vectors)
def test_without_moments_energy_and_angular_momentum_stay(rates):
    """d(w J w)/dt = 2 w J dw/dt = 0 and d|J w|²/dt = 2 J w · J dw/dt = 0."""
    J, w = np.array([240.0, 1500.0, 1800.0]), np.array(rates)
    dw = np.array(body.angular_acceleration(0.0, 0.0, 0.0, *w, *J))
    assert w @ (J * dw) == pytest.approx(0.0, abs=1e-7)
    assert (J * w) @ (J * dw) == pytest.approx(0.0, abs=1e-4)


def test_a_moment_turns_a_body_at_rest():
    assert body.angular_acceleration(24.0, 15.0, 9.0, 0.0, 0.0, 0.0, 240.0, 1500.0, 1800.0) == pytest.approx((0.1, 0.01, 0.005))


def test_a_symmetric_top_precesses():
    """Free, J_x = J_y: p + i q turns with (J_z - J_x)/J_x r (Schiehlen & Eberhard, chapter 3)."""
    J_x, J_z, r, dt = 2.0, 3.0, 4.0, 1e-4
    p, q = 0.1, 0.0
    for _ in range(10_000):
        dp, _, dr = body.angular_acceleration(0.0, 0.0, 0.0, p, q, r, J_x, J_x, J_z)
        p += dt * dp
        q += dt * body.angular_acceleration(0.0, 0.0, 0.0, p, q, r, J_x, J_x, J_z)[1]
    angle = (J_z - J_x) / J_x * r * 1.0
    assert dr == 0.0
    assert (p, q) == pytest.approx((0.1 * np.cos(angle), 0.1 * np.sin(angle)), abs=1e-4)
