"""What makes no sense is refused with its place, what is wrong, what is allowed and what to do; what can never be is told."""

import copy

import pytest
import yaml

from studio import job
from studio.errors import ScenarioError
from studio.execution.event import hopeless
from studio.kind.meant import mistaken
from studio.road.drawn.motorway import motorway

BASE = {
    "version": 3,
    "title": "two cars",
    "map": {"file": "motorway.xodr"},
    "clock": {"duration": 2},
    "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 15}]}},
    "vehicles": {name: {"route": "way", "position": {"along": at}, "speed": 15} for name, at in (("a", 100), ("b", 200))},
    "applications": {"group": {"application": "acc", "units": ["a"], "parameters": {"headway": 1.0}}},
}
PLACED = "leave it out, or say the place the other way"
BRAKE = {"kind": "brake", "vehicle": "a"}
STAR = [[0, 0], [100, 100], [100, 0], [0, 100]]


@pytest.fixture(scope="module")
def prepare(tmp_path_factory):
    """Prepares the two cars with other sections."""
    folder = tmp_path_factory.mktemp("nonsense")
    (folder / "motorway.xodr").write_text(motorway(length=600.0, lanes=2), encoding="utf-8")

    def made(sections):
        (folder / "two.yaml").write_text(yaml.safe_dump(copy.deepcopy(BASE) | sections))
        return job.prepare(job.load(folder / "two.yaml"))

    return made


def when(**condition):
    """A script whose entry waits for this."""
    return {"script": {"entry": {"when": condition, "do": BRAKE}}}


def do(**action):
    """A script whose entry does this."""
    return {"script": {"entry": {"do": action}}}


def start(**position):
    """The first car starts there."""
    return {"vehicles": {"a": {"route": "way", "position": position, "speed": 15}}}


def group(**parameters):
    """The group of applications with these parameters."""
    return {"applications": {"group": {"application": "acc", "units": ["a"], "parameters": parameters}}}


@pytest.mark.parametrize(
    ("sections", "where", "words"),
    [
        (when(kind="distance", vehicle="a", other="a", distance=5), "script.entry.when", "name two"),
        (when(kind="time_to_collision", vehicle="a", other="a", below=5), "script.entry.when", "name another, or leave `other` out"),
        (when(kind="message", sender="a", receiver="a"), "script.entry.when", "nobody hears himself"),
        (do(kind="jam", area={"x": 1e5, "y": 1e5, "radius": 10}), "script.entry.do.area", "lies off the map; allowed: east -350 to 350 m"),
        (start(along=100, lane=1), "vehicles.a.position", f"`lane` would count for nothing beside `along`: {PLACED}"),
        (start(along=100, lane=0), "vehicles.a.position", "`lane` would count for nothing beside `along`"),
        (start(along=100, lane=1, offset=5), "vehicles.a.position", "`lane`, `offset` would count for nothing beside `along`"),
        (do(kind="friction", route="way", lane=1, start=5, end=9, friction=0.5), "script.entry.do", "`lane` would count for nothing"),
        (do(kind="jam", area={"x": 1, "y": 1, "radius": 10, "start": 5}), "script.entry.do.area", "`start` would count for nothing"),
        ({"stations": {"s": {"position": {"x": 1, "y": 1, "along": 7}}}}, "stations.s.position", "`along` would count for nothing"),
        (do(kind="jam", area={"corners": STAR}), "script.entry.do.area", "crosses itself: give its corners in the order"),
        ({"radio": {"kind": "cellular", "coverage": "polygon", "corners": STAR}}, "radio", "crosses itself"),
        (do(kind="tune_application", application="group"), "script.entry.do.parameters", "names no parameter (got {}); allowed: headway"),
        ({"seeds": {"radio": True}}, "seeds.radio", "is a truth value (got True); allowed: a number"),
        ({"seed": True}, "seed", "is a truth value"),
        ({"radio": {"delay": "0.1"}}, "radio.delay", "is text (got '0.1'); allowed: a number; write it without quotes"),
        ({"clock": {"duration": "2"}}, "clock.duration", "is text"),
        (do(kind="mover", line=[[0, "1"], [1, 1]]), "script.entry.do.line", "a number"),
        (do(kind="mover", line=[[0, 0], [1, 1]], stays="yes"), "script.entry.do.stays", "is text (got 'yes'); allowed: true or false"),
        ({"recording": {"traffic": 1}}, "recording.traffic", "is a number (got 1); allowed: true or false"),
        (group(headway="1.0"), "applications.group.parameters.headway", "is text (got '1.0'); allowed: a number"),
        (group(headway=True), "applications.group.parameters.headway", "is a truth value"),
        ({"goals": {"min_ttc": {"least": 5, "most": 1}}}, "goals.min_ttc", "no value is at least 5 and at most 1"),
        ({"measures": {"m": {"kind": "min_gap", "begin": {"at": -5}}}}, "measures.m.begin", "a run begins at 0 s, not at -5 s"),
        ({"measures": {"m": {"kind": "min_gap", "end": {"at": -5}}}}, "measures.m.end", "a run begins at 0 s"),
        ({"measures": {"m": {"kind": "min_gap", "begin": {"at": 500}}}}, "measures.m.begin.at", "is after the end of the run"),
    ],
)  # fmt: skip
def test_nonsense_is_refused(prepare, sections, where, words):
    with pytest.raises(ScenarioError) as told:
        prepare(sections)
    (problem,) = told.value.problems
    assert problem.where.endswith(f": {where}") and words in str(problem)


@pytest.mark.parametrize(
    ("sections", "words"),
    [
        (when(kind="message", message="denm"), "nobody sends messages of the kind 'denm'"),
        (when(kind="signal", vehicle="a"), "there are no lights on this map"),
    ],
)
def test_what_can_never_be_is_told(prepare, sections, words):
    (event,) = hopeless(prepare(sections))
    assert event.text == f"entry can never begin: {words}"


def test_what_makes_sense_is_taken(prepare):
    """A whole number where a number is meant, an outline in either direction, a window before an event, a message that somebody sends."""
    square = [[0, 0], [100, 0], [100, 100], [0, 100]]
    for corners in (square, square[::-1]):
        prepare(do(kind="jam", area={"corners": corners}) | {"radio": {"delay": 1}, "goals": {"min_ttc": {"least": 1}}})
    window = {"measures": {"m": {"kind": "min_gap", "begin": {"entry": "entry", "at": -0.5}}}}
    prepare(when(kind="message", sender="a", was="sent") | window)


def test_what_is_meant_by_a_type():
    cases = [
        (1, float, ""), (True, int, "a number"), ("1", float | None, "a number"), (True, bool | float, ""), (1, bool, "true or false"),
        ([1, "2"], list[float], "a number"), ([(1, True)], list[tuple[float, float]], "a number"), ("x", str | float, ""),
        (None, float, ""),
    ]  # fmt: skip
    for value, annotation, wanted in cases:
        assert mistaken(value, annotation) == wanted
