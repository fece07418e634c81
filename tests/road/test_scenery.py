"""Scenery: what is drawn beside the road lies where it is mapped, is as large as it is mapped, and faces the right way."""

import gzip
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import shapely

from studio.road import load, scenery
from studio.road.formats import kind, osm
from studio.road.network import SPACE_HEADING, SPACE_LENGTH, SPACE_WIDTH, Area, Crossing, Scenery
from studio.road.network.outline import road_form
from studio.road.network.plane import polygon, rectangles
from studio.road.scenery import parking
from studio.scene.city import line, marking
from studio.scene.city.area import area_forms
from tests.road.conftest import lane, network

LAT, LON = 52.0, 10.0
BOX = osm.Box(LAT - 0.003, LON - 0.005, LAT + 0.003, LON + 0.005)
MUNICH = Path(__file__).parents[1] / "reference" / "maps" / "munich_olympiapark.osm.gz"


class Plan:
    """Writes a map in local metres."""

    def __init__(self, draft):
        self.draft, self.ways = draft, 0
        draft.lines.append(f'<bounds minlat="{BOX.south}" minlon="{BOX.west}" maxlat="{BOX.north}" maxlon="{BOX.east}"/>')

    def node(self, x, y, **tags):
        ((lon, lat),) = BOX.degrees(np.array([[x], [y]], dtype=float))
        return self.draft.node(f"{lat:.9f}", f"{lon:.9f}", **tags)

    def way(self, places, **tags):
        """A way through places, each a node's number or (x, y)."""
        self.ways += 1
        self.draft.way(self.ways, [each if isinstance(each, int) else self.node(*each) for each in places], **tags)
        return self.ways

    def area(self, x, y, length, width, angle=0.0, **tags):
        """A rectangle about (x, y)."""
        ring = np.array(rectangles(np.array([x]), np.array([y]), angle, np.array([length]), np.array([width]))[0].exterior.coords)
        first = [self.node(*corner) for corner in ring[:-1]]
        return self.way([*first, first[0]], **tags)

    def relation(self, members, **tags):
        inner = "".join(f'<member type="way" ref="{way}" role="{role}"/>' for way, role in members)
        inner += "".join(f'<tag k="{key}" v="{value}"/>' for key, value in {"type": "multipolygon", **tags}.items())
        self.draft.lines.append(f'<relation id="{9000 + self.ways}" version="1">{inner}</relation>')

    def load(self, folder):
        return load(self.draft.write(folder / "plan.osm"))


@pytest.fixture
def plan(draft, own_cache):
    return Plan(draft)


STREET = {"highway": "residential", "name": "Street"}


# -- parking ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_one_drives_into_a_space_away_from_its_aisle(plan, tmp_path, side):
    plan.way([(-150, 0), (150, 0)], **STREET)
    plan.area(20.0, side * 9.0, 5.2, 2.4, np.pi / 2, amenity="parking_space")
    spaces = plan.load(tmp_path).scenery.spaces
    assert spaces.shape[1] == 1
    assert spaces[:2, 0] == pytest.approx([20.0, side * 9.0], abs=0.02)
    assert np.cos(spaces[SPACE_HEADING, 0] - side * np.pi / 2) == pytest.approx(1.0, abs=1e-4)
    assert spaces[[SPACE_LENGTH, SPACE_WIDTH], 0] == pytest.approx([5.2, 2.4], abs=0.01)


@pytest.mark.parametrize(("side", "oneway", "heading"), [(-1, "no", 0.0), (1, "no", np.pi), (1, "yes", 0.0), (-1, "yes", 0.0)])
def test_a_space_along_a_street_points_with_the_traffic(plan, tmp_path, side, oneway, heading):
    """One drives on the right in Germany: north of a street that leads east, traffic comes from the east."""
    plan.way([(-150, 0), (150, 0)], **STREET, oneway=oneway)
    plan.area(20.0, side * 5.0, 5.5, 2.0, amenity="parking_space")
    (found,) = plan.load(tmp_path).scenery.spaces.T
    assert np.cos(found[SPACE_HEADING] - heading) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("slant", [np.radians(45.0), np.radians(60.0), np.radians(120.0)])
