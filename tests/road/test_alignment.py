"""Lanes are curves that a car can follow: they meet without a kink, and a mapped corner is no reason to brake."""

import itertools

import numpy as np
import pytest

from studio.road import load
from studio.road.assembly import alignment
from studio.road.assembly.alignment import COMFORT, MOST_SETBACK, SHARPEST, STEADY
from studio.road.network import curve

METRE = 1.0 / 111_194.9  # [deg] of latitude on a sphere of 6371 km


def heading(line):
    return np.unwrap(np.arctan2(*np.diff(line)[::-1]))


@pytest.mark.parametrize("theta", np.radians([20, 60, 90, 130]))
def test_a_bow_turns_by_its_angle_between_equal_legs(theta):
    line = alignment.bow(theta)
    assert heading(line)[-1] == pytest.approx(theta, abs=0.01)
    leg = alignment.legs(line)
    corner = np.array([leg, 0.0])
    assert np.hypot(*(line[:, -1] - corner)) == pytest.approx(leg, rel=0.01)
    assert curve.curvature(line)[2:-2].max() == pytest.approx(1.0, rel=0.02)


def test_an_arc_without_transitions_would_need_less_room(monkeypatch):
    """Closed form: an arc of radius 1 starts tan(theta / 2) before the corner."""
    monkeypatch.setattr(alignment, "EASED", 1e-3)
    assert alignment.legs(alignment.bow(np.pi / 2)) == pytest.approx(1.0, rel=0.02)


@pytest.mark.parametrize("theta", np.radians([20, 60, 90]))
def test_the_curvature_of_the_gentlest_bow_grows_steadily(theta):
    line = alignment.bow(theta) / alignment.gentlest(theta)
    kappa = np.gradient(heading(line), curve.length(line) / 60)
    assert np.abs(np.gradient(kappa, curve.length(line) / 60))[3:-3].max() < 1.15 * STEADY


def test_a_quintic_takes_over_place_direction_and_curvature():
    u = np.linspace(0.0, 1.0, 20_000)
    p, q = np.array([1.0, 2.0]), np.array([9.0, 8.0])
    start, end = (np.array([1.0, 0.0]), 0.05), (np.array([0.0, 1.0]), -0.03)
    for line in alignment.quintics(u, p, start, q, end, np.array([8.0, 12.0])):
        assert line[:, 0] == pytest.approx(p) and line[:, -1] == pytest.approx(q)
        assert heading(line)[[0, -1]] == pytest.approx([0.0, np.pi / 2], abs=0.01)
        kappa = np.gradient(heading(line)) / np.hypot(*np.diff(line))
        assert kappa[[9, -10]] == pytest.approx([0.05, -0.03], abs=0.01)


def test_room_that_a_right_angle_lacks():
    """From (0, 0) east, then north: with legs of 3 and 20 m only the first is too short."""
    needs = alignment.legs(alignment.bow(np.pi / 2)) / alignment.gentlest(np.pi / 2)
    east, north = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    before, behind = alignment.lacking(np.zeros(2), east, np.array([3.0, 20.0]), north)
    assert before == pytest.approx(needs - 3.0) and behind == 0.0


def road(draft, corner, limit):
    """Two straights of 120 m with a corner between them [rad]."""
    a = draft.node(52.0, 13.0)
    east = METRE / np.cos(np.radians(52.0))
    b = draft.node(52.0, 13.0 + 120 * east)
    c = draft.node(52.0 + 120 * np.sin(corner) * METRE, 13.0 + (120 + 120 * np.cos(corner)) * east)
    draft.way(1, [a, b, c], highway="secondary", maxspeed=str(limit), oneway="yes", lanes="1")
    return draft


@pytest.mark.parametrize(("degrees", "limit"), [(5, 100), (10, 70), (20, 50), (30, 40)])
def test_a_mapped_corner_is_no_reason_to_brake(draft, tmp_path, own_cache, degrees, limit):
    network = load(road(draft, np.radians(degrees), limit).write(tmp_path / "corner.osm"))
    lanes = [lane for lane in network.lanes if not lane.internal]
    assert sum(lane.length for lane in lanes) > 200
    for lane in lanes:
        assert lane.speed == pytest.approx(limit / 3.6, abs=0.01)
        assert curve.curvature(lane.centre).max() * lane.speed**2 <= COMFORT


def test_a_turn_has_the_room_of_a_car(draft, tmp_path, own_cache):
    """A crossing of two streets with a lane each way: all turns by a right angle stay within a car's reach."""
    east = METRE / np.cos(np.radians(52.0))
    middle = draft.node(52.0, 13.0)
    ends = [draft.node(52.0 + 100 * dy * METRE, 13.0 + 100 * dx * east) for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1))]
    draft.way(1, [ends[0], middle, ends[1]], highway="residential")
    draft.way(2, [ends[2], middle, ends[3]], highway="residential")
    network = load(draft.write(tmp_path / "cross.osm"))
    turns = [c for c in network.connections if c.direction in ("left", "right")]
    assert len(turns) == 8
    for turn in turns:
        line = np.concatenate([network.lanes[via].centre for via in turn.via], axis=1)
        line = alignment.without_doubles(line)
        assert curve.curvature(curve.resampled(line, 0.5)).max() < 1.1 * SHARPEST
    assert min(lane.length for lane in network.lanes if not lane.internal) > 100 - 12 - MOST_SETBACK


def test_lanes_meet_without_a_gap_or_a_kink(place):
    """Where both are long enough to have a direction."""
    for connection in place.connections:
        order = [place.lanes[lane] for lane in (connection.from_lane, *connection.via, connection.to_lane)]
        for a, b in itertools.pairwise(order):
            assert np.hypot(*(b.centre[:, 0] - a.centre[:, -1])) < 1e-6
            assert alignment.turned(a.centre[:, -1] - a.centre[:, -2], b.centre[:, 1] - b.centre[:, 0]) < np.radians(4.0)


def test_lanes_keep_their_order_across_a_road(place):
    """Though every lane is smoothed alone."""
    for each in place.roads.values():
        lanes = place.lanes_of(each.id)
        for inner, outer in itertools.pairwise(lanes):
            if not each.internal and inner.length > 5.0:
                apart = curve.distances(inner.centre, outer.centre)
                assert apart.min() > 0.8 * inner.width and apart.max() < 1.6 * inner.width + 1.0
