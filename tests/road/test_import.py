"""A real place becomes lanes, signals and scenery."""

import itertools

import numpy as np
import pyproj
import pytest

from studio.road import load
from studio.road.formats import osm
from studio.road.formats.netconvert import DEFAULT_LANE_WIDTH
from studio.road.ways.route import arms


@pytest.fixture(scope="module")
def survey(map_file):
    return osm.survey(map_file, osm.read(map_file))


@pytest.fixture(scope="module")
def box(survey):
    return osm.clip_box(survey, radius=None)


def test_local_metres_are_metres_on_the_ground(box):
    latitude, longitude = box.centre
    (x0, x1), (y0, y1) = box.local([latitude, latitude + 0.005], [longitude, longitude + 0.008])
    *_, ground = pyproj.Geod(ellps="WGS84").inv(longitude, latitude, longitude + 0.008, latitude + 0.005)
    assert (x0, y0) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert np.hypot(x1, y1) == pytest.approx(ground, rel=1e-6)


def test_degrees_undo_local(box):
    points = np.array([[-300.0, 12.5], [700.0, -3.0]])
    longitude, latitude = np.array(box.degrees(points)).T
    assert box.local(latitude, longitude) == pytest.approx(points, abs=1e-6)


def test_there_are_as_many_lane_kilometres_as_mapped(place, survey, box):
    """Two-way streets do not occur here. What the lanes lack is in the junctions, where lanes split as well."""
    ids = itertools.count(10**15)
    pieces = [piece for way in survey.ways for piece in osm.cut(way, box, ids)]
    mapped = sum(length(piece, box) * int(piece.tags["lanes"]) for piece in pieces)
    built = sum(lane.length for lane in place.lanes if not lane.internal)
    assert built < mapped < built + sum(lane.length for lane in place.lanes if lane.internal)


def length(way, box):
    longitude, latitude = np.array(way.points).T
    return np.hypot(*np.diff(box.local(latitude, longitude))).sum()


def test_five_arms_lead_in_and_out(place, routes):
    entries, exits = arms(place)
    streets = {"Straße des 17. Juni", "Spreeweg", "Altonaer Straße", "Hofjägerallee"}
    assert len(entries) == len(exits) == 5
    assert {place.roads[road].name for road in (*entries, *exits)} == streets
    assert len(routes) == 25


def test_ways_end_at_the_box(place):
    x0, y0, x1, y1 = place.bounds
    for lane in place.lanes:
        assert (lane.centre[0] > x0 - 15).all() and (lane.centre[0] < x1 + 15).all()
        assert (lane.centre[1] > y0 - 15).all() and (lane.centre[1] < y1 + 15).all()


def test_lanes_are_sound(place):
    for number, lane in enumerate(place.lanes):
        assert lane.id == number and place.roads[lane.road].lanes[lane.index] == number
        assert np.isfinite(lane.centre).all() and lane.width == DEFAULT_LANE_WIDTH
        assert lane.speed == pytest.approx(50 / 3.6, abs=0.01)


def test_connections_join_what_they_name(place):
    for connection in place.connections:
        chain = [connection.from_lane, *connection.via, connection.to_lane]
        for a, b in itertools.pairwise(chain):
            assert np.hypot(*(place.lanes[a].centre[:, -1] - place.lanes[b].centre[:, 0])) < 0.05


def test_mapped_signals_have_a_stop_line(place, survey, box):
    """All but those that stand where the map is cut: nothing lies behind them."""
    inner = {node for way in survey.ways for node in way.nodes[1:-1]}
    shared = [node for way in survey.ways for node in (way.nodes[0], way.nodes[-1])]
    inner |= {node for node in shared if shared.count(node) > 1}
    near = []
    for way in survey.ways:
        for node, (longitude, latitude) in zip(way.nodes, way.points, strict=True):
            x, y = box.local(latitude, longitude)
            within = box.west < longitude < box.east and box.south < latitude < box.north
            if survey.nodes.get(node, {}).get("highway") == "traffic_signals" and node in inner and within:
                near.append(np.hypot(place.signals.link_x - x, place.signals.link_y - y).min() < 15.0)
    assert len(near) >= 15 and np.mean(near) >= 0.9


def test_the_column_stands_in_the_middle(place):
    """The building under the statue of the Siegessäule is mapped with 58.59 m."""
    tallest = max(place.scenery.buildings, key=lambda building: building.height)
    assert tallest.height == pytest.approx(58.59)
    assert np.hypot(*tallest.outline.mean(axis=1)) < 30.0


def test_radius_cuts_the_place(map_file, own_cache):
    small = load(map_file, radius=150.0)
    assert np.abs(small.bounds) == pytest.approx(150.0, rel=0.01)
    assert max(np.abs(lane.centre).max() for lane in small.lanes) < 165.0


def test_the_importer_tells_what_it_does(map_file, own_cache):
    told = []
    load(map_file, progress=told.append)
    load(map_file, progress=told.append)
    assert len(told) == 3


def test_outline_with_parts_is_drawn_once(draft, tmp_path, own_cache):
    a, b = draft.node(52.5, 13.4), draft.node(52.502, 13.4)
    draft.way(1, [a, b], highway="residential")
    corners = [(52.5010, 13.4010), (52.5010, 13.4013), (52.5012, 13.4013), (52.5012, 13.4010)]
    ring = [draft.node(*corner) for corner in corners]
    draft.way(2, [*ring, ring[0]], building="yes", height="30")
    draft.way(3, [*ring, ring[0]], building__part="yes", height="20", min_height="5")
    loaded = load(draft.write(tmp_path / "house.osm"))
    assert [(b.height, b.base) for b in loaded.scenery.buildings] == [(20.0, 5.0)]


def test_height_from_levels_and_default(draft, tmp_path, own_cache):
    draft.way(1, [draft.node(52.5, 13.4), draft.node(52.502, 13.4)], highway="residential")
    for i, tags in enumerate(({"building__levels": "4"}, {"height": "12,5 m"}, {"height": "high"})):
        lon = 13.401 + 0.001 * i
        ring = [draft.node(lat, lon + d) for lat, d in ((52.501, 0), (52.501, 3e-4), (52.5012, 3e-4), (52.5012, 0))]
        draft.way(10 + i, [*ring, ring[0]], building="yes", **tags)
    loaded = load(draft.write(tmp_path / "heights.osm"))
    assert sorted(b.height for b in loaded.scenery.buildings) == [9.0, 12.0, 12.5]
