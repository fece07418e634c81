"""OpenDRIVE: every lane lies where the document says, lanes join as it says, and what cannot be used is told or refused."""

import gzip
import itertools
import json
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import shapely
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import fresnel

from studio.errors import MapError
from studio.road import load
from studio.road.library import place
from studio.road.opendrive.document import Header
from studio.road.opendrive.file import read_header
from studio.road.opendrive.reference_line import Bend, Cubic, Profile, ReferenceLine
from studio.road.ways.path import PATH_CURVATURE, path
from studio.road.ways.route import all_routes, connect
from tests.patience import PATIENCE

FILES = sorted((Path(__file__).parents[1] / "reference" / "opendrive").glob("*.xodr"))
FOLDER = FILES[0].parent


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("STUDIO_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


# -- a writer of small documents -------------------------------------------------------------------


def lanes(*kinds, width=3.5, side="right", inner=""):
    """Lanes of one side, from the middle outwards."""
    sign = 1 if side == "left" else -1
    text = "".join(
        f'<lane id="{sign * (i + 1)}" type="{kind}">{inner}<width sOffset="0" a="{width}" b="0" c="0" d="0"/></lane>'
        for i, kind in enumerate(kinds)
    )
    return f"<{side}>{text}</{side}>"


LINE = '<geometry s="0" x="0" y="0" hdg="0" length="200"><line/></geometry>'
LINKED = '<link><predecessor id="{0}"/><successor id="{0}"/></link>'


def road(number="1", *, length=200.0, plan=LINE, sections=None, extra="", link="", **attributes):
    """One road."""
    sections = sections or f'<laneSection s="0">{lanes("driving")}</laneSection>'
    more = "".join(f' {key}="{value}"' for key, value in ({"junction": "-1"} | attributes).items())
    return (
        f'<road id="{number}" length="{length}"{more}><link>{link}</link>{extra}<planView>{plan}</planView><lanes>{sections}</lanes></road>'
    )


def written(tmp_path, *content, head='<header name="Test" vendor="us"/>', name="map.xodr"):
    target = tmp_path / name
    target.write_text(f"<OpenDRIVE>{head}{''.join(content)}</OpenDRIVE>", encoding="utf-8")
    return target


# -- geometry against closed forms -----------------------------------------------------------------


def spiral(s, k_0, k_1, length):
    """x and y of a clothoid from the origin along x with rising curvature, by Fresnel's integrals."""
    rate = (k_1 - k_0) / length
    scale = np.sqrt(np.pi / abs(rate))
    sign, t_0 = np.sign(rate), k_0 / rate
    (s_a, c_a), (s_b, c_b) = fresnel(t_0 / scale), fresnel((t_0 + s) / scale)
    x, y = scale * (c_b - c_a), sign * scale * (s_b - s_a)
    turn = -0.5 * rate * t_0**2  # the heading of the whole clothoid where ours begins
    return x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)


@pytest.mark.parametrize(("k_0", "k_1"), [(0.0, 0.02), (0.02, 0.0), (-0.01, 0.03), (0.004, -0.004), (0.1, 0.3)])
def test_spiral_is_fresnels(k_0, k_1):
    s = np.linspace(0.0, 80.0, 41)
    x, y, heading = Bend(0.0, 0.0, 0.0, 0.0, 80.0, k_0, k_1).at(s)
    assert np.abs([x, y] - np.array(spiral(s, k_0, k_1, 80.0))).max() < 1e-10
    assert heading == pytest.approx(k_0 * s + (k_1 - k_0) * s**2 / 160.0)


def test_arc_and_line_are_circle_and_line():
    s = np.linspace(0.0, 300.0, 7)
    x, y, _ = Bend(0.0, 5.0, -2.0, 0.3, 300.0, 0.02, 0.02).at(s)
    assert np.abs(x - (5.0 + (np.sin(0.3 + s / 50) - np.sin(0.3)) * 50)).max() < 1e-10
    assert np.abs(y - (-2.0 - (np.cos(0.3 + s / 50) - np.cos(0.3)) * 50)).max() < 1e-10
    x, y, _ = Bend(0.0, 5.0, -2.0, 0.3, 300.0, 0.0, 0.0).at(s)
    assert np.abs([x - 5.0 - s * np.cos(0.3), y + 2.0 - s * np.sin(0.3)]).max() < 1e-10


