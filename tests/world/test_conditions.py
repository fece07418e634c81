"""Conditions: each by a closed form on a small world, how they join, when they come again, and what of them is refused or told."""

from itertools import pairwise
from math import hypot

import numpy as np
import pytest
import yaml

from studio import job
from studio.errors import ScenarioError
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import simulation
from studio.kind import registry
from studio.model import outline
from studio.road.drawn.motorway import motorway
from studio.road.network.signals import GREEN, RED
from studio.vehicle.parameter import FRONT, LENGTH, WIDTH
from studio.vehicle.state import X, Y
from studio.world.build import build
from studio.world.snapshot import restore, snapshot
from studio.world.tick import tick

TICK = 0.02
START = {"front": 160.0, "own": 100.0}


@pytest.fixture(scope="module")
def road(tmp_path_factory):
    """A straight road with a car at 20 m/s, and one 60 m ahead of it at 15 m/s."""
    folder = tmp_path_factory.mktemp("conditions")
    (folder / "motorway.xodr").write_text(motorway(length=1200.0, lanes=2), encoding="utf-8")
    car = {"route": "way", "driver": {"kind": "attentive", "time_headway": 0.5}}
    document = {
        "version": 3, "title": "conditions", "map": {"file": "motorway.xodr"}, "clock": {"duration": 10},
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 20}]}},
        "vehicles": {
            "own": car | {"position": {"road": "motorway", "lane": 0, "offset": START["own"]}, "speed": 20.0},
            "front": car | {"position": {"road": "motorway", "lane": 1, "offset": START["front"]}, "speed": 15.0},
        },
    }  # fmt: skip
    (folder / "conditions.yaml").write_text(yaml.safe_dump(document))
    return folder / "conditions.yaml"


def at(time):
    return {"kind": "time", "at": time}


def marks(road, conditions, seconds=5.0, again=(), **parts):
    """A run with a mark for each condition: its record, and the times of each mark."""
    script = {name: {"when": when, "again": name in again, "do": {"kind": "mark", "text": "so it is"}} for name, when in conditions.items()}
    other = parts.pop("script", {})
    run = simulation(job.prepare(job.load(road, {"script": script | other, "clock.duration": seconds} | parts)))
    as_fast_as_possible(run)
    told = [each for each in run.cases[0].happenings if each.kind == "script_begun"]
    return run.record(), {name: [each.time for each in told if each.text == f"{name} begins: so it is"] for name in conditions}


def first(record, true):
    """The time of the first sample of which something is true."""
    return pytest.approx(record.time[np.argmax(true)])


# -- each of them --------------------------------------------------------------------------------------


def test_speed_acceleration_standstill_and_time_gap(road):
    brake = {"brake": {"when": at(1), "do": {"kind": "brake", "vehicle": "own", "deceleration": 8, "duration": 6}}}
    record, times = marks(road, {
        "slow": {"kind": "speed", "vehicle": "own", "side": "below", "speed": 9},
        "hard": {"kind": "acceleration", "vehicle": "own", "side": "below", "acceleration": -6},
        "stands": {"kind": "standstill", "vehicle": "own"},
    }, 6, script=brake)  # fmt: skip
    speed, acceleration = record.trace("own.speed"), record.trace("own.acceleration")
    assert times["slow"][0] == first(record, speed < 9) and times["hard"][0] == first(record, acceleration < -6)
    assert times["stands"][0] == first(record, abs(speed) < 0.1) and 3.4 < times["stands"][0] < 4.2


