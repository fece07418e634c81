"""Paths on the lanes beside: they lie on these, lead where the usual one leads, come back in time, and stop where theirs stops."""

import numpy as np
import pytest

from studio.road import load
from studio.road.drawn.motorway import motorway
from studio.road.ways.aside import CLEAR, FARTHEST, LAST, MOST, sides
from studio.road.ways.path import PATH_CURVATURE, PATH_HEADING, PATH_X, PATH_Y, path
from studio.road.ways.route import all_routes, connect
from studio.road.ways.strand import driven
from studio.world.setting import USUAL_RADIUS
from tests.conftest import ROOT

STERN = ROOT / "scenarios" / "maps" / "berlin_siegessaeule_grosser_stern.osm.gz"


def left_of(usual, side):
    """How far to the left of the usual path the points of one on a side lie that belong to its own [m]."""
    grid = np.arange(side.path.points.shape[1])
    x, y = (np.interp(side.at, grid, side.path.points[row]) for row in (PATH_X, PATH_Y))
    heading = usual.points[PATH_HEADING]
    return (y - usual.points[PATH_Y]) * np.cos(heading) - (x - usual.points[PATH_X]) * np.sin(heading)


def test_on_a_motorway_they_go_all_along(tmp_path):
    file = tmp_path / "three.xodr"
    file.write_text(motorway(length=2000.0, lanes=3), encoding="utf-8")
    network = load(file)
    width = network.lanes_of("motorway")[0].width
    for lane, expected in enumerate(((1, 2), (1, -1), (-1, -2))):
        usual = path(network, connect(network, ["motorway"], start_lane=lane))
        found = sides(network, usual)
        assert tuple(side.step for side in found) == expected
        for side in found:
            assert left_of(usual, side) == pytest.approx(np.full(side.at.size, side.step * width), abs=0.05)
            assert np.isinf(side.spans[0][2]) and side.free.all()
            assert {one.lane_index for one in side.path.stations} == {lane + side.step}


@pytest.fixture(scope="module")
def town():
    network = load(STERN, radius=USUAL_RADIUS)
    usual = [path(network, each) for each in all_routes(network)[:12]]
    return network, [(one, side) for one in usual for side in sides(network, one)]


def test_in_a_town_they_leave_the_usual_path_and_come_back(town):
    _, found = town
    assert len(found) > 10
    for usual, side in found:
        aside = np.abs(left_of(usual, side))
        beside = np.zeros(aside.size, dtype=bool)
        for first, last, back in side.spans:
            beside[int(first) : int(last) + 1] = True
            assert back == np.inf or first < back < last
        assert aside[~beside].max(initial=0.0) < 0.35
        assert (aside[side.free] > 2.0 * abs(side.step)).all() and side.free.any() and abs(side.step) <= FARTHEST
        assert np.hypot(*(side.path.points[:2, -1] - usual.points[:2, -1])) < (1.0 if not beside[-1] else 6.0 * FARTHEST)
        assert np.abs(side.path.points[PATH_CURVATURE]).max() < np.abs(usual.points[PATH_CURVATURE]).max() + 0.05


def test_they_are_driven_without_a_gap_and_stop_at_lights_of_their_own(town):
    network, found = town
    ends = {each.link: network.lanes[each.from_lane] for each in network.connections}
    for usual, side in found:
        drives = driven(network, side.path)
        covered = np.zeros(side.path.points.shape[1], dtype=bool)
        for each in drives:
            covered[int(each.enter) : int(np.ceil(each.leave)) + 1] = True
        for first, _, _ in side.spans:  # nobody drives where the path leaves the usual one
            covered[int(side.at[int(first)]) :][: int(MOST)] |= first > 0
        assert covered.all()
        assert len(side.path.stop_lines) == len(usual.stop_lines)
        for s, link in side.path.stop_lines:
            place = [np.interp(s, np.arange(side.path.points.shape[1]), side.path.points[row]) for row in (PATH_X, PATH_Y)]
            assert np.hypot(*(np.array(place) - ends[link].centre[:, -1])) < 3.0
            assert not side.free[np.abs(side.at - s) < min(CLEAR, LAST)].any()
