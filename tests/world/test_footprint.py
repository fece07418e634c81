"""Footprints: how far two outlines reach into each other, by closed forms and against the compiled test of collisions."""

from math import cos, pi, sin, sqrt

import numpy as np
import pytest

from studio.world.footprint import Footprint, depth, overlaps
from studio.world.passes.collision import overlap


def box(x=0.0, y=0.0, heading=0.0, length=4.0, width=2.0, name=""):
    return Footprint(name, x, y, heading, length, width)


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        (box(x=3.9), 0.1),  # nose to tail
        (box(x=4.1), -0.1),
        (box(y=1.5), 0.5),  # side by side
        (box(y=3.5), -1.5),
        (box(x=2.9, heading=pi / 2), 0.1),  # across in front
        (box(x=2.0 + 3.0 * cos(pi / 4) - 0.1, heading=pi / 4), 3.0 / sqrt(2.0) - (3.0 / sqrt(2.0) - 0.1)),  # a corner first
    ],
)
def test_by_hand(other, expected):
    assert depth(box(), other) == pytest.approx(expected) == depth(other, box())


def test_the_same_as_collisions():
    """3000 pairs, turned at random: they overlap when, and only when, their depth is positive."""
    draw = np.random.default_rng(1)
    found = 0
    for x, y, one, other, length in draw.uniform((-4, -4, -pi, -pi, 1), (4, 4, pi, pi, 6), (3000, 5)):
        a, b = box(heading=one), box(x, y, other, length)
        hit = overlap(x, y, one, a.length, a.width, other, b.length, b.width)
        assert hit == (depth(a, b) > 0.0)
        found += hit
    assert 500 < found < 2500


def test_all_pairs_are_found():
    """Against looking at every pair, of 300 boxes in a square of 80 m."""
    draw = np.random.default_rng(2)
    boxes = [box(x, y, heading, name=str(i)) for i, (x, y, heading) in enumerate(draw.uniform((-40, -40, -3), (40, 40, 3), (300, 3)))]
    expected = {(a.name, b.name) for i, a in enumerate(boxes) for b in boxes[:i] if depth(a, b) > 0.0}
    assert {(each.one.name, each.other.name) for each in overlaps(boxes)} == expected and len(expected) > 20


def test_a_box_is_moved_apart_by_its_depth():
    a, b = box(), box(1.0, 1.2, 0.3)
    axes = (0.0, pi / 2, 0.3, 0.3 + pi / 2)
    deep = depth(a, b)
    moved = [depth(a, b._replace(x=b.x + side * 1.0001 * deep * cos(axis), y=b.y + side * 1.0001 * deep * sin(axis)))
             for axis in axes for side in (-1, 1)]  # fmt: skip
    assert min(moved) < 0.0 < deep
