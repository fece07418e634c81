"""Zones of paths whose closed form is known."""

import numpy as np
import pytest

from studio.road.ways.conflict import zones
from studio.road.ways.path import PATH_ROWS

WIDTH = 2.4


def line(x, y, heading, count):
    s = np.arange(float(count))
    points = np.zeros((PATH_ROWS, count))
    points[:2] = x + s * np.cos(heading), y + s * np.sin(heading)
    return points


def circle(radius, count, *, start=0.0):
    angle = start + np.arange(float(count)) / radius
    points = np.zeros((PATH_ROWS, count))
    points[:2] = radius * np.cos(angle), radius * np.sin(angle)
    return points


def between(one, other, width=WIDTH):
    both = np.concatenate([one, other], axis=1)
    return zones(both, 0, one.shape[1], one.shape[1], other.shape[1], width)


def test_a_right_angle_crossing_is_as_long_as_it_is_wide():
    found = between(line(0, 0, 0, 101), line(50.3, -40.2, np.pi / 2, 101))
    assert found == pytest.approx(np.array([[50.3 - WIDTH, 50.3 + WIDTH, 40.2 - WIDTH, 40.2 + WIDTH]]), abs=0.2)


def test_an_oblique_crossing_is_longer():
    """Two lines at angle a come within w of each other over w / sin(a) to either side."""
    angle = np.radians(30.0)
    start = np.array([60.0, 0.0]) - 50.0 * np.array([np.cos(angle), np.sin(angle)])
    found = between(line(0, 0, 0, 121), line(*start, angle, 101))
    half = WIDTH / np.sin(angle)
    assert found == pytest.approx(np.array([[60 - half, 60 + half, 50 - half, 50 + half]]), abs=0.4)


@pytest.mark.parametrize(("apart", "count"), [(2.0, 1), (3.2, 0)])
def test_parallel_lanes_are_a_zone_only_when_too_close(apart, count):
    found = between(line(0, 0, 0, 101), line(0, apart, 0, 101))
    assert len(found) == count
    if count:
        assert found[0] == pytest.approx([0.0, 100.0, 0.0, 100.0])


def test_opposite_lanes_that_pass_by_are_none():
    assert len(between(line(0, 0, 0, 101), line(100, 3.2, np.pi, 101))) == 0


def test_the_zone_of_a_shifted_follower_keeps_its_stations():
    found = between(line(0, 0, 0, 101), line(30, 0, 0, 101))
    assert found[0] == pytest.approx([30.0 - WIDTH, 100.0, 0.0, 70.0 + WIDTH], abs=0.05)


def test_a_merge_lasts_to_the_end():
    """One path runs east; the other comes in at 45° and turns east onto it at x = 60."""
    angle, s = np.pi / 4, np.arange(101.0)
    merging = np.zeros((PATH_ROWS, 101))
    merging[0] = np.where(s < 50, 60 - (50 - s) * np.cos(angle), 60 + s - 50)
    merging[1] = np.where(s < 50, -(50 - s) * np.sin(angle), 0.0)
    found = between(line(0, 0, 0, 121), merging)
    assert len(found) == 1
    reach = WIDTH / np.sin(angle)  # where the slanted part is just w beside the straight path
    assert found[0, 2] == pytest.approx(50.0 - reach, abs=0.3)
    assert found[0, 1] == pytest.approx(110.0 + WIDTH, abs=0.1) and found[0, 3] == pytest.approx(100.0)


def test_a_path_that_crosses_twice_makes_two_zones():
    x = np.linspace(0.0, 60.0, 101)
    bow = np.zeros((PATH_ROWS, 101))
    bow[:2] = x, 20.0 - ((x - 30.0) / 5.0) ** 2
    found = between(line(0, 0, 0, 61), bow)
    assert len(found) == 2
    assert (found[:, 0].min(), found[1, 2] > found[0, 3]) == (found[0, 0], True)


def test_two_rounds_of_a_ring_are_two_zones():
    """A path that passes the same place twice is followed on either round, not on both at once."""
    found = between(circle(30.0, 40), circle(30.0, int(2 * np.pi * 30.0) + 39, start=0.0))
    assert len(found) == 2
    assert found[0, 3] < found[1, 2]


def test_zones_are_mutual(paths):
    points = np.concatenate([one.points for one in paths], axis=1)
    count = np.array([one.points.shape[1] for one in paths])
    first = np.concatenate([[0], np.cumsum(count)[:-1]])
    for i in range(0, 25, 6):
        for j in range(1, 25, 5):
            here = zones(points, first[i], count[i], first[j], count[j], WIDTH)
            there = zones(points, first[j], count[j], first[i], count[i], WIDTH)[:, [2, 3, 0, 1]]
            assert here == pytest.approx(there[np.argsort(there[:, 0])], abs=0.5)


def test_the_paths_of_a_place_have_zones(paths):
    points = np.concatenate([one.points for one in paths], axis=1)
    count = np.array([one.points.shape[1] for one in paths])
    first = np.concatenate([[0], np.cumsum(count)[:-1]])
    found = [len(zones(points, first[i], count[i], first[j], count[j], WIDTH)) for i in range(25) for j in range(25) if i != j]
    assert sum(found) > 300
