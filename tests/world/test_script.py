"""The script: conditions and maneuvers by closed forms, kinds of a user's own in one file each, and events that say what happened."""

import numpy as np
import pytest

from studio.errors import KindError, ScenarioError
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import simulation
from studio.kind import registry
from studio.kind.number import numbers as plain
from studio.kind.number import tuple_of
from studio.kind.settings import references
from studio.kinds.action import brake, set_speed
from studio.kinds.condition import gap, passed
from studio.scenario import schema
from studio.world.maneuver import Sees, drive, over
from tests.changing import SLOW, run_for, scenario

BRAKE = {"kind": "brake", "vehicle": "leader", "deceleration": 3, "duration": 2}


def at(time):
    return {"kind": "time", "at": time}


def happened(sample, script, seconds, **parts):
    """A run of the sample with a script, and its events."""
    run = simulation(scenario(sample, script, clock={"duration": seconds}, **parts))
    as_fast_as_possible(run)
    return run, run.cases[0].happenings


def turns(events):
    """When each entry began and ended."""
    return {each.text.partition(":")[0]: each.time for each in events if each.kind.startswith("script")}


# -- conditions ----------------------------------------------------------------------------------------


def test_a_time_comes_with_the_first_tick_that_has_it(sample):
    _, events = happened(sample, {"a": {"when": at(0.05), "do": BRAKE}, "b": {"when": at(0.06), "do": SLOW}}, 0.2)
    assert turns(events) == {"a begins": 0.06, "b begins": 0.06}


def test_a_speed_is_noticed_when_it_is_crossed(sample):
    """From 13 m/s with 3 m/s² down, then up again: both sides, to the tick."""
    script = {
        "stop": {"when": at(0.5), "do": BRAKE | {"duration": 1.5}},
        "slow": {"when": {"kind": "speed", "vehicle": "leader", "side": "below", "speed": 11}, "do": SLOW},
        "fast": {
            "when": {"kind": "speed", "vehicle": "leader", "side": "above", "speed": 13.02},
            "do": SLOW | {"start": 1200, "end": 1300},
        },
    }
    run, events = happened(sample, script, 8)
    time, speed = run.record().time, run.record().channel("speed")[0]
    assert turns(events)["slow begins"] == pytest.approx(time[np.argmax(speed < 11)])
    assert turns(events)["fast begins"] == pytest.approx(time[np.argmax(speed > 13.02)])


def test_a_gap_is_what_the_driver_saw_last(sample):
    """One tick after the record shows it, and never while nothing is ahead."""
    near, alone = ({"kind": "gap", "vehicle": name, "below": 9.5} for name in ("follower_1", "leader"))
    script = {"push": {"when": at(0.5), "do": BRAKE}, "near": {"when": near, "do": SLOW}, "never": {"when": alone, "do": SLOW}}
    run, events = happened(sample, script, 4, alone=False, traffic={})
    time, seen = run.record().time, run.record().channel("gap")[1]
    assert turns(events)["near begins"] == pytest.approx(time[np.argmax(seen < 9.5) + 1])
    assert "never begins" not in turns(events)


@pytest.mark.parametrize(("turn", "expected"), [("begins", 1.5), ("ends", 2.2)])
def test_an_entry_follows_another(sample, turn, expected):
    script = {
        "second": {"when": {"kind": "after", "entry": "first", "turn": turn, "delay": 0.5}, "do": SLOW},
        "first": {"when": at(1), "until": at(1.7), "do": SLOW | {"start": 1200, "end": 1300}},
    }
    assert turns(happened(sample, script, 3)[1])["second begins"] == pytest.approx(expected)


