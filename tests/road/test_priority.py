"""Who goes first: the rules of the road on small maps, and on real ones."""

from pathlib import Path

import numpy as np
import pytest

from studio.road import load
from studio.road.network import RIGHTS
from tests.conftest import ROOT

MAPS = Path(__file__).parents[1] / "reference" / "maps"
METRE = 1.0 / 111_194.9  # [deg] of latitude on a sphere of 6371 km
BERLIN, PERTH, TOKYO = (52.5, 13.4), (-31.98, 115.9), (35.69, 139.7)
ARMS = {arm: np.array(way) for arm, way in {"south": (0, -1), "north": (0, 1), "west": (-1, 0), "east": (1, 0)}.items()}
RIGHT_OF = {"south": "east", "east": "north", "north": "west", "west": "south"}  # who comes from the right of one from there
AHEAD = {"south": "north", "north": "south", "east": "west", "west": "east"}


def place_at(centre, x, y):
    return centre[0] + y * METRE, centre[1] + x * METRE / np.cos(np.radians(centre[0]))


def crossing(draft, centre, *, classes=None, sign=None, reach=120, **tags):
    """Four streets that meet; the sign stands 15 m before the crossing on the one from the south."""
    middle = draft.node(*place_at(centre, 0, 0))
    for number, (arm, (x, y)) in enumerate(ARMS.items(), start=1):
        end = draft.node(*place_at(centre, reach * x, reach * y))
        between = draft.node(*place_at(centre, 15 * x, 15 * y), **(sign or {})) if arm == "south" else None
        nodes = [end, between, middle] if between else [end, middle]
        draft.way(number, nodes, highway=(classes or {}).get(arm, "residential"), **tags)
    return draft


def arms_of(network, connection):
    """From which arm a connection comes and to which it goes."""
    first, last = (network.lanes[lane].centre for lane in (connection.from_lane, connection.to_lane))
    return tuple(max(ARMS, key=lambda arm: ARMS[arm] @ point) for point in (first[:, 0], last[:, -1]))


def first_ones(network, connection):
    return {arms_of(network, network.connections[j]) for j in connection.yields}


def through(network):
    return [c for c in network.connections if c.direction != "turn" and arms_of(network, c)[0] != arms_of(network, c)[1]]


@pytest.mark.parametrize(("centre", "rule"), [(BERLIN, "right_before_left"), (PERTH, "right_before_left"), (TOKYO, "left_before_right")])
def test_equal_streets(draft, tmp_path, own_cache, centre, rule):
    """From the right, or in Japan the left; who turns across lets those from ahead go. The same table for all sides."""
    network = load(crossing(draft, centre).write(tmp_path / "cross.osm"))
    assert len(through(network)) == 12
    met = 0
    for connection in through(network):
        start, end = arms_of(network, connection)
        side = RIGHT_OF[start] if rule == "right_before_left" else AHEAD[RIGHT_OF[start]]
        if connection.right_of_way == "priority":
            assert not connection.yields
            continue
        assert connection.right_of_way == rule
        across = end == (AHEAD[RIGHT_OF[start]] if network.drive_side == "right" else RIGHT_OF[start])
        for other, _ in first_ones(network, connection):
            assert other == side or (across and other == AHEAD[start])
            met += 1
    assert met >= 16


def test_our_rule_for_equal_streets_is_netconverts(draft, tmp_path, own_cache, monkeypatch):
    """netconvert knows the rule where one drives on the right: the same answers from two programs."""
    path = crossing(draft, BERLIN).write(tmp_path / "cross.osm")
    ours = [c.yields for c in load(path).connections]
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path / "other"))
    monkeypatch.setattr("studio.road.assembly.priority.Ground.is_equal", lambda self, i: False)
    theirs = [c.yields for c in load(path).connections]
    assert ours == theirs and any(ours)


def test_the_greater_road_goes_first(draft, tmp_path, own_cache):
    classes = {"west": "secondary", "east": "secondary"}
    network = load(crossing(draft, BERLIN, classes=classes).write(tmp_path / "cross.osm"))
    for connection in through(network):
        start, end = arms_of(network, connection)
        if start in ("west", "east") and end != AHEAD[RIGHT_OF[start]]:  # the major road, not turning left
            assert connection.right_of_way == "priority" and not connection.yields
        elif end == AHEAD[start]:
            assert connection.right_of_way == "yield"
            assert {"west", "east"} <= {other for other, _ in first_ones(network, connection)}


