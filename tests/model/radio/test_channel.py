"""A shared channel: busy, waiting, speaking at once, congestion control; a cell that is too full."""

from math import pi

import numpy as np
import pytest

from studio.compiled import compiled
from studio.model.radio import arrival, cell, channel, congestion, packet
from studio.model.radio.congestion import OSCAR, VANETZA, Control, interval, level_of, sampled
from studio.model.random import uniform


@compiled
def waits(ratio, airtime, n):
    """n waits [s]."""
    return [channel.waiting(ratio, airtime, uniform(1, 1, 1, k), uniform(1, 1, 2, k)) for k in range(n)]


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.6])
def test_waiting_for_the_channel(ratio):
    """Mean AIFS + b (T/2 + 7.5 slots/(1 - b)) within four standard errors of 1e5 messages; never longer than is said."""
    airtime = packet.airtime(350.0, 2)
    found = np.array(waits(ratio, airtime, 100_000))
    mean = channel.AIFS + ratio * (0.5 * airtime + 7.5 * channel.SLOT / (1.0 - ratio))
    assert found.mean() == pytest.approx(mean, abs=4.0 * found.std() / 100_000**0.5 + 1e-15)
    assert found.min() >= channel.AIFS and found.max() <= channel.longest_wait(airtime)


def test_who_is_hidden():
    """None at the same place, all beyond twice the hearing distance; half a radius apart, as counted over 400 000 points."""
    assert channel.hidden(0.0, 500.0) == pytest.approx(0.0, abs=1e-15)
    assert channel.hidden(1000.0, 500.0) == channel.hidden(3000.0, 500.0) == 1.0
    draws = np.random.default_rng(1).uniform(0.0, 1.0, (2, 400_000))
    angle, radius = 2.0 * pi * draws[0], np.sqrt(draws[1])
    outside = np.mean((radius * np.cos(angle) - 0.5) ** 2 + (radius * np.sin(angle)) ** 2 > 1.0)
    assert channel.hidden(250.0, 500.0) == pytest.approx(outside, abs=4.0 * (0.25 / 400_000) ** 0.5)


def test_speaking_at_once():
    """Nobody else, no collision; hidden units as in ALOHA: e^(-2 G) survive; more load, more collisions."""
    assert channel.collision(0.0, 1.0) == 0.0
    alone = 1.0 - channel.collision(0.5, 0.0)
    assert (1.0 - channel.collision(0.5, 1.0)) / alone == pytest.approx(np.exp(-1.0))
    assert (np.diff([channel.collision(b, 0.3) for b in np.linspace(0.0, 1.0, 21)]) > 0.0).all()


# -- congestion control ------------------------------------------------------------------------------


def test_pinned_tables():
    """OScar's figures are lower bounds of the levels, Vanetza's upper ones: a ratio and its interval [s]."""
    assert [interval(level_of(each, OSCAR), OSCAR) for each in (0.1, 0.25, 0.35, 0.45, 0.65)] == [0.1, 0.2, 0.4, 0.5, 1.0]
    assert [interval(level_of(each, VANETZA), VANETZA) for each in (0.25, 0.45, 0.65)] == pytest.approx([0.1, 0.34, 0.46], abs=1e-12)
    assert [interval(level, VANETZA) for level in range(7)] == pytest.approx([0.06, 0.1, 0.18, 0.26, 0.34, 0.42, 0.46], abs=1e-12)


def test_bounds_belong_to_the_level_above():
    assert [level_of(each, OSCAR) for each in (0.1999, 0.2, 0.3, 0.4, 0.5)] == [0, 1, 2, 3, 4]
    assert [level_of(each, VANETZA) for each in (0.1899, 0.19, 0.27, 0.35, 0.43, 0.51, 0.59)] == [0, 1, 2, 3, 4, 5, 6]


