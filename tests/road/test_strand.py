"""Strands and their meetings: closed forms, and what must hold on every map."""

from itertools import pairwise

import numpy as np
import pytest

from studio.road import load
from studio.road.ways.conflict import ACROSS, ALONG, EQUAL, GIVE, NONE, TAKE
from studio.road.ways.meeting import meetings, meetings_of
from studio.road.ways.path import PATH_HEIGHT, PATH_ROWS, PATH_X, PATH_Y
from studio.road.ways.strand import WIDTH, Strands, driven, strands_of
from tests.road.conftest import lane, network
from tests.road.test_priority import BERLIN, arms_of, crossing

OPPOSITE = {GIVE: TAKE, TAKE: GIVE, EQUAL: EQUAL, NONE: NONE}


@pytest.fixture
def cross(draft, tmp_path, own_cache):
    """Four equal streets that meet at right angles."""
    return load(crossing(draft, BERLIN).write(tmp_path / "cross.osm"))


def places(strands, strand, stations):
    """Where stations [m] of a strand lie."""
    points = strands.points[:, strands.first[strand] : strands.first[strand] + strands.count[strand]]
    at = np.arange(points.shape[1]) * strands.spacing[strand]
    return np.array([np.interp(stations, at, points[row]) for row in (PATH_X, PATH_Y)])


def test_a_path_drives_on_strands_from_end_to_end(place, paths):
    """Without a gap; and wherever it is on a strand, it is less than the width that two need away from its line, on one lane 0.5 m."""
    strands = strands_of(place)
    for path in paths[:: len(paths) // 12]:
        drives = driven(place, path)
        assert drives[0].enter == pytest.approx(0.0, abs=1e-3) and max(each.leave for each in drives) == pytest.approx(path.length)
        for before, after in pairwise(drives):
            assert after.enter <= before.leave + 0.6
        for each in drives:
            stations = np.linspace(each.enter, each.leave, 9)
            own = np.array([np.interp(stations, np.arange(path.points.shape[1]), path.points[row]) for row in (PATH_X, PATH_Y)])
            apart = np.hypot(*(own - places(strands, each.strand, np.linspace(each.start, each.end, 9))))
            assert apart.max() < WIDTH + 0.3
            if each.strand >= strands.lanes:
                assert apart.max() < 0.6


def test_a_path_changes_lanes_on_both(place, paths):
    """While it goes over it is on both lanes, and on a lane that it comes to from the side it does not begin at the start."""
    changing = 0
    for path in paths:
        drives = [each for each in driven(place, path) if each.strand < strands_of(place).lanes]
        for before, after in pairwise(drives):
            if place.lanes[before.strand].road == place.lanes[after.strand].road:
                changing += 1
                assert after.enter < before.leave and after.start > 0.0
    assert changing > 5


def test_two_ways_at_right_angles_meet_over_twice_the_width(cross):
    """Two lines that cross at right angles come within w of each other over w on either side of the crossing."""
    strands, met = strands_of(cross), meetings_of(cross)
    straight = [len(cross.lanes) + i for i, c in enumerate(cross.connections) if c.direction == "straight"]
    found = 0
    for a in straight:
        for m in range(met.first[a], met.first[a + 1]):
            if met.shape[m] == ACROSS and met.partner[m] in straight:
                enter, leave, its_enter, its_leave = met.span[:, m]
                assert (leave - enter, its_leave - its_enter) == pytest.approx((2 * WIDTH, 2 * WIDTH), abs=0.35)
                middles = places(strands, a, (enter + leave) / 2), places(strands, met.partner[m], (its_enter + its_leave) / 2)
                assert np.hypot(*(middles[0] - middles[1])) < 0.35
                found += 1
    assert found == 8  # each of four meets two others


def test_meetings_are_mutual_and_who_goes_first_is_as_mapped(cross):
    """The same place from either side; of two one gives and the other takes, as the rule says; who comes from one lane parts."""
    met = meetings_of(cross)
    own = np.repeat(np.arange(met.first.size - 1), np.diff(met.first))
    rows = zip(own, met.partner, met.span.T, met.shape, met.turn, strict=True)
    told = {(a, b, *np.round(span, 6)): (shape, turn) for a, b, span, shape, turn in rows}
    assert told
    for (a, b, enter, leave, its_enter, its_leave), (shape, turn) in told.items():
        assert told[b, a, its_enter, its_leave, enter, leave] == (shape, OPPOSITE[turn])
        one, other = (cross.connections[s - len(cross.lanes)] if s >= len(cross.lanes) else None for s in (a, b))
        if one is None or other is None or one.from_lane == other.from_lane:
            assert turn == NONE or one is other is None
        else:
            first = (b - len(cross.lanes)) in one.yields
            assert (turn == GIVE) == (first and (a - len(cross.lanes)) not in other.yields)
        if one and other and one.to_lane == other.to_lane:
            assert shape == ALONG


def test_a_turn_across_gives_way_to_who_comes_from_ahead(cross):
    met = meetings_of(cross)
    at = {arms_of(cross, c): len(cross.lanes) + i for i, c in enumerate(cross.connections)}
    left, ahead = at["south", "west"], at["north", "south"]
    (turn,) = {int(met.turn[m]) for m in range(met.first[left], met.first[left + 1]) if met.partner[m] == ahead}
    assert turn == GIVE


@pytest.mark.parametrize(("height", "count"), [(0.0, 2), (1.0, 2), (5.0, 0)])
def test_on_a_bridge_one_meets_nobody_below(height, count):
    east, north = np.zeros((2, PATH_ROWS, 41))
    east[PATH_X], north[PATH_Y] = np.arange(41) - 20.0, np.arange(41) - 20.0
    north[PATH_HEIGHT] = height
    two = np.array([0, 41]), np.array([41, 41]), np.ones(2)
    where = network([lane(i, name, 0, each[[PATH_X, PATH_Y]]) for i, (name, each) in enumerate({"east": east, "north": north}.items())])
    assert len(list(meetings(where, Strands(np.concatenate([east, north], axis=1), *two, lanes=2), 0, 1))) == count
