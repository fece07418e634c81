"""OpenDRIVE element by element, missing, empty, unknown, out of range: a flawed element costs that element, and is told with its place."""

import re

import numpy as np
import pytest

from studio.errors import MapError
from studio.road import load
from studio.road.ways.path import path
from studio.road.ways.route import all_routes, connect
from studio.road.ways.trip import trip
from tests.road.plot import guessed, skipped, turns
from tests.road.test_opendrive import LINE, LINKED, crossing, lanes, road, written

SOUND = road("1", plan=LINE.replace('y="0"', 'y="300"'))
WIDTH = '<width sOffset="0" a="3" b="0" c="0" d="0"/>'
SECTION = f'<laneSection s="0">{lanes("driving")}</laneSection>'
BOTH = f'<laneSection s="0">{lanes("driving", side="left", inner="{0}")}{lanes("driving", inner="{0}")}</laneSection>'


def town(kind, inner="", attributes='s="0"'):
    return f'<type {attributes} type="{kind}">{inner}</type>'


def plan(**changes):
    values = {"s": "0", "x": "0", "y": "0", "hdg": "0", "length": "200"} | changes
    return f"<geometry {' '.join(f'{k}={chr(34)}{v}{chr(34)}' for k, v in values.items() if v is not None)}><line/></geometry>"


def beside(lane):
    """A road with a lane beside its first one."""
    return road("7", sections=SECTION.replace("</right>", lane + "</right>"))


def only(inner, direction="standard"):
    """A road with one lane that has this in it."""
    return road("7", sections=section(f'<lane id="-1" type="driving" direction="{direction}">{inner}</lane>'))


def section(lane='<lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>', s='s="0"', side="right"):
    return f"<laneSection {s}><{side}>{lane}</{side}></laneSection>"


def signal(**changes):
    values = {"id": "5", "s": "10", "t": "0", "dynamic": "yes", "type": "1000001", "orientation": "+"} | changes
    return f"<signals><signal {' '.join(f'{k}={chr(34)}{v}{chr(34)}' for k, v in values.items() if v is not None)}/></signals>"


