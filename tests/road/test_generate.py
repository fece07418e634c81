"""The maps that the studio draws: they are what stands in the folder of samples, and every count follows from the drawing."""

import itertools
from pathlib import Path

import numpy as np
import pytest
import shapely

from studio import job
from studio.errors import MapError
from studio.road import load
from studio.road.assembly.extract import ATTRIBUTION
from studio.road.drawn import deck
from studio.road.drawn import town as drawn
from studio.road.drawn.drawing import Drawing
from studio.road.network import SPACE_HEADING, SPACE_LENGTH, SPACE_WIDTH, SPACE_X, SPACE_Y
from studio.road.network.plane import polygon
from studio.road.ways.path import PATH_SPEED
from studio.road.ways.route import all_routes, arms

SCENARIOS = Path(__file__).parents[2] / "scenarios"
MAPS = SCENARIOS / "maps"
GRAIN = 0.012  # [m] OpenStreetMap keeps positions to 1e-7 degrees


@pytest.fixture(scope="module")
def town():
    return load(MAPS / "urban_grid.osm")


@pytest.fixture(scope="module")
def parking():
    return load(MAPS / "parking_deck.osm", parking_aisles=True)


@pytest.mark.parametrize(("made", "name"), [(drawn.town, "urban_grid"), (deck.deck, "parking_deck")])
def test_a_drawn_map_is_always_the_same_and_is_the_sample(made, name):
    assert made().xml() == (MAPS / f"{name}.osm").read_text(encoding="utf-8")


def test_a_map_is_written_as_osm_only(tmp_path):
    with pytest.raises(MapError, match=r"\.osm"):
        Drawing(reach=100.0).write(tmp_path / "town.xml")
    with pytest.raises(MapError, match="cannot be written"):
        Drawing(reach=100.0).node((0.0, 0.0)) and drawn.town().write(tmp_path / "missing" / "town.osm")


def test_nobody_else_has_a_right_in_a_drawn_map(town, parking):
    assert ATTRIBUTION not in (town.attribution, parking.attribution)


# -- the grid --------------------------------------------------------------------------------------


def loud(kinds):
    return sum(kind != "quiet" for kind in kinds)


def test_signals_stand_where_no_quiet_street_meets(town):
    wanted = loud(drawn.COLUMNS) * loud(drawn.ROWS)
    assert (town.report.signals.in_map, town.report.signals.placed, town.report.signals.groups) == (wanted,) * 3


def test_three_lanes_lead_to_lights_on_main_streets_and_each_leads_where_its_arrow_says(town):
    """A main street comes to a column's lights from both sides, a column's main streets to a row's."""
    mains, signalled = drawn.COLUMNS.count("main"), loud(drawn.ROWS)
    approaches = 2 * mains * signalled + 2 * drawn.ROWS.count("main") * loud(drawn.COLUMNS)
    turns = town.report.turn_lanes
    assert turns.tagged_lanes == turns.matching == 3 * approaches


def test_there_are_zebras_at_the_roundabout_and_the_park_and_lights_at_all_signals(town):
    crossings = town.report.crossings
    # four arms of the ring, two streets along the park; four arms of every crossing with lights
    assert (crossings.zebra, crossings.signalled, crossings.unmarked) == (4 + 2, 4 * town.report.signals.in_map, 0)


def test_every_arm_leads_to_every_other(town):
    entries, exits = arms(town)
    one_way = drawn.COLUMNS.count("north") + drawn.COLUMNS.count("south")
    two_way = 2 * (drawn.COLUMNS.count("main") + drawn.ROWS.count("main")) + 1  # and the quiet one through the roundabout
    assert len(entries) == len(exits) == one_way + two_way
    assert len(all_routes(town)) == len(entries) * len(exits)


def test_limits_are_those_of_the_kinds_of_streets(town):
    limits = {road.kind: {round(3.6 * town.lanes[lane].speed) for lane in road.lanes} for road in town.roads.values() if road.kind}
    assert limits == {"secondary": {50}, "tertiary": {50}, "residential": {30}}


def test_nothing_stands_on_the_road(town):
    from studio.road.network.outline import road_form

    form = road_form(town).buffer(-0.1)
    shapely.prepare(form)
    assert not any(form.intersects(polygon(building)) for building in town.scenery.buildings)
    assert not shapely.contains_xy(form, *town.scenery.trees).any()


# -- the deck --------------------------------------------------------------------------------------


