"""`studio check` lets applications decide: what only a call finds is found before a run, and told with application, reason and input."""

import pytest

from studio.kind import registry
from studio.scenario.schema import Application
from studio.workshop.trial import DRAWS, TICK, wrongs

HEAD = '''
"""An application that does something wrong, or nothing."""
from typing import NamedTuple
import numpy as np
from studio.application.contract import Clock, Command, Own, accelerate, leave
from studio.kind.settings import Part, number

KIND = "application"
TITLE = "tried"
COMMANDS = 1

class Parameters(Part):
    gain: float = number(1.0, unit="1", title="Gain", ge=-5, le=5)

class Memory(NamedTuple):
    t: float = 0.0

class Sees(NamedTuple):
    clock: Clock
    own: Own

class Does(NamedTuple):
    command: Command

def decide(parameters, memory, sees):
    {}
'''


@pytest.fixture
def tried(tmp_path):
    """What is wrong with an application that decides so."""
    before = list(registry.every())

    def tries(text, **parameters):
        (tmp_path / "tried.py").write_text(HEAD.format(text))
        kind = registry.load_file(tmp_path / "tried.py")
        return list(wrongs(kind, Application(application="tried", units=["a"], parameters=parameters)))

    yield tries
    registry.restore(before)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("sees.own.speed", "decide() returned None, not (memory, does)"), ("return -1.0", "decide() returned -1.0, not (memory, does)"),
        ("return Does(leave()), memory", "as its memory, not a Memory"), ("return memory, leave()", "as its does, not a Does"),
        ("return memory, Does(1.0)", "at command, not a Command"), ("return Memory('now'), Does(leave())", "raises TypeError"),
        ("return memory, Does(accelerate(np.array([0.5, 1.0])))", "raises TypeError"),
        ("return Memory(memory.t + float('nan')), Does(leave())", "in which a number is none"),
        ("return memory, Does(accelerate(float('nan')))", "in which a number is none"),
        ("return memory, Does(accelerate(float('inf')))", "in which a number is none"),
        ("return memory, Does(accelerate(0.0 if sees.own.speed > 5.0 else float('nan')))", "in which a number is none"),
        ("return memory, Does(accelerate(1.0 / (memory.t - 3.0) if memory.t < 9 else 0.0)) if 1 else Memory(memory.t + 1.0)", ""),
        ("return Memory(memory.t + 1.0), Does(accelerate(1.0 / (memory.t - 3.0)))", "raises ZeroDivisionError"),
        ("return memory, Does(accelerate(memory.nothing))", "raises AttributeError"),
    ],
)  # fmt: skip
def test_what_only_a_call_finds(tried, text, told):
    found = tried(text)
    assert bool(found) == bool(told)
    assert not told or (told in found[0][0] and "it was given" in found[0][1])


def test_an_application_decides_with_its_own_parameters(tried):
    text = "return memory, Does(accelerate(float('nan') if parameters.gain < 0.0 else parameters.gain))"
    assert not tried(text) and not tried(text, gain=5.0) and tried(text, gain=-1.0)


@pytest.mark.parametrize(
    ("what", "limit", "is_found"),
    [("sees.clock.time", (DRAWS - 2) * TICK, True), ("memory.t", DRAWS - 2, True), ("sees.clock.time", 2 * DRAWS * TICK, False)],
)
def test_it_is_called_for_a_while(tried, what, limit, is_found):
    """Time goes on, and memory is handed over from call to call."""
    text = f"return Memory(memory.t + 1.0), Does(accelerate(float('nan') if {what} >= {limit:g} else 0.0))"
    assert bool(tried(text)) == is_found


@pytest.mark.parametrize("name", ["acc", "cacc", "awareness", "perception", "cacc_direct"])
def test_the_built_in_ones_are_sound(name):
    assert not list(wrongs(registry.find("application", name), Application(application=name, units=["a"])))