# name: the flawed road, what is told of it
COSTS_THE_ROAD = {
    "no id": (road(""), "<road>: it has no id"),
    "twice": (road("1"), "road 1: <road> stands twice with this id; the first one counts"),
    "no plan": (road("7", plan=""), "road 7: <planView> has no <geometry>"),
    "no lanes": (road("7", sections=" "), "road 7: <lanes> has no <laneSection>"),
    "no x": (road("7", plan=plan(x=None)), "road 7: x of <geometry> is missing"),
    "x empty": (road("7", plan=plan(x="")), "road 7: x of <geometry> is no number"),
    "x in words": (road("7", plan=plan(x="east")), "road 7: x of <geometry> is no number that a road has (got 'east')"),
    "x beyond": (road("7", plan=plan(x="1e300")), "road 7: x of <geometry>"),
    "no hdg": (road("7", plan=plan(hdg=None)), "road 7: hdg of <geometry> is missing"),
    "length nan": (road("7", plan=plan(length="nan")), "road 7: length of <geometry>"),
    "length below 0": (road("7", plan=plan(length="-5")), "length is -5 m"),
    "unknown shape": (road("7", plan=LINE.replace("line", "bezier")), "<bezier> is no known geometry"),
    "no shape": (road("7", plan=LINE.replace("<line/>", "")), "is no known geometry"),
    "curled": (road("7", plan=LINE.replace("<line/>", '<arc curvature="20"/>')), "curvature is 20 1/m"),
    "no curvature": (road("7", plan=LINE.replace("<line/>", "<arc/>")), "curvature of <arc> is missing"),
    "torn": (road("7", length=300, plan=LINE + LINE.replace('s="0" x="0"', 's="200" x="240"')), "begins 40 m beside"),
    "into the sky": (
        road("7", extra='<elevationProfile><elevation s="0" a="0" b="400" c="0" d="0"/></elevationProfile>'),
        "heights of roads",
    ),
    "behind its end": (road("7", sections=SECTION.replace('s="0"', 's="900"')), "its first <laneSection> begins behind its end"),
    "far away": (road("7", plan=plan(x="900000")), "road 7: lies 900 km from most"),
    "another side": (road("7", rule="LHT"), "road 7: rule of <road> is LHT, that of most is RHT"),
}
# name: the flawed road, whose one lane is built all the same, and what is told of it
COSTS_LESS = {
    "rule unknown": (road("7", rule="UHT"), "rule=UHT"),
    "rule empty": (road("7", rule=""), ""),
    "link without id": (road("7", link='<successor elementType="road"/>'), "road 7: <successor> names no road"),
    "link to nothing": (road("7", link='<successor elementType="road" elementId="99" contactPoint="start"/>'), "there is no such road"),
    "link of a kind": (road("7", link='<successor elementType="lake" elementId="1"/>'), "road 7: <successor> names no road"),
    "contact unknown": (road("7", link='<successor elementType="road" elementId="1" contactPoint="middle"/>'), "<successor> names no"),
    "type without s": (road("7", extra=town("town", attributes="")), "s of <type> is missing"),
    "speed below 0": (road("7", extra=town("town", '<speed max="-3"/>')), "max of <speed> is -3"),
    "speed in words": (road("7", extra=town("town", '<speed max="fast"/>')), "max of <speed> is no number"),
    "speed too fast": (road("7", extra=town("town", '<speed max="900" unit="km/h"/>')), "allowed: 0 to 250 km/h"),
    "unit unknown": (road("7", extra=town("town", '<speed max="50" unit="knots"/>')), "unit of <speed> is unknown"),
    "no geometry length": (road("7", plan=plan(length="0", x="-5") + LINE), "an element without length"),
    "elevation flawed": (road("7", extra='<elevationProfile><elevation s="0" a="x" b="0" c="0" d="0"/></elevationProfile>'),
                         "a of <elevation> is no number"),
    "offset flawed": (road("7", sections='<laneOffset s="0" a="1" b="0" c="0"/>' + SECTION), "d of <laneOffset> is missing"),
    "section below 0": (road("7", sections=SECTION.replace('s="0"', 's="-3"') + SECTION), "lane sections begin from s = 0 on"),
    "section without s": (road("7", sections=section(s="") + SECTION), "s of <laneSection> is missing"),
    "section twice": (road("7", sections=SECTION + SECTION), "has no length on its road"),
    "section at the end": (road("7", sections=SECTION + SECTION.replace('s="0"', 's="200"')), "has no length on its road"),
    "lane without id": (beside('<lane type="driving"/>'), "id of <lane> is missing"),
    "lane of another side": (beside('<lane id="3" type="driving"/>'), "<lane> 3 does not belong on this side"),
    "lane in halves": (beside('<lane id="-2.5" type="driving"/>'), "not a whole number"),
    "lane twice": (beside('<lane id="-1" type="driving"/>'), "<lane> -1 stands twice"),
    "lane type unknown": (beside('<lane id="-2" type="tram"/>'), "1 of type tram"),
    "width without a": (beside('<lane id="-2" type="driving"><width sOffset="0" b="0" c="0" d="0"/></lane>'), "a of <width> is missing"),
    "width of a lake": (beside(f'<lane id="-2" type="driving">{WIDTH.replace("3", "500")}</lane>'), "it is 500 m wide"),
    "lane far off": (beside(f'<lane id="-2" type="driving">{WIDTH}</lane>'.replace('d="0"', 'd="9"')),
                     "lies more than 1000 m beside its road"),
    "lane link flawed": (only('<link><successor id="x"/></link>' + WIDTH), "id of <successor> is no number"),
    "lane speed flawed": (only(WIDTH + '<speed sOffset="0" max="-1"/>'), "max of <speed> is -1"),
    "lane direction": (only(WIDTH, direction="up"), "lane -1: up"),
    "signal without s": (road("7", extra=signal(s=None)), "s of <signal> is missing"),
    "signal of no way": (road("7", extra=signal(orientation="?")), "orientation of <signal> is unknown"),
    "validity flawed": (road("7", extra=signal().replace("/></signals>", '><validity fromLane="a" toLane="1"/></signal></signals>')),
                        "fromLane of <validity>"),
    "superelevation flawed": (road("7", extra='<lateralProfile><superelevation s="?" a="1" b="0" c="0" d="0"/></lateralProfile>'),
                              "roads have no slope across"),
}  # fmt: skip


