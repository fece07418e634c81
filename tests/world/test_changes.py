"""What changes about the road while a world runs: limits, friction and sight, begun by a time or by a vehicle."""

import re

import numpy as np
import pytest
import yaml

from studio import job
from studio.conventions import GRAVITY
from studio.errors import ScenarioError
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import simulation
from studio.model.driver import FOG_SPEED, REACTION, sight_speed
from studio.road.ways.path import PATH_SPEED
from studio.scenario import file
from studio.scenario.schema import Scenario, unit_at
from studio.vehicle.contact import MU
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import V_X
from studio.world.build import build
from studio.world.table.mind import GAP, RED_STATION, STATION, V_DESIRED
from studio.world.tick import tick
from tests.changing import SLOW, drive, run_for, scenario

# -- limits --------------------------------------------------------------------------------------------


def test_a_driver_has_slowed_down_where_a_limit_begins(sample):
    """To 0.1 m/s: what a driver is too fast dies away with 0.7 s."""
    station, speed, _ = drive(scenario(sample, {"slow": {"do": SLOW}}), 26)
    inside = (station >= 470) & (station <= 560)
    assert inside.sum() > 400
    assert speed[inside].max() <= 8.3 + 0.1
    assert speed[station < 420].max() > 12.5
    assert speed[station > 570].max() > 10.0


def test_slowing_down_for_a_limit_is_comfortable(sample):
    """The speeds before a sign fall with 1.5 m/s², v² = v_limit² + 2 a s, as before a bend."""
    made = build([scenario(sample, {"slow": {"do": SLOW}})])
    tick(made)
    speed, stations = made.roads.points[PATH_SPEED], np.arange(made.roads.points.shape[1])
    before = (stations < 469) & (stations > 440)
    assert speed[before] == pytest.approx(np.minimum(50 / 3.6, np.sqrt(8.3**2 + 3.0 * (469 - stations[before]))), rel=1e-3)
    assert (speed[469:561] <= 8.3).all()


def test_a_limit_is_for_all_lanes_and_all_who_come_by(sample):
    """A sign by the road concerns the traffic on the next lane as well, and nobody on another road."""
    base = build([scenario(sample, {}, alone=False)])
    made = build([scenario(sample, {"slow": {"do": SLOW}}, alone=False)])
    tick(made)
    slower = made.roads.points[PATH_SPEED] < base.roads.points[PATH_SPEED] - 1e-9
    paths = {(first, count) for first, count in zip(made.roads.path_first, made.roads.path_count, strict=True)}
    concerned = [first for first, count in paths if slower[first : first + count].any()]
    cars = scenario(sample, {}, alone=False).cars
    on_the_road = {id(car.path) for car in cars if any(station.road == "340498991" for station in car.path.stations)}
    assert len(concerned) == len(on_the_road) > 1


def test_a_limit_comes_and_goes(sample):
    made = build([scenario(sample, {"slow": {"when": {"kind": "time", "at": 1}, "until": {"kind": "time", "at": 2}, "do": SLOW}})])
    before = made.roads.points.copy()
    seen = []
    for _ in range(150):
        tick(made)
        seen.append((made.roads.points[PATH_SPEED, 480], made.clock.time - made.clock.tick))
    low = [round(time, 6) for speed, time in seen if speed == 8.3]
    assert (low[0], low[-1]) == (1.0, 1.98)
    assert (made.roads.points == before).all()


def test_a_limit_stands_on_a_lane_of_a_road_too(sample):
    """The same stretch named by its road, to the metre: its line is not that of the route to the millimetre."""
    by_road = SLOW | {"road": "340498991", "route": None, "lane": 2}
    route, road = (drive(scenario(sample, {"slow": {"do": do}}), 20)[2] for do in (SLOW, by_road))
    speeds = [made.roads.points[PATH_SPEED] for made in (route, road)]
    assert (np.abs(speeds[0] - speeds[1]) > 0.3).sum() <= 1 and (speeds[0] < 8.4).sum() > 80


