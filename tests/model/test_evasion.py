"""Ways around an obstacle: closed forms of the quintic, and the least distances of the literature's figures."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from studio.conventions import GRAVITY
from studio.model import evasion

CAR = {"W": 3.5, "beside": 3.5, "ahead": 2.25, "length": 4.5, "width": 1.8, "obstacle": 1.8, "a_y": 6.0, "b_B": 6.0}
CITY = {"W": 3.25, "beside": 3.25, "ahead": 1.5, "length": 4.3, "width": 1.75, "obstacle": 1.75, "a_y": 5.0, "b_B": 4.0}


def test_the_quintic():
    """Peaks: 5.052 m/s² at W = 3.5 m in 2 s; slope and bend are its derivatives."""
    u = np.linspace(0.0, 1.0, 20001)
    y, dy, ddy = (np.array([f(each) for each in u]) for f in (evasion.share, evasion.slope, evasion.bend))
    assert 3.5 / 4.0 * np.abs(ddy).max() == pytest.approx(5.052, rel=1e-3)
    np.testing.assert_allclose(np.gradient(y, u)[1:-1], dy[1:-1], atol=1e-6)
    np.testing.assert_allclose(np.gradient(dy, u)[1:-1], ddy[1:-1], atol=2e-3)
    assert evasion.change_time(3.5, 5.0518) == pytest.approx(2.0, rel=1e-4)
    jerk = np.gradient(ddy, u)[1:-1]
    assert 3.5 / 8.0 * np.abs(jerk).max() == pytest.approx(60.0 * 3.5 / 8.0, rel=5e-3)  # 60 W/T³


@pytest.mark.parametrize(("y", "u"), [(1.0, 0.3813), (1.8, 0.5076), (2.0, 0.5382), (2.5, 0.6187)])
def test_when_a_part_is_done(y, u):
    assert evasion.moment(y / 3.5) == pytest.approx(u, abs=1e-4)


@pytest.mark.parametrize(("kmh", "expected"), [(50, (24.34, 24.90, 26.29)), (70, (34.08, 34.86, 36.80)), (90, (43.82, 44.82, 47.32))])
def test_cooperative_distance_in_a_city(kmh, expected):
    """W 3.25 m, car 4.3 by 1.75 m, 1.5 m ahead, 5 and 4 m/s², 10, 50 and 150 ms."""
    found = [evasion.cooperative_distance(kmh / 3.6, latency, **CITY) for latency in (0.01, 0.05, 0.15)]
    assert found == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize(("kmh", "expected"), [(50, 16.29), (70, 22.80), (90, 29.32)])
def test_distance_with_nobody_beside(kmh, expected):
    """O1 of the checks: only the lag of the steering, 0.1 s, and 1.95 of 3.25 m of a quintic within 5 m/s², which takes 1.937 s."""
    T = evasion.change_time(3.25, 5.0)
    assert pytest.approx(1.9372, abs=1e-3) == T
    assert kmh / 3.6 * (evasion.STEERING_LAG + T * evasion.moment(1.95 / 3.25)) == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize(("kmh", "way"), [(5, 1.113), (10, 2.869), (20, 8.311)])
def test_the_way_to_stand_before_somebody_whom_only_the_deck_sees(kmh, way):
    """O14: 0.1 s until the next look, 0.25 s until it is given, 0.02 s by radio, 0.2 s until the brakes act, then 3 m/s²."""
    assert evasion.stopping_distance(kmh / 3.6, 3.0, 0.1 + 0.25 + 0.02 + 0.2, 0.0) == pytest.approx(way, rel=5e-3)


def test_stopping_distance():
    """100 km/h, 0.85 g: 46.27 m; with a ramp of 0.3 s 50.40 m; with a second before 74.05 m; 50 km/h 11.57 m; at 0.3 131.1 m."""
    assert evasion.stopping_distance(100 / 3.6, 0.85 * GRAVITY, 1.0, 0.0) == pytest.approx(74.05, rel=2e-3)
    assert evasion.stopping_distance(50 / 3.6, 0.85 * GRAVITY, 0.0, 0.0) == pytest.approx(11.57, rel=2e-3)
    assert evasion.stopping_distance(100 / 3.6, 0.3 * GRAVITY, 0.0, 0.0) == pytest.approx(131.1, rel=2e-3)
    a = 0.85 * GRAVITY
    assert evasion.stopping_distance(100 / 3.6, a, 0.0, 0.0) == pytest.approx(46.27, rel=2e-3)
    assert evasion.stopping_distance(100 / 3.6, a, 0.0, 0.3) == pytest.approx(50.40, rel=5e-3)


@pytest.mark.parametrize(("late", "way"), [(0.27, 53.76), (1.25, 80.98)])
def test_the_follower_of_who_evades_stands_before_the_obstacle(late, way):
    """100 km/h, 0.85 g: told by message, 0.27 s late, and by a person's eyes, 1.25 s late (O2 of the checks)."""
    assert evasion.stopping_distance(100 / 3.6, 0.85 * GRAVITY, late, 0.0) == pytest.approx(way, rel=0.01)


@pytest.mark.parametrize(("v", "way"), [(15.0, 9.979), (20.0, 13.554), (25.0, 17.079)])
def test_nothing_undercuts_the_friction_circle(v, way):
    """2 m aside while braking with what the tyre has left, mu 0.85: the least way of all lateral accelerations; the formula is above."""

    def needed(a_y):
        t = np.sqrt(2.0 * 2.0 / a_y)
        return v * t - 0.5 * evasion.left_over(0.85 * GRAVITY, a_y) * t * t

    bound = minimize_scalar(needed, bounds=(3.0, 0.85 * GRAVITY), method="bounded").fun
    assert bound == pytest.approx(way, rel=5e-3)
    assert evasion.cooperative_distance(v, 0.0, **CAR) > bound