@pytest.mark.parametrize("case", COSTS_THE_ROAD)
def test_a_flawed_road_costs_that_road(tmp_path, case):
    content, told = COSTS_THE_ROAD[case]
    network = load(written(tmp_path, SOUND, road("2", plan=LINE.replace('y="0"', 'y="400"')), content))
    assert set(network.roads) == {"1", "2"}
    (entry,) = [each for each in network.report.skipped if each.kind == "road"]
    assert told in entry.reason and (entry.where.startswith("road ") or case == "no id")


@pytest.mark.parametrize("case", COSTS_LESS)
def test_a_flawed_element_costs_that_element(tmp_path, case):
    content, told = COSTS_LESS[case]
    network = load(written(tmp_path, SOUND, content))
    assert [len(each.lanes) for name, each in network.roads.items() if name.startswith("7")] == [1]
    assert any(told in line and "at road 7" in line for line in skipped(network)) == bool(told)


def test_a_length_that_is_not_said_is_that_of_the_geometry(tmp_path):
    for number, length in enumerate(("", "0", "-7", "long", "nan")):
        network = load(written(tmp_path, road("7").replace('length="200.0"', f'length="{length}"'), name=f"{number}.xodr"))
        assert network.lanes[0].length == pytest.approx(200.0)
        assert any("length: 200.00 m at road 7" in line for line in guessed(network))


def test_lanes_beyond_one_that_cannot_be_read_are_left_out_with_it(tmp_path):
    """Nobody knows where they lie; those nearer to the middle are where they are."""
    second = 'id="-2" type="driving"><width sOffset="0" a="'
    three = lanes("driving", "driving", "driving").replace(second + "3.5", second + "?")
    network = load(written(tmp_path, road("7", sections=f'<laneSection s="0">{three}</laneSection>')))
    (lane,) = network.lanes
    assert lane.centre[1] + network.datum[1] == pytest.approx(-1.75)
    assert any("lanes -3" in line and "lie beyond lane -2" in line for line in skipped(network))


def test_numbers_with_gaps_count_from_the_middle(tmp_path):
    text = lanes("driving", "driving").replace('"-2"', '"-5"')
    network = load(written(tmp_path, road("7", sections=f'<laneSection s="0">{text}</laneSection>')))
    assert sorted(float(lane.centre[1, 0]) + network.datum[1] for lane in network.lanes) == pytest.approx([-5.25, -1.75])
    assert any("lane -5 is 3 nearer to the middle" in line for line in guessed(network))


def test_a_section_may_tell_of_one_side_only(tmp_path):
    """On the other side the lanes go on (singleSide, since 1.4)."""
    left, right = lanes("driving", side="left", inner=LINKED.format(1)), lanes("driving", inner=LINKED.format(-1))
    whole = f'<laneSection s="0">{left}{right}</laneSection>'
    half = f'<laneSection s="80" singleSide="true">{lanes("driving", "driving", inner=LINKED.format(-1))}</laneSection>'
    network = load(written(tmp_path, road("7", sections=whole + half)))
    assert network.roads["-7"].length == pytest.approx(200.0) and len(network.roads["7#1"].lanes) == 2
    assert {network.lanes[lane].centre[1, 0] + network.datum[1] for lane in network.roads["-7"].lanes} == {1.75}


