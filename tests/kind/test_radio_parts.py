"""What belongs together in the file of a radio or message: a file that has a part without its partner is told so."""

from pathlib import Path

import pytest

from studio.errors import KindError
from studio.kind import registry

PATCHY = (Path(__file__).parents[1] / "message" / "patchy.py").read_text()
CAM = registry.find("message", "cam").file.read_text()


def told(path, text, old, new):
    """What is said about a changed file."""
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(KindError) as error:
        registry.load_file(path)
    return " ".join(f"{each.what} {each.remedy}" for each in error.value.problems)


@pytest.mark.parametrize(("old", "new", "what"), [
    ("def transmit(settings, way, draw, memory)", "def transmit(settings, way, draw)", "transmit takes (settings, way, draw); it is"),
    ("class Memory(", "class Forgets(", "transmit takes (settings, way, draw, memory); it is called"),
    ("class Control(", "class Controls(", "has control, but no Control"),
    ("class Cell(", "class Cells(", "has admit, but no Cell"),
    ("def airtime(", "def air(", "has Control, but no airtime"),
    ("@compiled\ndef transmit", "def transmit", "transmit is not compiled"),
])  # fmt: skip
def test_a_radio(tmp_path, old, new, what):
    assert what in told(tmp_path / "odd.py", PATCHY, old, new)


@pytest.mark.parametrize(("old", "new", "what"), [
    ("class Memory(", "class Forgets(", "has due, but no Memory"),
    ("def beacon(own, settings, memory)", "def beacon(own, settings)", "beacon takes (own, settings); it is called with (own, settings, m"),
    ("def beacon(", "def other(", "has Settings, but no beacon"),
    ("def due(", "def other(", "has Memory, but no due"),
])  # fmt: skip
def test_a_message(tmp_path, old, new, what):
    assert what in told(tmp_path / "odd.py", CAM, old, new)
