"""Places on lanes, both ways, and the nearest lane against a search through all lanes of real maps."""

from math import inf, nan, pi

import numpy as np
import pytest

from studio.road import load
from studio.road.network.index import (
    CELL,
    NONE,
    P_EAST,
    P_HEADING,
    P_MITRE,
    P_NORTH,
    P_S,
    P_X,
    P_Y,
    POINT_COUNT,
    POINT_FIRST,
    index_of,
    joined,
)  # fmt: skip
from studio.road.ways.frenet import Place, nearest, nearest_lane, nearest_piece, to_lane, to_world
from tests.road.conftest import lane, network
from tests.road.test_places import FILES


@pytest.fixture(scope="module", params=FILES)
def here(request):
    return load(FILES[request.param])


def pieces(here):
    """Starts, ends, unit directions and lanes of all straight pieces, straight from the lanes."""
    lines = [each.centre for each in here.lanes]
    starts, ends = (np.concatenate([line[:, part] for line in lines], axis=1) for part in (slice(None, -1), slice(1, None)))
    step = ends - starts
    return starts, step, np.repeat([each.id for each in here.lanes], [line.shape[1] - 1 for line in lines])


def searched(here, x, y, heading=nan):
    """Distance of the nearest lane [m], by a look at every piece of every lane."""
    starts, step, _ = pieces(here)
    squared = np.maximum((step**2).sum(axis=0), 1e-18)  # netconvert draws some lanes of no length
    apart = np.array([[x], [y]]) - starts
    u = np.clip((apart * step).sum(axis=0) / squared, 0.0, 1.0)
    distance = np.hypot(*(apart - u * step))
    if not np.isnan(heading):
        distance[np.cos(heading) * step[0] + np.sin(heading) * step[1] <= 0.0] = inf
    return distance.min()