# -- junctions -------------------------------------------------------------------------------------

CONNECTION = '<connection id="{}" incomingRoad="{}" connectingRoad="{}" contactPoint="{}"><laneLink from="-1" to="{}"/></connection>'


def with_connection(text):
    *roads, junction = crossing()
    return (*roads, junction.replace("</junction>", text + "</junction>"))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (CONNECTION.format(9, 77, "w1", "start", -1), "incomingRoad names no road of this map (got '77')"),
        (CONNECTION.format(9, "in", 88, "start", -1), "connectingRoad names no road of this map (got '88')"),
        (CONNECTION.format(9, "", "w1", "start", -1), "incomingRoad names no road of this map (got '')"),
        ('<connection id="9"/>', "incomingRoad names no road"),
        (CONNECTION.format(9, "in", "w1", "start", "x"), "to of <laneLink> is no number"),
        (CONNECTION.format(9, "ahead", "w1", "top", -1).replace('to="-1"', 'to="-7"'), ""),
        ('<priority high="w1" low="99"/>', "w1 before 99"),
        ("<priority/>", "none before none"),
    ],
)
def test_a_flawed_connection_costs_that_connection(tmp_path, text, told):
    network = load(written(tmp_path, *with_connection(text)))
    assert turns(network) == {("in", "ahead"), ("in", "left")}
    assert not told or any(told in line for line in skipped(network))


def test_a_contact_that_is_not_said_follows_from_the_links(tmp_path):
    *roads, junction = crossing()
    network = load(written(tmp_path, *roads, junction.replace('contactPoint="start"', "")))
    assert turns(network) == {("in", "ahead"), ("in", "left")}
    assert any("the start of road w1" in line for line in guessed(network))


def test_a_road_may_be_joined_without_saying_at_which_end(tmp_path):
    link = '<successor elementType="road" elementId="{}"/>'
    plan_ = LINE.replace('x="0"', 'x="200"')
    network = load(written(tmp_path, road("1", link=link.format("2")), road("2", plan=plan_)))
    assert turns(network) == {("1", "2")} and any("the start of road 2" in line for line in guessed(network))


def test_junctions_twice_without_id_or_virtual(tmp_path):
    text = '<junction id="J"/><junction/><junction id="V" type="virtual"/><junctionGroup id="G" type="highwayInterchange"/>'
    network = load(written(tmp_path, *crossing(), text))
    lines = skipped(network)
    assert turns(network) == {("in", "ahead"), ("in", "left")}
    assert [any(word in line for line in lines) for word in ("stands twice", "has no id", "virtual junction V", "group G")] == 4 * [True]


# -- lanes without links ---------------------------------------------------------------------------


@pytest.mark.parametrize(("second", "kinds"), [("start", ("1", "2")), ("end", ("1", "-2"))])
def test_lanes_of_roads_that_meet_without_links(tmp_path, second, kinds):
    """As many on each side are joined, whichever end of the second road lies there, and that is a guess."""
    there = LINE.replace('x="0"', 'x="200"') if second == "start" else LINE.replace('x="0" y="0" hdg="0"', f'x="400" y="0" hdg="{np.pi}"')
    one = road("1", sections=BOTH.format(""), link=f'<successor elementType="road" elementId="2" contactPoint="{second}"/>')
    network = load(written(tmp_path, one, road("2", sections=BOTH.format(""), plan=there)))
    back = tuple(name[1:] if name[0] == "-" else "-" + name for name in kinds)[::-1]
    assert turns(network) == {kinds, back}
    assert sum("no lane has a <link> there" in line for line in guessed(network)) == 2
    for each in network.connections:
        a, b = (network.lanes[lane] for lane in (each.from_lane, each.to_lane))
        assert np.hypot(*(a.centre[:, -1] - b.centre[:, 0])) < 0.01