def test_a_slanted_space_is_entered_from_its_aisle(plan, tmp_path, slant):
    plan.way([(-150, 0), (150, 0)], highway="service", service="parking_aisle")
    plan.way([(-150, 50), (150, 50)], **STREET)
    plan.area(0.0, 6.0, 5.0, 2.5, slant, amenity="parking_space")
    (found,) = plan.load(tmp_path).scenery.spaces.T
    assert np.cos(found[SPACE_HEADING] - slant) == pytest.approx(1.0, abs=1e-4)


def test_an_outline_with_a_capacity_is_as_many_spaces_side_by_side(plan, tmp_path):
    plan.way([(-150, 0), (150, 0)], **STREET)
    plan.area(0.0, 9.0, 15.0, 5.0, amenity="parking_space", capacity="6")
    spaces = plan.load(tmp_path).scenery.spaces
    assert np.sort(spaces[0]) == pytest.approx(np.arange(-6.25, 6.5, 2.5), abs=0.02)
    assert spaces[[SPACE_LENGTH, SPACE_WIDTH]] == pytest.approx(np.array([[5.0] * 6, [2.5] * 6]), abs=0.01)
    assert np.sin(spaces[SPACE_HEADING]) == pytest.approx(1.0, abs=1e-4)


def test_a_space_that_is_but_a_point_has_the_usual_size_and_is_told_as_a_guess(plan, tmp_path):
    plan.way([(-150, 0), (150, 0)], **STREET)
    plan.node(10.0, 8.0, amenity="parking_space")
    found = plan.load(tmp_path)
    assert found.scenery.spaces[:, 0] == pytest.approx([10.0, 8.0, np.pi / 2, *parking.USUAL], abs=0.02)
    assert [guess.kind for guess in found.report.guesses].count("parking space") == 1
    assert found.report.parking.spaces == 1


def test_spaces_along_kerbs_keep_off_road_crossing_driveway_and_tree(plan, tmp_path):
    crossing = plan.node(0.0, 0.0, highway="crossing", crossing="zebra")
    plan.way([(-100, 0), crossing, (100, 0)], **STREET, parking__both="lane")
    plan.way([(50, 0), (50, 40)], highway="service")
    plan.node(-60.0, -4.3, natural="tree")
    found = plan.load(tmp_path)
    spaces = found.scenery.spaces
    forms = rectangles(*spaces)
    assert found.report.parking.along_kerbs == spaces.shape[1] > 40
    assert not shapely.intersects(road_form(found), forms).any()
    right = spaces[1] < 0
    assert np.cos(spaces[SPACE_HEADING, right]) == pytest.approx(1.0) and np.cos(spaces[SPACE_HEADING, ~right]) == pytest.approx(-1.0)
    # the zebra is 4 m wide, and 5 m on both sides stay free
    assert (np.abs(spaces[0]) - spaces[SPACE_LENGTH] / 2 >= 7.0 - 0.11).all()
    assert not shapely.contains_xy(shapely.union_all(forms), [50.0, -60.0], [6.0, -4.3]).any()
    pairs = shapely.STRtree(forms).query(forms, predicate="overlaps")
    assert pairs.shape[1] == 0


@pytest.mark.parametrize(
    ("tags", "expected"),
    [
        ({"parking:lane:right": "perpendicular"}, {"right": "perpendicular"}),
        ({"parking:lane:both": "parallel", "parking:lane:left": "no"}, {"right": "parallel"}),
        ({"parking:both": "no"}, {}),
        ({"parking:both": "separate"}, {}),
        ({"parking:left": "street_side", "parking:left:orientation": "diagonal"}, {"left": "diagonal"}),
        ({"parking:both": "half_on_kerb"}, {"left": "parallel", "right": "parallel"}),
    ],
)
def test_how_one_parks_along_a_way(tags, expected):
    assert parking.kerbs(tags) == expected