@pytest.mark.parametrize(("sign", "rule"), [
    ({"highway": "give_way"}, "yield"), ({"highway": "stop"}, "stop"), ({"highway": "stop", "stop": "all"}, "all_way_stop"),
])  # fmt: skip
def test_a_sign_lets_the_others_go_first(draft, tmp_path, own_cache, sign, rule):
    network = load(crossing(draft, BERLIN, sign=sign).write(tmp_path / "cross.osm"))
    for connection in through(network):
        start, _ = arms_of(network, connection)
        if start == "south" and connection.yields:
            assert connection.right_of_way == rule
        if start != "south":
            assert "south" not in {other for other, _ in first_ones(network, connection)}
    straight = next(c for c in through(network) if arms_of(network, c) == ("south", "north"))
    assert {"west", "east"} <= {other for other, _ in first_ones(network, straight)}


def test_a_sign_the_other_way_does_not_count(draft, tmp_path, own_cache):
    sign = {"highway": "stop", "direction": "backward"}  # the way runs from the south to the crossing
    network = load(crossing(draft, BERLIN, sign=sign).write(tmp_path / "cross.osm"))
    assert not [c for c in network.connections if c.right_of_way == "stop"]


def test_two_lanes_that_become_one_go_in_turn():
    """Of a place where that happens: an exit in Seattle. Each of the two waits for the other, if that one came first."""
    network = load(MAPS / "seattle_i5_exit_ramp.osm.gz")
    merging = [i for i, each in enumerate(network.connections) if each.right_of_way == "zipper"]
    assert len(merging) == 2
    assert [network.connections[i].yields for i in merging] == [(merging[1],), (merging[0],)]
    assert len({network.connections[i].to_lane for i in merging}) == 1


@pytest.mark.parametrize("name", ["perth_peanut_roundabout_lht.osm.gz", "munich_olympiapark.osm.gz", "singapore_bayfront_lht.osm.pbf"])
def test_nobody_waits_for_one_who_waits_for_him(name):
    """Two that meet never both wait, but in turn, and never both go."""
    network = load(MAPS / name)
    assert {c.right_of_way for c in network.connections} <= set(RIGHTS)
    for i, connection in enumerate(network.connections):
        for j in connection.yields:
            other = network.connections[j]
            same_road = network.lanes[connection.from_lane].road == network.lanes[other.from_lane].road
            assert same_road or i not in other.yields


@pytest.mark.parametrize(("minor", "major", "waits"), [(20, 30, False), (30, 100, True), (20, None, True), (None, 30, True)])
def test_lights_go_before_a_sign_right_behind_them(draft, tmp_path, own_cache, minor, major, waits):
    """A small street joins a great one, each with a light so far [m] before that. Where one holds whom the other lets go, nobody waits
    again behind it; he does where one of them has none, or where it is too far to know of the other."""
    light = {"highway": "traffic_signals"}
    south, north, west, east, middle = (draft.node(*place_at(BERLIN, x, y)) for x, y in ((0, -150), (0, 150), (-150, 0), (150, 0), (0, 0)))
    lights = [draft.node(*place_at(BERLIN, 0, -minor), **light)] if minor else []
    draft.way(1, [south, *lights, middle, north], highway="residential", oneway="yes")
    lights = [draft.node(*place_at(BERLIN, -major, 0), **light)] if major else []
    draft.way(2, [west, *lights, middle, east], highway="secondary", oneway="yes")
    network = load(draft.write(tmp_path / "joined.osm"))
    small = [c for c in network.connections if {network.lanes[lane].road[0] for lane in (c.from_lane, c.to_lane)} == {"1"}]
    straight = next(c for c in small if c.link < 0)
    assert bool(straight.yields) == waits == (straight.right_of_way == "yield")


def test_on_a_ring_with_lights_nobody_waits_for_whom_they_hold():
    """At the Großer Stern every way onto the ring and along it has its light, 5 to 40 m before it meets another."""
    network = load(ROOT / "scenarios" / "maps" / "berlin_siegessaeule_grosser_stern.osm.gz")
    assert {c.right_of_way for c in network.connections} == {"signal", "priority"}
    assert not any(c.yields for c in network.connections)


def test_the_ring_goes_first():
    network = load(MAPS / "perth_peanut_roundabout_lht.osm.gz")
    entering = [c for c in network.connections if c.right_of_way == "roundabout"]
    assert len(entering) >= 4
    for connection in entering:
        assert connection.yields
        assert all(network.connections[j].right_of_way in ("priority", "signal") for j in connection.yields)