def test_lanes_of_sections_without_links(tmp_path):
    two = f'<laneSection s="90">{lanes("driving", side="left")}{lanes("driving")}</laneSection>'
    network = load(written(tmp_path, road("1", sections=BOTH.format("") + two)))
    assert {name: each.length for name, each in network.roads.items()} == {"1": 200.0, "-1": 200.0}
    assert any("lanes -1 go on in road 1 at road 1, s = 90.0 m" in line for line in guessed(network))


def test_other_numbers_of_lanes_without_links_end_there(tmp_path):
    two = f'<laneSection s="90">{lanes("driving", "driving")}</laneSection>'
    network = load(written(tmp_path, road("1", sections=SECTION + two)))
    assert not network.connections
    assert any("1 meet 2 of road 1, so it ends there" in line for line in skipped(network))


def test_a_lane_that_ends_is_told_unless_it_has_run_out(tmp_path):
    inner = '<lane id="-1" type="driving">'
    one = f'<laneSection s="0">{lanes("driving", "driving")}</laneSection>'.replace(inner, inner + LINKED.format(-1))
    two = f'<laneSection s="100">{lanes("driving", inner=LINKED.format(-1))}</laneSection>'
    abrupt = load(written(tmp_path, road("1", sections=one + two), name="abrupt.xodr"))
    assert any("lane end: lane -2 ends at road 1, s = 100.0 m" in line for line in skipped(abrupt))
    outer = 'id="-2" type="driving"><width sOffset="0" a="3.5" b="'
    narrowing = one.replace(outer + "0", outer + "-0.035")
    gentle = load(written(tmp_path, road("1", sections=narrowing + two), name="gentle.xodr"))
    assert not any("lane end" in line for line in skipped(gentle))


# -- directions ------------------------------------------------------------------------------------


def directed(tmp_path, *directions, kind="driving", side="right", rule="RHT", opposite=""):
    text = lanes(*(kind for _ in directions), side=side)
    for i, direction in enumerate(directions, start=1):
        sign = -i if side == "right" else i
        text = text.replace(f'id="{sign}" type="{kind}"', f'id="{sign}" type="{kind}" direction="{direction}"')
    sections = f'<laneSection s="0">{opposite}{text}</laneSection>'
    return load(written(tmp_path, road("1", sections=sections, rule=rule)))


@pytest.mark.parametrize(
    ("directions", "side", "rule", "east"),
    [
        (("reversed", "standard"), "right", "RHT", {-5.25: True, -1.75: False}),
        (("standard", "reversed"), "right", "RHT", {-5.25: False, -1.75: True}),
        (("reversed",), "left", "RHT", {1.75: True}),
        (("reversed", "standard"), "right", "LHT", {-5.25: False, -1.75: True}),
        (("reversed", "reversed"), "left", "LHT", {1.75: False, 5.25: False}),
    ],
)
def test_reversed_lanes_are_driven_the_other_way(tmp_path, directions, side, rule, east):
    network = directed(tmp_path, *directions, side=side, rule=rule)
    found = {round(float(lane.centre[1, 0]) + network.datum[1], 3): lane.centre[0, -1] > lane.centre[0, 0] for lane in network.lanes}
    assert found == east


def test_a_lane_between_two_of_the_other_direction_parts_them(tmp_path):
    """Nobody changes lanes across an oncoming one."""
    network = directed(tmp_path, "standard", "reversed", "standard")
    assert sorted(len(each.lanes) for each in network.roads.values()) == [1, 1, 1]


@pytest.mark.parametrize("kind", ["driving", "bidirectional"])
def test_on_a_lane_for_both_directions_nobody_meets(tmp_path, kind):
    direction = "both" if kind == "driving" else "standard"
    alone = directed(tmp_path, direction, kind=kind)
    assert [lane.centre[0, -1] > 0.0 for lane in alone.lanes] == [True] and any("for both directions" in line for line in skipped(alone))
    opposite = lanes("driving", side="left")
    (tmp_path / "middle").mkdir()
    text = f'<laneSection s="0">{opposite}{lanes(kind, "driving")}</laneSection>'.replace('id="-1"', f'id="-1" direction="{direction}"')
    between = load(written(tmp_path / "middle", road("1", sections=text)))
    assert sorted(float(lane.centre[1, 0]) + between.datum[1] for lane in between.lanes) == pytest.approx([-5.25, 1.75])
    assert any("is kept free between the two directions" in line for line in skipped(between))