def test_nobody_is_asked_who_is_not_waited_for(sample):
    """Conditions and maneuvers cost nothing before and after."""
    run = simulation(scenario(sample, {"stop": {"when": at(0.1), "do": BRAKE | {"duration": 0.2}}}, clock={"duration": 1}))
    seen = []
    for _ in range(25):
        run.advance()
        seen.append((run.world.script.waiting.size, run.world.script.acting.size))
    assert seen == [(1, 0)] * 5 + [(0, 1)] * 10 + [(0, 0)] * 10


# -- maneuvers -----------------------------------------------------------------------------------------


def sees(**known):
    return Sees(**(dict.fromkeys(Sees._fields, 0.0) | known))


def numbers(module, **given):
    """Settings as compiled code has them."""
    settings = module.Settings(vehicle="leader", **given)
    return tuple_of(module, module.Settings)(*plain(settings, lambda what, name: 0.0))


@pytest.mark.parametrize("call", ["compiled", "py_func"])
def test_braking_by_the_book(call):
    """-b until the time or the speed is there."""
    act = brake.act if call == "compiled" else brake.act.py_func
    told = numbers(brake, deceleration=4, duration=2, to_speed=3)
    assert act(told, sees(speed=10, elapsed=1.98)) == drive(-4.0)
    assert act(told, sees(speed=10, elapsed=2.0)) == over() == act(told, sees(speed=3.0, elapsed=0.5))


@pytest.mark.parametrize("call", ["compiled", "py_func"])
def test_a_speed_is_driven_to(call):
    """With the acceleration, less in the last half second, over when it is there; down as well as up."""
    act = set_speed.act if call == "compiled" else set_speed.act.py_func
    told = numbers(set_speed, speed=15, acceleration=1.5)
    assert act(told, sees(speed=10)) == drive(1.5) and act(told, sees(speed=20)) == drive(-1.5)
    assert act(told, sees(speed=14.8)).acceleration == pytest.approx(0.4)
    assert act(told, sees(speed=14.96)) == over() == act(told, sees(speed=10, elapsed=60.0))


def test_a_vehicle_reaches_the_speed_and_goes_on_as_it_likes(sample):
    """From 13 to 9 m/s with 2 m/s²: two seconds and the lag of the brakes; then the driver has the pedals again."""
    script = {"slower": {"when": at(1), "do": {"kind": "set_speed", "vehicle": "leader", "speed": 9, "acceleration": 2}}}
    run, events = happened(sample, script, 8)
    time, speed = run.record().time, run.record().channel("speed")[0]
    ended = turns(events)["slower ends"]
    assert 3.0 < ended < 4.2 and np.interp(ended, time, speed) == pytest.approx(9, abs=0.06)
    steady = (time > 1.6) & (time < 2.4)
    assert np.polyfit(time[steady], speed[steady], 1)[0] == pytest.approx(-2, abs=0.1)
    assert speed[-1] > 10


def test_a_maneuver_that_begins_ends_the_one_before(sample):
    script = {"first": {"when": at(1), "do": BRAKE | {"duration": 5}}, "second": {"when": at(2), "do": BRAKE | {"deceleration": 1}}}
    run, events = happened(sample, script, 5)
    assert turns(events) == {"first begins": 1, "second begins": 2, "first ends": 2, "second ends": 4}
    time, asked = run.record().time, run.record().channel("acceleration")[0]
    assert asked[(time > 1.6) & (time < 2)].max() < -2.8 and asked[(time > 2.8) & (time < 4)] == pytest.approx(-1, abs=0.2)


def test_until_ends_a_maneuver_and_a_change(sample):
    slowly = {"kind": "speed", "vehicle": "leader", "side": "below", "speed": 12}
    script = {"stop": {"when": at(1), "until": slowly, "do": BRAKE}, "limit": {"when": at(1), "until": at(2), "do": SLOW}}
    run, events = happened(sample, script, 4)
    time, speed = run.record().time, run.record().channel("speed")[0]
    assert turns(events)["stop ends"] == pytest.approx(time[np.argmax(speed < 12)])
    assert turns(events)["limit ends"] == 2