def test_poly3_is_measured_along_its_arc():
    v = (0.0, 0.05, 2e-3, -1e-5)
    bent = Cubic(0.0, 0.0, 0.0, 0.0, 60.0, (0.0, 1.0, 0.0, 0.0), v, by_arc=True)
    s = np.array([0.0, 7.0, 33.0, 60.0])

    def arc(u):
        return quad(lambda q: np.hypot(1.0, v[1] + 2 * v[2] * q + 3 * v[3] * q * q), 0.0, u)[0]

    u = np.array([brentq(lambda q, each=each: arc(q) - each, 0.0, 60.0) for each in s])
    x, y, _ = bent.at(s)
    assert np.abs(x - u).max() < 1e-6
    assert np.abs(y - np.polynomial.Polynomial(v)(u)).max() < 1e-6


@pytest.mark.parametrize(("rate", "scale"), [(1.0, 1.0), (1.0 / 50.0, 50.0)])
def test_param_poly3_in_both_ranges(rate, scale):
    u, v = (0.0, scale, 0.0, -1e-5 * scale**3), (0.0, 0.0, 2e-3 * scale**2, 1e-5 * scale**3)
    s = np.linspace(0.0, 50.0, 11)
    x, y, heading = Cubic(0.0, 10.0, 20.0, np.pi / 2, 50.0, u, v, rate).at(s)
    assert x == pytest.approx(10.0 - (2e-3 * s**2 + 1e-5 * s**3)) and y == pytest.approx(20.0 + s - 1e-5 * s**3)
    assert heading == pytest.approx(np.pi / 2 + np.arctan2(4e-3 * s + 3e-5 * s**2, 1.0 - 3e-5 * s**2))


def test_chords_stay_within_a_millimetre():
    line = ReferenceLine((Bend(0.0, 0.0, 0.0, 0.0, 60.0, 0.0, 0.1), Bend(60.0, *spiral(60.0, 0.0, 0.1, 60.0), 3.0, 40.0, 0.1, 0.1)))
    chords = shapely.LineString(line.at(line.stations(100.0))[:2].T)
    fine = line.at(np.linspace(0.0, 100.0, 5001))[:2].T
    assert max(chords.distance(shapely.Point(point)) for point in fine) < 0.0011
    assert max(gap for _, gap, _ in line.gaps()) < 1e-9


def test_profile_is_piecewise():
    profile = Profile(np.array([0.0, 10.0]), np.array([[1.0, 2.0], [0.5, 0.0], [0.0, 0.1], [0.0, 0.0]]))
    assert profile.at(np.array([0.0, 4.0, 10.0, 12.0])) == pytest.approx([1.0, 3.0, 2.0, 2.4])


# -- real files against the document, evaluated here ------------------------------------------------


def evaluated(geometry, s):
    """x, y, heading of one `<geometry>` at a distance s from its start, by closed forms."""
    x_0, y_0, h, length = (float(geometry.get(name)) for name in ("x", "y", "hdg", "length"))
    shape = next(iter(geometry))
    value = {key: float(text) for key, text in shape.attrib.items() if key != "pRange"}
    if shape.tag == "line":
        u, v, turn = s, 0.0, 0.0
    elif shape.tag == "arc":
        k = value["curvature"]
        u, v, turn = np.sin(k * s) / k, (1.0 - np.cos(k * s)) / k, k * s
    elif shape.tag == "spiral":
        k_0, k_1 = value["curvStart"], value["curvEnd"]
        (u, v), turn = spiral(s, k_0, k_1, length), k_0 * s + 0.5 * (k_1 - k_0) * s * s / length
    else:
        p = s if shape.get("pRange") == "arcLength" else s / length
        u, v = (np.polynomial.Polynomial([value[letter + axis] for letter in "abcd"]) for axis in "UV")
        turn = np.arctan2(v.deriv()(p), u.deriv()(p))
        u, v = u(p), v(p)
    return x_0 + u * np.cos(h) - v * np.sin(h), y_0 + u * np.sin(h) + v * np.cos(h), h + turn