# -- degenerate lengths ----------------------------------------------------------------------------


WAYS = (
    '<predecessor elementType="road" elementId="1" contactPoint="end"/><successor elementType="road" elementId="3" contactPoint="start"/>'
)
GOING_ON = SECTION.replace("<width", LINKED.format(-1) + "<width")
NOTHINGS = [1e-9, 1e-4, 0.01, 0.3, 0.99, 1.0]


@pytest.mark.parametrize("length", NOTHINGS)
def test_a_section_of_nothing_breaks_nothing(tmp_path, length):
    sections = "".join(GOING_ON.replace('s="0"', f's="{s}"', 1) for s in (0, 100, 100 + length))
    network = load(written(tmp_path, road("1", sections=sections)))
    assert [each.length for each in network.roads.values()] == pytest.approx([200.0], abs=0.01)


@pytest.mark.parametrize("length", NOTHINGS)
@pytest.mark.parametrize("junction", ["-1", "J"])
def test_a_road_of_nothing_breaks_nothing(tmp_path, length, junction):
    """Before it and behind it one drives on, whether it lies in a junction or not."""
    to = '{} elementType="{}" elementId="{}" {}/>'
    named = ("junction", "J", "") if junction == "J" else ("road", "2", 'contactPoint="{}"')
    first, last = (to.format(tag, *named).replace("{}", end) for tag, end in (("<successor", "start"), ("<predecessor", "end")))
    roads = (
        road("1", sections=GOING_ON, link=first),
        road("2", length=length, plan=plan(x="200", length=str(length)), sections=GOING_ON, link=WAYS, junction=junction),
        road("3", sections=GOING_ON, plan=plan(x=str(200 + length)), link=last),
    )
    text = f'<junction id="J">{CONNECTION.format(0, "1", "2", "start", -1)}</junction>' if junction == "J" else ""
    network = load(written(tmp_path, *roads, text))
    assert path(network, connect(network, ["1", "3"])).length == pytest.approx(400.0, abs=1.5)
    assert all(np.isfinite(lane.centre).all() and lane.centre.shape[1] > 1 for lane in network.lanes)
    assert all_routes(network) and trip(network).length > 60.0


def test_a_reference_to_a_signal_that_there_is_not_is_told(tmp_path):
    extra = '<signals><signalReference id="99" s="150" t="0" orientation="+"/></signals>'
    network = load(written(tmp_path, SOUND, road("7", extra=extra)))
    (told,) = (each for each in network.report.skipped if each.kind == "signal")
    assert (told.what, told.where) == ("signalReference 99", "road 7, s = 150.0 m") and len(network.signals) == 0


# -- widths ----------------------------------------------------------------------------------------


def lane_of(*widths, kind="driving", name=-1):
    """A lane with these records of its width."""
    return f'<lane id="{name}" type="{kind}">{"".join(f"<{each}/>" for each in widths)}</lane>'


def record(a, b="0", tag="width", **at):
    return f'{tag} {" ".join(f"{k}={chr(34)}{v}{chr(34)}" for k, v in at.items())} a="{a}" b="{b}" c="0" d="0"'


NEAR = 12.0  # [m] between two places at which a straight road is looked at
NO_WIDTH = {
    "below 0": (
        (record("-3.5", sOffset=0),),
        "<lane> -1: it is -3.5 m wide at s = 0; allowed: 0 to 100 m; 0 m is taken: correct its <width>",
    ),
    "turned below 0": ((record("1", "-0.05", sOffset=0),), "it is -9 m wide at s = 200; allowed: 0 to 100 m"),
    "too narrow": ((record("1.2", sOffset=0),), "<lane> -1: it is 1.20 m wide at most; a car needs 1.8 m"),
    "not said": ((), "<lane> -1: it has no <width> and no <border>; a car needs 1.8 m"),
    "a border beyond the middle": ((record("2", tag="border", sOffset=0),), "it is -2 m wide at s = 0"),
}


