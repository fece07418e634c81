"""Who goes first on an OpenDRIVE map: lights for the lanes that they name, signs, the priorities of a junction, roundabouts."""

import numpy as np
import pytest

from studio.road import load
from tests.road.plot import guessed, skipped
from tests.road.test_opendrive import LINKED, lanes, road, written

GEOMETRY = '<geometry s="0" x="{}" y="{}" hdg="{}" length="{}">{}</geometry>'
HALF = np.pi / 2
IN, OUT = '<successor elementType="junction" elementId="J"/>', '<predecessor elementType="junction" elementId="J"/>'
WAY = (
    '<predecessor elementType="road" elementId="{}" contactPoint="end"/><successor elementType="road" elementId="{}" contactPoint="start"/>'
)
LANE = f'<laneSection s="0">{lanes("driving")}</laneSection>'
LINKED_LANE = f'<laneSection s="0">{lanes("driving", inner=LINKED.format(-1))}</laneSection>'
JOIN = '<connection id="{0}" incomingRoad="{1}" connectingRoad="{0}" contactPoint="start"><laneLink from="-1" to="-1"/></connection>'


def sign(kind, s=195, country="DE", orientation="+", inner="", dynamic="no", number="9"):
    return (
        f'<signals><signal id="{number}" s="{s}" t="-3" dynamic="{dynamic}" orientation="{orientation}" type="{kind}" '
        f'country="{country}">{inner}</signal></signals>'
    )


def merging(tmp_path, *, west="", south="", ahead="", joining="", junction="", speeds=(50, 50), beside=""):
    """A road from the west (w) that goes straight on into e, and one from the south (s) that turns right into it."""
    limits = [f'<type s="0" type="town"><speed max="{speed}" unit="km/h"/></type>' for speed in speeds]
    return load(
        written(
            tmp_path,
            road("w", plan=GEOMETRY.format(0, 0, 0, 200, "<line/>"), link=IN, extra=limits[0] + west, sections=LANE),
            road("s", plan=GEOMETRY.format(210, -210, HALF, 200, "<line/>"), link=IN, extra=limits[1] + south, sections=LANE),
            road("e", plan=GEOMETRY.format(220, 0, 0, 100, "<line/>"), length=100, link=OUT, extra=limits[0], sections=LANE),
            road("c1", plan=GEOMETRY.format(200, 0, 0, 20, "<line/>"), length=20, link=WAY.format("w", "e"), sections=LINKED_LANE,
                 junction="J", extra=ahead),
            road("c2", plan=GEOMETRY.format(210, -10, HALF, 10 * HALF, '<arc curvature="-0.1"/>'), length=10 * HALF,
                 link=WAY.format("s", "e"), sections=LINKED_LANE, junction="J", extra=joining),
            f'<junction id="J">{JOIN.format("c1", "w")}{JOIN.format("c2", "s")}{junction}</junction>{beside}',
        )
    )  # fmt: skip


def rules(network):
    return {network.lanes[c.from_lane].road: c.right_of_way for c in network.connections}


def test_without_a_word_the_right_goes_first(tmp_path):
    assert rules(merging(tmp_path)) == {"w": "right_before_left", "s": "right_before_left"}


@pytest.mark.parametrize(
    ("high", "low", "found"),
    [
        ("c1", "c2", {"w": "priority", "s": "yield"}), ("c2", "c1", {"w": "yield", "s": "priority"}),
        ("w", "s", {"w": "priority", "s": "yield"}), ("s", "w", {"w": "yield", "s": "priority"}),
    ],
)  # fmt: skip
def test_the_priorities_of_a_junction_count(tmp_path, high, low, found):
    """Named by connecting roads, as the standard says, or by the roads that come in, as some programs write them; before any limit."""
    network = merging(tmp_path, junction=f'<priority high="{high}" low="{low}"/>', speeds=(50, 100) if high in ("c1", "w") else (100, 50))
    assert rules(network) == found


@pytest.mark.parametrize(
    ("kind", "country", "rule"),
    [
        ("205", "DE", "yield"), ("206", "DEU", "stop"), ("205", "OpenDRIVE", "yield"), ("206", "", "stop"), ("R1-2", "US", "yield"),
        ("r1-1", "USA", "stop"), ("B1", "SE", "yield"), ("3.02", "CHE", "yield"), ("AB3a", "FR", "yield"), ("602", "GB", "yield"),
        ("B6", "NL", "yield"),
    ],
)  # fmt: skip
def test_a_sign_lets_the_other_road_go_first(tmp_path, kind, country, rule):
    network = merging(tmp_path, south=sign(kind, country=country))
    assert rules(network) == {"w": "priority", "s": rule}
    assert not any("sign" in line for line in skipped(network))
    assert any("German numbers" in line for line in guessed(network)) == (country in ("", "OpenDRIVE"))


