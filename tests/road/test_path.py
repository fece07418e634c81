"""Paths are evenly spaced, smooth, on their lanes, and slow enough for their bends."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.road.assembly.alignment import STEADY
from studio.road.network import curve
from studio.road.network.curve import LOCK
from studio.road.ways.lane_path import LanePath
from studio.road.ways.path import (
    CORRIDOR,
    PATH_CURVATURE,
    PATH_HEADING,
    PATH_SPACING,
    PATH_SPEED,
    PATH_X,
    PATH_Y,
    PROJECTION_REACH,
    interpolate,
    path,
    project,
)

LATERAL, BRAKING = 2.5, 1.5  # [m/s²] the defaults of path()


def test_points_are_one_metre_apart(paths):
    """Along the arc; a chord of a bend of 12 m radius is 0.3 mm shorter."""
    for one in paths:
        spacing = np.hypot(*np.diff(one.points[[PATH_X, PATH_Y]]))
        assert np.abs(spacing - 1.0).max() < 1e-3
        assert one.length == one.points.shape[1] - 1


def test_heading_is_continuous_and_points_ahead(paths):
    for one in paths:
        heading = one.points[PATH_HEADING]
        assert np.abs(np.diff(heading)).max() < LOCK * PATH_SPACING
        chord = np.unwrap(np.arctan2(*np.diff(one.points[[PATH_X, PATH_Y]])[::-1]))
        middle = (heading[1:] + heading[:-1]) / 2.0
        assert np.abs(np.angle(np.exp(1j * (chord - middle)))).max() < 0.02


def test_curvature_is_the_change_of_heading(paths):
    for one in paths:
        turned = np.concatenate([[0.0], np.cumsum((one.points[PATH_CURVATURE][1:] + one.points[PATH_CURVATURE][:-1]) / 2)])
        assert np.abs(one.points[PATH_HEADING] - one.points[PATH_HEADING][0] - turned).max() < 0.05


def test_curvature_is_bounded_and_steady(paths):
    """Within what turns are drawn for."""
    for one in paths:
        assert np.abs(one.points[PATH_CURVATURE]).max() < LOCK
        assert np.abs(np.diff(one.points[PATH_CURVATURE])).max() < STEADY * PATH_SPACING


def test_no_bend_is_taken_too_fast(paths):
    for one in paths:
        assert (one.points[PATH_SPEED] ** 2 * np.abs(one.points[PATH_CURVATURE])).max() <= LATERAL + 1e-9
        assert np.sqrt(LATERAL / LOCK) < one.points[PATH_SPEED].min() and one.points[PATH_SPEED].max() <= 50 / 3.6 + 0.01
        slowing = -np.diff(one.points[PATH_SPEED] ** 2) / 2.0
        assert slowing.max() <= BRAKING + 1e-9


def test_paths_stay_on_their_lanes(place, routes, paths):
    """Without lane changes; and a lane change never leaves both lanes."""
    for route, one in zip(routes, paths, strict=True):
        lanes = [place.lanes[lane] for lane in route.lanes]
        all_lines = np.array([nearest_of(one.points[:2], [lane]) for lane in lanes])
        closest = all_lines.min(axis=0)
        changed = {a.road for a, b in itertools.pairwise(lanes) if a.road == b.road and not a.internal}
        plain = np.array([lane.road not in changed for lane in lanes])
        alone = all_lines[plain].min(axis=0) == closest
        assert closest[alone].max() < CORRIDOR + 0.02
        assert closest.max() < 1.7


def nearest_of(points, lanes):
    return np.min([curve.distances(points, lane.centre) for lane in lanes], axis=0)


def test_stop_lines_are_where_the_signals_stand(place, routes, paths):
    for route, one in zip(routes, paths, strict=True):
        link = {c.from_lane: c.link for c in place.connections}
        passed = [link[lane] for lane in route.lanes[:-1] if link.get(lane, -1) >= 0]
        left = [number for s, number in one.stop_lines]
        assert [number for number in passed if number in left] == left
        assert list(one.stop_lines) == sorted(one.stop_lines)
        for s, number in one.stop_lines:
            x, y = (interpolate(one.points, 0, row, s) for row in (PATH_X, PATH_Y))
            assert np.hypot(place.signals.link_x[number] - x, place.signals.link_y[number] - y) < 0.5


def test_stations_tell_the_roads_in_order(place, routes, paths):
    for route, one in zip(routes, paths, strict=True):
        roads = [station.road for i, station in enumerate(one.stations)]
        once = tuple(road for i, road in enumerate(roads) if i == 0 or roads[i - 1] != road)
        assert once == route.roads(place)
        starts = [station.s for station in one.stations]
        assert starts[0] == pytest.approx(0.0, abs=1e-6) and starts == sorted(starts)


# -- closed forms ----------------------------------------------------------------------------------


def test_a_straight_lane_is_a_straight_path(straight):
    one = path(straight, LanePath((0,)))
    assert one.length == 200.0
    assert one.points[PATH_X] == pytest.approx(np.arange(201.0), abs=1e-6)
    for row in (PATH_Y, PATH_HEADING, PATH_CURVATURE):
        assert one.points[row] == pytest.approx(0.0, abs=1e-9)
    assert one.points[PATH_SPEED] == pytest.approx(13.9)


def test_a_lane_change_is_smooth_and_complete(straight):
    one = path(straight, LanePath((0, 1)))
    y = one.points[PATH_Y]
    assert y[0] == pytest.approx(0.0, abs=0.01) and y[-1] == pytest.approx(3.2, abs=0.01)
    assert (np.diff(y) > -0.005).all()
    assert 30.0 < ((y > 0.05) & (y < 3.15)).sum() < 60.0
    # the steepest curvature of the blend is 10 / sqrt(3) d / L² (its second derivative's extremum), L = 45 m
    assert np.abs(one.points[PATH_CURVATURE]).max() == pytest.approx(10 / np.sqrt(3) * 3.2 / 45.0**2, rel=0.1)
    assert [station.lane_index for station in one.stations] == [0, 1]


def test_a_bend_has_its_curvature_and_speed(bend):
    one = path(bend, LanePath((0, 1, 2)))
    inside = slice(120, 145)  # the arc runs from 100 m to 162.8 m
    assert one.points[PATH_CURVATURE][inside] == pytest.approx(1 / 40.0, rel=0.02)
    assert one.points[PATH_SPEED][inside] == pytest.approx(np.sqrt(LATERAL * 40.0), rel=0.02)
    assert one.points[PATH_HEADING][-1] == pytest.approx(np.pi / 2, abs=1e-3)
    assert one.length == pytest.approx(200.0 + 20.0 * np.pi, abs=1.0)


def test_slowing_for_a_bend_follows_constant_deceleration(bend):
    one = path(bend, LanePath((0, 1, 2)), lateral_acceleration=1.0, deceleration=2.0)
    speed = one.points[PATH_SPEED]
    braking = np.flatnonzero((speed[:95] < 13.8) & (speed[:95] > 7.0))
    squared = speed[braking] ** 2
    assert len(braking) > 15 and np.diff(squared) == pytest.approx(-2.0 * 2.0, rel=1e-6)


def test_a_line_that_doubles_back_is_straightened():
    points = np.array([[0.0, 5.0, 10.0, 8.0, 9.9, 15.0], [0.0, 0.0, 0.0, 0.1, 0.1, 0.0]])
    kept = points[:, curve.forward(points)]
    assert (np.diff(kept[0]) > 0.0).all() and kept[0, -1] == 15.0


def test_a_turning_loop_is_kept():
    angle = np.linspace(-np.pi / 2, np.pi / 2, 7)
    loop = np.array([[0.0, *(50.0 + 4.0 * np.cos(angle)), 0.0], [-4.0, *(4.0 * np.sin(angle)), 4.0]])
    assert curve.forward(loop) == list(range(loop.shape[1]))


def test_smoothing_leaves_straight_lines_and_keeps_the_corridor():
    x = np.arange(0.0, 60.0, 0.25)
    kink = np.array([x, np.maximum(0.0, x - 30.0)])
    for corridor in (0.1, 0.3):
        smooth = curve.smoothed(kink, spacing=0.25, wavelength=24.0, corridor=np.full(len(x), corridor))
        assert np.hypot(*(smooth - kink)).max() <= corridor
    line = np.array([x, 0.5 * x])
    assert curve.smoothed(line, spacing=0.28, wavelength=24.0, corridor=np.full(len(x), 0.3)) == pytest.approx(line)


# -- on the path -----------------------------------------------------------------------------------


@given(st.floats(1.0, 220.0), st.floats(-3.0, 3.0), st.floats(-4.5, 4.5), st.sampled_from([0, 37]))
def test_projection_finds_station_and_offset(bend_points, s, lateral, error, first):
    points = np.concatenate([np.full((5, first), 1e6), bend_points, np.full((5, 9), -1e6)], axis=1)
    count = bend_points.shape[1]
    x, y, heading = (interpolate(points, first, row, s) for row in (PATH_X, PATH_Y, PATH_HEADING))
    x, y = x - lateral * np.sin(heading), y + lateral * np.cos(heading)
    found, offset = project(points, first, count, x, y, min(max(s + error, 0.0), count - 1.0))
    assert found == pytest.approx(s, abs=0.05) and offset == pytest.approx(lateral, abs=0.01)


@pytest.fixture(scope="module")
def bend_points():
    s = np.arange(0.0, 231.0)
    angle = np.clip((s - 100.0) / 60.0, 0.0, np.pi / 3)
    x = np.where(s < 100, s, 100.0 + 60.0 * np.sin(angle)) + np.maximum(0.0, s - 100 - 20 * np.pi) * np.cos(np.pi / 3)
    y = 60.0 * (1.0 - np.cos(angle)) + np.maximum(0.0, s - 100 - 20 * np.pi) * np.sin(np.pi / 3)
    return np.array([x, y, angle, np.where(angle > 0, 1 / 60, 0.0), np.full(len(s), 10.0)])


@given(st.integers(0, 2**32 - 1))
def test_projection_is_the_nearest_of_all_pieces_within_reach(seed):
    """Piece by piece, by the definition; on wild lines as well, whose pieces are short, long or nothing, and of equal ones the first."""
    chance = np.random.default_rng(seed)
    count = int(chance.integers(2, 30))
    points = np.zeros((2, count))
    points[:] = np.cumsum(np.round(chance.normal(0.0, chance.choice([0.1, 1.0, 3.0]), (2, count)), 1), axis=1)
    x, y = np.round(chance.normal(0.0, chance.choice([0.5, 5.0, 50.0]), 2), 1)
    guess = float(chance.uniform(-3.0, count + 3.0))
    middle = int(guess)
    low, high = max(0, min(middle - PROJECTION_REACH, count - 2)), min(count - 2, max(middle + PROJECTION_REACH, 0))
    found = [nearest_on(points[:, i], points[:, i + 1], x, y) for i in range(low, high + 1)]
    best = min(range(len(found)), key=lambda i: found[i][0])
    s, offset = project(points, 0, count, x, y, guess)
    assert (s, abs(offset)) == (low + best + found[best][1], np.sqrt(found[best][0]))


def nearest_on(a, b, x, y):
    """The squared distance of a point from a piece, and which share of the piece leads to the place that is nearest."""
    t, d = b - a, np.array([x, y]) - a
    along, squared = d[0] * t[0] + d[1] * t[1], t[0] * t[0] + t[1] * t[1]
    u = 0.0 if along <= 0.0 else 1.0 if along >= squared else along / squared
    r = d - u * t
    return r[0] * r[0] + r[1] * r[1], u


def test_projection_beyond_the_ends_stays_on_the_path(bend_points):
    count = bend_points.shape[1]
    assert project(bend_points, 0, count, -7.0, 1.0, 0.0)[0] == 0.0
    assert project(bend_points, 0, count, *bend_points[:2, -1], count + 3.0)[0] == pytest.approx(count - 1.0)


def test_interpolation_at_the_last_point(bend_points):
    count = bend_points.shape[1]
    assert interpolate(bend_points, 0, PATH_X, count - 1.0) == bend_points[PATH_X, -1]
    assert interpolate(bend_points, 0, PATH_X, 10.25) == pytest.approx(10.25)
