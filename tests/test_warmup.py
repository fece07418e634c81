"""The warm-up compiles everything that a run may need, and tells how far it is."""

import pytest

from studio import sample, warmup
from studio.errors import RunError
from studio.kind import registry
from studio.source import PACKAGE, compiled_functions


@pytest.fixture(scope="module")
def seen():
    """How far a warm-up was, from its start to its end."""
    current, told = warmup.Warmup().start(), []
    try:
        current.wait(told.append)
    finally:
        current.close()
    return told


FOR_OTHERS = {"world.maneuver.drive_and_steer", "world.view.draw", "model.sensor.seen_from"}  # that no kind of the studio calls
FOR_OTHERS |= {f"world.view.{name}" for name in ("chance", "chance_normal", "chance_of_pair", "normal_of_pair")}
SELDOM = {
    "passes.ground.rise",
    "vehicle.light.attempt",
    "passes.notice.notice_shown",
    "board.text.bad_count",
    "board.post.lay",
}  # that no sample needs
# files of which no sample needs a function: these are compiled when a scenario first does
LATER = {
    "application.awareness", "application.perception", "application.cacc_consensus", "application.cacc_direct", "application.cacc_leader",
    "application.cacc_path", "condition.signal", "model.evasion", "model.generation", "passes.zebra", "radio.packet",
}  # fmt: skip


def test_afterwards_nothing_is_missing(seen):
    """Every compiled function that the program can reach is used by the rig, the bench, a sample or the stage, but for a few."""
    assert warmup.missing() == []
    without = {name for path in warmup.files() for name in warmup.without_code(path)}
    assert {each for each in without if each.rpartition(".")[0] not in LATER} <= FOR_OTHERS | SELDOM
    assert seen[-1].done == seen[-1].of and seen[-1].latest.count(".") == 1
    assert [each.done for each in seen] == sorted(each.done for each in seen)


def test_a_warm_machine_starts_no_process(seen):
    current = warmup.Warmup().start()
    assert current.processes == [] and current.is_over and current.compiled == 0


def test_nothing_is_there_in_an_empty_cache(tmp_path, monkeypatch):
    monkeypatch.setattr("studio.compiled.CACHE", tmp_path)
    names = warmup.missing()
    assert "model.tyre.forces" in names and "application.cacc.decide" in names
    assert len(names) == sum(len(compiled_functions(path)) for path in warmup.files())


def test_what_a_run_needs_follows_from_imports():
    files = warmup.files()
    assert PACKAGE / "model" / "tyre.py" in files and PACKAGE / "kinds" / "application" / "acc.py" in files


def test_an_application_of_ones_own_does_not_count(seen, tmp_path, own_kinds):
    """No warm-up compiles it, so none may wait for it."""
    own = tmp_path / "own_cruise.py"
    own.write_text((PACKAGE / "kinds" / "application" / "acc.py").read_text(encoding="utf-8"))
    registry.load_file(own)
    assert own not in warmup.files() and warmup.missing() == []


def test_a_process_that_fails_is_told(monkeypatch, tmp_path):
    """A part that cannot be done: its process ends with a traceback, and the warm-up says which."""
    monkeypatch.setattr(warmup, "parts", lambda: [str(tmp_path / "none.yaml")])
    monkeypatch.setattr(warmup, "missing", lambda: ["model.tyre.forces"])
    with pytest.raises(RunError, match="warm-up 1 failed"):
        warmup.Warmup().start().wait()


def test_every_sample_is_a_part():
    assert warmup.parts()[1] == str(sample.first())
    assert len(warmup.parts()) == 2 + len(list(sample.folder().glob("*.yaml")))
