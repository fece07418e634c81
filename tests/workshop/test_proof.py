"""Proofs of a text: every sort of mistake is found at its place by reading, what is sound is left in peace, and nothing is run."""

import pytest

from studio.kind import registry
from studio.workshop.proof import LONGEST, proof
from studio.workshop.start import starts
from studio.workshop.vocabulary import functions, names, ports

TEXT = starts()[0].text

MISTAKES = {
    "syntax": ("u = 0.5 *", "u = 0.5 * *", "invalid syntax"),
    "name": ("accelerate(min", "acelerate(min", "acelerate is not known"),
    "import": ("import ACCELERATION,", "import ACCELERATON,", "the contract has no ACCELERATON"),
    "field of the bus": ("sees.own.set_speed", "sees.own.set_sped", "own has no set_sped"),
    "port": ("sees.front.count", "sees.fornt.count", "Sees has no fornt"),
    "field of a target": ("target[0].rate", "target[0].rat", "target has no rat"),
    "place of a target": ("target[0].rate", "target[1].rate", "target has 1 places"),
    "setting": ("parameters.headway", "parameters.headwy", "Parameters has no headwy"),
    "sensor": ('"front_radar"', '"front_rader"', "there is no sensor 'front_rader'"),
    "how many": ('"front_radar", 1', '"front_radar", 99', "front has 99 places; allowed: 1 to 64"),
    "type of port": ("own: Own", "own: Command", "own is Command, which is no port of Sees"),
    "unknown unit": ('unit="s"', 'unit="sek"', "the unit 'sek' is not known"),
    "unit of others": ('unit="s"', 'unit="ms"', "the unit 'ms' is not one of SI"),
    "no unit": ('unit="s", ', "", "headway has no unit"),
    "first value": ("number(1.0", "number(9.0", "the first value 9 of headway is out of its own range"),
    "bare number": ('number(1.0, unit="s", title="Time headway", ge=0.3, le=5)', "1.0", "headway is a number without unit"),
    "bound": ("ge=0.3", "gee=0.3", "number() takes no gee"),
    "arguments": ("Does(accelerate(", "Does(1, accelerate(", "Does(command) is given 2 of 1"),
    "call": ("accelerate(min(max(u, -8.0), 2.0))", "accelerate()", "accelerate(acceleration) is given 0 of 1"),
    "sort": ('KIND = "application"', 'KIND = "sensor"', "KIND says 'sensor'"),
    "part": ("TITLE =", "TITEL =", "TITLE is missing"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_found_at_its_line(mistake):
    right, wrong, what = MISTAKES[mistake]
    assert right in TEXT
    text = TEXT.replace(right, wrong)
    found = [each for each in proof(text) if what in each.what]
    assert found, proof(text)
    line = next(i for i, each in enumerate(text.splitlines(), start=1) if wrong in each) if wrong and mistake != "part" else None
    assert line is None or line in [each.line for each in found]
    assert all(1 <= each.column <= len(text.splitlines()[each.line - 1]) + 1 for each in found)


def test_the_nearest_name_is_told_at_its_column():
    (found,) = proof(TEXT.replace("sees.own.set_speed", "sees.own.set_sped"))
    line = TEXT.replace("sees.own.set_speed", "sees.own.set_sped").splitlines()[found.line - 1]
    assert line[found.column - 1 :].startswith("set_sped") and "'set_speed'" in found.remedy


@pytest.mark.parametrize("start", starts(), ids=lambda each: each.name)
def test_what_is_sound_is_left_in_peace(start):
    """All that the studio offers to begin with, which its own tests run."""
    assert proof(start.text) == []


def test_a_name_that_stands_for_a_part_is_followed():
    text = TEXT.replace(
        "    if sees", "    own, radar = sees.own, sees.front\n    first = radar.target[0]\n    u = own.sped + first.rang\n    if sees"
    )
    assert [each.what for each in proof(text)] == ["own has no sped", "target has no rang"]


def test_names_of_inner_scopes_are_known():
    text = (
        TEXT
        + """

def many(values, *rest, scale=1.0):
    total = [each * scale for each in values if (last := each) > 0]
    try:
        import math as m
    except ImportError as error:
        raise error
    return max(total, key=lambda item: item + m.pi), last, rest
"""
    )
    assert proof(text) == []


def test_nothing_is_run(tmp_path):
    """Neither the file nor decorators, defaults, annotations and first values in it."""
    sign = tmp_path / "ran"
    act = f"open({str(sign)!r}, 'w')"
    text = f"{act}\n" + TEXT.replace("headway: float", f"x: {act} = {act}\n    headway: float").replace(
        "def decide(", f"@({act})\ndef decide("
    )
    assert isinstance(proof(text), list)
    assert not sign.exists()


@pytest.mark.parametrize("text", ["", "\0", "(" * 5000, "x = " + "-" * 20_000 + "1", "lambda: " * 3000 + "0", "\ud800"])
def test_whatever_it_is_it_is_answered(text):
    assert proof(text) and len(text) < LONGEST


def test_the_vocabulary_is_that_of_the_contract_and_the_kinds():
    """Every sensor and message is there with all that it gives, by itself."""
    told = {(each.type, each.kind): each for each in ports()}
    for kind in registry.known("sensor").values():
        target = next(each for each in told["Targets", kind.name].words if each.name == "target")
        assert [each.name for each in target.words] == list(kind.module.Reading._fields) and target.is_row
    for kind in registry.known("message").values():
        message = next(each for each in told["Inbox", kind.name].words if each.name == "message")
        payload = next(each for each in message.words if each.name == "payload")
        assert [each.name for each in payload.words] == list(kind.module.Payload._fields)
    own = {each.name: each for each in told["Own", ""].words}
    assert own["speed"].unit == "m/s" and own["speed"].meaning == "along the car"
    assert {each.name: each.unit for each in told["Clock", ""].words} == {"time": "s", "tick": "s"}
    assert {"accelerate", "steer", "brake"} <= {each.name for each in functions()} and "ACCELERATION" in names()
