"""Ports: what an application declares is what it gets and what counts; what it gives is looked at before."""

from textwrap import dedent

import numpy as np
import pytest

from studio import job
from studio.errors import KindError, ScenarioError
from studio.kind import registry
from tests.conftest import ROOT

SAMPLE = ROOT / "scenarios" / "motorway_platoon.yaml"
HEAD = '''
"""Something that is tried."""
from typing import Annotated, Literal, NamedTuple
from studio.application.contract import *
from studio.compiled import compiled
from studio.kind.settings import Part, number

KIND = "application"
TITLE = "Tried"
COMMANDS = ACCELERATION

class Parameters(Part):
    u: float = number(0.0, unit="m/s²", title="Acceleration")

class Memory(NamedTuple):
    n: Annotated[float, "1"] = 0.0

class Sees(NamedTuple):
    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    heard: Annotated[Inbox, "awareness", 2]

class Log(NamedTuple):
    seen: Annotated[float, "m"] = 0.0
    count: Annotated[float, "1"] = 0.0

class Does(NamedTuple):
    command: Command
    log: Log

'''
DECIDE = """
def decide(parameters, memory, sees):
    return Memory(memory.n + 1.0), Does(accelerate(parameters.u), Log(sees.front.target[0].range, float(sees.heard.count)))
"""
GROUP = {"units": ["follower_1", "follower_2"], "listens_to": [["leader"], ["follower_1", "leader"]]}


@pytest.fixture
def made(tmp_path):
    """Registers files of a folder; afterwards they are forgotten."""
    before = list(registry.every())

    def make(**files):
        for name, text in files.items():
            (tmp_path / f"{name}.py").write_text(dedent(text))
        return [registry.load_file(tmp_path / f"{name}.py") for name, text in files.items() if "KIND" in text]

    yield make
    registry.restore(before)


def run(applications, seconds=0.5, **changes):
    """The motorway's platoon with these applications."""
    return job.run(job.load(SAMPLE, {"clock.duration": seconds, "applications": applications} | changes))


@pytest.mark.parametrize("above", ["", "@compiled"])
def test_what_is_declared_is_what_runs(made, above):
    made(tried=HEAD + above + DECIDE)
    found = run({"mine": GROUP | {"application": "tried", "parameters": {"u": -1.0}}}, seconds=1.5)
    assert found.status == "done", found.error
    log = found.trace("follower_2.mine.seen")
    np.testing.assert_array_equal(log[1:-1], found.trace("follower_2.front.range")[1:-1])
    assert found.trace("follower_2.mine.count")[-1] == 2.0 and found.trace("follower_1.mine.count")[-1] == 1.0
    assert found.trace("follower_1.acceleration")[-1] == pytest.approx(-1.0, abs=0.2)


def test_compiled_or_not_is_the_same_to_the_last_bit(made):
    made(tried=HEAD + DECIDE, machine=HEAD + "@compiled" + DECIDE)
    one, other = (run({"mine": GROUP | {"application": name, "parameters": {"u": -0.5}}}) for name in ("tried", "machine"))
    np.testing.assert_array_equal(one.record.values, other.record.values)
    np.testing.assert_array_equal(one.trace("follower_2.mine.seen"), other.trace("follower_2.mine.seen"))


WRONG = {
    "accelerate(0.0 / max(sees.own.yaw_rate * 0.0, 0.0))": ("command.acceleration = nan", "is not finite"),
    "accelerate(-90.0)": ("command.acceleration = -90", "is out of range"),
    "steer(0.1)": ("command.steering = 0.1", "is not among its COMMANDS"),
}


@pytest.mark.parametrize("above", ["", "@compiled"])
@pytest.mark.parametrize("command", WRONG)
def test_what_must_not_be_ends_the_run_and_names_all(made, command, above):
    """Application, unit, field, value, tick; the run is failed and has its record until there."""
    late = f"{command} if sees.clock.time > 0.19 else accelerate(0.0)".replace("0.0 / max(sees.own.yaw_rate * 0.0, 0.0)", "zero / zero")
    body = DECIDE.replace("accelerate(parameters.u)", late).replace("    return", "    zero = np.float64(sees.own.speed * 0.0)\n    return")
    made(tried=HEAD + "import numpy as np\n" + above + body)
    found = run({"mine": {"units": ["follower_2"], "application": "tried"}})
    named, why = WRONG[command]
    assert found.status == "failed" and found.error.startswith(f"The application 'tried' on 'follower_2' gave {named} at tick 10 (0.2 s)")
    assert why in found.error and found.record.time[-1] == pytest.approx(0.18, abs=0.021)


