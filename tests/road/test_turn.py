"""Arrows on lanes: read, matched with roads, and put in the place of what netconvert guessed."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from studio.road import load
from studio.road.assembly import bend, cross_section, turn
from studio.road.formats import netconvert, osm
from studio.road.network.report import Notes
from studio.road.ways import route


def way(**tags):
    return osm.Way(1, [1, 2], [(0.0, 0.0), (0.001, 0.0)], {"highway": "primary", **{k.replace("__", ":"): v for k, v in tags.items()}})


def test_arrows_count_from_the_kerb():
    mapped = way(oneway="yes", turn__lanes="left|through|through;right")
    right = turn.arrows(mapped, forward=True, left_hand=False)
    assert right == (frozenset({"through", "right"}), frozenset({"through"}), frozenset({"left"}))
    assert turn.arrows(mapped, forward=True, left_hand=True) == right[::-1]
    assert turn.arrows(mapped, forward=False, left_hand=False) is None
    assert turn.arrows(way(turn__lanes="left|right"), forward=True, left_hand=False) is None  # of which direction?


def test_a_lane_for_bicycles_has_no_place_among_those_for_cars():
    """Reinhardtstraße in Berlin: yes|no|yes."""
    mapped = way(turn__lanes__forward="left;through|through|right", vehicle__lanes__forward="yes|no|yes")
    assert turn.arrows(mapped, forward=True, left_hand=False) == (frozenset({"right"}), frozenset({"left", "through"}))


@pytest.mark.parametrize(
    ("names", "turns", "expected"),
    [
        ({"left", "through", "right"}, {"a": 90, "b": 2, "c": -85}, {"left": "a", "through": "b", "right": "c"}),
        ({"left", "right"}, {"a": 20, "b": -25}, {"left": "a", "right": "b"}),  # a Y, however flat
        ({"through", "right"}, {"a": 30, "b": -40}, {"through": "a", "right": "b"}),
        ({"left", "through"}, {"a": 0, "b": -90}, {"through": "a"}),  # no road to the left
        ({"through", "slight_right", "right"}, {"a": 0, "b": -80}, {"through": "a", "slight_right": "b", "right": "b"}),
    ],
)
def test_arrows_and_roads_come_in_the_same_order(names, turns, expected):
    assert turn.matched(names, turns) == expected


def test_two_roads_behind_one_arrow():
    turns = {"a": 135.0, "b": 60.0, "c": -90.0}
    meant = turn.matched({"left", "right"}, turns)
    assert meant == {"left": "b", "right": "c"} and turn.besides(meant, turns) == {"left": {"a"}}


@pytest.fixture
def crossing(draft, tmp_path):
    """Four arms; the one from the south has three lanes with arrows that netconvert would not guess."""
    middle = draft.node(52.5, 13.4)
    south, north = draft.node(52.499, 13.4), draft.node(52.501, 13.4)
    west, east = draft.node(52.5, 13.3985), draft.node(52.5, 13.4015)
    draft.way(1, [south, middle], highway="primary", oneway="yes", lanes=3, turn__lanes="left|left;through|right")
    draft.way(2, [middle, north], highway="primary", oneway="yes", lanes=2)
    draft.way(3, [west, middle], highway="primary", lanes=4)
    draft.way(4, [middle, east], highway="primary", lanes=4)
    return draft.write(tmp_path / "crossing.osm")


def leads(network):
    """For every lane from the south the directions it leads to, the kerb lane first."""
    road = network.roads["1"]
    return [{c.direction for c in network.connections if c.from_lane == lane and c.direction != "turn"} for lane in road.lanes]


def test_lanes_lead_where_their_arrows_say(crossing, own_cache):
    built = load(crossing)
    assert leads(built) == [{"right"}, {"left", "straight"}, {"left"}]
    assert (built.report.turn_lanes.tagged_lanes, built.report.turn_lanes.matching) == (3, 3)


@pytest.fixture
def net(crossing):
    """What netconvert makes of the crossing, and its ways and box."""
    found = osm.survey(crossing, osm.read(crossing))
    box = osm.clip_box(found, radius=None)
    clean = osm.clean_xml(found, bend.rounded(found.ways, box, itertools.count(10**15)))
    return netconvert.convert(clean, box.projection, source=crossing), found.ways, box


def test_wrong_connections_are_mended_and_stay_smooth(net):
    """Every lane from the south is led to the right: all arrows are honoured again, over ways without a gap or a corner."""
    made, ways, box = net
    south = set(made.roads["1"].lanes)
    right = next(c for c in made.connections if c.from_lane in south and c.direction == "right")
    others = [c for c in made.connections if c.from_lane not in south]
    targets = {made.lanes[c.to_lane].road for c in made.connections if c.from_lane in south and c.direction != "turn"}
    # every road stays reachable, each from the wrong lane
    wrong = [replace(c, from_lane=made.roads["1"].lanes[0]) for c in made.connections if c.from_lane in south]
    broken = replace(made, connections=(*others, right, *wrong))
    found = turn.forks(broken, ways, box, Notes(), left_hand=False)
    assert turn.count(broken, found).matching == 0
    mended = turn.mended(broken, found, left_hand=False)
    assert turn.count(mended, found) == turn.TurnCount(3, 3)
    assert {mended.lanes[c.to_lane].road for c in mended.connections if c.from_lane in south} >= targets
    for number, lane in enumerate(mended.lanes):
        assert lane.id == number and mended.roads[lane.road].lanes[lane.index] == number
    new = [each for each in mended.connections if each.via[0] >= len(made.lanes)]
    assert len(new) == 3
    for each in new:
        chain = [mended.lanes[i].centre for i in (each.from_lane, *each.via, each.to_lane)]
        for before, after in itertools.pairwise(chain):
            assert before[:, -1] == pytest.approx(after[:, 0], abs=1e-9)
            assert bend.angle(before[:, -1] - before[:, -2], after[:, 1] - after[:, 0]) < np.radians(
                8.0
            )  # a quarter circle in a dozen pieces


def test_numbers_of_lanes_that_differ_are_told(draft, tmp_path, own_cache):
    a, b, c, d = draft.node(52.499, 13.4), draft.node(52.5, 13.4), draft.node(52.501, 13.4), draft.node(52.5, 13.402)
    draft.way(1, [a, b], highway="primary", oneway="yes", lanes=2, turn__lanes="left|through|through|right")
    draft.way(2, [b, c], highway="primary", oneway="yes", lanes=2)
    draft.way(3, [b, d], highway="primary", oneway="yes", lanes=1)
    built = load(draft.write(tmp_path / "differ.osm"))
    assert (built.report.turn_lanes.tagged_lanes, built.report.turn_lanes.matching) == (4, 0)
    assert any(each.kind == "turn lanes" and "4 lanes, 2" in each.what for each in built.report.skipped)


# -- widths and bus lanes --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tags", "width"),
    [
        ({"lanes": "2", "width": "6.5"}, "6.50"),
        ({"lanes": "1", "oneway": "yes", "width": "8,4 m"}, "4.50"),  # with the parked cars
        ({"width": "3.2"}, "5.00"),  # two directions on 3.2 m
        ({"width": "wide"}, None),
        ({}, None),
    ],
)
def test_lanes_are_as_wide_as_lanes_can_be(tags, width):
    notes = Notes()
    mended = cross_section.mended(way(**tags), notes, left_hand=False)
    assert mended.tags.get("width") == width
    assert len(notes.guesses) + len(notes.skipped) == (0 if width in (None, "6.50") and tags.get("width") != "wide" else 1)


def test_bus_lanes_lie_at_the_kerb():
    tags = {"oneway": "yes", "lanes": "3", "lanes__psv": "1"}
    assert cross_section.mended(way(**tags), Notes(), left_hand=False).tags["bus:lanes"] == "yes|yes|designated"
    assert cross_section.mended(way(**tags), Notes(), left_hand=True).tags["bus:lanes"] == "designated|yes|yes"
    for other in ({"lanes__psv__conditional": "1 @ (Mo-Fr)"}, {"bus__lanes": "designated|yes|yes"}, {"lanes": "1"}):
        same = way(**{**tags, **other})
        assert cross_section.mended(same, Notes(), left_hand=False) == same


def test_cars_keep_out_of_bus_lanes_unless_nothing_else_leads_on(draft, tmp_path, own_cache):
    """Along a street with a bus lane at the kerb; then the only way on begins at its kerb lane."""
    nodes = [draft.node(52.5, 13.4 + 0.003 * i) for i in range(3)]
    draft.way(1, nodes[:2], highway="primary", oneway="yes", lanes=2, lanes__psv=1)
    draft.way(2, nodes[1:], highway="primary", oneway="yes", lanes=2, lanes__psv=1, maxspeed=30)
    built = load(draft.write(tmp_path / "bus.osm"))
    roads = [road.id for road in built.roads.values() if not road.internal]
    assert [[lane.open for lane in built.lanes_of(road)] for road in roads] == [[False, True]] * len(roads)
    used = [built.lanes[lane] for lane in route.connect(built, sorted(roads)).lanes]
    assert used and all(lane.open for lane in used)
    begun = [built.lanes[lane] for lane in route.connect(built, sorted(roads), start_lane=0).lanes]
    assert not begun[0].open and sum(not lane.open for lane in begun if not lane.internal) == 1
    assert any(each.kind == "closed lane" for each in built.report.skipped)