@pytest.mark.parametrize("case", NO_WIDTH)
def test_a_width_that_no_lane_has_is_told_and_is_the_reason_where_nothing_is_left(tmp_path, case):
    widths, told = NO_WIDTH[case]
    text = section(lane_of(*widths) + lane_of(record("1", sOffset=0), kind="sidewalk", name=-2))
    with pytest.raises(MapError, match=re.escape(told)) as refused:
        load(written(tmp_path, road("7", sections=text)))
    assert "road 7, <laneSection> at s = 0, <lane> -1" in str(refused.value)
    network = load(written(tmp_path, SOUND, road("7", sections=text), name="two.xodr"))
    assert set(network.roads) == {"1"} and any(told in line and "at road 7" in line for line in skipped(network))


@pytest.mark.parametrize(
    ("begin", "at", "offset"),
    [("0", {"s": 0}, 0.0), ("0", {"s": 60}, 60.0), ("50", {"s": 110}, 60.0), ("50", {"s": 20}, 20.0), ("50", {}, 0.0)],
)
def test_a_record_with_s_in_place_of_its_offset_holds_from_that_station_on(tmp_path, begin, at, offset):
    """`s` is a station along the road; one before the section can only be a distance from its start."""
    before = "" if begin == "0" else section()
    first = () if offset == 0.0 else (record("3", sOffset=0),)
    text = section(lane_of(*first, record("4", **at)), s=f's="{begin}"')
    network = load(written(tmp_path, road("7", sections=before + text)))
    own = max((lane for lane in network.lanes), key=lambda lane: lane.centre[0, -1])
    x, y = own.centre + np.array(network.datum)[:, None]
    assert np.interp(float(begin) + offset + NEAR, x, y) == pytest.approx(-2.0)
    assert offset == 0.0 or np.interp(float(begin) + offset - NEAR, x, y) == pytest.approx(-1.5)
    (line,) = [line for line in guessed(network) if line.startswith("width")]
    assert f"from {offset:g} m after the section's start at road 7" in line and "<lane> -1: <width> has no sOffset" in line


def test_of_records_at_one_place_the_last_counts_and_one_that_begins_late_is_told(tmp_path):
    twice = section(lane_of(record("4", sOffset=0), record("3", sOffset=0)))
    late = section(lane_of(record("3", sOffset=40)))
    for name, text, told in (("7", twice, "several begin at the same place; the last one counts"), ("8", late, "begins so late")):
        network = load(written(tmp_path, road(name, sections=text), name=f"{name}.xodr"))
        assert network.lanes[0].centre[1, -1] + network.datum[1] == pytest.approx(-1.5)
        assert any(told in line and f"at road {name}" in line for line in skipped(network))


def test_a_width_that_ends_a_hair_below_nothing_is_none_to_tell_of(tmp_path):
    """As programs write it where a lane runs out: 3.5 m over 200 m, and 4e-4 m too much."""
    network = load(written(tmp_path, road("7", sections=section(lane_of(record("3.5", "-0.017502", sOffset=0))))))
    assert not any("allowed: 0 to 100 m" in line for line in skipped(network))


@pytest.mark.parametrize(("s", "stands"), [("-5", 0.0), ("260", 200.0)])
def test_a_signal_beyond_its_road_stands_at_its_end_and_that_is_told(tmp_path, s, stands):
    network = load(written(tmp_path, SOUND, road("7", extra=signal(s=s))))
    assert any(f"at s = {stands:g} m at road 7" in line and f"is {s} m; allowed: 0 to 200 m" in line for line in guessed(network))
