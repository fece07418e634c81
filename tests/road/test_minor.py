"""`stop=minor` at the node where roads cross: the lesser ones stop; `stop=all`: everybody does."""

import pytest

from studio.road import load

LATITUDE, LONGITUDE = 52.5, 13.4


def crossing(draft, tmp_path, kinds, on_ways=None, **tags):
    """Streets to the north, east, south and west of a node with these tags, of some classes; a class that is missing, a street too. Some
    have tags of their own."""
    middle = draft.node(LATITUDE, LONGITUDE, **tags)
    steps = {"north": (0.0009, 0), "east": (0, 0.00148), "south": (-0.0009, 0), "west": (0, -0.00148)}
    for number, (arm, kind) in enumerate(kinds.items(), 1):
        north, east = steps[arm]
        draft.way(number, [draft.node(LATITUDE + north, LONGITUDE + east), middle], highway=kind, **(on_ways or {}).get(arm, {}))
    network = load(draft.write(tmp_path / "minor.osm"))
    arms = dict(enumerate(kinds, 1))
    return {
        arms[int(network.lanes[each.from_lane].road.lstrip("-"))]: each.right_of_way
        for each in network.connections
        if each.direction == "straight" or each.right_of_way in ("stop", "yield", "all_way_stop")
    }


@pytest.mark.parametrize(("sign", "key", "rule"), [("stop", "stop", "stop"), ("give_way", "give_way", "yield")])
def test_the_lesser_class_stops(draft, tmp_path, own_cache, sign, key, rule):
    kinds = {"north": "residential", "east": "secondary", "south": "residential", "west": "secondary"}
    found = crossing(draft, tmp_path, kinds, highway=sign, **{key: "minor"})
    assert found["north"] == found["south"] == rule
    assert {found["east"], found["west"]} & {"stop", "all_way_stop"} == set()


def test_of_three_alike_the_one_that_ends_stops(draft, tmp_path, own_cache):
    found = crossing(draft, tmp_path, {"north": "residential", "east": "residential", "west": "residential"}, highway="stop", stop="minor")
    assert found["north"] == "stop" and "stop" not in (found.get("east"), found.get("west"))


def test_where_all_stop_all_do(draft, tmp_path, own_cache):
    kinds = dict.fromkeys(("north", "east", "south", "west"), "residential")
    assert set(crossing(draft, tmp_path, kinds, highway="stop", stop="all").values()) == {"all_way_stop"}


# -- said of ways ----------------------------------------------------------------------------------

CROSS = {"north": "residential", "east": "secondary", "south": "residential", "west": "secondary"}


@pytest.mark.parametrize(("key", "rule"), [("stop", "stop"), ("give_way", "yield")])
def test_a_lesser_way_says_that_it_waits(draft, tmp_path, own_cache, key, rule):
    """Of three alike the one that ends; said of the one that goes straight on, it means nothing there."""
    kinds = {"north": "residential", "east": "residential", "west": "residential"}
    found = crossing(draft, tmp_path, kinds, {"north": {key: "minor"}, "east": {key: "minor"}})
    assert (
        found["north"] == rule and found["west"] in ("priority", "right_before_left") and found["east"] in ("priority", "right_before_left")
    )


def test_only_the_way_that_says_so_stops(draft, tmp_path, own_cache):
    found = crossing(draft, tmp_path, CROSS, {"north": {"stop": "minor"}, "east": {"stop": "minor"}})
    assert (found["north"], found["south"]) == ("stop", "yield") and "stop" not in (found["east"], found["west"])


def test_of_a_way_where_all_stop_all_do(draft, tmp_path, own_cache):
    assert set(crossing(draft, tmp_path, CROSS, {"north": {"stop": "all"}}).values()) == {"all_way_stop"}


def test_a_sign_at_the_junction_goes_before_what_a_way_says(draft, tmp_path, own_cache):
    kinds = dict.fromkeys(("north", "east", "south", "west"), "residential")
    assert set(crossing(draft, tmp_path, kinds, {"north": {"stop": "minor"}}, highway="stop", stop="all").values()) == {"all_way_stop"}


def test_where_a_way_only_goes_on_nobody_stops(draft, tmp_path, own_cache):
    found = crossing(draft, tmp_path, {"east": "residential", "west": "secondary"}, {"east": {"stop": "all"}, "west": {"stop": "minor"}})
    assert not {"stop", "yield", "all_way_stop"} & set(found.values())


@pytest.mark.parametrize("value", ["no", "yes", "both", ""])
def test_other_values_say_nothing_of_ways(draft, tmp_path, own_cache, value):
    assert crossing(draft, tmp_path, CROSS, {"north": {"stop": value}})["north"] == "yield"