def test_parking_below_the_ground_is_not_drawn_and_told(plan, tmp_path):
    plan.way([(-150, 0), (150, 0)], **STREET)
    plan.area(0.0, 40.0, 30.0, 30.0, amenity="parking", parking="underground")
    plan.area(60.0, 40.0, 30.0, 30.0, amenity="parking", parking="surface")
    found = plan.load(tmp_path)
    (area,) = found.scenery.areas
    assert area.kind == "parking" and polygon(area).area == pytest.approx(900.0, rel=1e-3)
    assert [each.reason for each in found.report.skipped if each.kind == "parking"] == ["parking=underground is not in the open"]


# -- crossings -------------------------------------------------------------------------------------


def test_a_crossing_lies_across_the_road_from_edge_to_edge(plan, tmp_path):
    """The street leads to the north-east, two lanes of 3.2 m."""
    node = plan.node(10.0, 10.0, highway="crossing", crossing_ref="zebra")
    plan.way([(-120, -120), node, (120, 120)], **STREET)
    found = plan.load(tmp_path)
    (crossing,) = found.scenery.crossings
    across = np.diff(crossing.line)[:, 0]
    assert np.hypot(*across) == pytest.approx(6.4, abs=0.05)
    assert abs(across @ [1.0, 1.0]) < 0.05
    assert crossing.line.mean(axis=1) == pytest.approx([10.0, 10.0], abs=0.1)
    assert crossing.marking == "zebra" and not crossing.signalled
    assert found.report.crossings.zebra == 1


def test_a_mapped_way_and_its_point_are_one_crossing_and_the_point_tells_its_kind(plan, tmp_path):
    node = plan.node(0.0, 0.0, highway="crossing", crossing="traffic_signals")
    plan.way([(-150, 0), node, (150, 0)], **STREET)
    plan.way([(-3, -8), node, (3, 8)], highway="footway", footway="crossing")
    (crossing,) = plan.load(tmp_path).scenery.crossings
    # 6.4 m straight over, but the way runs at an angle
    assert np.hypot(*np.diff(crossing.line)[:, 0]) == pytest.approx(6.4 * np.hypot(3, 8) / 8, abs=0.05)
    assert crossing.marking == "lines" and crossing.signalled


def test_a_crossing_of_a_path_that_is_not_built_is_told(plan, tmp_path):
    plan.way([(-150, 0), (150, 0)], **STREET)
    plan.way([(-50, 40), plan.node(0.0, 40.0, highway="crossing", crossing="zebra"), (50, 40)], highway="cycleway")
    found = plan.load(tmp_path)
    assert not found.scenery.crossings
    assert [each.reason for each in found.report.skipped if each.kind == "crossing"] == ["leads over no road that is built"]


@pytest.mark.parametrize(
    ("tags", "expected"),
    [
        ({"crossing": "zebra"}, ("zebra", False)),
        ({"crossing": "marked"}, ("zebra", False)),
        ({"crossing": "uncontrolled"}, ("zebra", False)),
        ({"crossing": "uncontrolled", "crossing:markings": "no"}, ("none", False)),
        ({"crossing": "unmarked"}, ("none", False)),
        ({}, ("none", False)),
        ({"crossing": "traffic_signals"}, ("lines", True)),
        ({"crossing": "traffic_signals", "crossing:markings": "zebra:paired"}, ("zebra", True)),
        ({"crossing_ref": "pelican"}, ("lines", True)),
        ({"crossing:signals": "yes", "crossing:markings": "dots"}, ("lines", True)),
    ],
)
def test_what_is_painted_at_a_crossing(tags, expected):
    assert (kind.markings(tags), kind.is_signalled(tags)) == expected