def true_lanes(file):
    """The centre lines of the lanes for cars outside of junctions, half a metre from point to point, and their numbers."""
    for each in ElementTree.parse(file).getroot().iter("road"):
        if each.get("junction") != "-1":
            continue
        length, geometries = float(each.get("length")), each.findall("planView/geometry")
        starts = np.array([float(geometry.get("s")) for geometry in geometries])
        s = np.linspace(0.0, length - 1e-6, int(2 * length))
        own = [geometries[i] for i in np.searchsorted(starts, s, side="right") - 1]
        line = np.array([evaluated(geometry, at - float(geometry.get("s"))) for geometry, at in zip(own, s, strict=True)]).T
        (section,) = each.iter("laneSection")
        for side, sign in (("left", 1.0), ("right", -1.0)):
            edge = np.zeros_like(s)
            for lane in sorted(section.findall(f"{side}/lane"), key=lambda lane: abs(int(lane.get("id")))):
                (width,) = lane.findall("width")
                w = np.polynomial.Polynomial([float(width.get(letter)) for letter in "abcd"])(s)
                t, edge = edge + sign * w / 2.0, edge + sign * w
                if lane.get("type") == "driving":
                    yield each.get("id"), int(lane.get("id")), np.array([line[0] - t * np.sin(line[2]), line[1] + t * np.cos(line[2])])


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_lanes_lie_where_the_document_says(file):
    network = load(file)
    found = [lane for lane in network.lanes if not lane.internal]
    total = 0.0
    for number, lane, line in true_lanes(file):
        forward = (lane < 0) == (network.drive_side == "right")
        line = (line - np.array(network.datum)[:, None])[:, :: 1 if forward else -1]
        mine = [each for each in network.lanes if each.road.lstrip(":").split("#")[0] == ("" if forward else "-") + number]
        form = shapely.MultiLineString([each.centre.T for each in mine])
        assert shapely.distance(form, shapely.points(line.T)).max() < 0.003
        total += np.hypot(*np.diff(line)).sum()
        assert min(np.hypot(*(each.centre[:, 0] - line[:, 0])) for each in mine) < 0.01
    assert sum(lane.length for lane in found) == pytest.approx(total, rel=0.006)  # less the metres behind a stop line


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_connections_join_what_they_name(file):
    network = load(file)
    for each in network.connections:
        chain = [network.lanes[lane] for lane in (each.from_lane, *each.via, each.to_lane)]
        for a, b in itertools.pairwise(chain):
            assert np.hypot(*(a.centre[:, -1] - b.centre[:, 0])) < 0.05
            t, d = a.centre[:, -1] - a.centre[:, -2], b.centre[:, 1] - b.centre[:, 0]
            assert t @ d > 0.98 * np.hypot(*t) * np.hypot(*d)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_kerb_lanes_come_first_and_traffic_keeps_its_side(file):
    """The left neighbour of a lane is nearer to the middle where one drives on the right; the oncoming lanes lie beyond it."""
    network = load(file)
    assert network.drive_side == ("left" if "lht" in file.stem else "right")
    for one in network.roads.values():
        inner = [network.lanes[lane] for lane in one.lanes]
        back = network.roads.get(one.id.removeprefix("-") if one.id.startswith("-") else "-" + one.id)
        order = [*inner, network.lanes[back.lanes[-1]]] if back and not one.internal and "#" not in one.id else inner
        for a, b in itertools.pairwise(order):
            (t_x, t_y), middle = a.centre[:, 1] - a.centre[:, 0], b.centre[:, 0] if a.road == b.road else b.centre[:, -1]
            d_x, d_y = middle - a.centre[:, 0]
            assert (t_x * d_y - t_y * d_x) * network.middle > 0.0


def test_every_arm_leads_to_every_other():
    """Both crossings join their four arms with each other; the merge joins what its document joins."""
    for name in ("X-Intersection_NCAP", "fabriksgatan_traffic_lights"):
        network = load(FOLDER / f"{name}.xodr")
        assert len(all_routes(network)) == 12 and network.report.junctions == 1
        directions = [each.direction for each in network.connections]
        assert sorted(directions) == 4 * ["left"] + 4 * ["right"] + 4 * ["straight"]
    merge = load(FOLDER / "highway_merge.xodr")
    ways = {(way.roads(merge)[0], way.roads(merge)[-1]) for way in all_routes(merge)}
    assert ways == {("0", "2"), ("1", "2"), ("-2", "-0")}
    assert {round(lane.speed, 2) for lane in merge.lanes} == {33.33}


def test_a_path_has_the_documents_curvature():
    """ALKS road: arcs of 4e-3 to 6e-3 1/m; the smoothed path of the middle lane keeps k/(1 - k t) at t = -8 m."""
    network = load(FOLDER / "alks_road_different_curvatures.xodr")
    line = path(network, connect(network, ["0"], start_lane=1))
    s = np.cumsum(np.append(0.0, np.hypot(*np.diff(network.lanes[network.roads["0"].lanes[1]].centre))))
    assert line.length == pytest.approx(s[-1], abs=1.0)
    x, y = line.points[:2] + np.array(network.datum)[:, None]
    on_arc = np.hypot(x - 599.60, y - 6.65).argmin() + 100
    assert line.points[PATH_CURVATURE, on_arc] == pytest.approx(0.004 / (1.0 + 0.004 * 8.0), rel=0.01)
    assert line.points[PATH_CURVATURE, 200] == pytest.approx(0.0, abs=1e-6)


# -- traffic lights --------------------------------------------------------------------------------