def positions(here, count, seed):
    """Positions all over the map, beside its lanes, far outside, and where nothing is."""
    rng = np.random.default_rng(seed)
    x0, y0, x1, y1 = here.bounds
    anywhere = rng.uniform([x0, y0], [x1, y1], (count, 2))
    starts, step, _ = pieces(here)
    chosen = rng.integers(0, starts.shape[1], count)
    beside = (starts[:, chosen] + rng.uniform(0, 1, count) * step[:, chosen]).T + rng.normal(0.0, 3.0, (count, 2))
    outside = rng.uniform(-20_000, 20_000, (count // 10, 2))
    return np.concatenate([anywhere, beside, outside])


def test_the_nearest_lane_is_the_one_a_full_search_finds(here):
    index = index_of(here)
    for x, y in positions(here, 150, 1):
        column, distance = nearest_piece(index, 0, x, y, nan, inf)
        assert distance == pytest.approx(searched(here, x, y), abs=1e-9)
        assert column != NONE


def test_the_nearest_lane_of_a_direction(here):
    rng = np.random.default_rng(2)
    index = index_of(here)
    for (x, y), heading in zip(positions(here, 100, 2), rng.uniform(-pi, pi, 210), strict=True):
        column, distance = nearest_piece(index, 0, x, y, heading, inf)
        assert distance == pytest.approx(searched(here, x, y, heading), abs=1e-9)
        assert np.cos(heading) * index.points[P_EAST, column] + np.sin(heading) * index.points[P_NORTH, column] > 0.0


def test_nothing_beyond_the_reach(here):
    index = index_of(here)
    for x, y in positions(here, 100, 3):
        distance = searched(here, x, y)
        assert nearest_piece(index, 0, x, y, nan, 0.999 * distance)[0] == NONE
        assert nearest_piece(index, 0, x, y, nan, 1.001 * distance + 1e-9)[0] != NONE
    assert nearest(here, 1e6, 0.0) is None and nearest(here, nan, 0.0) is None and nearest(here, inf, 0.0) is None


def test_the_place_is_as_far_from_the_lane_as_the_position(here):
    """Where the position lies beside its lane, |d| is its distance; beyond an end and outside a corner it is less."""
    exact = total = 0
    for x, y in positions(here, 200, 4):
        place = nearest(here, x, y, reach=30.0)
        if place is not None:
            distance = searched(here, x, y)
            total += 1
            exact += abs(abs(place.d) - distance) < 1e-6
            assert abs(place.d) <= distance + 1e-6
            assert 0.0 <= place.s <= here.lanes[place.lane].length + 1e-6
    assert total > 100 and exact > 0.85 * total


def test_there_and_back_on_every_lane(here):
    """(s, d) → (x, y) → (s, d) within 1 µm and back within 1 nm, wherever the lane's lines do not cross."""
    rng = np.random.default_rng(5)
    same = tried = 0
    for each in here.lanes:
        for s, d in zip(rng.uniform(0.0, each.length, 4), rng.uniform(-2.0, 2.0, 4), strict=True):
            pose = to_world(here, Place(each.id, s, d))
            back = to_lane(here, each.id, pose.x, pose.y)
            again = to_world(here, back)
            tried += 1
            same += abs(back.s - s) < 1e-6 and abs(back.d - d) < 1e-6
            if here.lanes[each.id].length > 5.0 and not sharp(here, each):
                assert (back.s, back.d) == (pytest.approx(s, abs=1e-6), pytest.approx(d, abs=1e-6))
                assert np.hypot(again.x - pose.x, again.y - pose.y) < 1e-9
    assert same > 0.95 * tried


def sharp(here, each):
    """Whether a lane bends on less than 2 m, or comes back to within 4 m of itself: there a position has two places."""
    index = index_of(here)
    first, count = index.spans[[POINT_FIRST, POINT_COUNT], each.id]
    points = index.points[:, first : first + count]
    mitre, length = points[P_MITRE], np.diff(points[P_S])
    folds = (length - 2.0 * np.abs(mitre[:-1] + mitre[1:]) <= 1e-3).any()
    heading = points[P_HEADING]
    return folds or heading.max() - heading.min() > 2.5


def test_a_lane_starts_where_it_is_drawn(here):
    for each in here.lanes:
        start, end = to_world(here, Place(each.id, 0.0, 0.0)), to_world(here, Place(each.id, each.length, 0.0))
        assert np.hypot(start.x - each.centre[0, 0], start.y - each.centre[1, 0]) < 1e-6
        assert np.hypot(end.x - each.centre[0, -1], end.y - each.centre[1, -1]) < 1e-4


CORNERS = np.array([[0.0, 50.0, 80.0, 80.0, 120.0], [0.0, 0.0, 20.0, 60.0, 90.0]])


@pytest.fixture
def bent():
    return network([lane(0, "bent", 0, CORNERS)])


@pytest.mark.parametrize("d", [-4.0, -1.0, 0.0, 1.0, 4.0])
def test_lines_beside_a_lane_have_no_gaps(bent, d):
    """Along constant d the position moves in proportion to s, over all corners and both ends; its heading does not jump."""
    total = bent.lanes[0].length
    poses = np.array([to_world(bent, Place(0, s, d)) for s in np.arange(-5.0, total + 5.0, 0.01)])
    steps = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    assert steps.max() < 0.012 + 0.002 * abs(d) and steps.min() > 0.005
    assert np.abs(np.diff(poses[:, 2])).max() < 0.01 * 0.06


def test_places_have_no_gaps_along_a_straight_walk(bent):
    """Across the outer sides of corners s and d change no more than the walker moves, times what a mitre stretches."""
    for offset in np.linspace(-3.0, 3.0, 7):
        walk = np.array([[40.0, 90.0], [offset - 3.0, 33.0]])
        steps = np.linspace(0.0, 1.0, 5001)
        places = np.array([to_lane(bent, 0, *(walk[:, 0] + u * (walk[:, 1] - walk[:, 0])))[1:] for u in steps])
        moved = np.hypot(*(walk[:, 1] - walk[:, 0])) / 5000
        assert np.abs(np.diff(places[:, 1])).max() < 1.5 * moved
        assert np.abs(np.diff(places[:, 0])).max() < 2.0 * moved


def test_offset_is_the_distance_from_the_line_and_left_is_positive(bent):
    """s is drawn out or together evenly along a piece, at its end by d times the tangent of half the corner."""
    for d in (3.0, -3.0):
        end = 50.0 - d * np.tan(0.5 * np.arctan2(20.0, 30.0))
        assert to_lane(bent, 0, 0.4 * end, d) == (0, pytest.approx(0.4 * 50.0), pytest.approx(d))
    assert to_lane(bent, 0, -7.0, 1.0) == (0, pytest.approx(-7.0), pytest.approx(1.0))
    x, y = CORNERS[:, -1] + 3.0 * np.array([0.8, 0.6])
    assert to_lane(bent, 0, x, y) == (0, pytest.approx(bent.lanes[0].length + 3.0), pytest.approx(0.0, abs=1e-9))


def test_inside_a_bend_beyond_its_middle_there_is_still_a_place(bend):
    """60 m inside a bend of 40 m radius no piece has coordinates but the nearest point of the lane counts."""
    found = to_lane(bend, 1, 100.0 - 20.0, 40.0 + 20.0)
    assert np.isfinite(found.s) and np.isfinite(found.d)


def test_a_lane_without_length_has_places():
    dot = network([lane(0, "dot", 0, [[5.0, 5.0], [3.0, 3.0]])])
    assert to_world(dot, Place(0, 0.0, 0.0))[:2] == (5.0, 3.0)
    assert nearest(dot, 6.0, 3.0) is None  # but no direction: others lead there and away


def test_the_right_direction_is_found():
    """Two lanes on top of each other, one each way."""
    x, y = np.array([0.0, 100.0]), np.zeros(2)
    both = network([lane(0, "east", 0, [x, y]), lane(1, "west", 0, [x[::-1], y])])
    assert nearest(both, 30.0, 1.0, heading=0.3) == (0, pytest.approx(30.0), pytest.approx(1.0))
    assert nearest(both, 30.0, 1.0, heading=pi - 0.3) == (1, pytest.approx(70.0), pytest.approx(-1.0))
    assert nearest(both, 30.0, 1.0).lane == 0  # of equally near ones the first


def test_empty_cells_between_are_walked_through():
    """One lane far away, hundreds of empty cells of the grid between."""
    far = network([lane(0, "a", 0, [[0.0, 1.0], [0.0, 0.0]]), lane(1, "b", 0, [[5000.0, 5001.0], [3000.0, 3000.0]])])
    assert nearest(far, 2400.0, 1400.0, reach=inf).lane == 0
    assert nearest(far, 2700.0, 1700.0, reach=inf).lane == 1
    assert nearest(far, 2400.0, 1400.0, reach=10 * CELL) is None


def test_maps_side_by_side_answer_as_each_alone():
    """Two maps in one index: lanes of the second count on, everything else is bit for bit the same."""
    maps = [load(FILES[name]) for name in ("perth_peanut_roundabout_lht", "berlin_siegessaeule_grosser_stern")]
    alone = [index_of(each) for each in maps]
    both = joined(alone)
    for m, (each, index) in enumerate(zip(maps, alone, strict=True)):
        base = m * len(maps[0].lanes)
        for x, y in positions(each, 50, 6):
            lane_alone, *rest = nearest_lane(index, 0, x, y, 0.4, 100.0)
            lane_both, *same = nearest_lane(both, m, x, y, 0.4, 100.0)
            assert lane_both == (lane_alone + base if lane_alone != NONE else NONE)
            assert np.array_equal(rest, same, equal_nan=True)


def test_columns_of_points_are_unit_directions(here):
    points = index_of(here).points
    np.testing.assert_allclose(np.hypot(points[P_EAST], points[P_NORTH]), 1.0, rtol=1e-12)
    assert np.isfinite(points[[P_X, P_Y]]).all()