def test_a_zebra_has_stripes_of_half_a_metre_along_the_road():
    crossing = Crossing(np.array([[0.0, 0.0], [-4.0, 4.0]]), 4.0, "zebra", False)
    stripes = list(marking.crossing_pieces(crossing))
    assert len(stripes) == 8
    assert [stripe.area for stripe in stripes] == pytest.approx([0.5 * 4.0] * 8)
    assert np.diff([stripe.centroid.y for stripe in stripes]) == pytest.approx(1.0)
    assert shapely.union_all(stripes).centroid.y == pytest.approx(0.0)


def test_a_crossing_with_lights_has_two_broken_lines():
    crossing = Crossing(np.array([[0.0, 10.4], [0.0, 0.0]]), 3.5, "lines", True)
    pieces = list(marking.crossing_pieces(crossing))
    assert len(pieces) == 2 * 15
    assert sum(piece.area for piece in pieces) == pytest.approx(30 * 0.5 * line.LINE_WIDTH)
    assert {round(abs(piece.centroid.y), 3) for piece in pieces} == {round((3.5 - line.LINE_WIDTH) / 2, 3)}
    assert not list(marking.crossing_pieces(Crossing(crossing.line, 3.0, "none", False)))


def test_lane_lines_end_before_a_painted_crossing(plan, tmp_path):
    node = plan.node(0.0, 0.0, highway="crossing", crossing="zebra")
    plan.way([(-150, 0), node, (150, 0)], **STREET)
    found = plan.load(tmp_path)
    painted = shapely.union_all(marking.painted(found, road_form(found), marking.marks_of(found)))
    (crossing,) = found.scenery.crossings
    strip = marking.ground_of(crossing)
    # six stripes on 6.4 m and nothing else
    assert painted.intersection(strip).area == pytest.approx(6 * 0.5 * 4.0, rel=0.01)


# -- walls, posts, trees ---------------------------------------------------------------------------


def test_walls_keep_off_the_road_and_have_their_heights(plan, tmp_path):
    plan.way([(-150, 0), (150, 0)], **STREET)
    plan.way([(0, -30), (0, 30)], barrier="wall", height="2.5")
    plan.way([(20, 10), (40, 10)], barrier="fence")
    plan.way([(20, 20), (40, 20)], barrier="kerb")
    found = plan.load(tmp_path)
    lower, upper, fence = found.scenery.walls
    assert {lower.height, upper.height} == {2.5} and fence.height == kind.BARRIERS["fence"][0]
    free = sorted(np.abs(wall.line[1]).min() for wall in (lower, upper))
    assert free == pytest.approx([3.2 + 0.3] * 2, abs=0.05)
    assert [each.what for each in found.report.skipped if each.kind == "barrier"] == ["1 with barrier=kerb"]


def test_posts_and_rows_of_trees(plan, tmp_path):
    plan.way([(-150, 0), (150, 0)], **STREET)
    plan.node(5.0, 8.0, highway="street_lamp")
    plan.node(6.0, 8.0, barrier="bollard", height="0.7")
    plan.node(7.0, 0.5, power="pole")
    plan.way([(20, 20), (20, 38)], barrier="bollard")
    plan.way([(40, 20), (40, 74)], natural="tree_row")
    found = plan.load(tmp_path).scenery
    assert [post.kind for post in found.posts] == ["lamp", "bollard", *["bollard"] * 11]  # the pole stands on the road
    assert found.posts[1].height == 0.7
    assert np.diff(np.sort(found.trees[1])) == pytest.approx(9.0, abs=0.01) and found.trees.shape[1] == 7


