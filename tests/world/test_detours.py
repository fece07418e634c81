"""Lanes that are closed or shifted while a world runs: the lines around them, who takes which, and what stands there."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from studio import job
from studio.errors import ScenarioError
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import simulation
from studio.road.ways.detour import STEEPEST, place_at, stations_on
from studio.road.ways.path import PATH_CURVATURE, PATH_HEADING, PATH_SPEED, PATH_X, PATH_Y, ease
from studio.road.ways.strand import driven as strands_on
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import ACTIVE, X, Y
from studio.world.build import build
from studio.world.car import pose
from studio.world.snapshot import restore, snapshot
from studio.world.table.mind import OFFSET, STATION
from studio.world.table.street import CONE, O_KIND
from studio.world.tick import tick
from tests import changing
from tests.changing import drive, run_for

scenario = partial(changing.scenario, lane=1)  # the cars come along the middle lane
ROAD, LANE_WIDTH = "340498991", 3.2  # three lanes; the sample's leader comes along the middle one
CLOSED = {"kind": "close_lane", "road": ROAD, "lane": 1, "start": 460, "end": 520, "taper": 40}
WORKS = {"works": {"do": CLOSED}}


def beside(line, places):
    """Stations along a line, and how far to the left of it places lie [m]."""
    stations = stations_on(line, places)
    x, y, heading = place_at(line, stations)
    return stations, (places[1] - y) * np.cos(heading) - (places[0] - x) * np.sin(heading)


def driven(setting, seconds):
    """Where the first car is at every tick, float64[2, tick], and the world after it."""
    world, places = build([setting]), []
    for _ in range(round(seconds / world.clock.tick)):
        tick(world)
        places.append(world.vehicles.state[[X, Y], 0].copy())
    return np.array(places).T, world


# -- lines ---------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def closed(sample):
    return scenario(sample, WORKS)


def test_a_led_path_is_the_old_one_before_and_behind(closed):
    way = closed.works.way(closed.cars[0].path)
    (old, new), (enter, leave) = way.paths, way.spans[1, 0]
    first = int(enter)
    assert (new.points[:2, :first] == old.points[:2, :first]).all()
    shift = way.spans[1, 0, 1] - way.spans[0, 0, 1]
    for station in np.arange(leave + 1, new.length - 1, 37.0):
        assert np.hypot(*np.subtract(pose(new, station)[:2], pose(old, station - shift)[:2])) < 0.01
    assert [s for s, _ in new.stop_lines] == pytest.approx([s + shift for s, _ in old.stop_lines])


def test_a_led_path_has_its_points_a_metre_apart(closed):
    new = closed.works.way(closed.cars[0].path).paths[1]
    steps = np.diff(new.points[[PATH_X, PATH_Y]])
    assert np.hypot(*steps) == pytest.approx(1.0, abs=2e-3)
    turned = (np.arctan2(steps[1], steps[0]) - 0.5 * (new.points[PATH_HEADING, 1:] + new.points[PATH_HEADING, :-1]) + np.pi) % (
        2 * np.pi
    ) - np.pi
    assert np.abs(turned).max() < 0.01
    assert np.abs(np.diff(new.points[PATH_HEADING]) - 0.5 * (new.points[PATH_CURVATURE, 1:] + new.points[PATH_CURVATURE, :-1])).max() < 0.01


def test_a_taper_eases_over_by_a_lane(closed):
    """On a straight road the offset is the lane's width times 10 u³ - 15 u⁴ + 6 u⁵, the greatest curvature 10/√3 D/T²."""
    site, way = closed.sites[0].laid[0], closed.works.way(closed.cars[0].path)
    new = way.paths[1]
    stations, left = beside(site.line, new.points[[PATH_X, PATH_Y]])
    taper = (stations > 420) & (stations < 460)
    _, before = beside(site.line, way.paths[0].points[[PATH_X, PATH_Y]])
    assert left[taper] == pytest.approx(LANE_WIDTH * ease((stations[taper] - 420) / 40), abs=0.1 + np.abs(before[taper]).max())
    inside = (stations >= 460) & (stations <= 520)
    assert left[inside] == pytest.approx(LANE_WIDTH, abs=0.1)
    assert np.abs(new.points[PATH_CURVATURE, taper]).max() == pytest.approx(STEEPEST * LANE_WIDTH / 40**2, rel=0.15)
    bend = np.sqrt(2.5 / np.maximum(np.abs(new.points[PATH_CURVATURE]), 1e-6))
    assert (new.points[PATH_SPEED, taper] <= bend[taper] + 1e-9).all()


