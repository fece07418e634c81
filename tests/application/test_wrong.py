"""Kinds of one's own that go wrong: the run fails, says who did what, and nobody else is hurt; what is not lost is not called lost."""

import numpy as np
import pytest

from studio.errors import KindError
from studio.kind import registry
from tests.application.test_ports import DECIDE, HEAD, INTENT, SAMPLE, TALKER, made, refused, run  # noqa: F401 - made is a fixture

SENSOR = '''
"""Something around. Source: made up."""
from typing import Annotated, NamedTuple
from studio.compiled import compiled
from studio.kind.sensor import Sensor
from studio.kind.settings import number
from studio.world.view import report

KIND = "sensor"
TITLE = "Tried"
CAPACITY = 2

class Settings(Sensor):
    gain: float = number(1.0, unit="1", title="Gain", ge=0, le=10)

class Reading(NamedTuple):
    a: Annotated[float, "m", "one"] = 0.0
    b: Annotated[float, "m", "other"] = 0.0

class Pair(NamedTuple):
    a: float
    b: float

class One(NamedTuple):
    a: float

@compiled
def measure(view, me, settings, memory, out):
    {body}
'''
BODIES = {
    "report(out, me, 0, One(1.0))\n    return 1": "reported something that is no whole Reading",
    "report(out, me, 0, Reading(1.0, 0.0 / (0.0 * settings.gain)))\n    return 1": "reported a number that is not finite",
    "report(out, me, 0, Reading(1.0, 2.0))\n    return 7": "returned a number of targets that is none: 0 to 2",
    "return me.sinus": "cannot be asked",
}


@pytest.mark.parametrize("body", BODIES)
def test_a_sensor_that_goes_wrong_fails_the_run_and_is_named(made, body):  # noqa: F811
    made(odd=SENSOR.format(body=body))
    found = run({}, **{"vehicles.follower_1.sensors": {"side": {"kind": "odd"}}})
    assert found.status == "failed" and found.error.startswith("The sensor 'odd' (side of follower_1) " + BODIES[body])


def test_settings_that_are_no_numbers_are_told_at_once(made):  # noqa: F811
    with pytest.raises(KindError, match="name is str"):
        made(odd=SENSOR.format(body="return 0").replace("class Reading", 'class Settings(Sensor):\n    name: str = "x"\n\nclass Reading'))


def test_a_radio_that_goes_wrong_fails_the_run(made):  # noqa: F811
    head = "def transmit(settings, way, draw):"
    text = registry.find("radio", "ad_hoc").file.read_text().replace(head, f"{head}\n    way.nothing")
    made(odd=text)
    found = run({"mine": {"application": "cacc", "units": ["follower_1"], "listens_to": ["leader"]}}, radio={"kind": "odd"})
    assert found.status == "failed" and "on the radio 'odd' cannot be sent" in found.error


def test_a_message_of_a_megabyte_is_refused(made):  # noqa: F811
    """By the name of the file, with what is allowed."""
    with pytest.raises(KindError, match=r"intent.py: SIZE is 1000000, not 1 to 10000"):
        made(intent=INTENT.replace("SIZE = 120", "SIZE = 1_000_000"))


def test_who_sends_as_much_as_may_be_hurts_nobody(made):  # noqa: F811
    """Radios refuse messages larger than their frames. 64 of the largest in every tick, 4.5 MB a second from each: the run goes on."""
    talker = TALKER.replace("memory.n % 5.0 == 0.0", "memory.n >= 0.0").replace('Outbox, "intent", 1]', 'Outbox, "intent", 64]')
    talker = talker.replace("Outbox(send, (Payload(1.0, sees.own.speed),))", "Outbox(64 * send, (Payload(1.0, sees.own.speed),) * 64)")
    talker, group = talker.replace("@compiled", ""), {"mine": {"application": "talker", "units": ["leader", "follower_1"]}}
    made(intent=INTENT.replace("SIZE = 120", "SIZE = 1400"), talker=talker)
    found, quiet = run(group, seconds=0.2), run({}, seconds=0.2)
    assert found.status == "done", found.error
    assert found.record.messages.time.size > 1000
    np.testing.assert_array_equal(found.trace("follower_2.speed"), quiet.trace("follower_2.speed"))


def test_a_message_larger_than_a_frame_is_refused(made):  # noqa: F811
    made(intent=INTENT.replace("SIZE = 120", "SIZE = 10_000"), talker=TALKER)
    said = refused({"mine": {"application": "talker", "units": ["leader", "follower_1"]}}, radio={"kind": "wlan"})
    assert "'talker' sends 'intent', which is larger than the radio 'wlan' takes" in said


@pytest.mark.parametrize("above", ["", "@compiled"])
def test_yes_and_no_in_everything_that_is_given(made, above):  # noqa: F811
    message = INTENT.replace('    gap: Annotated[float, "m"] = 0.0', '    hurry: Annotated[bool, "", "in a hurry"] = False')
    text = HEAD.replace('"awareness", 2', '"intent", 2').replace(
        "    log: Log\n", '    send: Annotated[Outbox, "intent", 1]\n    log: Log\n'
    )
    text = text.replace("KIND =", "from .intent import Payload\nKIND =").replace('n: Annotated[float, "1"] = 0.0', "odd: bool = False")
    text = text.replace('count: Annotated[float, "1"] = 0.0', "count: bool = False")
    body = """
def decide(parameters, memory, sees):
    send = Outbox(1, (Payload(1.0, sees.own.speed > 0.0),))
    return Memory(not memory.odd), Does(leave(), send, Log(1.0 if sees.heard.message[0].payload.hurry else 0.0, memory.odd))
"""
    made(intent=message, talker=text + above + body)
    group = {"application": "talker", "units": ["leader", "follower_1"], "listens_to": [["follower_1"], ["leader"]]}
    found = run({"mine": group}, **{"radio.loss": 0.0})
    assert found.status == "done", found.error
    assert found.trace("follower_1.mine.seen")[-1] == 1.0
    assert found.trace("leader.mine.count").tolist()[:4] == [0.0, 1.0, 0.0, 1.0]


def test_what_is_overtaken_is_not_lost(made):  # noqa: F811
    """A radio that loses nothing, with delays that let them overtake each other: none is told as lost; one that loses some tells all."""
    group = {"mine": {"application": "cacc", "units": ["follower_1"], "listens_to": ["leader"]}}
    slow = {"radio.delay": 0.2, "radio.delay_variation": 0.2}
    whole = run(group, seconds=10.0, **slow, **{"radio.loss": 0.0})
    assert not [each for each in whole.record.happenings if each.kind == "message_lost"]
    some = run(group, seconds=10.0, **{"radio.loss": 0.3})
    told = [each for each in some.record.happenings if each.kind == "message_lost"]
    assert 15 <= sum(each.numbers["missed"].value for each in told) <= 45 and told[0].units == ("follower_1", "leader")


def test_one_application_twice_on_a_unit_is_recorded_twice(made):  # noqa: F811
    head = HEAD.replace("COMMANDS = ACCELERATION", "").replace("    command: Command\n", "")
    body = DECIDE.replace("accelerate(parameters.u), ", "").replace("sees.front.target[0].range", "parameters.u")
    made(tried=head + body)
    groups = {name: {"application": "tried", "units": ["follower_1"], "parameters": {"u": u}} for name, u in (("a", 1.0), ("b", 2.0))}
    found = run(groups)
    assert [found.trace(f"follower_1.{name}.seen")[-1] for name in groups] == [1.0, 2.0]
    assert "is named like a sensor" in refused({"front": groups["a"]})