# -- kinds of one's own --------------------------------------------------------------------------------

STANDS = '''
"""A vehicle stands. Source: this test."""

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.vehicle.state import V_X

KIND = "condition"
TITLE = "A vehicle stands"


class Settings(Part):
    """Who."""

    vehicle: VehicleName
    below: float = number(0.1, unit="m/s", title="Slower than", gt=0, le=5)
    is_asked: bool = True


@compiled
def holds(view, settings):
    return settings.is_asked > 0.0 and view.state[V_X, int(settings.vehicle)] < settings.below
'''
SWERVE = '''
"""A vehicle leaves its path for a while. Source: this test."""

from typing import Literal

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.world.maneuver import over, steer

KIND = "action"
TITLE = "Swerve"


class Settings(Part):
    """Who, and where to."""

    vehicle: VehicleName
    side: Literal["left", "right"] = "left"
    duration: float = number(0.5, unit="s", title="Duration", gt=0, le=5)


@compiled
def act(settings, sees):
    if sees.elapsed >= settings.duration:
        return over()
    return steer(0.04 if settings.side == 0.0 else -0.04)
'''
ACCIDENT = '''
"""An accident: two lanes closed, a limit before them, oil on the road. Source: this test."""

from studio.kind.settings import Part
from studio.kind.stretch import LaneStretch, Stretch
from studio.world.effect import Closing, Limit, Row, Slippery

KIND = "action"
TITLE = "Accident"


class Settings(Part):
    """Where."""

    road: str


def effects(settings, place):
    lanes = [LaneStretch(road=settings.road, lane=i, start=460, end=520, taper=40) for i in range(place.lanes(settings.road) - 1)]
    here = Stretch(road=settings.road, start=420, end=520)
    return [*map(Closing, lanes), Limit(here, 6.0), Slippery(here, 0.4, 8.0, 8.0), Row(here, "cones", 20.0, -5.0)]
'''


@pytest.fixture
def kinds(tmp_path):
    """Writes kinds into a folder and loads them; they are gone after the test."""
    kept = dict(registry._registered), dict(registry._broken)

    def load(**texts):
        for name, text in texts.items():
            (tmp_path / f"{name}.py").write_text(text.lstrip(), encoding="utf-8")
        return registry.load_folder(tmp_path)

    yield load
    registry._registered, registry._broken = kept
    schema.make_anew()


def test_a_condition_of_ones_own_is_one_file(sample, kinds):
    (kind,) = kinds(stands=STANDS)
    assert (kind.sort, kind.name) == ("condition", "stands")
    stop = {"when": at(1), "do": BRAKE | {"deceleration": 8, "duration": 5}}
    script = {"stop": stop, "limit": {"when": {"kind": "stands", "vehicle": "leader", "below": 1.0}, "do": SLOW}}
    run, events = happened(sample, script, 5)
    time, speed = run.record().time, run.record().channel("speed")[0]
    assert turns(events)["limit begins"] == pytest.approx(time[np.argmax(speed < 1.0)])


@pytest.mark.parametrize(("side", "sign"), [("left", 1), ("right", -1)])
def test_a_maneuver_of_ones_own_is_one_file(sample, kinds, side, sign):
    """It steers, and leaves the pedals alone."""
    kinds(swerve=SWERVE)
    plain_run, _ = happened(sample, {}, 3)
    run, events = happened(sample, {"away": {"when": at(1), "do": {"kind": "swerve", "vehicle": "leader", "side": side}}}, 3)
    assert turns(events) == {"away begins": 1.0, "away ends": 1.5}
    offsets = [each.record().channel("lateral_offset")[0] for each in (run, plain_run)]
    assert (sign * (offsets[0] - offsets[1])).max() > 0.2
    assert (offsets[0] == offsets[1])[run.record().time < 1].all()