def test_time_gap_and_time_to_collision_ahead(road):
    """On one lane, with constant speeds: gap over own speed, gap over the difference."""
    lane = {"vehicles.front.position": {"road": "motorway", "lane": 0, "offset": 160}}
    free = {"vehicles.own.driver.time_headway": 0.3, "vehicles.own.driver.deceleration": 8, "vehicles.front.driver.speed_factor": 0.75}
    record, times = marks(road, {
        "close": {"kind": "time_gap", "vehicle": "own", "below": 2.4},
        "near": {"kind": "time_to_collision", "vehicle": "own", "below": 9},
        "same": {"kind": "time_to_collision", "vehicle": "own", "other": "front", "below": 9},
    }, 6, **lane, **free)  # fmt: skip
    gap, speed = record.trace("own.gap"), record.trace("own.speed")
    assert times["close"][0] == first(record, np.append(np.inf, gap[:-1]) < 2.4 * speed)  # a gap is known from the tick before
    closing = speed - record.trace("front.speed")
    assert times["near"][0] == pytest.approx(first(record, gap < 9 * closing).expected, abs=2.01 * TICK)  # gap and speeds of two ticks
    assert times["same"][0] == pytest.approx(times["near"][0], abs=2.01 * TICK)  # on a straight road both are one


def test_distance_of_outlines_on_two_lanes(road):
    """Behind, beside and in front: at first the gap shrinks along the road, then it is that between the lanes, then it grows."""
    record, times = marks(road, {
        "near": {"kind": "distance", "vehicle": "own", "other": "front", "distance": 20},
        "beside": {"kind": "distance", "vehicle": "own", "other": "front", "distance": 2.5},
        "away": {"kind": "all_of", "of": [
            {"kind": "after", "entry": "beside"}, {"kind": "distance", "vehicle": "own", "other": "front", "side": "above", "distance": 6},
        ]},
    }, 18, **{"vehicles.front.driver.speed_factor": 0.75})  # fmt: skip
    world = build([job.prepare(job.load(road))])
    p = world.vehicles.parameter
    aside = abs(record.trace("own.y") - record.trace("front.y")) - record_width(p)
    middle = [record.trace(f"{name}.x") + (p[FRONT, i] - 0.5 * p[LENGTH, i]) for i, name in enumerate(("own", "front"))]
    gap = np.hypot(np.maximum(abs(middle[0] - middle[1]) - p[LENGTH, 0], 0.0), aside)
    assert times["near"][0] == pytest.approx(first(record, gap < 20).expected, abs=1.01 * TICK)
    assert times["beside"][0] == pytest.approx(first(record, gap < 2.5).expected, abs=1.01 * TICK)
    passed = record.time > times["beside"][0]
    assert times["away"][0] == pytest.approx(first(record, passed & (gap > 6)).expected, abs=1.01 * TICK)


def record_width(p):
    """Half of both bodies' widths [m]."""
    return 0.5 * (p[WIDTH, 0] + p[WIDTH, 1])


def test_the_gap_of_two_boxes_is_the_least_distance_of_their_points():
    """Against 400 points on each outline; 200 pairs that do not overlap."""
    draw = np.random.default_rng(1)

    def points(x, y, psi, length, width):
        t = np.linspace(0, 1, 100)
        a, b = 0.5 * length, 0.5 * width
        corners = np.array([(a, b), (-a, b), (-a, -b), (a, -b), (a, b)])
        edge = np.concatenate([p + t[:, None] * (q - p) for p, q in pairwise(corners)])
        return x + edge[:, 0] * np.cos(psi) - edge[:, 1] * np.sin(psi), y + edge[:, 0] * np.sin(psi) + edge[:, 1] * np.cos(psi)

    for _ in range(200):
        angle, far = draw.uniform(-3, 3), draw.uniform(6, 12)
        dx, dy, psi_a, psi_b = far * np.cos(angle), far * np.sin(angle), *draw.uniform(-3, 3, 2)
        (x, y), (u, v) = points(0, 0, psi_a, 4, 2), points(dx, dy, psi_b, 5, 1)
        least = np.hypot(x[:, None] - u, y[:, None] - v).min()
        assert outline.gap(dx, dy, psi_a, 4.0, 2.0, psi_b, 5.0, 1.0) == pytest.approx(least, abs=0.03)


