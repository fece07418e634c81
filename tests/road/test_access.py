"""OpenStreetMap: who may drive where and in which direction, what is forbidden, who goes first; what is not used of it is told."""

import pytest

from studio import job
from studio.errors import MapError
from studio.road import load
from studio.road.formats.access import closed, is_open, one_way
from studio.road.formats.turn_rule import excepts_cars, kind_of, reason
from studio.road.library import folder, intake
from studio.road.ways.route import connect
from tests.road.plot import ILLINOIS, LONDON, cross, guessed, plot, skipped, straight, turns


def built(network):
    """The ways that roads lead along, and how many lanes each direction has."""
    return {name: len(road.lanes) for name, road in network.roads.items() if not road.internal}


# -- who may drive ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tags", "told"),
    [
        ({"motor_vehicle": "permit"}, "motor_vehicle=permit"), ({"access": "no", "motor_vehicle": "delivery"}, "motor_vehicle=delivery"),
        ({"access": "customers"}, "access=customers"), ({"access": "military"}, "access=military"), ({"motor_vehicle": "bus"}, "bus"),
        ({"vehicle": "psv"}, "vehicle=psv"), ({"motorcar": "residents"}, "residents"), ({"access": "private;customers"}, "private"),
        ({"access": "yes", "motorcar": "no"}, "motorcar=no"), ({"vehicle:forward": "no", "vehicle:backward": "no"}, "vehicle:forward=no"),
        ({"oneway": "yes", "motor_vehicle:forward": "private"}, "motor_vehicle:forward=private"),
    ],
)  # fmt: skip
def test_who_may_not_drive_there_finds_no_road_and_a_word(tmp_path, own_cache, tags, told):
    network = load(straight(tmp_path / "map.osm", {}, tags))
    assert set(built(network)) == {"11", "-11"}
    (line,) = [line for line in skipped(network) if "closed way" in line]
    assert told in line and "way 12" in line


@pytest.mark.parametrize(
    ("tags", "told"),
    [
        ({"access": "no", "motor_vehicle": "yes"}, ""), ({"access": "no", "motorcar": "designated"}, ""), ({"access": "permissive"}, ""),
        ({"motor_vehicle": "destination"}, "access: motor_vehicle=destination"), ({"access": "yess"}, "access: access=yess"),
        ({"vehicle": "no;destination"}, "access: vehicle=no;destination"), ({"access": "private", "vehicle": "yes"}, ""),
    ],
)  # fmt: skip
def test_who_may_drive_there_finds_one(tmp_path, own_cache, tags, told):
    network = load(straight(tmp_path / "map.osm", {}, tags))
    assert len({name.lstrip("-") for name in built(network)} | set()) >= 1 and "closed way" not in " ".join(skipped(network))
    assert connect(network, [max(built(network))]) and bool(told) == any(told in line for line in skipped(network) if told)


@pytest.mark.parametrize(
    ("tags", "east", "west"),
    [
        ({"access:lanes:forward": "no"}, 0, 1), ({"lanes": "4", "vehicle:lanes:backward": "no|bus"}, 2, 0),
        ({"lanes": "4", "access:lanes:forward": "no|yes"}, 2, 2),
        ({"motor_vehicle:backward": "no"}, 1, 0), ({"vehicle:forward": "no"}, 0, 1), ({"access:backward": "private"}, 1, 0),
        ({"motorcar:forward": "no", "lanes": "3", "lanes:forward": "1", "lanes:backward": "2"}, 0, 2),
        ({"vehicle:backward": "no", "motorcar:backward": "yes"}, 1, 1), ({"access": "no", "motor_vehicle:forward": "yes"}, 1, 0),
        ({"oneway": "-1", "lanes": "2"}, 0, 2), ({"oneway": "reverse"}, 0, 1), ({"oneway": "yes", "oneway:motorcar": "no"}, 1, 1),
        ({"oneway": "no", "oneway:motor_vehicle": "yes"}, 1, 0), ({"oneway": "true"}, 1, 0), ({"oneway": "0"}, 1, 1),
        ({"oneway": "yes", "vehicle:backward": "no"}, 1, 0),
    ],
)  # fmt: skip
def test_only_open_directions_are_built(tmp_path, own_cache, tags, east, west):
    """How many lanes lead east and west on a way that was drawn eastwards."""
    lanes = {} if "lanes" in tags else {"lanes": ""}
    network = load(straight(tmp_path / "map.osm", tags | lanes))
    found = [lane.centre[0, -1] > lane.centre[0, 0] for lane in network.lanes if not lane.internal]
    assert (found.count(True), found.count(False)) == (east, west)