def test_the_deck_has_sixty_spaces_that_one_enters_from_the_nearer_aisle(parking):
    spaces = parking.scenery.spaces
    assert spaces.shape[1] == 60 == 4 * deck.SIXTY.groups * deck.SIXTY.together and parking.scenery.along_kerbs == 0
    assert spaces[[SPACE_LENGTH, SPACE_WIDTH]] == pytest.approx(np.tile([[deck.SIXTY.length], [deck.SIXTY.width]], 60), abs=GRAIN)
    aisle = deck.SIXTY.radius * np.sign(spaces[SPACE_Y])
    assert np.sin(spaces[SPACE_HEADING]) == pytest.approx(np.sign(spaces[SPACE_Y] - aisle), abs=1e-4)
    assert np.abs(spaces[SPACE_X]).max() == pytest.approx(deck.SIXTY.row / 2 - deck.GAP - deck.SIXTY.width / 2, abs=GRAIN)


def test_the_deck_has_its_pillars_and_walls(parking):
    pillars = [b for b in parking.scenery.buildings if b.height == deck.CLEAR]
    assert len(pillars) == 4 * (deck.SIXTY.groups + 1) + 2
    assert [polygon(pillar).area for pillar in pillars] == pytest.approx([deck.PILLAR**2] * len(pillars), abs=2 * GRAIN * deck.PILLAR)
    length = sum(np.hypot(*np.diff(wall.line)).sum() for wall in parking.scenery.walls)
    around = 4.0 * (deck.SIXTY.end + deck.SIXTY.side + deck.WALL)
    assert length == pytest.approx(around - 2 * deck.OPENING, abs=8 * GRAIN)


def test_aisles_are_built_only_if_asked_for(parking, own_cache):
    without = load(MAPS / "parking_deck.osm")
    assert without.digest != parking.digest
    assert {road.kind for road in without.roads.values() if not road.internal} == {"residential"}
    assert {road.kind for road in parking.roads.values() if not road.internal} == {"residential", "service"}
    assert [each.what for each in without.report.skipped if each.kind == "small way"] == ["6 ways with highway=service"]
    assert not parking.report.skipped


def test_driveways_without_an_aisle_are_not_built(draft, tmp_path, own_cache):
    """One driveway leads to an aisle over another one, a third leads to a house; an aisle is private."""
    a, b, c, d, e, f, g = (draft.node(52.0 + y * 1e-5, 10.0 + x * 1e-5) for x, y in
                           [(0, 0), (200, 0), (100, 0), (100, 50), (100, 100), (50, 50), (300, 100)])  # fmt: skip
    draft.way(1, [a, c, b], highway="residential")
    draft.way(2, [c, d], highway="service")
    draft.way(3, [d, e], highway="service", service="parking_aisle")
    draft.way(4, [a, f], highway="service", service="driveway")
    draft.way(5, [b, g], highway="service", service="parking_aisle", access="private")
    network = load(draft.write(tmp_path / "lot.osm"), parking_aisles=True)
    built = {way for road in network.roads.values() for way in [road.id.lstrip("-").split("#")[0]] if not road.internal}
    assert built <= {"1", "2", "3"} and {"2", "3"} <= built | {"3"}
    assert [each.reason for each in network.report.skipped if each.kind == "closed way"] == ["access=private"]


# -- the scenarios ---------------------------------------------------------------------------------


def test_cars_pass_walls_and_pillars_at_walking_pace():
    setting = job.prepare(job.load(SCENARIOS / "parking_deck.yaml"))
    scenery = setting.network.scenery
    solid = [polygon(b) for b in scenery.buildings] + [shapely.LineString(w.line.T).buffer(w.thickness / 2) for w in scenery.walls]
    inside = shapely.box(-deck.SIXTY.end, -deck.SIXTY.side, deck.SIXTY.end, deck.SIXTY.side)
    for car in setting.cars:
        line = shapely.LineString(car.path.points[:2].T)
        # a car is 1.8 m wide
        assert min(line.distance(each) for each in solid) > 0.9 + 0.5
        here = shapely.contains_xy(inside, *car.path.points[:2])
        assert here.any() and car.path.points[PATH_SPEED, here].max() <= 10.0 / 3.6 + 0.005


@pytest.mark.parametrize("name", ["urban_grid", "parking_deck", "left_hand"])
def test_a_sample_runs_and_nobody_collides(name):
    run = job.run(job.load(SCENARIOS / f"{name}.yaml", {"clock.duration": 20}))
    assert run.status == "done" and run.error is None and not run.unmet
    assert run.metrics["collisions"].value == 0
    speeds = [run.trace(f"{car}.speed") for car in job.load(SCENARIOS / f"{name}.yaml").scenario.vehicles]
    assert all(speed.max() > 1.0 for speed in speeds)


def test_the_left_hand_sample_keeps_left():
    """The lanes of a road count from the kerb: on the left, each next one lies to the right."""
    network = job.prepare(job.load(SCENARIOS / "left_hand.yaml")).network
    assert network.drive_side == "left"
    for road in network.roads.values():
        for a, b in itertools.pairwise([] if road.internal else network.lanes_of(road.id)):
            along, aside = np.diff(a.centre)[:, 0], b.centre[:, 0] - a.centre[:, 0]
            assert along[0] * aside[1] - along[1] * aside[0] < 0.0
