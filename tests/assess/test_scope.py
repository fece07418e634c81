"""What a measure looks at: a window by time or events, some vehicles; and what of it is refused."""

from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.assess.goal import unmet
from studio.assess.measure import measure_all
from studio.errors import ScenarioError
from studio.execution.happening import happening
from studio.execution.record import Chain
from studio.kind import registry
from studio.kind.slot import chosen
from studio.scenario.schema import Goal
from studio.world.table.event import ARRIVED, HIT, NEAR_MISS, SCRIPT_BEGUN, SCRIPT_ENDED
from tests.assess.drive import record

TIME = np.arange(0.0, 10.0 + 1e-9, 0.02)
EVENTS = (
    happening(SCRIPT_BEGUN, 2.0, ("a",), entry="brake", action="brakes"),
    happening(SCRIPT_BEGUN, 3.0, (), entry="fog", action="fog"),
    happening(SCRIPT_ENDED, 4.0, ("a",), entry="brake", action="brakes"),
    happening(NEAR_MISS, 8.0, ("b", "c"), ttc=1.0),
    happening(ARRIVED, 9.0, ("a",)),
)


@pytest.fixture
def drive():
    """Three cars; the gap of b falls from 50 to 40 m, that of c from 30 to 10 m over 10 s."""
    gap = np.array([np.full(TIME.size, np.nan), 50.0 - TIME, 30.0 - 2.0 * TIME])
    made = record(TIME, ("a", "b", "c"), gap=gap, speed=20.0, ahead=np.array([[-1.0], [0.0], [1.0]]))
    return replace(made, happenings=EVENTS)


def asked(made, kind="min_gap", **given):
    """One measure as a scenario asks for it."""
    return measure_all(made, {"mine": chosen(registry.known("metric")[kind])(**given)})["mine"]


def test_usually_it_is_the_whole_run_and_everybody(drive):
    found = measure_all(drive)["min_gap"]
    assert (found.value, found.subject, found.time, found.kind) == (pytest.approx(10.0), ("c", "b"), 10.0, "min_gap")


@pytest.mark.parametrize(
    ("given", "value", "subject", "time"),
    [
        ({"vehicles": ["b"]}, 40.0, ("b", "a"), 10.0),
        ({"end": {"at": 5}}, 20.0, ("c", "b"), 5.0),
        ({"begin": {"entry": "brake"}, "end": {"entry": "brake", "event": "script_ended"}}, 22.0, ("c", "b"), 4.0),
        ({"begin": {"event": "script_begun", "at": 0.5}, "end": {"event": "near_miss", "at": -1}, "vehicles": ["b"]}, 43.0, ("b", "a"), 7),
        ({"end": {"event": "near_miss", "unit": "b"}}, 14.0, ("c", "b"), 8.0),
        ({"end": {"event": "rolled_over"}}, 10.0, ("c", "b"), 10.0),
    ],
)  # fmt: skip
def test_windows_and_vehicles(drive, given, value, subject, time):
    found = asked(drive, **given)
    assert (found.value, found.subject, found.time) == (pytest.approx(value), subject, pytest.approx(time))


def test_what_never_began_is_not_measured(drive):
    assert asked(drive, begin={"event": "near_miss", "unit": "a"}).value is None


def test_events_of_the_window_and_of_the_vehicles_count(drive):
    hit = replace(drive, happenings=(*EVENTS, happening(HIT, 8.0, ("b", "c"), impact_speed=3.0)))
    assert [asked(hit, "collisions", **each).value for each in ({}, {"end": {"at": 7}}, {"vehicles": ["a"]}, {"vehicles": ["c"]})] == [
        1,
        0,
        0,
        1,
    ]
    assert asked(drive, "travel_time", begin={"at": 2}).value == pytest.approx(7.0)


def test_a_chain_falls_apart_where_somebody_is_left_out(drive):
    """Accelerations of amplitude 1, 2, 1, 3: without the second there is no hop to the third."""
    wave = np.sin(TIME)
    made = record(TIME, ("a", "b", "c", "d"), acceleration=np.array([wave, 2 * wave, wave, 3 * wave]))
    made = replace(made, chains=(Chain("platoon", "", ("a", "b", "c", "d")),))
    whole, part = asked(made, "worst_hop_gain"), asked(made, "platoon_gain", vehicles=["a", "c", "d"])
    assert (whole.value, whole.subject, whole.about) == (pytest.approx(3.0), ("c", "d"), "from c to d")
    assert (part.value, part.subject) == (pytest.approx(3.0), ("c", "d"))


def test_links_are_those_to_the_vehicles(drive):
    made = replace(drive, links=("a→b", "b→c"), ages=np.array([[0.1], [0.3]]) * np.ones(TIME.size))
    assert asked(made, "information_age").subject == ("b", "c")
    assert asked(made, "information_age", vehicles=["b"]).value == pytest.approx(0.1)
    assert [asked(made, "stale_decisions", limit=0.2, **each).value for each in ({}, {"vehicles": ["b"]})] == [1.0, 0.0]


def test_a_listed_measure_takes_the_place_of_the_usual_one(drive):
    listed = {"min_gap": chosen(registry.known("metric")["min_gap"])(vehicles=["b"])}
    found = measure_all(drive, listed)
    assert found["min_gap"].value == pytest.approx(40.0) and next(iter(found)) == "min_gap" and "min_ttc" in found


def test_an_unmet_goal_says_whom_and_when(drive):
    (told,) = unmet({"min_gap": Goal(least=12)}, measure_all(drive))
    assert told == "min_gap is 10 m (c behind b at 10.00 s), at least 12 is wanted"


@pytest.mark.parametrize(
    ("measures", "words"),
    [
        ({"mine": {"kind": "min_gpa"}}, "min_gap"),
        ({"min_ttc": {"kind": "min_gap"}}, "measures.min_ttc: is the name of another metric"),
        ({"mine": {"kind": "min_gap", "begin": {"event": "colision"}}}, "mine.begin.event: is no kind of event .*did you mean 'collision'"),
        ({"mine": {"kind": "min_gap", "end": {"unit": "leader"}}}, "give `event` or `entry` too"),
        ({"mine": {"kind": "min_gap", "begin": {"at": 5}, "end": {"at": 5}}}, "must end"),
        ({"mine": {"kind": "min_gap", "limit": 3}}, "limit"),
        ({"mine": {"kind": "time_exposed_ttc", "limit": 0}}, "limit"),
    ],
)  # fmt: skip
def test_what_is_refused(sample, measures, words):
    with pytest.raises(ScenarioError, match=words):
        job.load(sample, {"measures": measures})


@pytest.mark.parametrize(
    ("given", "path"),
    [({"vehicles": ["nobody"]}, "vehicles.0"), ({"end": {"entry": "never"}}, "end.entry"),
     ({"begin": {"event": "arrived", "unit": "x"}}, "begin.unit")],
)  # fmt: skip
def test_names_of_a_measure_must_exist(sample, given, path):
    with pytest.raises(ScenarioError, match=rf"measures\.mine\.{path}: names no"):
        job.check(job.load(sample, {"measures": {"mine": {"kind": "min_gap", **given}}}))


def test_a_goal_may_be_about_a_listed_measure(sample):
    loaded = job.load(sample, {"measures": {"mine": {"kind": "min_gap"}}, "goals": {"mine": {"least": 1}}})
    assert loaded.scenario.measures["mine"].kind == "min_gap"
    with pytest.raises(ScenarioError, match=r"goals\.mien"):
        job.load(sample, {"measures": {"mine": {"kind": "min_gap"}}, "goals": {"mien": {"least": 1}}})
