"""A channel in one number as a column: worked out once, kept, and the same as of the run itself."""

import csv
import io
import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio import job
from studio.cli import app
from studio.errors import ScenarioError
from studio.store.aggregate import aggregated
from studio.store.column import Wanted, cell, fill, filled, kept, lacking, wanted
from studio.store.ledger import ledger
from studio.store.runs import open_runs, reopen_runs
from tests.conftest import ROOT

SPEED = "follower_1.speed.p95"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A database with a run of a platoon, one of which no speed was recorded, and one that goes on."""
    found = open_runs(tmp_path_factory.mktemp("column") / "runs.db")
    for changes in ({}, {"recording.channels": ["gap"]}):
        job.run(job.load(ROOT / "scenarios" / "cacc_step.yaml", {"clock.duration": 2} | changes), runs=found)
    with found.writing():
        row = found.rows("select * from runs where run = 1")[0] | {"run": 3, "status": "running"}
        found.database.table("runs").insert(row)
    found.close()
    return found.path


@pytest.fixture
def runs(made, tmp_path):
    """A copy of it."""
    return reopen_runs(Path(shutil.copy(made, tmp_path)))


def test_it_is_worked_out_once_and_is_what_is_told_of_the_run(runs):
    column = wanted("follower_1.speed.mean@0.5..1.5")
    assert kept(runs, column) == [] and lacking(runs, column) == [2, 1]  # the one that goes on has none yet
    fill(runs, column, [2, 1])
    other, platoon = kept(runs, column)
    (told,) = aggregated(runs, [1], "follower_1.speed", begin=0.5, end=1.5)
    assert platoon.value == next(each.value for each in told.aggregates if each.kind == "mean")
    trace = runs.trace(1, ["follower_1.speed"])
    inside = (trace["time"] >= 0.5 - 1e-9) & (trace["time"] <= 1.5 + 1e-9)
    assert platoon.value == pytest.approx(np.mean(trace["follower_1.speed"][inside]), rel=1e-12)
    assert (platoon.unit, platoon.time, platoon.why) == ("m/s", None, "")
    assert (other.run, other.value) == (2, None) and "no channel 'follower_1.speed'" in other.why
    assert lacking(runs, column) == []
    with runs.writing():
        runs.database.conn.execute("delete from traces")
    assert filled(runs, column, [1, 2]) == {1: platoon, 2: other}  # nothing is read again


def test_columns_do_not_mix(runs):
    """Each name has values of its own, and a name that says the same in other digits is the same."""
    filled(runs, wanted(SPEED), [1, 2])
    assert lacking(runs, wanted("follower_1.speed.p5")) == [2, 1]
    assert lacking(runs, wanted(f"{SPEED}@0..")) == [2, 1]
    filled(runs, wanted(f"{SPEED}@0.50..1"), [1])
    assert [each.run for each in kept(runs, wanted(f"{SPEED}@.5..1.0"))] == [1]


def test_at_an_event(runs):
    event = runs.events(1)[0]
    found = cell(runs, 1, wanted(f"leader.speed.at_{event.kind}"))
    trace = runs.trace(1, ["leader.speed"])
    assert found.value == trace["leader.speed"][trace["time"] <= event.time + 1e-6][-1]
    assert "no such event" in cell(runs, 1, wanted("leader.speed.at_meteorite")).why


def test_the_table_has_it_with_its_unit(runs, tmp_path):
    rows = list(csv.DictReader(io.StringIO(ledger(runs, "csv", channels=[SPEED]).decode())))
    head = f"channel.{SPEED} [m/s]"
    assert [row["run"] for row in rows] == ["3", "2", "1"]
    assert [row[head] for row in rows[:2]] == ["", ""]
    assert float(rows[2][head]) == cell(runs, 1, wanted(SPEED)).value
    app(["runs", "--db", str(runs.path), "--out", str(tmp_path / "runs.json"), "--column", SPEED], standalone_mode=False)
    assert json.loads((tmp_path / "runs.json").read_text())[2][f"channel.{SPEED}"] == float(rows[2][head])


@pytest.mark.parametrize(
    "name", ["", "speed", "leader.speed.median", "leader.speed.max@1..soon", "leader.speed.max@nan..", "leader.speed.at_", ".max"]
)
def test_a_name_that_says_nothing_is_refused(name):
    with pytest.raises(ScenarioError) as refused:
        wanted(name)
    assert "at_EVENT" in str(refused.value)


times = st.none() | st.floats(-1e6, 1e6).map(lambda time: time + 0.0)


@given(st.sampled_from(["min", "max", "mean", "p5", "p95"]), times, times, st.sampled_from(["", "collision", "script_begun"]))
def test_a_name_says_all_of_it(kind, begin, end, event):
    column = Wanted("car_1.speed", "at_event" if event else kind, begin, end, event)
    assert wanted(column.name) == column
