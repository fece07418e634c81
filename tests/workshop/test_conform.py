"""The suite of conformance finds what is wrong with a kind; that our own kinds pass it stands in tests/conformance."""

import pytest

from studio.kind.registry import load_file
from studio.workshop.conform import conform, of_settings
from studio.workshop.suite.action import RANGES
from studio.world.maneuver import Sees

METRIC = '''"""Does something."""
KIND = "metric"
TITLE = "Mine"
UNIT = "m"
BETTER = None
COUNT = [0]
def measure(record):
    """Number [m]."""
    COUNT[0] += 1
    return 1.0
'''
CHANNEL = '''"""Does something."""
KIND = "channel"
TITLE = "Mine"
UNIT = "m"
COUNT = [0]
def trace(read):
    """Values [m]."""
    COUNT[0] += 1
    return read("speed")
'''


def wrong(path, text, what, by):
    """What the suite says about a kind with a line changed."""
    assert what in text
    path.write_text(text.replace(what, by))
    return "\n".join(str(check) for check in conform(load_file(path)) if check.wrong)


@pytest.mark.parametrize(
    ("what", "by", "words"),
    [
        ("return 1.0", "return 1.0", ""),
        ("return 1.0", "return float('nan')", ""),
        ("return 1.0", "return float('inf')", "returned inf"),
        ("return 1.0", "return 'much'", "returned 'much'"),
        ("return 1.0", "return COUNT[0]", "keep nothing between calls"),
        ("return 1.0", "return record.channel('sped').max()", "did you mean 'speed'"),
        ("return 1.0", "return 1.0 / record.channel('speed').item()", "ValueError"),
        ('    """Number [m]."""\n', "", "measure: write a docstring"),
    ],
)
def test_metrics(tmp_path, own_kinds, what, by, words):
    said = wrong(tmp_path / "mine.py", METRIC, what, by)
    assert words in said and bool(said) == bool(words), said


@pytest.mark.parametrize(
    ("what", "by", "words"),
    [
        ('return read("speed")', 'return read("speed")', ""),
        ('return read("speed")', 'return read("speed")[0]', "returned the shape"),
        ('return read("speed")', 'return read("speed") + float("inf")', "infinite"),
        ('return read("speed")', 'return read("speed") + COUNT[0]', "other values the second time"),
        ('return read("speed")', 'return read("time")', "returned the shape"),
    ],
)
def test_channels(tmp_path, own_kinds, what, by, words):
    said = wrong(tmp_path / "mine.py", CHANNEL, what, by)
    assert words in said and bool(said) == bool(words), said


GOOD = 'number(1.0, unit="m", title="Reach", ge=0, le=2)'


@pytest.mark.parametrize(
    ("field", "base", "words"),
    [
        (GOOD, "Part", ""),
        (GOOD.replace(', title="Reach"', ', title=""'), "Part", "reach: write number"),
        (GOOD.replace('unit="m"', 'unit=""'), "Part", "reach: write number"),
        (GOOD.replace(", le=2", ""), "Part", "reach: give a lower and an upper bound"),
        (GOOD.replace("1.0", "5.0"), "Part", "less than or equal to 2"),
        (GOOD, "BaseModel", "no_such_setting = 1 was taken"),
        (GOOD.replace("ge=0, le=2", "ge=0, le=2, allow_inf_nan=True"), "Part", ""),
    ],
)
def test_settings(field, base, words):
    from pydantic import BaseModel

    from studio.kind.settings import Part, number

    names = {"Part": Part, "BaseModel": BaseModel, "number": number}
    exec(f"class Settings({base}):\n    reach: float = {field}", names)
    said = "\n".join(check.wrong for check in of_settings("Settings", names["Settings"]))
    assert words in said and bool(said.strip()) == bool(words), said


def test_actions_are_tried_with_all_that_they_see():
    assert (*RANGES, "pool") == Sees._fields