def test_a_light_has_its_stop_line_where_it_stands():
    network = load(FOLDER / "fabriksgatan_traffic_lights.xodr")
    assert network.report.signals.in_map == network.report.signals.placed == 1
    (lane,) = network.signals.link_lane
    assert network.lanes[lane].road == "3" and network.lanes[lane].length == pytest.approx(109.0, abs=0.2)
    links = {c.link for c in network.connections if c.from_lane == lane}
    assert links == {0} and all(c.link == -1 for c in network.connections if c.from_lane != lane)
    assert {each.kind for each in network.report.skipped} >= {"light", "object", "lane"}


LIGHT = '<signals><signal id="{0}" s="{1}" t="-4" dynamic="yes" orientation="{2}" type="1000001" country="OpenDRIVE">{3}</signal></signals>'
BOTH = f'<laneSection s="0">{lanes("driving", "driving", side="left")}{lanes("driving", "driving")}</laneSection>'


@pytest.mark.parametrize(
    ("rule", "orientation", "validity", "stopped"),
    [
        ("RHT", "+", "", {("1", 80.0)}), ("RHT", "-", "", {("-1", 120.0)}), ("LHT", "+", "", {("1", 80.0)}),
        ("RHT", "none", "", {("1", 80.0), ("-1", 120.0)}), ("RHT", "+", '<validity fromLane="-2" toLane="-2"/>', {("1", 80.0)}),
    ],
)  # fmt: skip
def test_a_light_in_the_middle_of_a_road(tmp_path, rule, orientation, validity, stopped):
    """It stops the lanes that it is valid for, where it stands; the road goes on behind it."""
    network = load(
        written(
            tmp_path,
            road(sections=BOTH, rule=rule, extra="").replace("</planView>", "</planView>" + LIGHT.format("7", 80, orientation, validity)),
        )
    )
    ends = [network.lanes[lane] for lane in network.signals.link_lane]
    assert {(lane.road.split("#")[0], round(lane.length, 6)) for lane in ends} == stopped
    assert len(ends) == (1 if validity else 2 * len(stopped))
    assert {network.lanes[c.to_lane].road for c in network.connections if c.link >= 0} and network.report.signals.placed == 1


def crossing(*, lights="", reference=""):
    """A road that ends at a junction, where two others lead on, straight and to the left."""
    link = '<successor elementType="junction" elementId="J"/>'
    behind = '<predecessor elementType="junction" elementId="J"/>'
    before = '<predecessor elementType="road" elementId="in" contactPoint="end"/>'
    ways = before + '<successor elementType="road" elementId="{}" contactPoint="start"/>'
    joined = f'<laneSection s="0">{lanes("driving", inner=LINKED.format(-1))}</laneSection>'
    geometry = '<geometry s="0" x="{}" y="{}" hdg="{}" length="{}">{}</geometry>'
    straight = geometry.format(200, 0, 0, 20, "<line/>")
    bend = geometry.format(200, 0, 0, 10 * np.pi, '<arc curvature="0.05"/>')
    lane = '<laneLink from="-1" to="-1"/>'
    connection = f'<connection id="{{k}}" incomingRoad="in" connectingRoad="w{{k}}" contactPoint="start">{lane}</connection>'
    return (
        road("in", link=link, extra=lights),
        road("ahead", plan=geometry.format(220, 0, 0, 100, "<line/>"), length=100, link=behind),
        road("left", plan=geometry.format(220, 20, np.pi / 2, 100, "<line/>"), length=100, link=behind),
        road("w1", plan=straight, length=20, link=ways.format("ahead"), sections=joined, junction="J", extra=reference),
        road("w2", plan=bend, length=10 * np.pi, link=ways.format("left"), sections=joined, junction="J"),
        f'<junction id="J">{connection.format(k=1)}{connection.format(k=2)}</junction>',
    )


def test_a_junction_joins_and_names_its_directions(tmp_path):
    network = load(written(tmp_path, *crossing()))
    found = {network.lanes[c.to_lane].road: (c.direction, len(c.via)) for c in network.connections}
    assert found == {"ahead": ("straight", 1), "left": ("left", 1)}
    assert network.roads["in"].to_junction == "J" == network.roads["left"].from_junction
    assert len(network.junctions) == 1 and network.report.junctions == 1


def test_lights_within_a_junction_stop_before_it(tmp_path):
    """A light on a connecting road, and one that another road refers to: the stop line is at the end of the road that leads there."""
    inside = written(tmp_path, *crossing(reference=LIGHT.format("7", 10, "+", "")), name="inside.xodr")
    referred = LIGHT.format("7", 190, "+", "") + "<signals/>"
    twice = written(
        tmp_path,
        *crossing(lights=referred, reference='<signals><signalReference id="7" s="1" orientation="+"/></signals>'),
        name="twice.xodr",
    )
    for file in (inside, twice):
        network = load(file)
        (lane,) = network.signals.link_lane
        assert network.lanes[lane].road == "in" and all(c.link == 0 for c in network.connections)
    assert network.lanes[lane].length == pytest.approx(190.0) and {len(c.via) for c in network.connections} == {2}