def test_a_building_over_the_road_has_a_passage_and_a_low_one_ends_at_the_kerb(plan, tmp_path):
    """The street is 6.4 m wide, and 0.3 m on both sides stay free: 7 m of the 40 m."""
    plan.way([(-150, 0), (150, 0)], **STREET)
    plan.area(0.0, 0.0, 12.0, 40.0, building="yes", height="20")
    plan.area(50.0, 0.0, 10.0, 40.0, building="yes", height="4")
    buildings = plan.load(tmp_path).scenery.buildings
    over = [building for building in buildings if building.base > 0.0]
    assert [building.base for building in over] == [scenery.PASSAGE]
    assert polygon(over[0]).area == pytest.approx(12.0 * 7.0, rel=0.01)
    assert sum(polygon(building).area for building in buildings if building.height == 20.0) == pytest.approx(12.0 * 40.0, rel=0.01)
    assert sum(polygon(building).area for building in buildings if building.height == 4.0) == pytest.approx(10.0 * 33.0, rel=0.01)


# -- ground and holes ------------------------------------------------------------------------------


def test_a_multipolygon_keeps_its_holes(plan, tmp_path):
    """A house of 40 m by 30 m with two yards, and a lake of 60 m with an island that bears a wood."""
    plan.way([(-150, 0), (150, 0)], **STREET)
    house = plan.area(-60.0, 40.0, 40.0, 30.0)
    yards = [plan.area(-70.0, 40.0, 8.0, 10.0), plan.area(-50.0, 40.0, 6.0, 12.0)]
    plan.relation([(house, "outer"), *((yard, "inner") for yard in yards)], building="yes")
    lake, island = plan.area(60.0, 60.0, 60.0, 60.0), plan.area(60.0, 60.0, 20.0, 20.0, natural="wood")
    plan.relation([(lake, "outer"), (island, "inner")], natural="water")
    found = plan.load(tmp_path).scenery
    (building,) = found.buildings
    assert len(building.holes) == 2
    assert polygon(building).area == pytest.approx(40 * 30 - 8 * 10 - 6 * 12, rel=1e-3)
    areas = {area.kind: polygon(area).area for area in found.areas}
    assert areas == pytest.approx({"water": 60**2 - 20**2, "green": 20**2}, rel=1e-3)


def test_an_outline_whose_members_are_not_in_the_file_is_told(plan, tmp_path):
    plan.way([(-150, 0), (150, 0)], **STREET)
    plan.relation([(4711, "outer")], building="yes")
    found = plan.load(tmp_path)
    assert not found.scenery.buildings
    assert [each.what for each in found.report.skipped if each.kind == "outline"] == ["1 building relations"]


# -- water at the edge of the file ---------------------------------------------------------------------

REST = (4711, "outer")  # of the outline, which is not in the file
WIDE, HIGH = (2.0 * extent for extent in BOX.bounds()[2:])


def waters(found) -> float:
    """The area of all water [m²]."""
    return sum(polygon(area).area for area in found.scenery.areas if area.kind == "water")


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_lake_that_the_file_cuts_is_closed_along_its_box_where_no_street_is(plan, tmp_path, side):
    """A shore from south to north, or back: which way it runs says nothing; with an island in the lake."""
    plan.way([(-side * 150, -50), (-side * 150, 50)], **STREET)
    coast = plan.way([(side * 100, -side * 500), (side * 100, side * 500)])
    island = plan.area(side * 200.0, 0.0, 40.0, 40.0)
    plan.relation([(coast, "outer"), REST, (island, "inner")], natural="water", name="Lake")
    found = plan.load(tmp_path)
    assert waters(found) == pytest.approx((WIDE / 2 - 100) * HIGH - 40**2, rel=1e-3)
    (guess,) = [each for each in found.report.guesses if each.kind == "water"]
    assert (guess.where, guess.what) == ("Lake", "closed along the edge of the file")
    assert not [each for each in found.report.skipped if each.kind == "outline"]


