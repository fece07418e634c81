"""Spring, damper, anti-roll bar, links and the vertical tyre: the laws of one corner."""

import itertools
from math import exp, log, pi, sqrt

import pytest

from studio.model import suspension

k, d, k_a, F_0 = 25_000.0, 1500.0, 6000.0, 3000.0
k_t, m_u, R = 200_000.0, 40.0, 0.3


def test_at_the_static_position_the_spring_carries_the_static_load():
    assert suspension.spring_force(F_0, k, d, k_a, 0.0, 0.0, 0.0) == F_0


def test_springs_and_dampers_push_a_compressed_corner_up():
    assert suspension.spring_force(F_0, k, d, 0.0, 0.02, 0.0, 0.0) == pytest.approx(F_0 + 500.0)
    assert suspension.spring_force(F_0, k, d, 0.0, 0.0, 0.1, 0.0) == pytest.approx(F_0 + 150.0)


def test_a_bar_works_on_the_difference_only():
    """Heave leaves it alone; roll by phi at a track T has the moment k_a T² phi = its stiffness in Nm/rad times phi."""
    T, phi = 1.4, 0.02
    left, right = (suspension.spring_force(0.0, 0.0, 0.0, k_a, x, 0.0, -x) for x in (-phi * T / 2, phi * T / 2))
    assert suspension.spring_force(F_0, k, d, k_a, 0.02, 0.0, 0.02) == suspension.spring_force(F_0, k, d, 0.0, 0.02, 0.0, 0.02)
    assert (right - left) * T / 2 == pytest.approx(k_a * T**2 * phi)


def test_links_carry_what_acts_below_the_roll_centre():
    """The links of an axle have the moment h_l F_y about the vehicle's axis, against the roll, and lift nothing themselves."""
    T, h, F_y = 1.4, 0.12, 2500.0
    left, right = (suspension.link_force(side, F_y, 2.0 * h / T) for side in (1.0, -1.0))
    assert (left - right) * T / 2 == pytest.approx(-h * 2.0 * F_y)  # about x, which a force to the left at the road rolls by +
    assert left + right == 0.0


def test_a_tyre_is_a_spring_that_only_pushes():
    assert suspension.tyre_load(F_0, k_t, 0.0, R, R, 0.0) == F_0
    assert suspension.tyre_load(F_0, k_t, 0.0, R, R - 0.01, 0.0) == pytest.approx(F_0 + 2000.0)
    assert suspension.tyre_load(F_0, k_t, 100.0, R, R, -0.5) == pytest.approx(F_0 + 50.0)  # it sinks in
    assert suspension.tyre_load(F_0, k_t, 0.0, R, R + F_0 / k_t, 0.0) == 0.0
    assert suspension.tyre_load(F_0, k_t, 0.0, R, R + 0.1, 0.0) == 0.0  # off the ground


def hopping(damping, dt, seconds):
    """A wheel between a body that stands still and the road: travel at every step, from 1 cm on."""
    x, rate, seen = 0.01, 0.0, []
    for _ in range(round(seconds / dt)):
        force = -(k + k_t) * x - damping * rate
        rate = suspension.travel_rate(rate, force, 0.0, m_u, damping, dt)
        x += dt * rate
        seen.append(x)
    return seen


def test_a_wheel_hops_at_its_natural_frequency_and_decays_by_its_damping_ratio():
    """w² = (k + k_t)/m_u, D = d/(2 sqrt((k + k_t) m_u)) (Massow & Radusch 2018, Eq. 5); log decrement 2 pi D/sqrt(1 - D²)."""
    dt = 2e-5
    seen = hopping(d, dt, 0.5)
    w, D = sqrt((k + k_t) / m_u), d / (2.0 * sqrt((k + k_t) * m_u))
    peaks = [i for i in range(1, len(seen) - 1) if seen[i - 1] < seen[i] >= seen[i + 1]]
    assert (peaks[1] - peaks[0]) * dt == pytest.approx(2.0 * pi / (w * sqrt(1.0 - D * D)), rel=2e-3)
    assert log(seen[peaks[0]] / seen[peaks[1]]) == pytest.approx(2.0 * pi * D / sqrt(1.0 - D * D), rel=5e-3)


def test_no_damping_is_too_much_for_a_step():
    """Overdamped a hundredfold the wheel creeps back, exp(-k t/d), and neither swings nor explodes at 5 ms."""
    damping = 200.0 * sqrt((k + k_t) * m_u)
    seen = hopping(damping, 0.005, 5.0)
    assert all(0.0 < after <= before for before, after in itertools.pairwise(seen))
    assert seen[-1] == pytest.approx(0.01 * exp(-(k + k_t) / damping * 5.0), rel=0.01)


def test_a_wheel_stays_where_the_body_leaves_it():
    """Inertia: without force a wheel keeps its place in the world, so its travel accelerates against the body's."""
    assert suspension.travel_rate(0.0, 0.0, 2.0, m_u, 0.0, 0.005) == pytest.approx(-0.01)