def test_arrows_of_a_way_against_its_drawing(tmp_path, own_cache):
    """oneway=-1: the arrows are those of the direction in which one drives, from its left to its right."""
    nodes = {1: (0, 0), 2: (200, 0), 3: (0, 200), 4: (0, -200)}
    one = {"oneway": "yes", "lanes": "1"}
    ways = {11: ([1, 2], {"oneway": "-1", "lanes": "2", "turn:lanes": "left|right"}), 12: ([1, 3], one), 13: ([1, 4], one)}
    network = load(plot(tmp_path / "map.osm", nodes, ways))
    found = {(network.lanes[c.from_lane].index, network.lanes[c.to_lane].centre[1, -1] > 0) for c in network.connections}
    assert found == {(0, True), (1, False)} and network.report.turn_lanes.matching == network.report.turn_lanes.tagged_lanes == 2


def test_values_and_directions_of_access():
    assert closed({"access": "no", "motorcar": "yes"}) == "" and closed({"access": "no", "bicycle": "yes"}) == "access=no"
    assert closed({"motor_vehicle": "yes", "motor_vehicle:backward": "no"}, ":forward") == "" and is_open("private;yes")
    assert closed({"motor_vehicle": "yes", "access:backward": "no"}, ":backward") == ""  # the more exact key counts
    assert [one_way({"oneway": value}) for value in ("1", "0", "reverse", "-1", "reversible")] == ["yes", "no", "-1", "-1", "reversible"]


# -- lanes and directions --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tags", "each"),
    [
        ({"lanes": "3", "lanes:forward": "1", "lanes:backward": "1", "lanes:both_ways": "1", "turn:lanes:both_ways": "left"}, 1),
        ({"lanes": "5", "lanes:both_ways": "1", "turn:lanes:both_ways": "left"}, 2),
        ({"lanes": "3", "lanes:both_ways": "1"}, 1), ({"lanes": "5", "lanes:reversible": "1"}, 2),
        ({"lanes": "4", "lanes:forward": "1", "lanes:backward": "2", "lanes:both_ways": "1"}, None),
    ],
)  # fmt: skip
def test_a_lane_of_both_directions_is_no_through_lane(tmp_path, own_cache, tags, each):
    network = load(straight(tmp_path / "map.osm", tags, centre=ILLINOIS))
    assert built(network) == ({"11": each, "-11": each} if each else {"11": 1, "-11": 2})
    assert any("lanes of both directions are not built" in line and "way 11" in line for line in skipped(network))


@pytest.mark.parametrize("tags", [{"lanes": "1"}, {"lanes": "1", "width": "3"}, {"lanes": "1", "oneway": "alternating"},
                                  {"lanes": "1", "oneway": "no", "width": "4.5"}])  # fmt: skip
def test_one_lane_for_both_directions_is_passed_one_after_the_other(tmp_path, own_cache, tags):
    """Where it begins and ends there is room for two cars, and the report says so."""
    network = load(straight(tmp_path / "map.osm", tags))
    east, west = (network.lanes_of(name)[0] for name in ("11", "-11"))
    assert abs(east.centre[1, 0] - west.centre[1, -1]) >= (east.width + west.width) / 2 - 0.01 and min(east.width, west.width) >= 2.5
    assert (east.facing, west.facing) == (west.id, east.id)
    assert any("one lane: passed one after the other on" in line and "way 11" in line for line in guessed(network))


def test_a_reversible_road_is_driven_one_way(tmp_path, own_cache):
    network = load(straight(tmp_path / "map.osm", {"oneway": "reversible", "lanes": "2"}))
    assert built(network) == {"11": 2} and any("oneway=reversible" in line for line in skipped(network))


# -- turns -----------------------------------------------------------------------------------------


def restriction(tags, members=(("way", 11, "from"), ("node", 1, "via"), ("way", 14, "to"))):
    return {21: (members, tags)}


