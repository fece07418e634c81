"""Swings: ways of bounded curvature between two poses, and how near to their line they keep."""

import itertools
from math import cos, pi, sin

import numpy as np
import pytest

from studio.road.network import curve
from studio.road.ways import swing
from studio.road.ways.path import CORRIDOR, Draft, curvature_of, joined, smooth
from studio.road.ways.swing import Pose

R = 5.0


def ways(start, end, radius=R):
    """All words between two poses, as lines."""
    found = list(swing.swings(start, end, radius, 1e9))
    return [swing.drawn(start, parts, radius, 0.05) for parts in found], found


def test_half_a_circle_is_two_radii_aside():
    """Straight back, two radii to the left: one arc of half a turn, pi R long."""
    _, parts = ways(Pose(0.0, 0.0, 0.0), Pose(0.0, 2.0 * R, pi))
    assert min(sum(length for _, length in each) for each in parts) == pytest.approx(pi * R)


def test_straight_ahead_is_straight():
    _, parts = ways(Pose(1.0, 2.0, 0.5), Pose(1.0 + 7.0 * cos(0.5), 2.0 + 7.0 * sin(0.5), 0.5))
    assert min(sum(length for _, length in each) for each in parts) == pytest.approx(7.0)


@pytest.mark.parametrize("seed", range(20))
def test_every_way_ends_where_it_shall(seed):
    """From anywhere to anywhere: the drawn line arrives at the place with the heading, and never bends more than 1/R."""
    chance = np.random.default_rng(seed)
    start, end = (Pose(*chance.uniform(-12.0, 12.0, 2), chance.uniform(-pi, pi)) for _ in range(2))
    lines, parts = ways(start, end)
    assert lines
    for line, each in zip(lines, parts, strict=True):
        assert line[:, 0] == pytest.approx([start.x, start.y]) and line[:, -1] == pytest.approx([end.x, end.y], abs=0.02)
        turned = sum(bend * length / R for bend, length in each)
        assert cos(start.heading + turned - end.heading) == pytest.approx(1.0, abs=1e-9)
        assert all(length >= 0.0 and bend in (-1.0, 0.0, 1.0) for bend, length in each)


def corner(degrees, radius=0.5, leg=40.0):
    """Two straights that meet with a turn and a small radius, a point every quarter of a metre."""
    angle = np.linspace(0.0, np.radians(degrees), 40)
    bend = np.array([radius * np.sin(angle), radius * (1.0 - np.cos(angle))])
    ahead = np.array([np.cos(angle[-1]), np.sin(angle[-1])])
    line = np.column_stack([[-leg, 0.0], bend, bend[:, -1] + leg * ahead])
    return curve.resampled(line, 0.25)


@pytest.mark.parametrize(("degrees", "lock"), list(itertools.product((60, 90, 120, 140), (0.19, 0.123))))
def test_a_corner_is_driven_within_the_lock(degrees, lock):
    """Whoever may leave a corner by half of what an arc would cut off its outside and inside does: R (1/cos(turn/2) - 1) in all."""
    draft, line = Draft(), corner(degrees)
    draft.add(line, np.zeros(line.shape[1]), CORRIDOR, 10.0)
    made, height = smooth(draft, lock)
    assert np.abs(curvature_of(made)).max() <= lock and height.shape == made[0].shape
    whole = (1.0 / lock) * (1.0 / cos(np.radians(degrees) / 2.0) - 1.0)
    assert curve.distances(made[:, ::4], joined(draft)[0]).max() < max(0.6 * whole, 0.7)
    assert made[:, 0] == pytest.approx(line[:, 0], abs=0.05) and made[:, -1] == pytest.approx(line[:, -1], abs=0.05)


def test_two_bends_in_a_row_are_one_swing():
    """Right and left again, three metres apart: the second bend lies within the swing of the first."""
    line = curve.resampled(np.array([[-40.0, 0.0, 0.0, 40.0], [0.0, 0.0, 3.0, 3.0]]), 0.25)
    draft = Draft()
    draft.add(line, np.linspace(0.0, 4.0, line.shape[1]), CORRIDOR, 10.0)
    made, height = smooth(draft, 0.123)
    assert np.abs(curvature_of(made)).max() <= 0.123
    assert height[[0, -1]] == pytest.approx([0.0, 4.0]) and (np.diff(height) >= -1e-9).all()


def test_what_is_gentle_stays_as_it_is():
    angle = np.linspace(0.0, 1.5, 300)
    line = np.array([20.0 * np.sin(angle), 20.0 * (1.0 - np.cos(angle))])
    same, at = swing.swung(line, angle, np.zeros(300, dtype=bool), 0.19)
    assert same is not line and np.array_equal(same, line) and np.array_equal(at, np.arange(300))
