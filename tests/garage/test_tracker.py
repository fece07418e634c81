"""A car along its way: closed forms of what it does."""

from math import atan, cos, exp, pi, sin

import numpy as np
import pytest

from studio.garage import tracker, way
from studio.garage.plan import SIXTY, Pose
from studio.garage.way import Car

COMPACT = Car(2.765, 4.261, 1.809, 0.84, 4.6)


def test_a_circle_is_reckoned():
    """2 m/s and 0.5 rad/s for a full turn come back to the start, within what a step of 20 ms cuts off."""
    at, dt = Pose(1.0, 2.0, 0.3), 0.02
    for _ in range(round(2.0 * pi / 0.5 / dt)):
        at = tracker.reckoned(at, 2.0, 0.5, dt)
    assert (at.x, at.y) == pytest.approx((1.0, 2.0), abs=0.02)


def test_the_first_fixes_are_averaged_then_a_share_is_taken():
    at = Pose(0.0, 0.0, 0.0)
    for n, x in enumerate((1.0, 3.0, 2.0)):
        at = tracker.fixed(at, Pose(x, 0.0, 0.0), 0.0, float(n))
    assert at.x == pytest.approx(2.0)
    assert tracker.fixed(at, Pose(3.0, 0.0, 0.0), 0.0, 1e3).x == pytest.approx(2.0 + tracker.GAIN)


@pytest.mark.parametrize("g", [1.0, -1.0])
def test_both_errors_fade_forward_and_backward(g):
    """e = (1 + w s) exp(-w s) e0 for a kinematic car beside a straight, either way."""
    line = np.linspace(0.0, g * 12.0, 241)
    straight = way.Way(line, 0.0 * line, 0.0 * line, 0.0 * line, 0.0 * line + g, np.abs(line), line)
    e0, step, at = 0.1, 0.01, Pose(0.0, 0.1, 0.0)
    for i in range(1, 501):
        k = round(abs(at.x) / 0.05)
        angle = tracker.wheels(straight, k, at, 0.0, 2.765)
        at = Pose(at.x + g * step * cos(at.heading), at.y + g * step * sin(at.heading), at.heading + g * step * np.tan(angle) / 2.765)
        s = i * step * tracker.OMEGA
        assert at.y == pytest.approx((1.0 + s) * exp(-s) * e0, abs=0.004)


def test_it_comes_to_a_stand_at_every_end():
    """The speed falls as v² = 2 a s to each, and is never more than the turn's or the aisle's."""
    found, v, last = tracker.profile(SIXTY, 7, COMPACT, False, 2.5)
    ends = np.unique(last)
    assert np.all(v[ends] == 0.0) and v.max() == 2.5
    assert np.all(v <= np.sqrt(2.0 * tracker.DECELERATION * (found.driven[last] - found.driven)) + 1e-9)
    assert v[found.direction < 0.0].max() == tracker.TURNING


def test_it_stops_before_somebody_on_its_way():
    found, _, last = tracker.profile(SIXTY, 7, COMPACT, False, 2.5)
    k = 100
    front = found.x[k] + COMPACT.wheelbase + COMPACT.front
    free = tracker.before_persons(found, k, int(last[k]), COMPACT, [(float(front) + 3.0, -8.0)], 1.0)
    assert free == pytest.approx(3.0 - (COMPACT.width / 2.0 + 0.8) - 1.0, abs=0.3)
    assert tracker.before_persons(found, k, int(last[k]), COMPACT, [(float(front) + 3.0, -12.5)], 1.0) == 1e3


def test_pointing_along_a_bend():
    found = way.into(SIXTY, 40, COMPACT)
    k = int(np.argmax(found.bend > 0.1))
    at = Pose(float(found.x[k + 40]), float(found.y[k + 40]), float(found.heading[k + 40]))
    assert tracker.wheels(found, k + 40, at, 2.0, 2.765) == pytest.approx(atan(2.765 / 8.0), abs=1e-3)