@pytest.mark.parametrize(
    ("tags", "left"),
    [
        ({"restriction": "no_left_turn", "except": "motorcar"}, True), ({"restriction": "no_left_turn", "except": "psv"}, False),
        ({"restriction": "no_left_turn", "except": "bicycle;motor_vehicle"}, True), ({"restriction:hgv": "no_left_turn"}, True),
        ({"restriction:motorcar": "no_left_turn"}, False), ({"restriction": "only_straight_on", "except": "bus;taxi"}, None),
    ],
)  # fmt: skip
def test_for_whom_a_turn_is_forbidden(tmp_path, own_cache, tags, left):
    members = restriction(tags)[21][0] if left is not None else (("way", 11, "from"), ("node", 1, "via"), ("way", 12, "to"))
    network = load(cross(tmp_path / "map.osm", relations=restriction(tags, members)))
    assert ("11", "14") in turns(network) if left else ("11", "14") not in turns(network)
    assert ("11", "12") in turns(network) and not any("turn restriction" in line for line in skipped(network))


@pytest.mark.parametrize(
    ("tags", "told"),
    [
        ({"restriction:conditional": "no_left_turn @ (Mo-Fr 07:00-09:00)"}, "do not change with time"),
        ({"restriction:motorcar:conditional": "no_left_turn @ (wet)"}, "do not change with time"),
        ({"restriction": "no_left_turn", "hour_on": "07:00", "hour_off": "09:00"}, "do not change with time"),
        ({"restriction": "no_lefts"}, "is no kind of restriction"), ({}, "is no kind of restriction"),
        ({"type": "restriction:bus", "restriction": "no_left_turn"}, "other vehicles"),
        ({"type": "connectivity", "connectivity": "1:1"}, "lanes lead where their arrows say"),
    ],
)  # fmt: skip
def test_a_restriction_that_is_not_kept_to_is_told(tmp_path, own_cache, tags, told):
    network = load(cross(tmp_path / "map.osm", relations=restriction(tags)))
    assert ("11", "14") in turns(network)
    assert any(told in line and "relation 21" in line for line in skipped(network))


@pytest.mark.parametrize("missing", ["from", "via", "to"])
def test_a_restriction_that_lacks_a_member_is_told(tmp_path, own_cache, missing):
    members = [each for each in restriction({})[21][0] if each[2] != missing]
    network = load(cross(tmp_path / "map.osm", relations=restriction({"restriction": "no_left_turn"}, members)))
    assert ("11", "14") in turns(network)
    assert any("its members are not two roads" in line for line in skipped(network))


def test_no_entry_may_be_from_several_roads(tmp_path, own_cache):
    members = (("way", 11, "from"), ("way", 13, "from"), ("node", 1, "via"), ("way", 14, "to"))
    network = load(cross(tmp_path / "map.osm", relations=restriction({"restriction": "no_entry"}, members)))
    assert {start for start, end in turns(network) if end == "14"} == {"-12"}


def test_what_a_restriction_says_to_cars():
    assert kind_of({"type": "restriction", "restriction": "no_u_turn", "restriction:motorcar": "only_left_turn"}) == "only_left_turn"
    assert excepts_cars({"type": "restriction", "restriction:hgv": "no_left_turn"}) and not reason(
        {"type": "restriction", "restriction:hgv": "x"}
    )


# -- who goes first --------------------------------------------------------------------------------


def rules(network):
    return {
        (network.lanes[c.from_lane].road, network.lanes[c.to_lane].road): c.right_of_way
        for c in network.connections
        if c.direction != "turn"
    }


def waits(network, start, end):
    """The roads of those that go first."""
    lanes = network.lanes
    (one,) = [c for c in network.connections if (lanes[c.from_lane].road, lanes[c.to_lane].road) == (start, end)]
    return {lanes[network.connections[j].from_lane].road for j in one.yields}


