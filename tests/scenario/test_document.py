"""A document: whatever patch is applied, its inverse gives back the same bytes; what a patch does not mean stays as it is."""

import difflib
import json

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from studio.errors import ConflictError, ScenarioError
from studio.scenario import catalogue
from studio.scenario.text import patch, source
from studio.scenario.text.document import Document
from tests.conftest import ROOT
from tests.scenario import yaml_text

FILES = sorted([*(ROOT / "scenarios").glob("*.yaml"), *catalogue.VEHICLES.glob("*.yaml")])
SLOW = settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
HEADED = """\
# The file
version: 2

# How long
clock:
  duration: 60.0  # one minute
  # 1/50 s
  tick: 0.02

# loose

speeds:  # of all
- 10
- 20  # fast
place: {along: 1.50, road: "a"}
"""


def text_of(path) -> str:
    return path.read_bytes().decode()


def plain(operations) -> list[dict]:
    """Operations as they travel."""
    return json.loads(json.dumps([each.as_json() for each in operations]))


def changed(text: str, *operations: dict) -> str:
    """The text after a patch, whose inverse gives the text back."""
    document = Document.read(text, "my.yaml")
    inverse = document.apply(patch.operations(list(operations)))
    after = document.text
    document.apply(patch.operations(plain(inverse)))
    assert document.text == text
    return after


def difference(before: str, after: str) -> list[str]:
    """Lines that went and came."""
    lines = difflib.unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    return [line for line in lines if not line.startswith(("---", "+++", "@@"))]