def test_signals_that_are_no_lights_are_told(tmp_path):
    signs = '<signals><signal id="1" s="5" dynamic="no" type="274" country="DE"/><signal id="2" s="6" dynamic="yes" type="1000002"/>'
    network = load(written(tmp_path, road(extra=signs + '<signal id="3" s="7" dynamic="yes" type="77"/></signals>')))
    found = {each.what: (each.kind, each.where) for each in network.report.skipped}
    assert found == {
        "signal 1 of type 274 in DE": ("sign", "road 1, s = 5.0 m"), "signal 2 of type 1000002": ("light", "road 1, s = 6.0 m"),
        "signal 3 of type 77": ("light", "road 1, s = 7.0 m"),
    }  # fmt: skip
    assert len(network.signals) == 0


# -- limits ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("speed", "limit"),
    [
        ('max="50" unit="km/h"', 50.0),
        ('max="30" unit="mph"', 48.28032),
        ('max="25"', 90.0),
        ('max="25" unit="m/s"', 90.0),
        ('max="no limit"', 130.0),
    ],
)
def test_units_of_speed(tmp_path, speed, limit):
    network = load(written(tmp_path, road(extra=f'<type s="0" type="rural"><speed {speed}/></type>')))
    assert network.lanes[0].speed * 3.6 == pytest.approx(limit)
    assert network.report.speed_limits.mapped_ways == 1 and not [each for each in network.report.guesses if each.kind == "speed limit"]


@pytest.mark.parametrize(
    ("kind", "limit", "sure"),
    [
        ('type="motorway" country="DE"', 130.0, "medium"),
        ('type="rural" country="GBR"', 96.56064, "medium"),
        ('type="town" country="us"', 56.32704, "medium"),
        ('type="rural"', 90.0, "low"),
        ('type="rural" country="OpenDRIVE"', 90.0, "low"),
        ('type="lowSpeed" country="AUT"', 10.0, "medium"),
    ],
)
def test_no_limit_given_is_a_guess_by_kind_and_country(tmp_path, kind, limit, sure):
    for number, inner in enumerate(("", '<speed max="undefined"/>')):
        network = load(written(tmp_path, road(extra=f'<type s="0" {kind}>{inner}</type>'), name=f"{number}.xodr"))
        assert network.lanes[0].speed * 3.6 == pytest.approx(limit)
        (guess,) = [each for each in network.report.guesses if each.kind == "speed limit"]
        assert guess.sure == sure and "without <speed>" in guess.source and guess.where == "road 1, s = 0.0 m"


def test_limits_change_along_a_road_and_lanes_have_their_own(tmp_path):
    """80 km/h, 60 from 120 m on; the outer lane has 40 km/h of its own up to 50 m, where it gets that of the road."""
    kinds = "".join(f'<type s="{s}" type="rural"><speed max="{v}" unit="km/h"/></type>' for s, v in ((0, 80), (120, 60)))
    own = '<speed sOffset="0" max="40" unit="km/h"/><speed sOffset="50" max="undefined"/>'
    section = f'<laneSection s="0">{lanes("driving", "driving")}</laneSection>'.replace(
        'id="-2" type="driving">', 'id="-2" type="driving">' + own
    )
    network = load(written(tmp_path, road(extra=kinds, sections=section)))
    found = {
        name: [(round(network.lanes[lane].speed * 3.6), round(network.lanes[lane].length)) for lane in one.lanes]
        for name, one in network.roads.items()
    }
    assert found == {"1": [(40, 50), (80, 50)], "1#1": [(80, 70), (80, 70)], "1#2": [(60, 80), (60, 80)]}
    assert len(network.connections) == 4 and all(c.via == () for c in network.connections)


# -- cross sections --------------------------------------------------------------------------------


def test_borders_offsets_and_unused_lanes_place_the_lanes(tmp_path):
    """Lanes by their borders beside a lane offset: the centre of the outer one is 1 - 2 - 4.5 = -5 m from the reference line."""
    section = (
        '<laneOffset s="0" a="1" b="0" c="0" d="0"/><laneSection s="0"><right>'
        '<lane id="-1" type="median"><border sOffset="0" a="-2" b="0" c="0" d="0"/></lane>'
        '<lane id="-2" type="driving"><border sOffset="0" a="-6" b="0" c="0" d="0"/>'
        '<border sOffset="100" a="-6" b="-0.01" c="0" d="0"/></lane>'
        "</right></laneSection>"
    )
    network = load(written(tmp_path, road(sections=section)))
    (lane,) = network.lanes
    y = lane.centre[1] + network.datum[1]
    assert (
        y[0] == pytest.approx(1.0 - 4.0) and y[-1] == pytest.approx(1.0 - (2.0 + 7.0) / 2.0) and lane.width == pytest.approx(4.0, abs=0.1)
    )
    (guess,) = [each for each in network.report.guesses if each.kind == "lane width"]
    assert guess.source == "4.00 to 5.00 m wide"