@pytest.mark.parametrize(("centre", "first"), [(LONDON, "13"), ((52.5, 13.4), "-14")])
@pytest.mark.parametrize("highway", ["secondary", "residential"])
def test_at_a_mini_roundabout_the_circle_goes_first(tmp_path, own_cache, centre, first, highway):
    """From the west one waits for who comes round: from the right in Britain, from the left in Berlin; so does everyone."""
    every = {"highway": highway}
    network = load(cross(tmp_path / "map.osm", middle={"highway": "mini_roundabout"}, centre=centre, everywhere=every))
    assert set(rules(network).values()) == {"roundabout"}
    assert waits(network, "11", "12") & {"13", "-14"} == {first}
    for start, end in (("-12", "-11"), ("13", "14"), ("-14", "-13")):
        assert len(waits(network, start, end) & {"11", "-12", "13", "-14"}) >= 1


@pytest.mark.parametrize("value", ["designated", "yes_unposted"])
@pytest.mark.parametrize(("major", "minor"), [(("west", "east"), ("south", "north")), (("south", "north"), ("west", "east"))])
@pytest.mark.parametrize("highway", ["secondary", "residential"])
def test_a_priority_road_goes_first(tmp_path, own_cache, value, major, minor, highway):
    network = load(cross(tmp_path / "map.osm", everywhere={"highway": highway}, **{arm: {"priority_road": value} for arm in major}))
    names = {"west": "11", "east": "-12", "south": "13", "north": "-14"}
    through = {"west": "12", "east": "-11", "south": "14", "north": "-13"}
    for arm in major:
        assert rules(network)[names[arm], through[arm]] == "priority"
    for arm in minor:
        assert rules(network)[names[arm], through[arm]] == "yield"
        assert {names[each] for each in major} <= waits(network, names[arm], through[arm])


def test_a_priority_road_that_bends(tmp_path, own_cache):
    """From the west to the north: both go before the others, and whoever follows the bend before one who leaves it to the left."""
    network = load(cross(tmp_path / "map.osm", west={"priority_road": "designated"}, north={"priority_road": "designated"}))
    assert not waits(network, "11", "14") & {"13", "-12"} and {"11", "-14"} <= waits(network, "13", "14") | waits(network, "13", "-11")
    assert not waits(network, "-14", "-11") & {"13", "-12"}


def test_a_road_whose_priority_ends_has_none(tmp_path, own_cache):
    plain = rules(load(cross(tmp_path / "plain.osm")))
    ended = rules(load(cross(tmp_path / "ended.osm", west={"priority_road": "end"}, east={"priority_road": "end"})))
    assert plain == ended


@pytest.mark.parametrize("value", ["blinker", "blink_mode", "emergency"])
def test_lights_that_only_blink_are_none(tmp_path, own_cache, value):
    network = load(cross(tmp_path / "map.osm", middle={"highway": "traffic_signals", "traffic_signals": value}))
    assert len(network.signals) == 0 and "signal" not in rules(network).values()
    assert any(f"signal: traffic_signals={value} at node 1" in line for line in skipped(network))
    lit = load(cross(tmp_path / "lit.osm", middle={"highway": "traffic_signals", "traffic_signals": "signal"}))
    assert len(lit.signals) == 4


# -- what is not built -----------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["raceway", "construction", "proposed", "escape", "bus_guideway", "rest_area", "raod"])
def test_ways_that_are_not_built_are_told_with_their_place(tmp_path, own_cache, kind):
    network = load(straight(tmp_path / "map.osm", {"highway": kind}, {}))
    assert set(built(network)) == {"12", "-12"}
    assert any(f"other way: highway={kind} at way 11" in line for line in skipped(network))


def test_ferries_are_told(tmp_path, own_cache):
    network = load(straight(tmp_path / "map.osm", {"highway": "", "route": "ferry"}, {}))
    assert any("ferry: route=ferry at way 11" in line for line in skipped(network))


@pytest.mark.parametrize(
    ("own", "says"),
    [
        (({"highway": "raceway"},) * 2, "it has 2 ways with highway=raceway; public roads are built"),
        (({"highway": "service"},) * 3, "3 ways with highway=service; public roads are built.*--parking-aisles builds the aisles"),
        (({"highway": "track"}, {"highway": "raceway"}), "1 ways with highway=raceway, 1 ways with highway=track"),
        (({"access": "private"}, {"motor_vehicle": "permit"}), r"2 closed to cars \(access=private, motor_vehicle=permit\)"),
    ],
)
def test_a_map_without_roads_says_what_it_has(tmp_path, own_cache, own, says):
    with pytest.raises(MapError, match=says):
        load(straight(tmp_path / "map.osm", *own))