SHAPES = {
    "return accelerate(0.0)": "not (memory, does)",
    "return Memory(0.0), accelerate(0.0)": "not a Does",
    "return Memory(0.0), Does(accelerate(0.0), (1.0, 2.0))": "at log, not a Log",
    "return Memory('a'), Does(accelerate(0.0), Log(0.0, 0.0))": "memory.n is 'a'; a number is meant",
    "return Memory(0.0), Does(accelerate(0.0), Log((1.0, 2.0), 0.0))": "log.seen is (1.0, 2.0); a number is meant",
}


@pytest.mark.parametrize("answer", SHAPES)
def test_an_answer_of_another_shape_is_told(made, answer):
    made(tried=HEAD + f"\ndef decide(parameters, memory, sees):\n    {answer}\n")
    found = run({"mine": {"units": ["follower_2"], "application": "tried"}})
    assert found.status == "failed" and "'tried' on 'follower_2'" in found.error and SHAPES[answer] in found.error


INTENT = '''
"""What a car is about to do. Source: made up."""
from typing import Annotated, NamedTuple
KIND = "message"
TITLE = "Intent"
SIZE = 120
class Payload(NamedTuple):
    lane: Annotated[float, "1"] = 0.0
    gap: Annotated[float, "m"] = 0.0
'''
TALKER = (
    HEAD.replace('"awareness", 2', '"intent", 2')
    .replace("    log: Log\n", '    send: Annotated[Outbox, "intent", 1]\n    log: Log\n')
    .replace("KIND =", "from .intent import Payload\nKIND =")
    .replace("COMMANDS = ACCELERATION", "")
    .replace("    command: Command\n", "")
    + """
@compiled
def decide(parameters, memory, sees):
    first, second = sees.heard.message[0], sees.heard.message[1]
    seen = first.payload.gap + 100.0 * second.payload.gap
    send = 1 if memory.n % 5.0 == 0.0 else 0
    return Memory(memory.n + 1.0), Does(Outbox(send, (Payload(1.0, sees.own.speed),)), Log(seen, first.sender + 10.0 * second.sender))
"""
)


def test_messages_of_ones_own_from_two_senders(made):
    """Each sends its speed ten times a second; the third hears both, knows which is which, and how old it is."""
    made(intent=INTENT, talker=TALKER)
    group = {"application": "talker", "units": ["leader", "follower_1", "follower_2"]}
    subscribed = group | {"listens_to": [[], [], ["follower_1", "leader"]]}
    found = run({"mine": subscribed}, seconds=1.0, **{"radio.loss": 0.0})
    assert found.status == "done", found.error
    speeds = [found.trace(f"{name}.speed")[30:40].mean() for name in ("follower_1", "leader")]
    assert found.trace("follower_2.mine.seen")[-1] == pytest.approx(speeds[0] + 100.0 * speeds[1], rel=0.01)
    assert found.trace("follower_2.mine.count")[-1] == 1.0 + 10.0 * 0.0
    some = run({"mine": group | {"listens_to": [[], [], "leader"]}}, seconds=1.0, **{"radio.loss": 0.0})
    assert some.trace("leader.mine.seen")[-1] > 100.0  # an empty list hears everybody, beside others that name whom they hear
    everybody = run({"mine": group}, seconds=1.0, **{"radio.loss": 0.0})
    assert everybody.status == "done" and everybody.trace("leader.mine.seen")[-1] > 100.0


def test_a_station_hears_and_logs(made):
    """It has no actuators and no radar; its clock is wrong by two seconds, and so are the ages that it takes messages to have."""
    text = (
        HEAD.replace('    front: Annotated[Targets, "front_radar", 1]\n', "")
        .replace("COMMANDS = ACCELERATION", "")
        .replace("    command: Command\n", "")
    )
    ages = """
def decide(parameters, memory, sees):
    return Memory(memory.n), Does(Log(sees.heard.message[0].age, sees.clock.time))
"""
    made(watcher=text + ages)
    station = {"position": {"x": 0.0, "y": 0.0}, "clock": {"offset": 2.0}}
    group = {"application": "watcher", "units": ["roadside"], "listens_to": ["leader"]}
    found = run({"watch": group}, seconds=1.0, stations={"roadside": station}, **{"radio.range": 5000.0, "radio.loss": 0.0})
    assert found.status == "done", found.error
    assert found.trace("roadside.watch.count")[-2] == pytest.approx(2.98)
    assert 2.0 < found.trace("roadside.watch.seen")[-2] < 2.2


def refused(applications, **changes):
    """What is said about a scenario, place by place."""
    loaded = job.load(SAMPLE, {"applications": applications} | changes)
    with pytest.raises(ScenarioError) as caught:
        job.check(loaded)
    return "\n".join(map(str, caught.value.problems))