@pytest.mark.parametrize("shape", ["circle", "polygon", "lane"])
def test_areas(road, shape):
    """From 170 to 230 m of the road, as a circle, a polygon and a stretch of the own lane: the middle of the outline comes in, goes out."""
    world = build([job.prepare(job.load(road))])
    p, x, y = world.vehicles.parameter, *world.vehicles.state[[X, Y], world.column("own")]
    left, right = x + 70 - 1e-6, x + 130
    area = {
        "circle": {"x": x + 100.0, "y": y, "radius": 30.0},
        "polygon": {"corners": [[left, y - 9], [right, y - 9], [right, y + 9], [left, y + 9]]},
        "lane": {"road": "motorway", "lane": 0, "start": 170.0, "end": 230.0},
    }[shape]
    inside = {"kind": "in_area", "vehicle": "own", "area": area}
    out = {"kind": "all_of", "of": [{"kind": "after", "entry": "in"}, {"kind": "not_", "of": inside}]}
    record, times = marks(road, {"in": inside, "out": out}, 9)
    middle = record.trace("own.x") - x + p[FRONT, 0] - 0.5 * p[LENGTH, 0]
    assert times["in"][0] == pytest.approx(first(record, middle >= 70).expected, abs=1.01 * TICK)
    assert times["out"][0] == pytest.approx(first(record, middle > 130).expected, abs=1.01 * TICK)


def test_the_lane_beside_is_another_area(road):
    area = {"road": "motorway", "lane": 1, "start": 100.0, "end": 400.0}
    _, times = marks(
        road, {"own": {"kind": "in_area", "vehicle": "own", "area": area}, "front": {"kind": "in_area", "vehicle": "front", "area": area}}
    )
    assert times == {"own": [], "front": [0.0]}


def test_a_light(sample):
    """The lights before the Großer Stern turn green when the programme says so."""
    setting = job.prepare(job.load(sample, {"traffic.count": 0}))
    signals, roads = setting.network.signals, setting.network.lanes
    link = next(i for i in range(len(signals)) if signals.state(i, setting.scenario.map.signal_start) == RED)
    road = roads[signals.link_lane[link]].road
    script = {name: {"when": {"kind": "signal", "road": road, "shows": name}, "do": {"kind": "mark"}} for name in ("red", "green")}
    run = simulation(
        job.prepare(job.load(sample, {"traffic.count": 0, "applications": {}, "goals": {}, "script": script, "clock.duration": 50}))
    )
    as_fast_as_possible(run)
    told = {each.text.split()[0]: each.time for each in run.cases[0].happenings if each.kind == "script_begun"}
    times = np.arange(0, 50, TICK)
    shown = np.array([signals.state(link, setting.scenario.map.signal_start + t) for t in times])
    assert told["green"] == pytest.approx(times[np.argmax(shown == GREEN)], abs=1.01 * TICK)


def test_values_of_sensors_and_vehicles(road):
    sensors = {"vehicles.own.sensors": {"front": {"kind": "front_radar", "range": 60}}}
    lane = {"vehicles.front.position": {"road": "motorway", "lane": 0, "offset": 160}, "vehicles.front.driver.speed_factor": 0.75}
    record, times = marks(road, {
        "range": {"kind": "value", "name": "own.front.range", "side": "below", "bound": 45},
        "station": {"kind": "value", "name": "own.station", "bound": 150},
    }, 5, **sensors, **lane)  # fmt: skip
    station = record.trace("own.station")
    assert times["station"][0] == pytest.approx(first(record, station > 150).expected, abs=1.01 * TICK)
    assert times["range"][0] == pytest.approx(first(record, record.trace("own.front.range") < 45).expected, abs=1.01 * TICK)


LOGS = '''
"""Logs the square of the time. Source: this test."""

from typing import Annotated, NamedTuple

from studio.application.contract import Clock
from studio.kind.settings import Part

TITLE = "Logs"


class Parameters(Part):
    """None."""


class Memory(NamedTuple):
    """None."""


class Log(NamedTuple):
    square: Annotated[float, "s²"] = 0.0


class Sees(NamedTuple):
    clock: Clock


class Does(NamedTuple):
    log: Log


def decide(parameters, memory, sees):
    return memory, Does(Log(sees.clock.time**2))
'''


