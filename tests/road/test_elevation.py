"""Heights: from OpenDRIVE's elevation as they are, from OpenStreetMap's `ele` tags as a smooth guess, and none where none is known."""

import itertools
import math
from pathlib import Path as File
from xml.etree import ElementTree

import numpy as np
import pytest

from studio.road import load
from studio.road.assembly import elevation
from studio.road.drawn.motorway import motorway
from studio.road.ways.path import PATH_HEIGHT, PATH_SLOPE, path
from studio.road.ways.route import all_routes, connect

MAPS = File(__file__).parents[1] / "reference"
STEP = 0.0009  # [deg] of latitude: 100 m


@pytest.fixture(autouse=True)
def cache(own_cache):
    return own_cache


# -- OpenDRIVE -------------------------------------------------------------------------------------


def test_lanes_have_the_elevation_of_the_document():
    """e6mini: every lane's height is the profile at the station that its point belongs to, forward and backward."""
    file = MAPS / "opendrive" / "e6mini.xodr"
    rows = [[float(each.get(k)) for k in "sabcd"] for each in ElementTree.parse(file).getroot().iter("elevation")]
    network = load(file)
    for lane in network.lanes:
        assert lane.height.shape == (lane.centre.shape[1],)
        share = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(lane.centre)))]) / lane.length
        s = 1464.4343507055999 * (share if lane.road == "0" else 1.0 - share)
        expected = [
            next(a + (x - at) * (b + (x - at) * (c + (x - at) * d)) for at, a, b, c, d in reversed(rows) if x >= at - 1e-6) for x in s
        ]
        assert np.abs(lane.height - expected).max() < 0.02 and np.ptp(lane.height) > 0.5


def test_a_path_has_the_profiles_slope(tmp_path):
    """A hilly motorway: height and slope of every path are those of the parabolas, within what lane lengths differ."""
    file = tmp_path / "hills.xodr"
    file.write_text(motorway(grade=0.04))
    rows = [[float(each.get(k)) for k in "sabc"] for each in ElementTree.parse(file).getroot().iter("elevation")]
    network = load(file)
    for name, sign in (("motorway", 1), ("-motorway", -1)):
        line = path(network, connect(network, [name], start_lane=2))
        s = np.arange(line.points.shape[1]) * 6000.0 / line.length
        s = s if sign > 0 else 6000.0 - s
        at = [next(row for row in reversed(rows) if x >= row[0] - 1e-9 or row is rows[0]) for x in s]
        height = np.array([a + b * (x - s_0) + c * (x - s_0) ** 2 for x, (s_0, a, b, c) in zip(s, at, strict=True)])
        slope = sign * np.array([b + 2.0 * c * (x - s_0) for x, (s_0, _, b, c) in zip(s, at, strict=True)])
        assert np.abs(line.points[PATH_HEIGHT] - height).max() < 0.3 and np.ptp(height) > 30.0
        assert np.abs(line.points[PATH_SLOPE] - slope).max() < 0.001
        assert np.abs(np.diff(line.points[PATH_SLOPE])).max() < 1.1 / 8800.0
        assert line.points[PATH_SLOPE] == pytest.approx(np.gradient(line.points[PATH_HEIGHT]))


def test_where_nothing_is_known_heights_are_zero_to_the_bit(place, paths):
    assert all(lane.height.tobytes() == np.zeros(lane.centre.shape[1]).tobytes() for lane in place.lanes)
    for line in paths:
        rows = line.points[[PATH_HEIGHT, PATH_SLOPE]]
        assert rows.tobytes() == np.zeros_like(rows).tobytes()


# -- OpenStreetMap ---------------------------------------------------------------------------------


def street(draft, tmp_path, heights, name="hill.osm"):
    """A street north with a node every 100 m, of which some have `ele`."""
    nodes = [draft.node(52.5 + STEP * i, 13.4, **({} if ele is None else {"ele": ele})) for i, ele in enumerate(heights)]
    draft.way(1, nodes, highway="residential", oneway="yes")
    return load(draft.write(tmp_path / name))


def along(network):
    """The path of the street."""
    (way,) = all_routes(network)
    return path(network, way).points


def kinds(network, kind="elevation"):
    report = network.report
    return [each for each in (*report.guesses, *report.skipped) if each.kind == kind]