@pytest.mark.parametrize(
    ("signs", "found"),
    [
        ({"south": sign("306", s=20)}, {"w": "yield", "s": "priority"}),  # far before the junction: it holds up to there
        ({"west": sign("301")}, {"w": "priority", "s": "yield"}),
        ({"joining": sign("205", s=1)}, {"w": "priority", "s": "yield"}),  # on the way through the junction
        ({"south": sign("205", inner='<validity fromLane="-1" toLane="-1"/>', orientation="-")}, {"w": "priority", "s": "yield"}),
    ],
)
def test_where_signs_stand(tmp_path, signs, found):
    assert rules(merging(tmp_path, **signs)) == found


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (sign("205", orientation="-"), "signal 9: yield"),  # for nobody: the lane is driven the other way
        (sign("205", s=100), "no junction is within 40 m"),
        (sign("205", country="XX"), "signal 9 of type 205 in XX"),
        (sign("274"), "signal 9 of type 274 in DE"),
    ],
)
def test_a_sign_that_is_not_used_is_told(tmp_path, text, told):
    network = merging(tmp_path, south=text)
    assert rules(network) == {"w": "right_before_left", "s": "right_before_left"}
    assert any(told in line and "road s" in line for line in skipped(network))


@pytest.mark.parametrize("orientation", ["+", "-", "none"])
@pytest.mark.parametrize("place", ["west", "ahead"])
def test_a_light_is_for_the_lanes_that_it_names(tmp_path, orientation, place):
    """Before the junction or within it, whatever its orientation: some programs write there the sign of the lanes."""
    light = sign("1000001", s=195 if place == "west" else 2, orientation=orientation, dynamic="yes",
                 inner='<validity fromLane="-1" toLane="-1"/>')  # fmt: skip
    network = merging(tmp_path, **{place: light})
    assert rules(network)["w"] == "signal" and rules(network)["s"] != "signal"


@pytest.mark.parametrize(
    ("orientation", "inner", "stopped"),
    [
        ("+", '<validity fromLane="0" toLane="0"/>', {"1"}),  # the middle alone: all lanes
        ("-", '<validity fromLane="0" toLane="0"/>', {"-1"}),
        ("+", '<validity fromLane="-1" toLane="1"/>', {"1"}),  # lanes of both directions: the orientation decides
        ("none", '<validity fromLane="-1" toLane="1"/>', {"1", "-1"}),
        ("+", '<validity fromLane="1" toLane="1"/>', {"-1"}),
        ("-", '<validity fromLane="1" toLane="1"/><validity fromLane="2" toLane="2"/>', {"-1"}),
    ],
)
def test_for_whom_a_light_in_the_middle_of_a_road_is(tmp_path, orientation, inner, stopped):
    section = f'<laneSection s="0">{lanes("driving", side="left")}{lanes("driving")}</laneSection>'
    light = sign("1000001", s=100, orientation=orientation, inner=inner, dynamic="yes")
    network = load(written(tmp_path, road("1", sections=section, extra=light)))
    assert {network.lanes[lane].road.split("#")[0] for lane in network.signals.link_lane} == stopped


def test_who_comes_first_where_all_stop(tmp_path):
    """Three arms with stop signs: nobody has a greater road, who came first goes first."""
    arms = {"w": (0, 0, 0), "s": (210, -210, HALF), "n": (210, 210, -HALF)}
    roads = [road(name, plan=GEOMETRY.format(*at, 200, "<line/>"), link=IN, sections=LANE, extra=sign("206")) for name, at in arms.items()]
    ways = {"c1": ("w", (200, 0, 0, 20, "<line/>"), 20), "c2": ("s", (210, -10, HALF, 10 * HALF, '<arc curvature="-0.1"/>'), 10 * HALF),
            "c3": ("n", (210, 10, -HALF, 10 * HALF, '<arc curvature="0.1"/>'), 10 * HALF)}  # fmt: skip
    roads += [
        road(name, plan=GEOMETRY.format(*plan), length=length, link=WAY.format(arm, "e"), sections=LINKED_LANE, junction="J")
        for name, (arm, plan, length) in ways.items()
    ]
    out = road("e", plan=GEOMETRY.format(220, 0, 0, 100, "<line/>"), length=100, link=OUT, sections=LANE)
    joins = "".join(JOIN.format(name, arm) for name, (arm, _, _) in ways.items())
    network = load(written(tmp_path, *roads, out, f'<junction id="J">{joins}</junction>'))
    assert rules(network) == {"w": "all_way_stop", "s": "all_way_stop", "n": "all_way_stop"}


def test_a_ring_goes_first(tmp_path):
    """The way from w to e is part of a roundabout of three junctions; s comes into it, and would be the greater road."""
    beside = (
        road("f", plan=GEOMETRY.format(-120, 0, 0, 100, "<line/>"), length=100, sections=LANE),
        road(
            "c0", plan=GEOMETRY.format(-20, 0, 0, 20, "<line/>"), length=20, sections=LINKED_LANE, junction="I", link=WAY.format("f", "w")
        ),
        road(
            "c9", plan=GEOMETRY.format(320, 0, 0, 20, "<line/>"), length=20, sections=LINKED_LANE, junction="K", link=WAY.format("e", "g")
        ),
        road("g", plan=GEOMETRY.format(340, 0, 0, 100, "<line/>"), length=100, sections=LANE),
        '<junction id="I"/><junction id="K"/>',
        '<junctionGroup id="G" type="roundabout">{}</junctionGroup>'.format("".join(f'<junctionReference junction="{j}"/>' for j in "IJK")),
    )
    found = rules(merging(tmp_path, beside="".join(beside), speeds=(50, 100)))
    assert found["s"] == "roundabout" and found["w"] == "priority"