def test_what_an_application_logs(road, tmp_path):
    """From the tick on after it was logged: 2 s² are passed at 1.42 s."""
    kept = list(registry.every())
    (tmp_path / "logs.py").write_text(LOGS.lstrip())
    registry.load_file(tmp_path / "logs.py")
    try:
        record, times = marks(
            road,
            {"late": {"kind": "value", "name": "own.clerk.square", "side": "above", "bound": 2.0}},
            applications={"clerk": {"application": "logs", "units": ["own"]}},
        )
    finally:
        registry.restore(kept)
    assert times["late"] == pytest.approx([1.42 + TICK]) and record.trace("own.clerk.square")[71] == pytest.approx(1.42**2)


# -- joined --------------------------------------------------------------------------------------------


def test_all_any_not_nested(road):
    early, late = at(1), at(2)
    _, times = marks(road, {
        "all": {"kind": "all_of", "of": [early, late]},
        "any": {"kind": "any_of", "of": [late, early]},
        "not": {"kind": "not_", "of": late},
        "deep": {"kind": "all_of", "of": [{"kind": "not_", "of": {"kind": "any_of", "of": [at(3), {"kind": "not_", "of": late}]}}, early]},
    })  # fmt: skip
    assert times == {"all": [2.0], "any": [1.0], "not": [0.0], "deep": [2.0]}


def test_delay_and_duration(road):
    """`later` counts from the first time, `lasting` anew after every break."""
    span = {"kind": "all_of", "of": [at(1), {"kind": "not_", "of": at(1.5)}]}
    both = {"kind": "any_of", "of": [span, at(2)]}
    _, times = marks(road, {
        "later": {"kind": "later", "of": span, "delay": 1.0},
        "lasting": {"kind": "lasting", "of": both, "duration": 0.75},
        "short": {"kind": "lasting", "of": both, "duration": 0.4},
        "at_once": {"kind": "lasting", "of": both, "duration": 0.0},
    })  # fmt: skip
    assert times == {"later": [2.0], "lasting": [2.76], "short": [1.4], "at_once": [1.0]}  # 0.75 s is reached at the tick after it


def test_once_and_again(road):
    """Every period; and whenever the car comes over a speed anew, however long it stays there."""
    to = {"kind": "set_speed", "vehicle": "own", "acceleration": 3}
    wave = {f"to_{i}": {"when": at(1 + 1.5 * i), "do": to | {"speed": speed}} for i, speed in enumerate((17, 19, 17))}
    slow = {"kind": "speed", "vehicle": "own", "side": "below", "speed": 18}
    tock = {"kind": "every", "period": 0.5, "first": 1.0}
    record, times = marks(road, {"often": tock, "seldom": tock, "slow": slow}, 6, again=("often", "slow"), script=wave)
    assert times["often"] == pytest.approx(np.arange(1.0, 6.0, 0.5)) and times["seldom"] == [1.0]
    below = record.trace("own.speed") < 18
    begins = record.time[1:][below[1:] & ~below[:-1]]
    assert times["slow"] == pytest.approx(begins) and len(begins) == 2


def test_another_entry_acts(road):
    brake = {"brake": {"when": at(1), "do": {"kind": "brake", "vehicle": "own", "deceleration": 1, "duration": 1}}}
    acts = {"kind": "acts", "entry": "brake"}
    _, times = marks(road, {
        "acts": acts, "over": {"kind": "all_of", "of": [{"kind": "after", "entry": "brake"}, {"kind": "not_", "of": acts}]},
    }, script=brake)  # fmt: skip
    assert times == {"acts": [1.02], "over": [2.02]}  # a maneuver begins and ends at a tick, and is seen at the next


