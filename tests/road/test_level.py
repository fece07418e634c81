"""Levels: who crosses on another level is not met; who leads to the same junction is."""

import numpy as np
import pytest

from studio.road import load
from studio.road.ways.meeting import meetings_of
from studio.road.ways.strand import strands_of

LATITUDE, LONGITUDE = 52.5, 13.4
STEP_NORTH, STEP_EAST = 0.0009, 0.00148  # [deg] about 100 m


@pytest.fixture(autouse=True)
def cache(own_cache):
    return own_cache


def crossing(draft, tmp_path, over, under):
    """A street to the east and one to the north that cross in the middle of their ways, without a node of both."""
    west, east = (draft.node(LATITUDE, LONGITUDE + i * STEP_EAST) for i in (-2, 2))
    south, north = (draft.node(LATITUDE + i * STEP_NORTH, LONGITUDE) for i in (-2, 2))
    draft.way(1, [west, east], highway="primary", oneway="yes", lanes=1, **over)
    draft.way(2, [south, north], highway="primary", oneway="yes", lanes=1, **under)
    return load(draft.write(tmp_path / "crossing.osm"))


def met(network):
    """Pairs of roads whose lanes meet."""
    found, strands = meetings_of(network), strands_of(network)
    own = np.repeat(np.arange(strands.count.size), np.diff(found.first))
    pairs = [(a, b) for a, b in zip(own.tolist(), found.partner.tolist(), strict=True) if max(a, b) < strands.lanes]
    return {frozenset(network.lanes[lane].road for lane in pair) for pair in pairs}


@pytest.mark.parametrize(("over", "under"), [
    ({"bridge": "yes"}, {}), ({"bridge": "yes", "layer": "1"}, {}), ({}, {"tunnel": "yes"}), ({"layer": "2"}, {"layer": "1"}),
    ({"bridge": "viaduct"}, {"layer": "-1"}), ({"layer": "0"}, {"tunnel": "yes", "layer": "-1"}),
])  # fmt: skip
def test_who_crosses_on_another_level_is_not_met(draft, tmp_path, over, under):
    assert not met(crossing(draft, tmp_path, over, under))


@pytest.mark.parametrize(("over", "under"), [
    ({}, {}), ({"bridge": "no"}, {}), ({"layer": "1"}, {"layer": "1"}), ({"layer": "high"}, {}), ({"bridge": "yes", "layer": "0"}, {}),
])  # fmt: skip
def test_who_crosses_on_the_same_level_is(draft, tmp_path, over, under):
    assert met(crossing(draft, tmp_path, over, under)) == {frozenset({"1", "2"})}


def test_who_comes_off_a_bridge_meets_whom_he_joins(draft, tmp_path):
    """A bridge ends where a street on the ground joins: both lead into one lane."""
    nodes = [draft.node(LATITUDE, LONGITUDE + i * STEP_EAST) for i in (-2, 0, 2)]
    south = draft.node(LATITUDE - STEP_NORTH, LONGITUDE - 0.3 * STEP_EAST)
    draft.way(1, nodes[:2], highway="primary", oneway="yes", lanes=1, bridge="yes")
    draft.way(2, nodes[1:], highway="primary", oneway="yes", lanes=1)
    draft.way(3, [south, nodes[1]], highway="residential", oneway="yes", lanes=1)
    network = load(draft.write(tmp_path / "ramp.osm"))
    assert any(each.yields for each in network.connections)
    assert meetings_of(network).partner.size > 0


def test_a_lane_that_climbs_onto_a_bridge_knows_where(draft, tmp_path):
    """netconvert makes one road of two ways that just go on: each place has the level of its way."""
    nodes = [draft.node(LATITUDE, LONGITUDE + i * STEP_EAST) for i in (-2, 0, 2)]
    draft.way(1, nodes[:2], highway="primary", oneway="yes", lanes=1)
    draft.way(2, nodes[1:], highway="primary", oneway="yes", lanes=1, bridge="yes")
    network = load(draft.write(tmp_path / "bridge.osm"))
    for lane in network.lanes:
        if lane.level.size and not lane.internal:
            east = lane.centre[0]
            assert set(lane.level[east < east.max() - 210.0]) <= {0.0} and set(lane.level[east > east.max() - 190.0]) == {1.0}
    assert any(lane.level.size and lane.level.max() == 1.0 for lane in network.lanes)