def test_a_lane_opens_and_sections_join(tmp_path):
    """One lane, then two: the inner one goes on, the new one is reached by a lane change; where nothing changes the road is one."""
    one = f'<laneSection s="{{}}">{lanes("driving", inner=LINKED.format(-1))}</laneSection>'
    two = f'<laneSection s="100">{lanes("driving", "driving")}</laneSection>'.replace(
        '<lane id="-1" type="driving">', '<lane id="-1" type="driving">' + LINKED.format(-1)
    )
    network = load(written(tmp_path, road(sections=one.format(0) + one.format(50) + two)))
    assert {name: [round(network.lanes[lane].length) for lane in each.lanes] for name, each in network.roads.items()} == {
        "1": [100],
        "1#2": [100, 100],
    }
    (connection,) = network.connections
    assert network.lanes[connection.from_lane].road == "1" and network.lanes[connection.to_lane].index == 1
    way = connect(network, ["1", "1#2"])
    assert len(way.lanes) == 2 and path(network, way).length == pytest.approx(200.0, abs=1.0)


@pytest.mark.parametrize(("begin", "length"), [(0.2, 200.0), (100.0, 100.3), (100.0, 100.0005), (150.0, 100.0)])
def test_a_section_may_be_shorter_than_a_car_or_lie_beyond_the_end_of_its_road(tmp_path, begin, length):
    """Then it is a short piece, or none."""
    lane = lanes("driving", inner=LINKED.format(-1))
    sections = f'<laneSection s="0">{lane}</laneSection><laneSection s="{begin}">{lane}</laneSection>'
    network = load(written(tmp_path, road(length=length, sections=sections, plan=LINE.replace("200", str(length)))))
    assert sum(lane.length for lane in network.lanes) == pytest.approx(length, abs=0.01)


@pytest.mark.parametrize("length", [0.1, 0.4])
def test_a_road_shorter_than_a_stop_line_needs(tmp_path, length):
    roads = road("1", link='<successor elementType="road" elementId="2" contactPoint="start"/>'), road("2", length=length)
    assert load(written(tmp_path, *roads)).roads.keys() >= {"1"}


def test_links_between_roads_follow_their_contact(tmp_path):
    """Two roads end to end, the second one drawn backwards: its left lane goes on where the first one's right lane ends."""
    there = '<link><successor id="{}"/></link>'
    first = (
        f'<laneSection s="0">{lanes("driving", side="left", inner=there.format(-1))}{lanes("driving", inner=there.format(1))}</laneSection>'
    )
    plan = f'<geometry s="0" x="400" y="0" hdg="{np.pi}" length="200"><line/></geometry>'
    second = (
        f'<laneSection s="0">{lanes("driving", side="left", inner=there.format(-1))}{lanes("driving", inner=there.format(1))}</laneSection>'
    )
    link = '<successor elementType="road" elementId="{}" contactPoint="end"/>'
    network = load(
        written(tmp_path, road("a", sections=first, link=link.format("b")), road("b", sections=second, plan=plan, link=link.format("a")))
    )
    found = {(network.lanes[c.from_lane].road, network.lanes[c.to_lane].road) for c in network.connections}
    assert found == {("a", "-b"), ("b", "-a")}


def test_bus_lanes_are_closed_and_narrow_lanes_left_out(tmp_path):
    access = '<access sOffset="0" rule="deny" restriction="passengerCar"/>'
    section = f'<laneSection s="0">{lanes("driving", "driving", "bus", "biking")}</laneSection>'.replace(
        'id="-2" type="driving">', 'id="-2" type="driving">' + access
    )
    network = load(written(tmp_path, road(sections=section)))
    assert [lane.open for lane in network.lanes] == [False, False, True]
    assert [each.what for each in network.report.skipped] == ["1 of type biking"]


def test_left_and_right_are_mirrored(tmp_path):
    """The same document driven on the left: each lane is driven the other way."""
    right, left = (load(written(tmp_path, road(sections=BOTH, rule=rule), name=f"{rule}.xodr")) for rule in ("RHT", "LHT"))
    assert (right.drive_side, left.drive_side) == ("right", "left")
    for a, b in zip(right.lanes, left.lanes, strict=True):
        assert (a.road, a.index) == (b.road, b.index)
        assert np.abs(a.centre[1] + b.centre[1] + right.datum[1] + left.datum[1]).max() < 1e-9 and np.allclose(a.centre[0], b.centre[0])