def test_what_begins_again_does_so_with_its_effects(road):
    """A limit in turns, while the car is in an area; a brake that comes back."""
    brake = {
        "when": {"kind": "every", "period": 2.0, "first": 1.0},
        "again": True,
        "do": {"kind": "brake", "vehicle": "own", "deceleration": 2, "duration": 0.5},
    }
    run = job.run(job.load(road, {"script": {"brake": brake}, "clock.duration": 6}))
    told = [(each.kind, each.time) for each in run.record.happenings if each.kind.startswith("script")]
    assert told == [(kind, t + d) for t in (1.0, 3.0, 5.0) for kind, d in (("script_begun", 0.0), ("script_ended", 0.5))]


def test_worlds_and_snapshots(road):
    """Joined conditions have the bits that they have alone; a world that goes on from a snapshot remembers since when what holds."""
    script = {
        "a": {"when": {"kind": "lasting", "of": {"kind": "speed", "vehicle": "own", "side": "above", "speed": 15}, "duration": 1.5},
              "do": {"kind": "brake", "vehicle": "own", "deceleration": 3, "duration": 1}},
        "b": {"when": {"kind": "every", "period": 0.7}, "again": True, "do": {"kind": "brake", "vehicle": "front", "duration": 0.1}},
    }  # fmt: skip
    variants = [job.prepare(job.load(road, {"script": each})) for each in (script, {}, {"b": script["b"]})]

    def run(settings, ticks):
        world = build(settings)
        for _ in range(ticks):
            tick(world)
        return world

    alone = [run([each], 150).digest(0) for each in variants]
    assert [run(variants, 150).digest(w) for w in range(3)] == alone
    world = run(variants[:1], 50)
    kept, anew = snapshot(world), build(variants[:1])
    restore(anew, kept)
    for _ in range(100):
        tick(anew)
    assert anew.digest(0) == alone[0]


# -- bad input -----------------------------------------------------------------------------------------

MARK = {"do": {"kind": "mark"}}
NESTED = {"kind": "all_of", "of": [at(1), {"kind": "not_", "of": {"kind": "speed", "vehicle": "owm", "speed": 3}}]}