def test_an_even_slope_stays_one(draft, tmp_path):
    """Tags every 100 m on 4 %: the path climbs 4 % all along; nothing is bent where nothing has to."""
    points = along(street(draft, tmp_path, [str(34 + 4 * i) for i in range(9)]))
    assert points[PATH_SLOPE, 100:-100] == pytest.approx(0.04, abs=0.0015)
    assert points[PATH_HEIGHT, 0] == pytest.approx(34.0, abs=0.5) and points[PATH_HEIGHT, -1] == pytest.approx(66.0, abs=0.5)


def test_rounded_tags_make_no_steps(draft, tmp_path):
    """2 % in whole metres on nodes 25 m apart rises by 0 and 1 m in turn; the road rises evenly."""
    nodes = [draft.node(52.5 + STEP * i / 4, 13.4, ele=str(round(100 + 0.5 * i + 0.01))) for i in range(33)]
    draft.way(1, nodes, highway="residential", oneway="yes")
    points = along(load(draft.write(tmp_path / "steps.osm")))
    assert np.abs(points[PATH_SLOPE, 60:-60] - 0.02).max() < 0.012
    assert np.abs(np.diff(points[PATH_SLOPE])).max() < 2e-3


def test_between_tags_it_is_interpolated_and_rounded_off(draft, tmp_path):
    """Level at 0, up to 10 m between 400 and 600 m, level again: no kink, and in the middle the half of it."""
    points = along(street(draft, tmp_path, ["0", "0", None, "0", "0", None, "10", "10", None, "10", "10"]))
    assert points[PATH_HEIGHT, 500] == pytest.approx(5.0, abs=0.5) and points[PATH_SLOPE].max() < 0.08
    assert np.abs(np.diff(points[PATH_SLOPE])).max() < 2e-3  # at 50 km/h less than 0.4 m/s² upwards
    assert points[PATH_SLOPE, 5:30] == pytest.approx(0.0, abs=0.01)


def test_a_lone_tag_is_a_guess_and_no_cliff(draft, tmp_path):
    network = street(draft, tmp_path, [None, None, "250", None, None])
    assert not along(network)[[PATH_HEIGHT, PATH_SLOPE]].any()
    (guess,) = kinds(network)
    assert guess.sure == "low" and "250" in guess.source


@pytest.mark.parametrize("slip", ["3500", "-99", "tall", "1e9", "NaN", "99999"])
def test_slips_are_left_out(draft, tmp_path, slip):
    network = street(draft, tmp_path, ["30", "31", slip, "33", "34", "35"])
    points = along(network)
    assert points[PATH_SLOPE, 60:-60] == pytest.approx(0.01, abs=0.004)
    skipped = [each for each in kinds(network) if hasattr(each, "reason")]
    assert [each.what for each in skipped] == ([f"ele={slip}"] if slip in ("3500", "-99") else [])


def test_streets_that_hang_together_meet_at_one_height(draft, tmp_path):
    """A crossing on a slope: where lanes join, heights join; a street of another part without tags stays level."""
    middle = draft.node(52.5, 13.4)
    arms = [
        draft.node(52.5 + 2 * STEP * math.cos(k), 13.4 + 3.3 * STEP * math.sin(k), ele=str(50 + 8 * math.cos(k)))
        for k in (0, math.pi / 2, math.pi, -math.pi / 2)
    ]
    for number, node in enumerate(arms):
        draft.way(number + 1, [node, middle], highway="residential")
    draft.way(9, [draft.node(52.51, 13.41), draft.node(52.51, 13.412)], highway="residential")
    network = load(draft.write(tmp_path / "cross.osm"))
    for each in network.connections:
        chain = [network.lanes[lane] for lane in (each.from_lane, *each.via, each.to_lane)]
        for a, b in itertools.pairwise(chain):
            assert a.height[-1] == pytest.approx(b.height[0], abs=0.01)
    heights = {lane.road.removeprefix("-").split("#")[0]: lane.height for lane in network.lanes if not lane.internal}
    assert not heights["9"].any() and np.ptp(heights["1"]) > 4.0
    assert max(np.abs(h).max() for h in heights.values()) == pytest.approx(58.0, abs=1.0)


@pytest.mark.parametrize(
    ("text", "height"),
    [("34.5", 34.5), (" 12 m", 12.0), ("100 ft", 30.48), ("12,5", 12.5), ("", None), ("12 km", None), ("-500", None), ("inf", None)],
)
def test_what_a_tag_means(text, height):
    assert elevation.metres(text) == height
