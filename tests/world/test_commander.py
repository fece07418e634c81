"""Who commands: wheel, brake, drive and gear at every tick, by the order of precedence, as channels and as events."""

import numpy as np
import pytest
import yaml

from studio import job
from studio.application.port import BITS
from studio.kind import registry
from studio.road.drawn.motorway import motorway
from studio.world.commander import commanders
from studio.world.table.mind import APPLICATION, DRIVER_HAS, GEARBOX_HAS, INTERVENTION_HAS, SCRIPT_HAS

TICK = 0.02
PULSE = '''
"""Commands between two times, every other of its spans. Source: this test."""

from typing import NamedTuple

from studio.application.contract import ACCELERATION, BRAKE_TORQUE, GEAR, STEERING, Clock, Command
from studio.compiled import compiled
from studio.kind.settings import Part, number

TITLE = "Pulse"
COMMANDS = ACCELERATION | BRAKE_TORQUE | STEERING | GEAR


class Parameters(Part):
    """When, and what."""

    begin: float = number(1.0, unit="s", title="From", ge=0, le=100)
    end: float = number(2.0, unit="s", title="To", ge=0, le=100)
    span: float = number(100.0, unit="s", title="Span", gt=0, le=100)
    which: int = 1
    acceleration: float = number(-1.0, unit="m/s²", title="Acceleration", ge=-8, le=2)


class Memory(NamedTuple):
    """None."""


class Sees(NamedTuple):
    clock: Clock


class Does(NamedTuple):
    command: Command


@compiled
def decide(parameters, memory, sees):
    acts = parameters.begin - 1e-6 <= sees.clock.time < parameters.end - 1e-6
    even = int((sees.clock.time - parameters.begin + 1e-6) / parameters.span) % 2 == 0
    mask = int(parameters.which) if acts and even else 0
    return memory, Does(Command(mask, parameters.acceleration, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0))
'''


@pytest.fixture(scope="module")
def road(tmp_path_factory):
    """A motorway with a car on it, and an application that commands when it is told to."""
    kept = list(registry.every())
    folder = tmp_path_factory.mktemp("commands")
    (folder / "pulse.py").write_text(PULSE.lstrip())
    registry.load_file(folder / "pulse.py")
    (folder / "motorway.xodr").write_text(motorway(length=900.0, lanes=2), encoding="utf-8")
    document = {
        "version": 3, "title": "who commands", "map": {"file": "motorway.xodr"}, "clock": {"duration": 6},
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 20}]}},
        "vehicles": {"car": {"route": "way", "position": {"along": 100}, "speed": 20.0}},
    }  # fmt: skip
    (folder / "commands.yaml").write_text(yaml.safe_dump(document))
    yield folder / "commands.yaml"
    registry.restore(kept)


def pulse(begin, end, *, which=("acceleration",), priority=0, **parameters):
    """A group that commands some actuators from a time to another."""
    given = {"begin": begin, "end": end, "which": sum(BITS[each] for each in which)} | parameters
    return {"application": "pulse", "units": ["car"], "priority": priority, "parameters": given}


def driven(road, **parts):
    """Trace of each hand by name, times, and the events about hands."""
    run = job.run(job.load(road, parts))
    found = {each: run.trace(f"car.commands_{each}") for each in ("wheel", "brake", "drive", "gear")}
    events = [(each.time, each.text) for each in run.record.happenings if each.kind in ("takes_over", "gives_back")]
    return run.time, found, events


def test_alone_the_driver_has_everything_but_the_gear(road):
    _, hands, events = driven(road)
    assert not events and {name: set(each) for name, each in hands.items()} == {
        "wheel": {DRIVER_HAS}, "brake": {DRIVER_HAS}, "drive": {DRIVER_HAS}, "gear": {GEARBOX_HAS}
    }  # fmt: skip


def test_script_before_application_before_driver(road):
    """Two applications by priority, one of the brakes alone, and a maneuver over all: to the tick."""
    time, hands, events = driven(
        road,
        applications={
            "acc": pulse(1, 5),
            "aeb": pulse(2, 3, priority=5, which=("brake_torque",)),
            "steer": pulse(1, 2, priority=-1, which=("steering", "gear")),
        },
        script={"stop": {"when": {"kind": "time", "at": 3.5}, "do": {"kind": "brake", "vehicle": "car", "duration": 0.5}}},
    )  # fmt: skip
    acc, aeb, steer = (APPLICATION + i for i in range(3))  # in the order of their names
    spans = {
        "wheel": [(1, 2, steer)],
        "gear": [(1, 2, steer)],
        "drive": [(1, 5, acc), (3.5, 4, SCRIPT_HAS)],
        "brake": [(1, 5, acc), (2, 3, aeb), (3.5, 4, SCRIPT_HAS)],
    }
    for name, some in spans.items():
        expected = np.full(time.size - 1, float(GEARBOX_HAS if name == "gear" else DRIVER_HAS))
        for begin, end, who in some:
            expected[round(begin / TICK) : round(end / TICK)] = who
        assert (hands[name][:-1] == expected).all(), name
    assert events == [
        (1.0, "steer takes over wheel from driver"),
        (1.0, "acc takes over brake and drive from driver"),
        (1.0, "steer takes over gear from gearbox"),
        (2.0, "steer gives wheel back to driver"),
        (2.0, "aeb takes over brake from acc"),
        (2.0, "steer gives gear back to gearbox"),
        (3.0, "aeb gives brake back to acc"),
        (3.5, "script takes over brake and drive from acc"),
        (4.0, "script gives brake and drive back to acc"),
        (5.0, "acc gives brake and drive back to driver"),
    ]


def test_one_that_comes_and_goes_is_no_storm(road):
    """Fifty changes in two seconds are on the channel; every half second one of them is told."""
    _, hands, events = driven(road, applications={"acc": pulse(1, 3, span=0.04)})
    assert np.count_nonzero(np.diff(hands["brake"])) == 50
    assert 3 <= len(events) <= 5 and np.diff([when for when, _ in events]).min() >= 0.5 - 1e-9


def test_who_overrules_an_application_has_the_pedals(road):
    """The driver sees a barrier that the application does not: from the event on he has brake and drive."""
    put = {"kind": "objects", "route": "way", "what": "barriers", "start": 250, "end": 251}
    minding = {"reasons": ["collision"], "reaction_time": 0.3}
    run = job.run(job.load(road, {
        "applications": {"acc": pulse(0, 100, acceleration=0.0)}, "vehicles.car.intervention": minding, "script": {"block": {"do": put}},
    }))  # fmt: skip
    begun = next(each.time for each in run.record.happenings if each.kind == "driver_takes_over")
    for name in ("brake", "drive"):
        trace = run.trace(f"car.commands_{name}")
        assert (trace[run.time < begun - 1e-9] == APPLICATION).all() and trace[np.searchsorted(run.time, begun - 1e-9)] == INTERVENTION_HAS


def test_numbers_have_names(road):
    scenario = job.load(road, {"applications": {"b": pulse(1, 2), "a": pulse(1, 2, priority=1)}}).scenario
    assert commanders(scenario) == ("driver", "script", "driver's intervention", "gearbox", "a", "b")