@pytest.mark.parametrize(
    ("when", "field", "word"),
    [
        (NESTED, "when.of.1.of.vehicle", "did you mean 'own'?"),
        ({"kind": "any_of", "of": []}, "when.of", "at least 1 item"),
        ({"kind": "any_of", "of": [{"kind": "tim", "at": 3}]}, "when.of.0.kind", "did you mean 'time'?"),
        ({"kind": "lasting", "of": at(1), "duration": -1}, "when.duration", "≥ 0"),
        ({"kind": "in_area", "vehicle": "own", "area": {"x": 1, "y": 2, "radius": 0}}, "when.area.radius", "> 0"),
        ({"kind": "in_area", "vehicle": "own", "area": {"corners": [[0, 0], [1, 1], [2, 2]]}}, "when.area", "has no extent"),
        ({"kind": "in_area", "vehicle": "own", "area": {"road": "motorwey"}}, "when.area.road", "did you mean 'motorway'?"),
        ({"kind": "in_area", "vehicle": "own", "area": {"road": "motorway", "end": 9999}}, "when.area.end", "lies beyond the end"),
        ({"kind": "signal", "road": "motorway"}, "when.road", "names no road of this map with lights"),
        ({"kind": "value", "name": "own.front.rang", "bound": 1}, "when.name", "did you mean 'own.front.range'?"),
        ({"kind": "distance", "vehicle": "own", "other": "nobody", "distance": 1}, "when.other", "names no vehicle"),
        ({"kind": "any_of", "of": [at(1), {"kind": "passed", "vehicle": "own", "along": 99999}]}, "when.of.1.along", "≤ "),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(road, when, field, word):
    with pytest.raises(ScenarioError) as caught:
        job.prepare(job.load(road, {"script": {"x": {"when": when} | MARK}}))
    assert f"script.x.{field}:" in str(caught.value) and word in str(caught.value)


@pytest.mark.parametrize(
    ("script", "names"),
    [
        ({"a": {"when": {"kind": "after", "entry": "a"}}}, "a begins → a begins"),
        (
            {"a": {"when": {"kind": "after", "entry": "b"}}, "b": {"when": {"kind": "any_of", "of": [{"kind": "acts", "entry": "a"}]}}},
            "a begins → b begins → a begins",
        ),
        (
            {"a": {"when": {"kind": "after", "entry": "b", "turn": "ends"}}, "b": {"until": {"kind": "after", "entry": "a"}}},
            "a begins → b ends → a begins",
        ),
    ],
)
def test_a_cycle_is_named(road, script, names):
    with pytest.raises(ScenarioError) as caught:
        job.prepare(job.load(road, {"script": {name: each | MARK for name, each in script.items()}}))
    (problem,) = caught.value.problems
    assert "waits for itself" in str(problem) and names in str(problem) and "script.a.when" in problem.where


def test_an_entry_may_end_with_another_that_it_begins(road):
    """That is no cycle: b begins after a, and ends it."""
    script = {"a": {"when": at(1), "until": {"kind": "after", "entry": "b"}}, "b": {"when": {"kind": "after", "entry": "a", "delay": 1}}}
    job.prepare(job.load(road, {"script": {name: each | MARK for name, each in script.items()}}))


def test_what_can_never_be_is_told(road):
    """At the start of the run, as an event: it is no error, for the run may have been made shorter."""
    off = {"kind": "in_area", "vehicle": "own", "area": {"x": 90_000, "y": 0, "radius": 10}}
    script = {
        "late": {"when": at(30)} | MARK,
        "off": {"when": {"kind": "all_of", "of": [at(1), off]}} | MARK,
        "fine": {"when": {"kind": "any_of", "of": [at(1), off]}} | MARK,
        "open": {"when": at(1), "until": {"kind": "lasting", "of": at(1), "duration": 60}, "do": {"kind": "brake", "vehicle": "own"}},
    }
    run = job.run(job.load(road, {"script": script, "clock.duration": 2}))
    assert [each.text for each in run.record.happenings if each.kind == "never_begins"] == [
        "late can never begin: the run ends at 2 s", "off can never begin: the area lies off the map",
        "open can never end: the run lasts 2 s",
    ]  # fmt: skip


# -- the end of the run --------------------------------------------------------------------------------


def test_a_script_ends_the_run(road):
    end = {"end": {"when": {"kind": "value", "name": "own.station", "bound": 150}, "do": {"kind": "end"}}}
    run = job.run(job.load(road, {"script": end}))
    assert run.status == "done" and run.sim_time_s == pytest.approx(2.52, abs=0.1)
    assert run.record.time[-1] == pytest.approx(run.sim_time_s) and run.trace("own.station")[-1] == pytest.approx(150, abs=1)
    (told,) = [each for each in run.record.happenings if each.kind == "run_ended"]
    assert (told.text, told.time) == ("end ends the run", run.sim_time_s)


def test_it_ends_in_a_batch_as_it_does_alone(road):
    settings = [
        job.prepare(job.load(road, {"script": {"end": {"when": at(t), "do": {"kind": "end"}}}, "clock.duration": 3})) for t in (1, 2, 9)
    ]

    def run(*some):
        made = simulation(*some)
        as_fast_as_possible(made)
        return [(each.state_hash, each.time, each.samples, [e.text for e in each.happenings]) for each in made.cases]

    assert run(*settings) == [*run(settings[0]), *run(settings[1]), *run(settings[2])]


def test_lanes_are_apart(road):
    """What the tests above take for granted: own and front drive on two lanes."""
    state = build([job.prepare(job.load(road))]).vehicles.state
    assert 3.0 < hypot(0.0, state[Y, 0] - state[Y, 1]) < 4.0