# -- drafts ----------------------------------------------------------------------------------------


def negative(path, *, deleted=0, also=""):
    """The same map as one that was drawn and not uploaded."""
    text = path.read_text().replace('id="', 'id="-').replace('ref="', 'ref="-').replace('<osm version="0.6">', '<osm version="0.6">' + also)
    if deleted:
        text = text.replace(f'<way id="-{deleted}"', f'<way action="delete" id="-{deleted}"')
    path.write_text(text)
    return path


def test_a_plan_that_was_never_uploaded_is_a_map(tmp_path, own_cache):
    """Roads, turns and rules are those of the same map with positive identities, and people read the names of the file."""
    rule = restriction({"restriction": "no_left_turn"})
    whole = load(cross(tmp_path / "map.osm", relations=rule))
    drawn = load(negative(cross(tmp_path / "draft.osm", relations=rule)))
    assert sorted(built(drawn).values()) == sorted(built(whole).values()) and len(turns(drawn)) == len(turns(whole)) == 11
    assert {each.element for each in drawn.report.guesses} == {
        each.element.replace(" ", " -") for each in whole.report.guesses if each.element
    }
    assert {way for road in drawn.roads.values() for way in road.ways} == {-11, -12, -13, -14}


def test_what_was_deleted_in_a_draft_is_gone(tmp_path, own_cache):
    network = load(negative(cross(tmp_path / "draft.osm"), deleted=14))
    assert {way for road in network.roads.values() for way in road.ways} == {-11, -12, -13}


def test_new_and_known_elements_stand_side_by_side(tmp_path, own_cache):
    """An edited map: a new way -11 at nodes of the map, beside its way 11."""
    path = cross(tmp_path / "map.osm")
    new = '<node id="-1" lat="52.501" lon="13.402"/><way id="-11"><nd ref="5"/><nd ref="-1"/><tag k="highway" v="secondary"/></way>'
    path.write_text(path.read_text().replace("</osm>", new + "</osm>"))
    network = load(path)
    assert {way for road in network.roads.values() for way in road.ways} == {11, 12, 13, 14, -11}


def test_a_draft_is_corrected_by_the_names_of_its_file(tmp_path, own_cache):
    from studio.road.library.tag import correction

    intake.take(negative(cross(tmp_path / "draft.osm")), tmp_path / "place")
    network = intake.correct(tmp_path / "place", correction("way -11", {"lanes": "4"}, ()))
    assert [each.element for each in network.report.corrected] == ["way -11"] and folder.opened(tmp_path / "place")
    assert max(built(network).values()) == 2


# -- the part that is kept -------------------------------------------------------------------------


@pytest.mark.parametrize("radius", [150.0, 800.0])
def test_where_the_middle_has_no_roads_that_of_the_roads_is_taken(tmp_path, own_cache, radius):
    """A village at the edge of a mapped forest 4 km wide."""
    path = cross(tmp_path / "village.osm")
    trees = "".join(
        f'<node id="{100 + i}" version="1" lat="{52.51 + 0.0004 * i}" lon="13.4{i % 10}"><tag k="natural" v="tree"/></node>'
        for i in range(100)
    )
    path.write_text(path.read_text().replace('<way id="11"', trees + '<way id="11"', 1))
    network = load(path, radius=radius)
    assert set(built(network)) == {"11", "-11", "12", "-12", "13", "-13", "14", "-14"}
    assert any("no road lies that near to the middle" in line for line in guessed(network))
    assert not any(line.startswith("part:") for line in guessed(load(path)))


def test_a_scenario_needs_no_radius_for_such_a_map(tmp_path, own_cache):
    test_where_the_middle_has_no_roads_that_of_the_roads_is_taken(tmp_path, own_cache, 800.0)
    text = "version: 3\ntitle: village\nmap: {file: village.osm}\nroutes: {r: {roads: ['11', '12']}}\nclock: {duration: 1}\n"
    (tmp_path / "s.yaml").write_text(text + "vehicles: {ego: {route: r, position: {along: 5}, speed: 5}}\n")
    assert job.prepare(job.load(tmp_path / "s.yaml"))
