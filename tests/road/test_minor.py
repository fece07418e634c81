"""`stop=minor` at the node where roads cross: the lesser ones stop; `stop=all`: everybody does."""

import pytest

from studio.road import load

LATITUDE, LONGITUDE = 52.5, 13.4


def crossing(draft, tmp_path, kinds, **tags):
    """Streets to the north, east, south and west of a node with these tags, of some classes; a class that is missing, a street too."""
    middle = draft.node(LATITUDE, LONGITUDE, **tags)
    steps = {"north": (0.0009, 0), "east": (0, 0.00148), "south": (-0.0009, 0), "west": (0, -0.00148)}
    for number, (arm, kind) in enumerate(kinds.items(), 1):
        north, east = steps[arm]
        draft.way(number, [draft.node(LATITUDE + north, LONGITUDE + east), middle], highway=kind)
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