def test_a_led_path_is_on_the_lane_that_it_is_led_onto(sample):
    """Between the tapers it is on that lane alone, within them on both; the usual path never leaves its own."""
    setting = scenario(sample, WORKS, vehicles=two_lanes())
    lanes = setting.network.roads[ROAD].lanes
    found = []
    for path in setting.works.way(setting.cars[0].path).paths:
        on_road = [each for each in strands_on(setting.network, path) if each.strand in lanes]
        found.append({setting.network.lanes[each.strand].index: (each.enter, each.leave) for each in on_road if each.leave > 400})
    usual, led = found
    assert list(usual) == [1] and 1 in led and 2 in led
    enter, leave = led[2]
    assert 420 < enter < 460 and 520 < leave < 560
    own = [
        (each.enter, each.leave)
        for each in strands_on(setting.network, setting.works.way(setting.cars[0].path).paths[1])
        if each.strand == lanes[1]
    ]
    assert any(enter < left < 460 for _, left in own) and any(520 < entered < leave for entered, _ in own)


def two_lanes():
    """Two cars side by side, one on the closed lane and one on the lane that it is led onto."""
    one = {"route": "east_to_west", "position": {"road": ROAD, "lane": 1, "offset": 380}, "speed": 13.0}
    other = {"route": "east_to_west", "position": {"road": ROAD, "lane": 2, "offset": 376}, "speed": 13.0}
    return {"leader": one, "other": other}


# -- driving -------------------------------------------------------------------------------------------


def test_cars_drive_around_a_closed_lane(sample, closed):
    """Within the closed stretch the car is a lane's width aside, to 0.3 m; it strikes nothing, and comes back."""
    places, world = driven(closed, 18)
    stations, left = beside(closed.sites[0].laid[0].line, places)
    inside = (stations > 460) & (stations < 520)
    assert inside.sum() > 100
    assert left[inside].min() > LANE_WIDTH - 0.3
    assert np.abs(left[(stations < 415) | (stations > 570)]).max() < 0.3
    assert world.events.hits_found == 0
    assert world.obstacles.standing.all()


def test_objects_stand_where_cars_used_to_drive(closed):
    """Who does not go around strikes them: the usual path leads through cones and boards, the led one through nothing."""
    world = build([closed])
    way = closed.works.way(closed.cars[0].path)
    places = world.obstacles.table[:2]
    for path, least in ((way.paths[0], 0.0), (way.paths[1], 1.3)):
        nearest = np.array([np.hypot(*(path.points[:2] - place[:, None])).min() for place in places.T])
        assert (nearest.min() > least) if least else (nearest.min() < 1.0)
    assert {int(kind) for kind in world.obstacles.table[O_KIND]} == {0, 1}
    assert (world.obstacles.table[O_KIND] == CONE).sum() == 14


@pytest.mark.parametrize("along", [400.0, 450.0, 480.0])
def test_who_is_within_goes_on_and_the_lane_is_closed_behind(sample, along):
    """At the moment of closing: before the taper a car goes around, on it and behind it goes on; the fence waits for it."""
    begin = {"kind": "passed", "vehicle": "leader", "along": along}
    setting = scenario(sample, {"works": {"when": begin, "do": CLOSED}})
    world, left, standing = build([setting]), [], []
    for _ in range(900):
        tick(world)
        left.append(beside(setting.sites[0].laid[0].line, world.vehicles.state[[X, Y], :1]))
        standing.append(int(world.obstacles.standing.sum()))
    stations, left = np.array(left)[:, :, 0].T
    inside = (stations > 460) & (stations < 520)
    stays = along > 420 - world.vehicles.parameter[FRONT, 0]
    assert np.abs(left[inside]).max() < 0.3 if stays else left[inside].min() > LANE_WIDTH - 0.3
    assert world.events.hits_found == 0
    up = stations[np.flatnonzero(standing)[0]]
    rear = world.vehicles.parameter[LENGTH, 0] - world.vehicles.parameter[FRONT, 0]
    assert up == pytest.approx(560 + rear if stays else along, abs=1.0)
    assert standing[-1] == world.obstacles.standing.size


def test_a_lane_opens_again(sample):
    setting = scenario(sample, {"works": {"until": {"kind": "time", "at": 2}, "do": CLOSED}})
    places, world = driven(setting, 18)
    stations, left = beside(setting.sites[0].laid[0].line, places)
    assert np.abs(left[(stations > 440) & (stations < 540)]).max() < 0.3
    assert not world.obstacles.standing.any() and (world.detours.choice == 0).all()


def test_cars_stop_where_all_lanes_are_closed(sample):
    changes = {f"lane_{i}": {"do": CLOSED | {"lane": i}} for i in range(3)}
    station, speed, world = drive(scenario(sample, changes), 25)
    bumper = station[-1] + world.vehicles.parameter[FRONT, 0]
    assert speed[-1] < 0.05 and world.events.hits_found == 0
    assert bumper == pytest.approx(461 - 0.125 - 2.0, abs=0.4)