def test_an_action_on_the_road_of_ones_own_is_one_file(sample, kinds):
    """Five effects of one entry: who comes goes around both lanes, slowly."""
    kinds(accident=ACCIDENT)
    run, events = happened(sample, {"crash": {"do": {"kind": "accident", "road": "340498991"}}}, 26, lane=1)
    station, speed = run.record().channel("station")[0], run.record().channel("speed")[0]
    assert events[0].text == "crash begins: Accident" and events[0].x is not None
    assert station[-1] > 520 and speed[(station > 440) & (station < 500)].max() < 6.2
    assert run.world.events.hits_found == 0 and len(run.world.obstacles.names) > 6


# -- bad input -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("entry", "field", "word"),
    [
        ({"do": BRAKE | {"vehicle": "leder"}}, "do.vehicle", "did you mean 'leader'?"),
        ({"when": {"kind": "speed", "vehicle": "leder", "speed": 3}, "do": BRAKE}, "when.vehicle", "did you mean 'leader'?"),
        ({"when": {"kind": "after", "entry": "y"}, "do": BRAKE}, "when.entry", "names no entry of the script"),
        ({"until": {"kind": "passed", "vehicle": "leader", "along": 9999}, "do": BRAKE}, "until.along", "≤ "),
        ({"do": BRAKE | {"kind": "brak"}}, "do.kind", "did you mean 'brake'?"),
        ({"when": {"kind": "speed", "vehicle": "leader", "speed": 3, "side": "under"}, "do": BRAKE}, "when.side", "'above' or 'below'"),
        ({"when": at(3), "until": at(2), "do": BRAKE}, "", "it must end (2 s) after its beginning (3 s)"),
        ({"until": 3, "do": BRAKE}, "until", "dictionary"),
    ],
)
def test_what_is_wrong_in_an_entry_is_named(sample, entry, field, word):
    with pytest.raises(ScenarioError) as caught:
        scenario(sample, {"x": entry})
    (problem,) = caught.value.problems
    assert problem.where == f"changing: script.x.{field}".rstrip(".")
    assert word in str(problem)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (STANDS.replace("is_asked: bool", "is_asked: str"), "Settings is_asked is str; allowed: float, int, bool"),
        (STANDS.replace("def holds(view, settings)", "def holds(settings)"), "holds takes (settings); it is called with (view, settings)"),
        (SWERVE.replace("vehicle: VehicleName", "vehicle: float = 0"), "has act, but no vehicle that it is about"),
        (ACCIDENT.replace("def effects", "def effect"), "has neither act nor effects"),
    ],
)
def test_a_file_that_is_no_kind_says_why(kinds, tmp_path, text, what):
    kinds(other=text)
    assert what in str(next(each for each in registry.broken() if each.name == "other").error)
    with pytest.raises(KindError):
        registry.load_file(tmp_path / "other.py")


def test_a_broken_kind_is_named_where_it_is_used(sample, kinds):
    kinds(stands=STANDS.replace("def holds", "def hold"))
    with pytest.raises(ScenarioError) as caught:
        scenario(sample, {"x": {"when": {"kind": "stands", "vehicle": "leader"}, "do": BRAKE}})
    assert "script.x.when.kind" in str(caught.value) and "has neither holds nor joins" in str(caught.value)


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        ("raise ValueError('no idea')", "no idea"),
        ("return [3]", "gives what is no effect (got 3); allowed: Limit, Slippery, Row, Closing, Shift"),
        ("return [Limit(Stretch(road='340498991', start=1, end=9000), 6.0)]", "script.x.do.end: lies beyond the end of road '340498991'"),
    ],
)
def test_effects_that_are_wrong_are_told(sample, kinds, wrong, word):
    kinds(accident=ACCIDENT.partition("    lanes =")[0] + f"    {wrong}\n")
    with pytest.raises(ScenarioError) as caught:
        scenario(sample, {"x": {"do": {"kind": "accident", "road": "340498991"}}})
    assert word in str(caught.value) and "script.x.do" in str(caught.value)