# -- when ----------------------------------------------------------------------------------------------


def test_an_event_is_as_good_as_its_time(sample):
    """A change that a vehicle begins ends in the same bits as one that begins at the time when it passed."""
    by_event = simulation(
        scenario(sample, {"slow": {"when": {"kind": "passed", "vehicle": "leader", "along": 430}, "do": SLOW}}, clock={"duration": 15})
    )
    as_fast_as_possible(by_event)
    (begun,) = [each for each in by_event.cases[0].happenings if each.text.startswith("slow begins")]
    assert begun.vehicle == "leader"
    by_time = simulation(scenario(sample, {"slow": {"when": {"kind": "time", "at": begun.time}, "do": SLOW}}, clock={"duration": 15}))
    as_fast_as_possible(by_time)
    assert by_event.world.digest() == by_time.world.digest()
    passed = by_event.record().channel("station")[0]
    assert passed[by_event.record().time < begun.time - 1e-6].max() < 430 <= passed[by_event.record().time >= begun.time - 1e-6].min()


def test_beginning_and_end_are_told(sample):
    changes = {
        "ice": {
            "when": {"kind": "time", "at": 1},
            "until": {"kind": "time", "at": 2},
            "do": SLOW | {"kind": "friction", "friction": 0.3, "speed": 0},
        }
    }
    del changes["ice"]["do"]["speed"]
    run = simulation(scenario(sample, changes, clock={"duration": 3}))
    as_fast_as_possible(run)
    told = [(each.time, each.text) for each in run.cases[0].happenings]
    assert told == [(1.0, "ice begins: friction 0.3"), (2.0, "ice ends")]


def test_friction_is_felt_while_it_acts(sample):
    oil = {"kind": "friction", "route": "east_to_west", "start": 300, "end": 500, "width": 20, "friction": 0.3}
    made = build([scenario(sample, {"oil": {"when": {"kind": "time", "at": 0.5}, "until": {"kind": "time", "at": 1.0}, "do": oil}})])
    felt = []
    for _ in range(75):
        tick(made)
        felt.append(made.vehicles.ground[MU].max())
    assert felt == [1.0] * 25 + [0.3] * 25 + [1.0] * 25


# -- batches -------------------------------------------------------------------------------------------


CHANGES = {
    "slow": {"when": {"kind": "time", "at": 2}, "do": SLOW},
    "oil": {
        "when": {"kind": "passed", "vehicle": "leader", "along": 400},
        "do": {"kind": "friction", "route": "east_to_west", "start": 380, "end": 460, "friction": 0.4, "width": 8},
    },
}


def test_a_world_changes_alone(sample):
    """Side by side with worlds that change otherwise, or not at all, every world has the bits that it has alone."""
    variants = [scenario(sample, changes, alone=False) for changes in (CHANGES, {}, {"slow": CHANGES["slow"]})]
    alone = [run_for([each], 12).digest(0) for each in variants]
    assert len(set(alone)) == 3
    for order in ([0, 1, 2], [2, 0, 1]):
        together = run_for([variants[i] for i in order], 12)
        assert [together.digest(w) for w in range(3)] == [alone[i] for i in order]


def test_the_phase_is_part_of_the_hash(sample):
    """Far from every car a change does nothing, and yet the world is another one."""
    far = {"slow": {"when": {"kind": "time", "at": 1}, "do": SLOW | {"start": 1500, "end": 1600}}}
    later = {"slow": {"when": {"kind": "time", "at": 3}, "do": SLOW | {"start": 1500, "end": 1600}}}
    one, other = (run_for([scenario(sample, each)], 2) for each in (far, later))
    assert one.vehicles.state.tobytes() == other.vehicles.state.tobytes()
    assert one.digest() == one.digest(0) != other.digest()


