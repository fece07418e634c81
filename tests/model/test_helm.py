"""How a driver steers: the way back against its closed form, and what is never asked of a car."""

from math import acos, asin, cos, exp, isfinite, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.kind.driver import Sees
from studio.model import helm

K, C = 0.1, 0.01  # [1/m] tail and arc
FIRST = asin(C / K)  # [rad] course where both meet
CAR = Sees(rolling=10.0, compliance=0.005, understeer=0.001, steering_max=0.6)
cars = st.builds(
    Sees, rolling=st.floats(-15, 60), yaw_rate=st.floats(-1, 1), offset=st.floats(-50, 50), heading=st.floats(-7, 7),
    curvature=st.floats(-0.2, 0.2), compliance=st.floats(0.001, 0.02), steering_max=st.floats(0.3, 1.1), steering_rate=st.floats(0.1, 1),
    wheelbase=st.floats(1.5, 7), understeer=st.floats(-0.001, 0.01), sideways=st.floats(-5, 5),
)  # fmt: skip


def steered(car, **changes):
    return helm.path_steering(car._replace(**changes), 2.0, 0.1)


def driven(e, step=0.01):
    """Offsets and courses of a point that follows the way back from an offset, a sample every `step` metres."""
    found = []
    while abs(e) > 0.01:
        chi = helm.way_back(e, K, C)[0]
        found.append((e, chi))
        e += step * sin(chi)
    return np.array(found).T


def test_the_way_back_is_an_arc_and_a_tail():
    """From 6 m: a circle of curvature C down to the course asin(C/K); then e falls as exp(-K s), for small angles."""
    e, chi = driven(6.0)
    bends = np.gradient(chi) / 0.01
    arc = e > FIRST / K + 0.05
    assert bends[arc][1:] == pytest.approx(C, rel=0.01)
    assert np.cos(chi[0]) == pytest.approx(cos(FIRST) - C * (6.0 - FIRST / K), abs=1e-12)
    tail = e[~arc]
    assert tail[500] / tail[0] == pytest.approx(exp(-K * 5.0), rel=0.01)


def test_the_two_parts_meet():
    """Course and its slope are the same on both sides, and the feed-forward of the arc sets in without a jump."""
    place, small = FIRST / K, 1e-6
    inner, at, outer = (helm.way_back(place + d, K, C) for d in (-small, 0.0, small))
    assert (outer[0] - at[0]) / small == pytest.approx((at[0] - inner[0]) / small, rel=1e-3)
    assert outer[1] == pytest.approx(inner[1], abs=1e-6)
    assert helm.way_back(2.5 * place, K, C) == pytest.approx((-acos(cos(FIRST) - C * 1.5 * place), C))


@pytest.mark.parametrize("speed", [5.0, 10.0, 20.0, 40.0])
def test_the_arc_is_bounded_by_acceleration_and_by_the_wheels(speed):
    k = helm.tail(speed, 2.0, 0.005)
    c = helm.arc(speed, k, 2.7, 0.4, 0.6)
    assert c * speed**2 <= helm.ARC * (1 + 1e-9)
    assert 2.7 * c * k * speed <= helm.HAND * 0.4 * (1 + 1e-9)  # the wheels turn by L c while an offset is driven off over 1/k


@given(v=st.floats(0.1, 60), compliance=st.floats(0.001, 0.02))
def test_the_tail_is_damped(v, compliance):
    """T e'' + e' + k v e = 0 has the damping 1/(2 sqrt(k v T)), at least 0.7."""
    T = compliance * v / helm.quickened(v, compliance)
    assert 0.5 / (helm.tail(v, 2.0, compliance) * v * T) ** 0.5 > 0.7


@given(car=cars)
def test_left_and_right_are_alike(car):
    mirrored = car._replace(
        yaw_rate=-car.yaw_rate, offset=-car.offset, heading=-car.heading, curvature=-car.curvature, sideways=-car.sideways
    )
    if abs(abs(helm.wrapped(car.heading)) - pi) > 1e-6:
        assert steered(mirrored) == pytest.approx(-steered(car), abs=1e-12)


@given(car=cars)
def test_what_is_asked_is_bounded(car):
    """Within the lock; forwards on a straight no steady bend beyond HARD. The same as machine code and as Python."""
    angle = steered(car)
    assert isfinite(angle) and abs(angle) <= car.steering_max
    assert helm.path_steering.py_func(car, 2.0, 0.1) == pytest.approx(angle, rel=1e-9, abs=1e-12)
    per_bend = car.wheelbase + max(car.understeer, 0.0) * car.rolling**2
    if car.rolling > 0.1:
        assert abs(steered(car, curvature=0.0)) / per_bend * car.rolling**2 <= helm.HARD * (1 + 1e-9)


def test_on_the_path_nothing_is_steered_and_beside_it_back():
    assert steered(CAR) == 0.0
    assert steered(CAR, offset=0.5) < 0.0 < steered(CAR, offset=-0.5)
    assert steered(CAR, rolling=-3.0) == 0.0
    assert steered(CAR, rolling=-3.0, offset=0.5) < 0.0  # backwards the nose goes to the left, so that the tail comes back to the right


def test_a_car_that_has_turned_once_around_is_where_it_was():
    assert steered(CAR, heading=2.0 * pi + 0.1) == pytest.approx(steered(CAR, heading=0.1))


def test_a_bend_gets_the_angle_of_the_steady_bend():
    """Front axle wide by L² kappa/8, along the path, turning as it does: L kappa, and the slip; on a line as much longer as it is wide."""
    kappa, v = 0.01, 10.0
    car = CAR._replace(curvature=kappa, offset=-helm.SWING * 2.7**2 * kappa, yaw_rate=v * kappa, heading=-2.7 * kappa, rolling=v)
    assert steered(car) == pytest.approx(2.7 * kappa + 0.005 * v * v * kappa, rel=1e-3)
