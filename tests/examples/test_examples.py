"""One example of each sort, a file each: they keep their contracts, and one scenario uses them all."""

import json
import re
import subprocess
import sys

import pytest

from studio.kind import registry
from studio.kind.sort import SORTS
from studio.log import recording
from studio.workshop.conform import conform
from tests.conftest import ROOT
from tests.patience import PATIENCE

EXAMPLES = ROOT / "examples"
PAGE = ROOT / "docs" / "pages" / "how" / "kind.md"


@pytest.fixture
def examples(own_kinds):
    """The examples by their sort."""
    return {kind.sort: kind for kind in own_kinds(EXAMPLES)}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A run of the scenario with all of them, in a process of its own, and the events of it."""
    folder = tmp_path_factory.mktemp("run")
    command = ("run", EXAMPLES / "everything.yaml", "--kinds", EXAMPLES, "--json")
    done = subprocess.run(
        [sys.executable, "-m", "studio.cli", *map(str, command)], cwd=folder, capture_output=True, text=True, timeout=24 * PATIENCE
    )
    assert done.returncode == 0, done.stderr
    from studio.store.runs import open_runs

    return json.loads(done.stdout), open_runs(folder / "runs.db")


def test_there_is_one_of_each_sort(examples):
    assert registry.broken() == []
    assert sorted(examples) == sorted(SORTS) and len(list(EXAMPLES.glob("*.py"))) == len(SORTS)


def test_each_keeps_its_contract_and_names_its_source(examples):
    for kind in examples.values():
        assert [str(check) for check in conform(kind) if check.wrong] == [], kind.name
        assert kind.explanation.count("\n") >= 2, kind.name


def test_one_scenario_uses_them_all(run, examples):
    row, runs = run
    assert row["status"] == "done" and row["error"] is None and row["unmet"] == []
    assert {f"{kind.sort}.{kind.name}" for kind in examples.values() if SORTS[kind.sort].is_run} <= set(row["kinds"])
    assert row["metrics"]["time_exposed"]["value"] == 0.0
    kept = runs.trace(1, ["letting.letting.wanting", "letting.letting.notice", "letting.side.ahead", "ahead.specific_power"])
    assert kept["letting.letting.wanting"].max() == 1.0 and kept["letting.letting.notice"].max() == 1.0
    assert 2.0 < kept["letting.side.ahead"][0] < 12.0 and kept["ahead.specific_power"].max() > 5.0
    told = [event.text for event in runs.events(1)]
    assert any("careful begins" in text for text in told) and any("wriggle begins: sine with dwell" in text for text in told)


def test_a_track_is_read_by_its_format(examples, tmp_path):
    """One second and 0.0001° of latitude apart, 11.12 m on the sphere of the format, then twice that."""
    path = tmp_path / "ride.gpx"
    path.write_bytes(examples["logformat"].module.SAMPLE)
    made = recording.load(path)
    assert made["speed"][[0, -1]] == pytest.approx([11.1195, 22.239], abs=1e-3) and made.start == 0.5


def files_of(kind) -> int:
    """How many files a kind needs: its own, and those beside it that are no kinds by themselves."""
    own = {each.file.name for each in registry.every() if each.file} - {kind.file.name}
    return len([name for name in kind.texts if name not in own])


def test_the_page_tells_how_many_files_a_new_one_needs(examples):
    """The table is counted here, not remembered."""
    told = {name: int(count) for name, count in re.findall(r"^\| (\w+) \|.*\| (\d+) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)}
    assert told == {sort: files_of(examples[sort]) for sort in SORTS}