def test_a_change_is_set_by_its_path(sample, tmp_path):
    document = file.read(sample) | {"script": {"slow": {"do": SLOW}}}
    path = tmp_path / "slow.yaml"
    path.write_text(yaml.safe_dump(document))
    loaded = job.load(path, {"script.slow.when.at": 10, "script.slow.do.speed": 5.0, "weather.visibility": 80})
    assert loaded.document["script"]["slow"]["when"]["at"] == 10
    assert loaded.document["script"]["slow"]["do"]["speed"] == 5.0
    with pytest.raises(ScenarioError) as caught:
        job.load(path, {"script.slow.do.sped": 5.0})
    assert "script.slow.do.speed" in caught.value.problems[0].remedy


# -- sight ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("sight", "braking"), [(20.0, 2.0), (60.0, 2.0), (200.0, 3.5), (1000.0, 1.0)])
def test_a_driver_can_stop_within_sight(sight, braking):
    """v t + v²/(2 b) = d; in thick fog 50 km/h at most."""
    v = sight_speed(sight, braking)
    assert v * REACTION + v * v / (2.0 * braking) == pytest.approx(sight)
    assert sight_speed(49.9, 9.0) == FOG_SPEED < sight_speed(50.1, 9.0)


@pytest.mark.parametrize(("visibility", "friction"), [(30.0, 1.0), (30.0, 0.12)])
def test_fog_slows_down_everybody(sample, visibility, friction):
    braking = min(2.0, friction * GRAVITY)
    fastest = braking * (np.sqrt(1.0 + 2.0 * visibility / braking) - 1.0)
    weather = {"visibility": visibility, "friction": friction}
    _, speed, world = drive(scenario(sample, {}, weather=weather), 12)
    assert world.vehicles.mind[V_DESIRED, 0] == pytest.approx(min(fastest, 50 / 3.6))
    assert speed[-1] == pytest.approx(fastest, abs=0.2)


def test_what_is_beyond_sight_is_not_reacted_to(sample):
    """The next car ahead and the next light are seen at 200 m, and not at 20 m; the radar sees the car in any weather."""
    clear, fog = (run_for([scenario(sample, {}, alone=False, weather={"visibility": sight})], 0.02) for sight in (200.0, 12.0))
    assert np.nanmax(clear.vehicles.mind[GAP]) > 20.0 and np.nanmax(fog.vehicles.mind[GAP]) <= 12.0
    assert np.isfinite(clear.vehicles.mind[RED_STATION]).sum() > np.isfinite(fog.vehicles.mind[RED_STATION]).sum()
    assert np.array_equal(clear.units.mounted[0].out, fog.units.mounted[0].out) and clear.units.mounted[0].out[:, 0].any()


def test_nobody_collides_in_fog(sample):
    world = run_for([scenario(sample, {}, alone=False, weather={"visibility": 40.0})], 40)
    assert world.events.hits_found == 0


# -- the schema ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("script.x.do.speed", "m/s"), ("script.x.do.taper", "m"), ("script.x.do.friction", "1"), ("script.x.when.at", "s"),
        ("vehicles.a.position.along", "m"), ("weather.visibility", "m"), ("script.x.do.nothing", ""),
    ],
)  # fmt: skip
def test_fields_of_alternatives_have_their_unit(path, unit):
    assert unit_at(Scenario, path) == unit