def test_two_closed_lanes_are_passed_on_the_third(sample):
    changes = {f"lane_{i}": {"do": CLOSED | {"lane": i}} for i in (0, 1)}
    vehicles = {"leader": {"route": "east_to_west", "position": {"road": ROAD, "lane": 0, "offset": 360}, "speed": 12.0}}
    setting = scenario(sample, changes, vehicles=vehicles)
    places, world = driven(setting, 18)
    stations, left = beside(setting.sites[0].laid[0].line, places)
    inside = (stations > 460) & (stations < 520)
    assert left[inside] == pytest.approx(2 * LANE_WIDTH, abs=0.3)
    assert world.events.hits_found == 0


@pytest.mark.parametrize("offset", [1.2, -0.8])
def test_a_shifted_lane_is_driven_where_it_is_now(sample, offset):
    shift = CLOSED | {"kind": "shift_lane", "offset": offset}
    setting = scenario(sample, {"shift": {"do": shift}})
    places, world = driven(setting, 18)
    stations, left = beside(setting.sites[0].laid[0].line, places)
    usual, _ = driven(scenario(sample, {}), 18)
    before = np.interp(stations, *beside(setting.sites[0].laid[0].line, usual))
    inside = (stations > 460) & (stations < 520)
    assert (left - before)[inside] == pytest.approx(offset, abs=0.15)
    assert np.abs(left - before)[(stations < 415) | (stations > 575)].max() < 0.1
    assert world.obstacles.standing.size == 0


def test_cars_side_by_side_sort_themselves_at_the_taper(sample):
    world = run_for([scenario(sample, WORKS, vehicles=two_lanes())], 25)
    assert world.events.hits_found == 0
    assert (world.vehicles.mind[STATION, :2] > 560).all()


@pytest.mark.parametrize("seed", [1, 2])
def test_traffic_and_platoon_pass_three_sites(sample, seed):
    """A minute of everybody with a closed lane on the way in, on the circle and on the way out: nobody collides, all keep their line."""
    changes = {
        "way_in": {"when": {"kind": "time", "at": 5}, "do": CLOSED},
        "circle": {"do": {"kind": "close_lane", "road": "30194726", "lane": 2, "start": 30, "end": 45, "taper": 25}},
        "way_out": {
            "when": {"kind": "passed", "vehicle": "leader", "along": 700},
            "do": {"kind": "close_lane", "road": "206170873#1", "start": 40, "end": 90},
        },
    }
    world = build([scenario(sample, changes, alone=False, minding=["right_of_way"], seed=seed)])
    worst = 0.0
    for _ in range(3000):
        tick(world)
        worst = max(worst, np.where(world.vehicles.state[ACTIVE] > 0, np.abs(world.vehicles.mind[OFFSET]), 0.0).max())
    assert world.events.hits_found == 0
    assert worst < 0.5
    assert (world.detours.choice > 0).sum() >= 5


# -- batches, snapshots, moments -----------------------------------------------------------------------


def test_a_closing_does_not_know_its_batch(sample):
    variants = [
        scenario(sample, changes, alone=False)
        for changes in (
            {"works": {"when": {"kind": "time", "at": 3}, "do": CLOSED}},
            {},
            {"works": {"when": {"kind": "passed", "vehicle": "leader", "along": 390}, "do": CLOSED}},
        )
    ]
    alone = [run_for([each], 14).digest(0) for each in variants]
    assert len(set(alone)) == 3
    for order in ([0, 1, 2], [1, 2, 0]):
        together = run_for([variants[i] for i in order], 14)
        assert [together.digest(order.index(i)) for i in range(3)] == alone


@pytest.mark.parametrize("seconds", [1.0, 4.0, 10.0])
def test_a_snapshot_goes_on_around_a_closing(sample, seconds):
    """Before the lane is closed, while the first cars are led, and while one has not left it."""
    settings = [scenario(sample, {"works": {"when": {"kind": "time", "at": 3}, "do": CLOSED}}, alone=False, applications={})]
    world, twin = run_for(settings, seconds), build(settings)
    restore(twin, snapshot(world))
    for _ in range(300):
        tick(world)
        tick(twin)
    assert twin.digest() == world.digest()


def test_an_event_on_a_led_path_is_where_it_was(sample):
    """A station of a route is a place: a limit that begins behind a closing begins there on the led path as well."""
    slow = {"kind": "limit", "route": "east_to_west", "start": 900, "end": 950, "speed": 5}
    after = {"slow": {"when": {"kind": "passed", "vehicle": "leader", "along": 600}, "do": slow}}
    setting = scenario(sample, WORKS | after, clock={"duration": 30})
    run = simulation(setting)
    as_fast_as_possible(run)
    (begun,) = [each.time for each in run.cases[0].happenings if each.text.startswith("slow begins")]
    at = np.searchsorted(run.record().time, begun - 1e-6)
    place = np.array([run.record().channel("x")[0, at], run.record().channel("y")[0, at]])
    assert np.hypot(*(place - pose(setting.cars[0].path, 600.0)[:2])) < 0.4


