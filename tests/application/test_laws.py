"""The laws of following that come with the studio, each taken from its own file, against the figures of the literature (domain notes 1).

A law is linear in what it sees, so its gains are its differences:

    u = g_d d + g_r r + g_v v,    s V = A u,    d = (V_p - V)/s,    r = V_p - V
    V/V_p = A (g_d/s + g_r)/(s + A (g_d/s + g_r - g_v))

A is what turns a request into an acceleration: 1 of an ideal car, 1/(tau s + 1) of one with a lag.
"""

from functools import partial

import numpy as np
import pytest

from studio.application.contract import Own
from studio.assess.transfer import FREQUENCIES, actuated, delayed, laplace, least_headway, ploeg
from studio.kind.number import numbers, tuple_of
from studio.kinds.application import acc, cacc_leader, cacc_path
from studio.kinds.message.awareness import Payload
from studio.kinds.sensor.front_radar import Reading

IDEAL = np.ones(FREQUENCIES.size)


def given(module, **values):
    """Parameters as the application gets them."""
    return tuple_of(module, module.Parameters)(*numbers(module.Parameters(**values)))


def at(v=0.0):
    """The own bus at a speed."""
    return Own(v, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def gains(law):
    """g_d [1/s²], g_r [1/s] and g_v [1/s] of a law u(d, r, v)."""
    return law(1.0, 0.0, 0.0) - law(0.0, 0.0, 0.0), law(0.0, 1.0, 0.0) - law(0.0, 0.0, 0.0), law(0.0, 0.0, 1.0) - law(0.0, 0.0, 0.0)


def gain(law, A, frequency=FREQUENCIES):
    """|V/V_p| over frequency [Hz]."""
    g_d, g_r, g_v = gains(law)
    s = laplace(frequency)
    follows = A * (g_d / s + g_r)
    return np.abs(follows / (s + follows - A * g_v))


def rajamani(h, d, r, v):
    """acc with a headway [s]."""
    return acc.keep_gap.py_func(given(acc, headway=h), v, Reading(d, r, 0.0))


def path_alone(h, d, r, v):
    """cacc_path without a link."""
    return cacc_path.alone.py_func(given(cacc_path), h, d, r, at(v))


def path_linked(step, h, d, r, v):
    """cacc_path with a link, and with no gain on the change of the gap, as the formula has it."""
    return cacc_path.cooperative.py_func(given(cacc_path, k_d=0.0, step=step), h, d, r, at(v))


@pytest.mark.parametrize("tau", [0.2, 0.5, 0.8])
def test_acc_is_string_stable_from_twice_the_lag_on(tau):
    """R. Rajamani, Vehicle Dynamics and Control, 2012, section 6.6: h >= 2 tau."""
    assert least_headway(lambda h: gain(partial(rajamani, h), actuated(tau, 0.0))) == pytest.approx(2.0 * tau, abs=0.01)


@pytest.mark.parametrize(("headway", "expected"), [(0.3, 1.184), (1.2, 0.697)])
def test_gain_of_acc_in_a_swing(headway, expected):
    """0.2 Hz, a car with a lag of 0.5 s (check 9)."""
    (found,) = gain(partial(rajamani, headway), actuated(0.5, 0.0, [0.2]), [0.2])
    assert found == pytest.approx(expected, abs=0.01)


def test_acc_of_the_field_tests():
    """V. Milanés, S. E. Shladover 2014: stable from 2.66 s on; at 1.1 s, where people drove it, it amplifies by 1.59 (check 12)."""
    assert least_headway(lambda h: gain(partial(path_alone, h), IDEAL)) == pytest.approx(2.660, abs=0.01)
    assert gain(partial(path_alone, 1.1), IDEAL).max() == pytest.approx(1.590, abs=0.003)


@pytest.mark.parametrize(("step", "headway"), [(0.01, 0.211), (0.05, 0.471), (0.1, 0.667)])
def test_cacc_of_the_field_tests(step, headway):
    """sqrt(2 T_step/k_p), for k_d = 0 (check 13)."""
    assert least_headway(lambda h: gain(partial(path_linked, step, h), IDEAL)) == pytest.approx(headway, abs=0.01)


@pytest.mark.parametrize(("tau", "phi", "theta"), [(0.1, 0.2, 0.0778), (0.5, 0.0, 0.0688)])
def test_critical_delay_of_cacc(tau, phi, theta):
    """The delay at which the gain is just 1 at a headway of 0.5 s, to a tenth of a millisecond (check 6)."""
    low, high = 0.0, 0.3
    while high - low > 1e-5:
        middle = 0.5 * (low + high)
        grows = abs(ploeg(actuated(tau, phi), delayed(middle), 0.5)).max() > 1.0 + 1e-6
        low, high = (low, middle) if grows else (middle, high)
    assert high == pytest.approx(theta, abs=5e-4)


@pytest.mark.parametrize(("A", "expected"), [
    (IDEAL, 1.231), (actuated(0.1, 0.0), 1.251), (actuated(0.1, 0.2), 1.303), (actuated(0.5, 0.0), 1.386),
])  # fmt: skip
def test_a_constant_distance_behind_one_car_always_grows(A, expected):
    """No headway and nobody else heard: above 1 whatever the gains, 0.2 and 0.7 among them (check 18)."""
    assert abs(ploeg(A, 0.0, 0.0)).max() == pytest.approx(expected, abs=0.003)
    for k_p, k_d in ((0.05, 0.2), (0.2, 3.0), (1.0, 1.0), (2.0, 0.5)):
        assert abs(ploeg(A, 0.0, 0.0, k_p=k_p, k_d=k_d)).max() > 1.0


def test_with_the_leader_heard_errors_fade_from_car_to_car():
    """E_i/E_{i-1} = (a_1 s² - a_3 s - a_5)/(s² - (a_3 + a_4) s - a_5) = (s + 0.4)/(2 (s + 0.2)): 1, 0.528 at 1 rad/s, 0.5 (check 11)."""
    p, still = given(cacc_leader), Payload(0.0, 0.0, 0.0, 0.0, 0.0)

    def law(d=p.distance, r=0.0, v=0.0, ahead=0.0, leads=0.0):
        told = still._replace(intention=ahead), still._replace(speed=leads)
        return cacc_leader.together.py_func(p, at(v), d, r, *told)

    a_1, a_3, a_4, a_5 = law(ahead=1.0), -law(r=1.0), law(v=1.0), -law(d=p.distance + 1.0)
    assert law() == 0.0 and law(leads=1.0) == pytest.approx(-a_4)
    s = 1j * np.array([1e-6, 1.0, 1e6])
    found = np.abs((a_1 * s * s - a_3 * s - a_5) / (s * s - (a_3 + a_4) * s - a_5))
    assert found == pytest.approx([1.0, 0.528, 0.5], abs=1e-3)


@pytest.mark.parametrize(("headway", "expected"), [(0.5, 4905), (0.6, 4317), (1.1, 2699), (1.4, 2203)])
def test_how_many_cars_a_lane_carries(headway, expected):
    """3600 v/(v h + r + L) of a platoon in which acc asks for nothing, at 27.78 m/s with 2 m and cars of 4.5 m (check 20)."""
    v = 27.78
    gap = brought_to_rest(partial(keeping, headway), v)
    assert round(3600.0 * v / (gap + 4.5)) == expected


def keeping(headway, d, r, v):
    """acc with 2 m of standstill distance."""
    return acc.keep_gap.py_func(given(acc, headway=headway, standstill=2.0), v, Reading(d, r, 0.0))


def brought_to_rest(law, v):
    """The gap [m] at which a law asks for nothing at a steady speed: it is linear."""
    level, slope = law(0.0, 0.0, v), gains(law)[0]
    return -level / slope