def test_names_in_settings_are_found_wherever_they_stand():
    entry = schema.Entry.model_validate(
        {"when": {"kind": "passed", "vehicle": "a", "along": 3}, "do": {"kind": "limit", "route": "r", "start": 1, "end": 2, "speed": 3}}
    )
    assert [tuple(each) for each in references(entry)] == [("when.vehicle", "vehicle", "a"), ("do.route", "route", "r")]


def test_settings_are_plain_numbers():
    given = {"vehicle": "b", "along": 7.0}
    assert plain(passed.Settings(**given), lambda what, name: {"b": 4.0}[name]) == [4.0, 7.0]
    assert tuple_of(gap, gap.Settings)._fields == ("vehicle", "below")


# -- events --------------------------------------------------------------------------------------------


def test_an_event_is_data_and_words(sample):
    """Kind, time, units and place of a maneuver; the place is where its vehicle is."""
    run, events = happened(sample, {"stop": {"when": at(1), "do": BRAKE}}, 3.5)
    begun, ended = (each for each in events if each.kind.startswith("script"))
    assert (begun.kind, begun.time, begun.vehicle, begun.units) == ("script_begun", 1.0, "leader", ("leader",))
    assert begun.text == "stop begins: brake with 3 m/s²" and ended.text == "stop ends" and ended.time == 3.0
    x, y = (np.interp(1.0, run.record().time, run.record().channel(name)[0]) for name in ("x", "y"))
    assert np.hypot(begun.x - x, begun.y - y) < 0.5


def test_a_red_light_that_is_passed_is_an_event(sample):
    """Everybody else stops; who is told to drive on is told of, with speed and place."""
    script = {"on": {"do": {"kind": "set_speed", "vehicle": "leader", "speed": 20, "acceleration": 0.01, "duration": 60}}}
    obedient, told = (happened(sample, each, 45, map={"file": "maps/berlin_siegessaeule_grosser_stern.osm.gz", "signal_start": 60})
                      for each in ({}, script))  # fmt: skip
    assert "red_light_passed" not in {each.kind for each in obedient[1]}
    passed_at = [each for each in told[1] if each.kind == "red_light_passed"]
    assert passed_at and passed_at[0].vehicle == "leader" and passed_at[0].numbers["speed"].unit == "m/s"
    time, speed = told[0].record().time, told[0].record().channel("speed")[0]
    assert np.interp(passed_at[0].time, time, speed) == pytest.approx(passed_at[0].numbers["speed"].value, abs=0.1)
    assert passed_at[0].text == f"passes a red light at {passed_at[0].numbers['speed'].value:.1f} m/s"


def test_what_a_maneuver_commands_must_be_a_number(sample, kinds):
    """A command that is none ends the run as failed; it does not hand the car to the driver unseen."""
    kinds(swerve=SWERVE.replace("steer(0.04", "steer(sees.elapsed * float('nan')").replace("-0.04)", "0.0)"))
    run, events = happened(sample, {"away": {"when": at(1), "do": {"kind": "swerve", "vehicle": "leader"}}}, 3)
    assert run.cases[0].status == "failed"
    assert run.cases[0].error == "the action 'swerve' of leader wants an acceleration or steering that is not finite at 1.000 s"
    assert events[-1].kind == "failed"


def test_worlds_have_scripts_of_their_own(sample):
    """Side by side every world has the bits that it has alone."""
    each = [{"stop": {"when": at(0.5), "do": BRAKE}}, {}, {"limit": {"do": SLOW}, "go": {"when": at(1), "do": BRAKE | {"deceleration": 5}}}]
    variants = [scenario(sample, script, alone=False) for script in each]
    alone = [run_for([one], 4).digest(0) for one in variants]
    together = run_for(variants, 4)
    assert [together.digest(w) for w in range(3)] == alone and len(set(alone)) == 3