def test_a_river_that_the_file_cuts_at_both_ends_lies_between_its_banks(plan, tmp_path):
    """A bridge over it is no land, and neither is a street on both sides of it water."""
    plan.way([(-150, 0), (-40, 0)], **STREET)
    plan.way([(40, 0), (150, 0)], **STREET)
    plan.way([(-40, 0), (40, 0)], **STREET, bridge="yes", layer="1")
    banks = [plan.way([(x, -500), (x, 500)]) for x in (-30, 30)]
    plan.relation([*((bank, "outer") for bank in banks), REST], natural="water")
    assert waters(plan.load(tmp_path)) == pytest.approx(60 * HIGH, rel=1e-3)


@pytest.mark.parametrize(
    ("shore", "way"),
    [([(100, -500), (100, 0)], STREET), ([(100, -500), (100, 500)], {**STREET, "bridge": "yes"})],
    ids=["ends in the middle of the map", "nothing shows which side is land"],
)
def test_water_whose_outline_says_too_little_is_not_drawn_and_told(plan, tmp_path, shore, way):
    plan.way([(-150, 0), (150, 0)], **way)
    plan.relation([(plan.way(shore), "outer"), REST], natural="water")
    found = plan.load(tmp_path)
    assert waters(found) == 0.0
    assert [each.what for each in found.report.skipped if each.kind == "outline"] == ["1 water relations"]


def raw_area(root, relation, places) -> float:
    """The area of a relation of closed and open ways, put together by shapely alone."""
    ways = {way.get("id"): [places[nd.get("ref")] for nd in way.iter("nd")] for way in root.iter("way")}
    area = 0.0
    for role, sign in (("outer", 1.0), ("inner", -1.0)):
        lines = [shapely.LineString(ways[m.get("ref")]) for m in relation.iter("member") if m.get("role") == role]
        area += sign * sum(ring.area for ring in shapely.polygonize(lines).geoms)
    return area


def test_the_courtyards_of_a_real_place_stay_open(own_cache):
    """Every building relation of the file, put together from its members without the importer."""
    root, network = ElementTree.fromstring(gzip.decompress(MUNICH.read_bytes())), load(MUNICH)
    box = osm.Box(*(network.origin * 2))
    places = {node.get("id"): tuple(box.local(float(node.get("lat")), float(node.get("lon")))) for node in root.iter("node")}
    known = {way.get("id") for way in root.iter("way")}
    checked = 0
    for relation in root.iter("relation"):
        tags = {tag.get("k"): tag.get("v") for tag in relation.iter("tag")}
        members = list(relation.iter("member"))
        if kind.area_kind(tags) != "building" or not all(m.get("ref") in known for m in members):
            continue
        outer = next(m.get("ref") for m in members if m.get("role") == "outer")
        start = next(way for way in root.iter("way") if way.get("id") == outer).find("nd").get("ref")
        own = [b for b in network.scenery.buildings if np.hypot(*(b.outline - np.array(places[start])[:, None])).min() < 0.05]
        own = [b for b in own if len(b.holes) == sum(m.get("role") == "inner" for m in members)]
        if own:
            assert min(abs(polygon(b).area - raw_area(root, relation, places)) for b in own) < 0.01
            checked += 1
    assert checked >= 3


def test_where_areas_overlap_the_smaller_one_is_seen_and_none_lies_on_another():
    square = np.array([[-10.0, 10.0, 10.0, -10.0], [-10.0, -10.0, 10.0, 10.0]])
    areas = (Area("water", 0.3 * square, ()), Area("green", square, ()), Area("sand", 0.1 * square, ()), Area("green", square + 5.0, ()))
    bare = network([lane(0, "a", 0, [[0.0, 50.0], [0.0, 0.0]])])
    forms = area_forms(replace(bare, scenery=Scenery((), areas, np.empty((2, 0)))))
    assert forms["sand"].area == pytest.approx(4.0) and forms["water"].area == pytest.approx(36.0 - 4.0)
    assert sum(form.area for form in forms.values()) == pytest.approx(shapely.union_all([polygon(area) for area in areas]).area)