def switched(stretches, table=OSCAR):
    """When [s] the interval [ms] changes, with what it is at first; stretches of (ratio, seconds)."""
    control, told, k = Control(), [(0.0, 100)], 0
    for ratio, seconds in stretches:
        for _ in range(round(seconds / congestion.SAMPLE)):
            control = sampled(control, ratio, table)
            now = round(1000.0 * interval(control.level, table))
            if now != told[-1][1]:
                told.append((round(k * congestion.SAMPLE, 1), now))
            k += 1
    return told


def test_up_after_one_second_down_after_five():
    found = switched([(0.10, 2), (0.35, 3), (0.55, 3), (0.25, 8), (0.10, 8)])
    assert found == [(0.0, 100), (3.0, 400), (6.0, 1000), (13.0, 200), (21.0, 100)]


def test_a_short_peak_changes_nothing_and_the_nearest_level_is_taken():
    assert switched([(0.10, 1), (0.55, 0.9), (0.10, 3)]) == [(0.0, 100)]
    assert switched([(0.10, 1), (0.55, 0.5), (0.25, 2)]) == [(0.0, 100), (2.0, 200)]
    assert switched([(0.55, 2), (0.10, 3), (0.45, 5)]) == [(0.0, 100), (1.0, 1000), (7.0, 500)]


# -- cells -------------------------------------------------------------------------------------------


def test_twice_the_bandwidth_adds_a_second_a_second():
    """200 kB/s on 100 kB/s for ten seconds, in packets of 1000 bytes; then the queue empties as fast."""
    q, c, dt = 0.0, 100e3, 0.005
    for k in range(2000):
        q = cell.backlog(q, dt, c) + 1000.0
        assert cell.waiting(q, c) == pytest.approx(0.01 + k * dt, abs=0.006)
    assert cell.waiting(q, c) == pytest.approx(10.0, abs=0.01)
    assert cell.waiting(cell.backlog(q, 4.0, c), c) == pytest.approx(6.0, abs=0.01) and cell.backlog(q, 20.0, c) == 0.0


def test_circle_and_polygon():
    assert cell.in_circle(3.0, 4.0, 0.0, 0.0, 5.0) and not cell.in_circle(3.1, 4.0, 0.0, 0.0, 5.0)
    corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (5.0, 2.0), (0.0, 10.0)]

    def inside(x, y):
        return sum(cell.crosses(x, y, *one, *other) for one, other in zip(corners, corners[1:] + corners[:1], strict=True)) % 2 == 1

    assert inside(1.0, 1.0) and inside(9.5, 8.0) and not inside(5.0, 5.0) and not inside(-1.0, 1.0) and not inside(11.0, 1.0)


def test_the_bound_of_collisions_is_above_them_and_near_where_few_collide():
    for distance in (0.0, 10.0, 200.0, 800.0, 2000.0):
        for ratio in (0.0, 0.02, 0.2, 0.6, 1.0):
            exact = channel.collision(ratio, channel.hidden(distance, 400.0))
            bound = channel.collision_bound(ratio, distance, 400.0)
            assert exact <= bound + 1e-15 and (bound < 1.3 * exact or ratio > 0.1 or distance > 200.0 or exact == 0.0)


# -- latency -----------------------------------------------------------------------------------------


def skewed(shortest, rest, longest, draw):
    """A delay with the share that belongs to it."""
    return arrival.skewed_delay(shortest, rest, longest, arrival.not_cut(shortest, rest, longest), draw)


def test_skewed_delays():
    """Quantiles a - b ln(1 - p) where nothing is cut; none beyond the longest, and the same draws stretched within."""
    for p in (0.05, 0.5, 0.95, 0.99):
        assert skewed(0.010, 0.009, 10.0, p) == pytest.approx(0.010 - 0.009 * np.log(1.0 - p), abs=1e-12)
        assert skewed(0.010, 0.009, 0.03, p) < 0.03
    assert skewed(0.010, 0.009, 0.03, 1.0 - 1e-16) == pytest.approx(0.03)
    assert skewed(0.010, 0.0, 0.03, 0.7) == 0.010 and skewed(0.040, 0.009, 0.03, 0.5) == 0.03