def test_the_higher_priority_commands(made):
    made(tried=HEAD + DECIDE)
    both = {
        name: {"application": "tried", "units": ["follower_1"], "parameters": {"u": u}, "priority": priority}
        for name, u, priority in (("a", -1.0, 5), ("b", 1.0, 0))
    }
    assert run(both, seconds=1.5).trace("follower_1.acceleration")[-1] == pytest.approx(-1.0, abs=0.2)
    both["a"]["priority"] = 0
    told = refused(both)
    assert "applications.b.priority" in told and "commands acceleration of 'follower_1', as 'a' does" in told


def test_ports_that_cannot_be_connected_are_told(made):
    made(tried=HEAD + DECIDE, intent=INTENT, talker=TALKER)
    blind = refused({"mine": {"application": "tried", "units": ["follower_1"]}}, **{"vehicles.follower_1.sensors": {}})
    assert "has no sensor of the kind 'front_radar'" in blind and "sensors: {front: {kind: front_radar}}" in blind
    silent = refused({"mine": {"application": "talker", "units": ["follower_1"], "listens_to": ["leader"]}})
    assert "never sends 'intent'" in silent and "'leader'" in silent
    many = refused({"mine": {"application": "talker", "units": ["follower_1"], "listens_to": [["leader", "follower_2", "follower_3"]]}})
    assert "has room for 2" in many
    assert "no unit of this scenario" in refused({"mine": {"application": "tried", "units": ["nobody"]}})


BROKEN_FILES = {
    HEAD.replace('"front_radar", 1', '"front_radar"') + DECIDE: "does not say which sensor and how many",
    HEAD.replace("    log: Log\n", "    log: float\n") + DECIDE: "log is float; allowed",
    HEAD.replace("COMMANDS = ACCELERATION", "") + DECIDE: "COMMANDS",
    HEAD.replace("n: Annotated", "n: str = 'a'\n    m: Annotated") + DECIDE: "n is str",
    HEAD: "decide: is missing",
    HEAD + "@compiled" + DECIDE.replace("memory, sees)", "memory)"): "decide takes (parameters, memory)",
    HEAD.replace('"""Something that is tried."""', "") + DECIDE: "has no docstring",
    HEAD.replace(', unit="m/s²"', "").replace("number(0.0", "number(0.0, unit=''") + DECIDE: "is a number without unit",
}


@pytest.mark.parametrize("text", BROKEN_FILES, ids=range(len(BROKEN_FILES)))
def test_a_broken_contract_is_told_at_once(made, text):
    with pytest.raises(KindError) as caught:
        made(wrong=text)
    assert BROKEN_FILES[text] in str(caught.value) and "wrong.py" in str(caught.value)


def test_choices_and_arrays(made):
    """A choice is its place in the list; arrays of parameters and memory are tuples."""
    text = HEAD.replace(
        'title="Acceleration")\n',
        'title="Acceleration")\n    law: Literal["soft", "hard"] = "soft"\n    table: tuple[float, float] = (1.0, 2.0)\n',
    ).replace('n: Annotated[float, "1"] = 0.0', 'n: Annotated[tuple[float, float, float], "1"] = (0.0, 0.0, 0.0)')
    body = """
@compiled
def decide(parameters, memory, sees):
    n = (memory.n[1], memory.n[2], memory.n[0] + 1.0)
    return Memory(n), Does(accelerate(0.0), Log(parameters.table[int(parameters.law)], n[0] + 10.0 * n[1] + 100.0 * n[2]))
"""
    made(tried=text + body)
    found = run({"mine": {"application": "tried", "units": ["follower_1"], "parameters": {"law": "hard"}}}, seconds=0.1)
    assert found.status == "done", found.error
    assert (found.trace("follower_1.mine.seen")[:-1] == 2.0).all()
    assert found.trace("follower_1.mine.count").tolist()[:4] == [100.0, 110.0, 111.0, 211.0]


def test_what_is_shown_to_the_driver(made):
    text = HEAD.replace("    log: Log\n", "    notice: Notice\n").replace(
        "COMMANDS = ACCELERATION", 'COMMANDS = ACCELERATION\nNOTICES = ("Brake!", "Turn!")'
    )
    body = """
def decide(parameters, memory, sees):
    return Memory(memory.n + 1.0), Does(leave(), Notice(int(memory.n) // 5 % 3))
"""
    made(shows=text + body)
    found = run({"mine": {"application": "shows", "units": ["follower_1"]}}, seconds=0.3)
    assert found.trace("follower_1.mine.notice").tolist()[:12] == [0.0] * 5 + [1.0] * 5 + [2.0] * 2