def test_what_is_not_built_is_told_with_its_place(tmp_path):
    extra = (
        '<lateralProfile><superelevation s="20" a="0.05" b="0" c="0" d="0"/>'
        '<superelevation s="0" a="0" b="0" c="0" d="0"/></lateralProfile>'
        '<objects><object id="5" type="tree" s="60" t="9"/><bridge id="6" s="70" length="9"/></objects>'
        '<surface><CRG file="rough.crg" sStart="1" sEnd="2"/></surface>'
    )
    place = "+proj=tmerc +lat_0=52 +lon_0=13 +k=1 +x_0=0 +y_0=0 +ellps=WGS84"
    head = f"<header><geoReference><![CDATA[{place}]]></geoReference></header>"
    network = load(written(tmp_path, road(extra=extra), head=head))
    found = {(each.kind, each.where) for each in network.report.skipped}
    assert found == {
        ("superelevation", "road 1, s = 20.0 m"),
        ("object", "road 1, s = 60.0 m"),
        ("surface", "road 1, s = 1.0 m"),
    }
    (bridge,) = (each for each in network.report.guesses if each.kind == "level")
    assert (bridge.what, bridge.where) == ("level 1 for 9.0 m", "road 1, s = 70.0 m")
    tree = next(each for each in network.report.skipped if each.kind == "object")
    assert tree.latitude == pytest.approx(52.0, abs=1e-6) and tree.longitude == pytest.approx(13.0 + 60.0 / 68_678.0, abs=1e-6)


# -- the place on earth ----------------------------------------------------------------------------


def test_the_origin_is_the_georeferences(tmp_path):
    """UTM zone 33 with its false easting; the middle of the road is (0, 0), and says where it lies in the document's plane."""
    head = "<header><geoReference>+proj=utm +zone=33 +datum=WGS84 +units=m +no_defs</geoReference></header>"
    far = LINE.replace('x="0" y="0"', 'x="391677" y="5819566"')
    network = load(written(tmp_path, road(plan=far), head=head))
    assert network.origin == pytest.approx((52.5145, 13.4060), abs=0.002) and network.datum == (391777.0, 5819566.0)
    assert np.abs(network.lanes[0].centre).max() < 101.0 and network.report.country == "Germany"
    assert not [each for each in network.report.guesses if each.kind == "origin"]


@pytest.mark.parametrize(("text", "source"), [("", "no <geoReference>"), ("<geoReference>somewhere</geoReference>", "cannot be read")])
def test_no_origin_is_a_guess(tmp_path, text, source):
    network = load(written(tmp_path, road(), head=f"<header>{text}</header>"))
    (guess,) = [each for each in network.report.guesses if each.kind == "origin"]
    assert source in guess.source and guess.sure == "low" and network.report.country == ""
    assert network.origin == pytest.approx((0.0, 100.0 / 111_320.0), abs=1e-5)


# -- attribution, licence and the folder -----------------------------------------------------------


def test_attribution_is_the_headers():
    assert load(FOLDER / "alks_road_straight.xodr").attribution == "ALKS Road, BMW AG"
    assert place.attribution(FOLDER / "alks_road_straight.xodr") == "ALKS Road, BMW AG"
    assert load(FOLDER / "e6mini.xodr").attribution == place.attribution(FOLDER / "e6mini.xodr") == ""
    head = b'<OpenDRIVE><header name="A" vendor="B"><license name="CC0" resource="x"/></header><road'
    assert read_header(head) == Header("A", "B", "CC0", "")


def studio(*arguments):
    done = subprocess.run([sys.executable, "-m", "studio.cli", *map(str, arguments)], capture_output=True, text=True, timeout=PATIENCE)
    return done.returncode, done.stdout, done.stderr


def test_the_folder_is_that_of_every_import(tmp_path):
    file = FOLDER / "fabriksgatan_traffic_lights.xodr"
    code, output, _ = studio("import", file, "--out", tmp_path / "street", "--json")
    assert code == 0
    text = json.loads((tmp_path / "street" / "report.json").read_text())
    assert text == json.loads(output) and text["licence"] == "" and "ODbL" not in output and "OpenStreetMap" not in output
    assert {"drive_side", "lane_km", "junctions", "signals", "turn_lanes", "speed_limits", "guesses", "skipped"} <= set(text)
    assert sorted(each.name for each in (tmp_path / "street").iterdir()) == ["map.xodr", "network.json.gz", "report.json"]
    opened = load(tmp_path / "street")
    assert opened.digest == load(file).digest and opened.name == "street" and place.attribution(tmp_path / "street") == ""
    network = json.loads(gzip.decompress((tmp_path / "street" / "network.json.gz").read_bytes()))
    assert len(network["lanes"]) == len(opened.lanes)
    with pytest.raises(MapError, match="taken whole"):
        load(file, bbox="0,0,1,1")
    assert load(file, radius=100.0).digest == load(file).digest