@SLOW
@given(st.data())
def test_the_inverse_of_any_patch_gives_the_same_bytes(data):
    text = data.draw(yaml_text.texts())
    document = Document.read(text, "my.yaml")
    inverses = []
    for _ in range(data.draw(st.integers(1, 4))):
        operation = data.draw(yaml_text.operations(document.value))
        wanted = patch.patched(document.value, patch.operations([operation]))
        inverses.append(document.apply(patch.operations([operation])))
        assert patch.equal(document.value, wanted)
        assert source.same(source.read(document.text, "my.yaml").value, document.value)
    for each in reversed(inverses):
        document.apply(patch.operations(plain(each)))
    assert document.text == text


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
@settings(max_examples=10, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_steps_in_real_files_are_undone_and_done_again(path, data):
    text = text_of(path)
    document = Document.read(text, path.name)
    texts = [text]
    for number in range(3):
        operation = data.draw(yaml_text.operations(document.value))
        document.apply(patch.operations([operation]), name=f"step {number}")
        texts.append(document.text)
    for number in (2, 1, 0):
        assert document.undo() == f"step {number}" and document.text == texts[number]
    assert document.undo() is None
    for number in (0, 1, 2):
        assert document.redo() == f"step {number}" and document.text == texts[number + 1]
    assert document.redo() is None


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_files_are_kept_to_the_byte(path):
    assert Document.read(text_of(path), path.name).text.encode() == path.read_bytes()


def test_a_patch_after_an_undo_forgets_what_was_undone():
    document = Document.read("a: 1\n", "my.yaml")
    document.apply(patch.operations([{"op": "replace", "path": "/a", "value": 2}]), name="two")
    document.undo()
    document.apply(patch.operations([{"op": "replace", "path": "/a", "value": 3}]), name="three")
    assert document.redo() is None and [step.name for step in document.done] == ["three"]


@pytest.mark.parametrize(
    ("operation", "lines"),
    [
        ({"op": "replace", "path": "/clock/duration", "value": 30},
         ["-  duration: 60.0  # one minute", "+  duration: 30  # one minute"]),
        ({"op": "remove", "path": "/clock/tick"}, ["-  # 1/50 s", "-  tick: 0.02"]),
        ({"op": "add", "path": "/clock/step", "value": 0.005}, ["+  step: 0.005"]),
        ({"op": "add", "path": "/speeds/1", "value": 15}, ["+- 15"]),
        ({"op": "add", "path": "/speeds/0", "value": 5}, ["+- 5"]),
        ({"op": "remove", "path": "/speeds/1"}, ["-- 20  # fast"]),
        ({"op": "replace", "path": "/place/road", "value": "b"},
         ['-place: {along: 1.50, road: "a"}', "+place: {along: 1.50, road: b}"]),
        ({"op": "add", "path": "/place/lane", "value": 1},
         ['-place: {along: 1.50, road: "a"}', '+place: {along: 1.50, road: "a", lane: 1}']),
        ({"op": "move", "from": "/clock", "path": "/time"}, ["-clock:", "+time:"]),
        ({"op": "add", "path": "/goals", "value": {"collisions": {"most": 0}}}, ["+goals:", "+  collisions: {most: 0}"]),
        ({"op": "add", "path": "/title", "value": "on"}, ["+title: 'on'"]),
        ({"op": "add", "path": "/title", "value": "a\nb\n"}, ["+title: |", "+  a", "+  b"]),
    ],
)  # fmt: skip
def test_only_the_lines_that_are_meant_change(operation, lines):
    assert difference(HEADED, changed(HEADED, operation)) == lines


def test_what_many_share_is_changed_in_one_place(sample):
    """Four cars share the driver of `follower_1` by an anchor."""
    text = text_of(sample)
    path = "/vehicles/follower_2/driver/speed_factor"
    after = changed(text, {"op": "replace", "path": path, "value": 1.2})
    assert difference(text, after) == ["-    driver: *brisk", "+    driver: {kind: attentive, speed_factor: 1.2}"]
    after = source.read(changed(text, {"op": "remove", "path": "/vehicles/follower_1"}), "my.yaml").value
    assert {name: car.get("driver") for name, car in after["vehicles"].items()} == {
        "leader": None, **{f"follower_{i}": {"kind": "attentive", "speed_factor": 1.1} for i in (2, 3, 4)},
    }  # fmt: skip


def test_what_a_merge_brings_can_be_changed_too():
    text = "base: &base {a: 1, b: 2}\nmine:\n  <<: *base\n  b: 3\n"
    assert source.read(text, "my.yaml").value["mine"] == {"a": 1, "b": 3}
    after = source.read(changed(text, {"op": "replace", "path": "/mine/a", "value": 7}), "my.yaml").value
    assert after == {"base": {"a": 1, "b": 2}, "mine": {"a": 7, "b": 3}}


def test_an_anchor_within_a_merge():
    text = "mine: {<<: &part {a: 1}, b: 2}\nother: *part\n"
    after = source.read(changed(text, {"op": "replace", "path": "/mine/a", "value": 7}), "my.yaml").value
    assert after == {"mine": {"a": 7, "b": 2}, "other": {"a": 1}}


def test_an_inverse_still_fits_when_others_have_changed_something_else():
    document = Document.read(HEADED, "my.yaml")
    inverse = document.apply(patch.operations([{"op": "remove", "path": "/clock/tick"}]))
    document.apply(patch.operations([{"op": "replace", "path": "/place/along", "value": 2}]))
    document.apply(inverse)
    assert difference(HEADED, document.text) == ['-place: {along: 1.50, road: "a"}', '+place: {along: 2, road: "a"}']


def test_a_layout_can_lie_about_looks_only():
    """What an operation says of its text is taken only if it reads as its value."""
    lie = {"op": "replace", "path": "/clock/duration", "value": 30, "layout": {"source": " 31\nseed: 7"}}
    assert source.read(changed(HEADED, lie), "my.yaml").value["clock"]["duration"] == 30
    true = {"op": "replace", "path": "/clock/duration", "value": 30, "layout": {"source": " 3.0e+1"}}
    assert "duration: 30 " in changed(HEADED, true)  # a number of another kind
    true = {"op": "replace", "path": "/clock/duration", "value": 30.0, "layout": {"source": " 3.0e+1"}}
    assert "duration: 3.0e+1  # one minute" in changed(HEADED, true)


def test_a_patch_that_fails_in_the_middle_changes_nothing():
    document = Document.read(HEADED, "my.yaml")
    bad = [{"op": "remove", "path": "/clock"}, {"op": "test", "path": "/version", "value": 1}]
    with pytest.raises(ConflictError):
        document.apply(patch.operations(bad))
    with pytest.raises(ScenarioError):
        document.apply(patch.operations([{"op": "remove", "path": "/clock"}, {"op": "remove", "path": "/clock"}]))
    assert document.text == HEADED and document.done == []
