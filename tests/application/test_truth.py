"""What an application is given says nothing about others when its sensors and its radio are off."""

import numpy as np
import pytest

from studio import job
from tests.conftest import ROOT

SAMPLE = ROOT / "scenarios" / "motorway_platoon.yaml"
SPY = '''
"""Writes down all that it is given."""
from typing import Annotated, NamedTuple
from studio.application.contract import *
from studio.kind.settings import Part, number

KIND = "application"
TITLE = "Spy"
COMMANDS = ACCELERATION

class Parameters(Part):
    drives: float = number(1.0, unit="1", title="Whether it drives", ge=0, le=1)

class Memory(NamedTuple):
    n: Annotated[float, "1"] = 0.0

class Sees(NamedTuple):
    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    around: Annotated[Targets, "object_sensor", 8]
    heard: Annotated[Inbox, "awareness", 2]

class Log(NamedTuple):
{log}

class Does(NamedTuple):
    command: Command
    log: Log

def flat(given):
    return [x for each in given for x in flat(each)] if isinstance(given, tuple) else [float(given)]

def decide(parameters, memory, sees):
    values = flat(sees)
    assert len(values) == {count}, len(values)
    return memory, Does(accelerate(0.3) if parameters.drives else leave(), Log(*values))
'''
COUNT = 86
ACCELERATION, REQUEST = 3, 7  # behind the clock's two
OFF = {"kind": "front_radar", "range": 0.0}
BLIND = {"kind": "object_sensor", "range": 0.0}
SILENT = {"kind": "ad_hoc", "loss": 1.0}


@pytest.fixture
def spy(tmp_path, own_kinds):
    """The application that writes down all it is given."""
    log = "\n".join(f'    v{i}: Annotated[float, "1"] = 0.0' for i in range(COUNT))
    (tmp_path / "spy.py").write_text(SPY.format(log=log, count=COUNT))
    own_kinds(tmp_path)


def given(where, speed, drives):
    """All that the last car is given in 4 s, while the one ahead of it is at a place, and as fast as this."""
    last = "vehicles.follower_4"
    changes = {
        "clock.duration": 4,
        "traffic.count": 0,
        f"{last}.sensors": {"front": OFF, "around": BLIND},
        "vehicles.follower_3.position.along": where,
        "vehicles.follower_3.speed": speed,
        "radio": SILENT,
        "applications": {"spy": {"application": "spy", "units": ["follower_4"], "parameters": {"drives": drives}}},
    }
    found = job.run(job.load(SAMPLE, changes))
    assert found.status == "done", found.error
    return np.array([found.trace(f"follower_4.spy.v{i}") for i in range(COUNT)])


def test_nothing_about_others_can_be_computed(spy):
    """Whoever is ahead, and however near and fast: of all that is given the last bit is the same."""
    first = given(425.0, 30.0, 1.0)
    for other in (given(410.0, 30.0, 1.0), given(440.0, 24.0, 1.0)):
        np.testing.assert_array_equal(first, other)


def test_what_a_person_wants_stands_on_no_bus(spy):
    """Where the driver drives, he has seen the car ahead; what he asks for is told as what the car does."""
    found = given(425.0, 24.0, 0.0)
    assert found[ACCELERATION].min() < -1.0
    np.testing.assert_array_equal(found[REQUEST], found[ACCELERATION])
