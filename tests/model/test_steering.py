"""Steering: Ackermann geometry, the rack under torque and under an angle."""

from math import atan2, exp, hypot, tan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model import steering

L, TRACK, DT = 2.6, 1.4, 0.005


def angle(delta, y):
    c, s = steering.wheel_direction(delta, L, y)
    return atan2(s, c)


@given(st.floats(-0.9, 0.9).filter(lambda delta: abs(delta) > 1e-3))
def test_ackermann_points_at_one_centre(delta):
    """Both front wheels and the rear axle turn about one point: cot(right) - cot(left) = track/wheelbase, the mean on delta."""
    left, right = angle(delta, TRACK / 2), angle(delta, -TRACK / 2)
    assert 1 / tan(right) - 1 / tan(left) == pytest.approx(TRACK / L, rel=1e-6)
    assert 1 / tan(right) + 1 / tan(left) == pytest.approx(2 / tan(delta), rel=1e-6)


@given(st.floats(-0.9, 0.9))
def test_a_direction_has_unit_length_and_left_mirrors_right(delta):
    c, s = steering.wheel_direction(delta, L, TRACK / 2)
    assert hypot(c, s) == pytest.approx(1.0, abs=1e-12)
    assert steering.wheel_direction(-delta, L, -TRACK / 2) == pytest.approx((c, -s), abs=1e-12)


def test_straight_is_straight():
    assert steering.wheel_direction(0.0, L, TRACK / 2) == (1.0, 0.0)


def test_a_side_force_behind_the_kingpin_turns_the_wheel_back():
    """A wheel at a positive steer angle is pushed to the left; trail and aligning torque both turn it right."""
    assert steering.kingpin_moment(-30.0, 2000.0, 0.02) == pytest.approx(-70.0)


def by_torque(T, M_align, seconds, *, ratio=16.0, J=0.04, d=0.5, unassisted=0.4, dt=1e-4, rate=0.0):
    delta = 0.0
    for _ in range(round(seconds / dt)):
        delta, rate = steering.by_torque(delta, rate, T, M_align, ratio, J, d, unassisted, dt)
    return delta, rate


def test_a_torque_turns_the_wheel_until_damping_balances_it():
    """d ddelta_s/dt = T, delta_s = i_s delta; the way there is 1 - exp(-d t/J)."""
    T, J, d, ratio = 2.0, 0.04, 0.5, 16.0
    assert by_torque(T, 0.0, 2.0)[1] == pytest.approx(T / d / ratio)
    assert by_torque(T, 0.0, J / d)[1] == pytest.approx(T / d / ratio * (1.0 - exp(-1.0)), rel=1e-2)


def test_a_hand_that_holds_carries_the_unassisted_part():
    """T = -c M_align/i_s keeps the wheel where it is."""
    assert by_torque(0.4 * 70.0 / 16.0, -70.0, 1.0) == pytest.approx((0.0, 0.0), abs=1e-15)
    assert by_torque(0.0, -70.0, 0.1)[0] < 0.0


def test_left_alone_it_comes_to_rest():
    J, d = 0.04, 0.5
    delta, rate = by_torque(0.0, 0.0, 3 * J / d, rate=0.2)
    assert rate == pytest.approx(0.2 * exp(-3.0), rel=1e-2)
    assert delta == pytest.approx(0.2 * J / d * (1.0 - exp(-3.0)), rel=1e-2)


def test_an_angle_is_reached_within_rate_and_lag():
    delta, rate = steering.by_angle(0.0, 1.0, 0.06, 0.5, DT)
    assert (delta, rate) == pytest.approx((0.5 * DT, 0.5))  # as fast as it can
    for _ in range(1000):
        delta, rate = steering.by_angle(delta, 1.0, 0.06, 0.5, DT)
    assert (delta, rate) == pytest.approx((1.0, 0.0), abs=1e-9)