# -- bad input -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "field", "word"),
    [
        ({"a": CLOSED | {"start": 20}}, "script.a.do.taper", "≤ 20 m"),
        ({"a": CLOSED | {"end": 670}}, "script.a.do.taper", "≤ 13 m"),
        ({"a": CLOSED | {"lane": 3}}, "script.a.do.lane", "0 to 2"),
        ({"a": CLOSED | {"road": "x"}}, "script.a.do.road", "road of this map"),
        ({"a": CLOSED | {"taper": 10}}, "script.a.do.taper", "≥ 12 m"),
        ({"a": CLOSED, "b": CLOSED}, "script.b.do", "overlaps 'a'"),
        ({"a": CLOSED, "b": CLOSED | {"lane": 0, "start": 590, "end": 600}}, "script.b.do", "overlaps 'a'"),
        ({"a": CLOSED, "b": CLOSED | {"kind": "shift_lane", "offset": 1, "lane": 2}}, "script.b.do", "overlaps 'a'"),
        ({"a": CLOSED | {"start": 350, "end": 370}}, "vehicles.leader.position", "from the beginning"),
        ({"a": CLOSED | {"speed": 3}}, "script.a.do.speed", "not a field"),
        (
            {f"w{i}": CLOSED | {"start": 60 + 120 * i, "end": 70 + 120 * i, "taper": 20} for i in range(5)},
            "vehicles.leader.route",
            "at most 4",
        ),
    ],
)
def test_bad_works_are_named(sample, changes, field, word):
    with pytest.raises(ScenarioError) as caught:
        scenario(sample, {name: {"do": do} for name, do in changes.items()})
    assert any(problem.where == f"changing: {field}" and word in str(problem) for problem in caught.value.problems), str(caught.value)


def test_no_traffic_starts_within_a_closing(sample):
    """The sample's traffic is where it was, but for those who would stand on the closed ground."""
    free = scenario(sample, {}, alone=False)
    works = {"way_out": {"do": {"kind": "close_lane", "road": "206170873#1", "lane": 0, "start": 100, "end": 600}}}
    closed = scenario(sample, works, alone=False)
    assert len(closed.cars) == len(free.cars)
    for car in closed.cars:
        assert not closed.works.way(car.path).is_touched(car.station, 0.0, {0})
    assert [car.station for car in closed.cars] != [car.station for car in free.cars]


# -- the sample ----------------------------------------------------------------------------------------


def test_the_sample_passes_its_roadworks(root):
    """Goals met, nobody collides; the whole platoon has gone around both closings, and is at 30 km/h in the first one.

    Its last car waits at a red light in between.
    """
    run = job.run(job.load(root / "scenarios" / "grosser_stern_roadworks.yaml"))
    assert run.status == "done" and run.unmet == [] and run.metrics["collisions"].value == 0
    texts = [each.text for each in run.record.happenings]
    assert [text.partition(":")[0] for text in texts if "begins" in text] == ["limit begins", "roadworks begins", "way_out begins"]
    station, speed = run.record.channel("station"), run.record.channel("speed")
    assert (np.nanmax(station, axis=1) > 977 + 140).all()
    leader = (station[0] > 440) & (station[0] < 600)
    assert speed[0][leader].max() < 8.333 + 0.1


def test_who_is_beside_on_the_lane_that_one_changes_to_is_not_struck(root):
    """Too fast to stop where a middle lane is closed: half a length behind, somebody is on the lane that one goes over to."""
    works = {"do": {"kind": "close_lane", "road": "motorway", "lane": 1, "start": 3000, "end": 3300, "taper": 150}}
    places = {"own": (1, 2600.0), "beside": (2, 2597.5), "ahead": (2, 2630.0)}
    vehicles = {
        name: {"route": "eastbound", "position": {"road": "motorway", "lane": lane, "offset": offset}, "speed": 30}
        for name, (lane, offset) in places.items()
    }
    loaded = job.load(root / "scenarios" / "motorway_platoon.yaml", {"clock.duration": 32})
    document = loaded.scenario.model_dump(mode="json", exclude_unset=True)
    document |= {"vehicles": vehicles, "applications": {}, "script": {"works": works}, "goals": {}, "measures": {}, "traffic": {"count": 0}}
    running = simulation(job.prepare(replace(loaded, scenario=type(loaded.scenario).model_validate(document))))
    while not running.is_over:
        running.advance(50)
    assert not [each for each in running.cases[0].happenings if each.kind == "collision"]
    own, other = (running.record().trace(f"{name}.station")[-1] for name in ("own", "beside"))
    assert 3300 < own < other