# -- bad input -------------------------------------------------------------------------------------

BOMB = '<!DOCTYPE OpenDRIVE [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><OpenDRIVE>&b;</OpenDRIVE>'
REFUSED = {
    "empty": ("", "empty"),
    "blank": ("  \n", "empty"),
    "bomb": (BOMB, "entities"),
    "wide bomb": (BOMB.encode("utf-16"), "entities"),
    "encoding": ('<?xml version="1.0" encoding="klingon"?><OpenDRIVE/>', "encoding"),
    "text": ("road 1", "not XML"),
    "cut off": (FILES[0].read_bytes()[:1200], "cut off"),
    "another root": ('<osm version="0.6"></osm>', "root element is <osm>"),
    "no roads": ('<OpenDRIVE><header revMajor="1"/></OpenDRIVE>', "no roads"),
    "version": (f'<OpenDRIVE><header revMajor="2"/>{road()}</OpenDRIVE>', "revMajor"),
}
WRONG = {
    "no geometry": (road("7", plan=""), "road 7: <planView>"),
    "no lanes": (road("7", sections=" "), "road 7: <lanes>"),
    "unknown geometry": (road("7", plan=LINE.replace("line", "wave")), "road 7, <geometry> at s = 0: <wave>"),
    "not a number": (road("7", plan=LINE.replace('hdg="0"', 'hdg="north"')), "road 7: hdg of <geometry>"),
    "infinite": (road("7", plan=LINE.replace('x="0"', 'x="inf"')), "road 7: x of <geometry>"),
    "missing": (road("7", plan=LINE.replace('y="0"', "")), "road 7: y of <geometry> is missing"),
    "endless": (road("7", plan=LINE.replace("200", "1e9")), "length is 1e[+]09 m"),
    "curled": (road("7", plan=LINE.replace("<line/>", '<arc curvature="20"/>')), "curvature is 20 1/m"),
    "torn": (road("7", length=300, plan=LINE + LINE.replace('s="0" x="0"', 's="200" x="240"')), "begins 40 m beside"),
    "sidewalk": (road("7", sections=f'<laneSection s="0">{lanes("sidewalk", "border")}</laneSection>'), "no roads for cars"),
    "narrow": (road("7", sections=f'<laneSection s="0">{lanes("driving", width=0.5)}</laneSection>'), "no roads for cars"),
    "late section": (road("7", sections=f'<laneSection s="900">{lanes("driving")}</laneSection>'), "road 7: its first <laneSection>"),
    "vast width": (road("7", sections=f'<laneSection s="0">{lanes("driving")}</laneSection>').replace('d="0"', 'd="9"'),
                   "road 7: <lane> -1 of the <laneSection>"),
    "stretched": (road("7", plan=LINE.replace("<line/>", '<paramPoly3 aU="0" bU="9000" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0"/>')),
                  "far longer"),
    "sky": (road("7", extra='<elevationProfile><elevation s="0" a="0" b="400" c="0" d="0"/></elevationProfile>'), "road 7: <elevation>"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_map_is_refused(tmp_path, case):
    content, says = REFUSED[case]
    target = tmp_path / "bad.xodr"
    target.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(MapError, match=says) as error:
        load(target)
    assert str(error.value).startswith(str(target)) and "Traceback" not in str(error.value)


@pytest.mark.parametrize("case", WRONG)
def test_a_refusal_names_the_element(tmp_path, case):
    """Of a map whose only road cannot be used; beside others it costs that road alone (test_flaws.py)."""
    content, says = WRONG[case]
    with pytest.raises(MapError, match=says) as error:
        load(written(tmp_path, content))
    assert "map.xodr" in str(error.value)


def test_refused_files_leave_no_folder(tmp_path):
    bad = tmp_path / "bad.xodr"
    bad.write_text(BOMB)
    code, output, errors = studio("import", bad, "--out", tmp_path / "out" / "place")
    assert code == 2 and "entities" in errors and "Traceback" not in errors and not output
    assert not (tmp_path / "out").exists()
    with pytest.raises(MapError, match="no such map file"):
        load(tmp_path / "gone.xodr")
    with pytest.raises(MapError, match="cannot be read"):
        place.attribution(tmp_path / "gone.xodr")
