"""Ways are cut at the border of the box, and rounded in their bends."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.road.assembly import bend
from studio.road.formats import osm

UNIT = osm.Box(0.0, 0.0, 1.0, 1.0)
coordinate = st.floats(-2.0, 3.0, allow_nan=False)


def way(points, **tags):
    return osm.Way(7, list(range(100, 100 + len(points))), points, {"highway": "primary", **tags})


@given(coordinate, coordinate, coordinate, coordinate)
def test_visible_part_is_inside_and_the_rest_is_not(ax, ay, bx, by):
    part = osm.visible((ax, ay), (bx, by), UNIT)
    for u in np.linspace(0.0, 1.0, 21):
        x, y = ax + u * (bx - ax), ay + u * (by - ay)
        depth = min(x, 1.0 - x, y, 1.0 - y)
        if depth > 1e-9:
            assert part is not None and part[0] - 1e-9 <= u <= part[1] + 1e-9
        elif depth < -1e-9:
            assert part is None or not part[0] + 1e-9 < u < part[1] - 1e-9


def test_a_way_that_comes_back_makes_two_pieces():
    pieces = osm.cut(way([(0.5, 0.5), (1.5, 0.5), (1.5, 0.7), (0.5, 0.7)]), UNIT, itertools.count(1000))
    assert [piece.points for piece in pieces] == [[(0.5, 0.5), (1.0, 0.5)], [(1.0, 0.7), (0.5, 0.7)]]
    assert [piece.nodes[0] for piece in pieces] == [100, 1001]
    assert len({piece.id for piece in pieces}) == 2


def test_a_way_outside_disappears_and_one_inside_stays():
    assert osm.cut(way([(2.0, 2.0), (3.0, 3.0)]), UNIT, itertools.count(1000)) == []
    inside = way([(0.1, 0.2), (0.3, 0.4), (0.9, 0.5)])
    assert osm.cut(inside, UNIT, itertools.count(1000)) == [inside]


BOX = osm.Box(52.5, 13.4, 52.52, 13.43)


def placed(points):
    return way(BOX.degrees(np.array(points, dtype=float)))


def local(of):
    longitude, latitude = np.array(of.points).T
    return BOX.local(latitude, longitude)


def test_a_polygon_becomes_the_circle_it_stands_for():
    angle = np.linspace(0.0, 2.0 * np.pi, 17)
    polygon = placed([70.0 * np.cos(angle), 70.0 * np.sin(angle)])
    closed = osm.Way(7, [*polygon.nodes[:-1], polygon.nodes[0]], polygon.points, {**polygon.tags, "oneway": "yes"})
    (round_way,) = bend.rounded([closed], BOX, itertools.count(1000))
    radius = np.hypot(*local(round_way))
    corner = 70.0 * (1.0 - np.cos(np.pi / 16))  # what the polygon misses of the circle in the middle of a side
    assert len(radius) > 100
    assert np.abs(radius - 70.0).max() < 0.1 * corner


def test_mapped_nodes_stay():
    mapped = placed([[0.0, 30.0, 55.0, 70.0], [0.0, 0.0, 8.0, 25.0]])
    (round_way,) = bend.rounded([mapped], BOX, itertools.count(1000))
    kept = dict(zip(round_way.nodes, round_way.points, strict=True))
    assert all(kept[node] == point for node, point in zip(mapped.nodes, mapped.points, strict=True))


@pytest.mark.parametrize("points", [[[0.0, 50.0, 100.0], [0.0, 0.0, 0.0]], [[0.0, 50.0, 50.0], [0.0, 0.0, 50.0]]])
def test_straights_and_corners_stay_as_they_are(points):
    (same,) = bend.rounded([placed(points)], BOX, itertools.count(1000))
    assert local(same) == pytest.approx(np.array(points), abs=1e-3)


def test_a_bend_runs_on_into_the_next_way():
    angle = np.linspace(0.0, np.pi, 13)
    x, y = 60.0 * np.cos(angle), 60.0 * np.sin(angle)
    first, second = placed([x[:7], y[:7]]), placed([x[6:], y[6:]])
    second = osm.Way(8, [106, *range(207, 213)], second.points, {**second.tags, "oneway": "yes"})
    first = osm.Way(7, first.nodes, first.points, {**first.tags, "oneway": "yes"})
    for piece in bend.rounded([first, second], BOX, itertools.count(1000)):
        joint = np.hypot(*local(piece))[:-10] if piece.id == 8 else np.hypot(*local(piece))[10:]
        assert np.abs(joint - 60.0).max() < 0.01


def test_a_long_straight_bends_only_near_its_ends():
    points = [[0.0, 20.0, 40.0, 440.0], [8.0, 3.0, 0.0, 0.0]]
    (round_way,) = bend.rounded([placed(points)], BOX, itertools.count(1000))
    x, y = local(round_way)
    assert np.abs(y[x > 61.0]).max() < 1e-3 and np.abs(y[x > 39.9]).max() < 0.5