def test_the_readme_shows_changes_that_are_valid(sample, root):
    (block,) = re.findall(r"```yaml\n(script:.*?)```", (root / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    shown = yaml.safe_load(block)
    made = scenario(sample, shown["script"], weather=shown["weather"])
    assert [site.name for site in made.sites] == ["roadworks", "slow", "spill"]


# -- bad input -----------------------------------------------------------------------------------------


def test_all_that_is_wrong_is_told_at_once(sample):
    changes = {
        "a": {"do": SLOW | {"route": "east_to_wst"}},
        "b": {"do": SLOW | {"route": None, "road": "34049899"}},
        "c": {"do": SLOW | {"route": None, "road": "340498991", "lane": 3}},
        "d": {"do": SLOW | {"route": None, "road": "340498991", "end": 900}},
        "e": {"do": SLOW | {"end": 5000}},
        "f": {"when": {"kind": "passed", "vehicle": "leder", "along": 10}, "do": SLOW},
        "g": {"until": {"kind": "passed", "vehicle": "leader", "along": 9999}, "do": SLOW},
    }
    with pytest.raises(ScenarioError) as caught:
        scenario(sample, changes)
    told = {problem.where.removeprefix("changing: "): problem for problem in caught.value.problems}
    assert sorted(told) == [
        "script.a.do.route", "script.b.do.road", "script.c.do.lane", "script.d.do.end", "script.e.do.end",
        "script.f.when.vehicle", "script.g.until.along",
    ]  # fmt: skip
    assert told["script.a.do.route"].remedy == "did you mean 'east_to_west'?"
    assert told["script.b.do.road"].remedy == "did you mean '340498991'?"
    assert told["script.f.when.vehicle"].remedy == "did you mean 'leader'?"
    assert told["script.c.do.lane"].allowed == "0 to 2" and told["script.d.do.end"].allowed == "≤ 683 m"


@pytest.mark.parametrize(
    ("change", "field", "word"),
    [
        ({"do": SLOW | {"kind": "limt"}}, "script.x.do.kind", "did you mean 'limit'?"),
        ({"do": {"speed": 3}}, "script.x.do.kind", "close_lane"),
        ({"do": SLOW | {"sped": 3}}, "script.x.do.sped", "speed"),
        ({"do": SLOW | {"speed": 0}}, "script.x.do.speed", "1"),
        ({"do": SLOW | {"road": "340498991"}}, "script.x.do", "either"),
        ({"do": SLOW | {"end": 300}}, "script.x.do", "behind"),
        ({"do": SLOW, "when": {"kind": "tim", "at": 3}}, "script.x.when.kind", "did you mean 'time'?"),
        ({"do": SLOW, "until": {"kind": "pased"}}, "script.x.until.kind", "did you mean 'passed'?"),
        ({"do": SLOW, "when": {"kind": "time", "at": 3, "vehicle": "leader"}}, "script.x.when.vehicle", "not a field"),
        ({"do": SLOW, "when": {"kind": "passed", "vehicle": "leader"}}, "script.x.when.along", "missing"),
        ({"do": SLOW, "until": {"kind": "passed", "vehicle": "leader"}}, "script.x.until.along", "missing"),
        ({"do": SLOW, "when": {"kind": "time", "at": 3}, "until": {"kind": "time", "at": 3}}, "script.x", "after its beginning (3 s)"),
        ({}, "script.x.do", "missing"),
    ],
)
def test_bad_changes_are_named(sample, change, field, word):
    with pytest.raises(ScenarioError) as caught:
        scenario(sample, {"x": change})
    (problem,) = caught.value.problems
    assert problem.where == f"changing: {field}"
    assert word in str(problem)


# -- objects -------------------------------------------------------------------------------------------

WALL = {"kind": "objects", "route": "east_to_west", "start": 450, "end": 451, "what": "barriers", "spacing": 5}


def wall(at=450.0, **other):
    """One row of objects across nothing: a single one in the middle of the lane."""
    return {"wall": {"do": WALL | {"start": at, "end": at + 1.0} | other}}


@pytest.mark.parametrize("kind", ["cones", "barriers"])
def test_a_driver_stops_before_what_stands_in_the_way(sample, kind):
    """At the gap that he wants at rest, comfortably; the gap is recorded as that to a car."""
    run = simulation(scenario(sample, wall(what=kind), clock={"duration": 20}))
    as_fast_as_possible(run)
    half = {"cones": 0.15, "barriers": 0.75}[kind]
    bumper = run.record().channel("station")[0] + run.world.vehicles.parameter[FRONT, 0]
    assert bumper[-1] == pytest.approx(450.0 - half - 2.0, abs=0.3)
    assert run.record().channel("gap")[0] == pytest.approx(450.0 - half - bumper, abs=1e-6)
    assert run.record().channel("acceleration")[0].min() > -3.0
    assert run.world.events.hits_found == 0


def test_what_stands_aside_is_passed(sample):
    """A row of barriers that leaves half a metre beside the car slows nobody down."""
    aside = {"start": 420, "end": 480, "offset": 0.9 + 0.125 + 0.5}
    plain, passed = (drive(scenario(sample, each), 10) for each in ({}, {"row": {"do": WALL | aside}}))
    assert (plain[1] == passed[1]).all() and passed[2].events.hits_found == 0


def test_a_collision_with_an_object_is_told_by_its_name(sample):
    """Nobody can stop before a barrier that appears 5 m ahead at 13 m/s, but before the next one, 20 m farther on."""
    changes = wall(at=450.0)
    changes["wall"]["when"] = {"kind": "passed", "vehicle": "leader", "along": 443}
    changes["wall"]["do"] |= {"end": 470, "spacing": 20}
    run = simulation(scenario(sample, changes, clock={"duration": 12}))
    as_fast_as_possible(run)
    hits = [each for each in run.cases[0].happenings if each.kind == "collision"]
    assert [each.units for each in hits] == [("leader", "barrier_1 of wall")]
    assert 8.0 < hits[0].numbers["impact_speed"].value < 13.0 and hits[0].numbers["impact_speed"].unit == "m/s"
    assert hits[0].text == f"collision of leader and barrier_1 of wall at {hits[0].numbers['impact_speed'].value:.1f} m/s"
    contact = run.record().channel("station")[0][np.searchsorted(run.record().time, hits[0].time)] + run.world.vehicles.parameter[FRONT, 0]
    assert 450.0 - 0.75 - 0.3 < contact < 450.0 - 0.75 + 0.6


def test_the_radar_sees_a_barrier_at_rest_and_no_cone(sample):
    for kind, seen in (("barriers", True), ("cones", False)):
        world = run_for([scenario(sample, wall(what=kind))], 0.5)
        (found, distance, rate, _), state = world.units.mounted[0].out[0], world.vehicles.state[:, 0]
        assert found == seen
        if seen:
            assert distance == pytest.approx(450.0 - 0.75 - world.vehicles.mind[STATION, 0] - world.vehicles.parameter[FRONT, 0], abs=0.6)
            assert rate == pytest.approx(-state[V_X], abs=0.3)


def test_objects_come_and_go(sample):
    changes = wall(at=600.0)
    changes["wall"] |= {"when": {"kind": "time", "at": 0.2}, "until": {"kind": "time", "at": 0.4}}
    made = build([scenario(sample, changes)])
    stand = []
    for _ in range(30):
        tick(made)
        stand.append(int(made.obstacles.standing.sum()))
    assert stand == [0] * 10 + [1] * 10 + [0] * 10


def test_objects_are_not_seen_through_fog(sample):
    """A driver who sees 30 m takes a barrier for nothing at 60 m, and stops before it all the same."""
    each = scenario(sample, wall(at=430.0), weather={"visibility": 30.0})
    assert np.isnan(run_for([each], 0.5).vehicles.mind[GAP, 0])
    _, speed, world = drive(each, 25)
    assert speed[-1] < 0.05 and world.events.hits_found == 0


def test_objects_of_one_world_do_not_stand_in_another(sample):
    plain, walled = scenario(sample, {}), scenario(sample, wall())
    alone = [run_for([each], 12).digest(0) for each in (plain, walled)]
    assert alone[0] != alone[1]
    for order in ([0, 1, 1], [1, 0, 0]):
        together = run_for([(plain, walled)[i] for i in order], 12)
        assert [together.digest(w) for w in range(3)] == [alone[i] for i in order]


def test_too_many_objects_are_refused(sample):
    with pytest.raises(ScenarioError) as caught:
        scenario(sample, {"x": {"do": WALL | {"start": 0, "end": 900, "spacing": 0.5}}})
    assert "1801 objects" in str(caught.value)
