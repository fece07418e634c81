"""The run database: what goes in comes out; what is no database is refused; a killed run says so."""

import json
import signal
import sqlite3
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
from pydantic import BaseModel

from studio import job
from studio.errors import ScenarioError, StoreError, UnknownError
from studio.execution.happening import Happening, happening
from studio.provenance import Provenance
from studio.scenario.schema import json_schema
from studio.store import trace
from studio.store.comparison import beside, compare
from studio.store.runs import event_of, event_row, open_runs
from studio.store.setting import settings
from studio.world.table.event import HIT
from tests.patience import until


@pytest.fixture(scope="module")
def kept(sample, tmp_path_factory):
    """A database with a run of 4 s and its child with ACC, and the first run's result."""
    runs = open_runs(tmp_path_factory.mktemp("db") / "runs.db")
    first = job.run(job.load(sample, {"clock.duration": 4}), runs=runs)
    child = job.load(sample, {"clock.duration": 4, "applications.platoon.application": "acc"})
    job.run(child, runs=runs, parent=first.row.run, seed=5)
    return runs, first


def test_a_run_is_found_as_it_was(kept):
    runs, first = kept
    row = runs.find(first.row.run)
    assert (row.status, row.seed, row.parent, row.state_hash) == ("done", 1, None, first.state_hash)
    assert row.parameters == {"clock.duration": 4}
    assert row.metrics == first.metrics
    assert runs.document(row)["clock"]["duration"] == 4


def test_traces_keep_all_bits(kept):
    runs, first = kept
    columns = runs.trace(first.row.run, ["follower_1.speed", "leader.gap"])
    assert columns["follower_1.speed"].tobytes() == first.trace("follower_1.speed").tobytes()
    assert columns["time"].tobytes() == first.time.tobytes()
    assert {"name": "leader.gap", "unit": "m", "label": "Gap to the car ahead"} in runs.channels(first.row.run)


def test_newest_first_and_lineage(kept):
    runs, _ = kept
    assert [row.run for row in runs.select()] == [2, 1]
    assert runs.find(2).parent == 1 and runs.find(2).seed == 5


def test_comparison(kept):
    runs, _ = kept
    result = compare(runs, 1, 2)
    differing = {each["path"]: each for each in result["parameters"]}
    assert differing["applications.platoon.application"]["a"] == "cacc"
    assert differing["seed"]["b"] == 5
    assert differing["applications.platoon.parameters.k_p"]["b"] is None  # on one side only: shown, not dropped
    assert "clock.duration" not in differing
    gap = next(each for each in result["metrics"] if each["name"] == "min_gap")
    assert gap["difference"] == pytest.approx(gap["b"] - gap["a"]) and gap["unit"] == "m"


def test_what_ended_early_is_not_ranked(sample, tmp_path):
    """A run that was stopped has better metrics of a shorter time; which are not better, and the reason is told."""
    runs = open_runs(tmp_path / "runs.db")
    for _ in range(2):
        job.run(job.load(sample, {"clock.duration": 0.2}), runs=runs)
    runs.database.conn.execute("update runs set status = 'stopped', sim_time_s = 0.1 where run = 1")
    runs.database.conn.execute("update metrics set value = 2 * value where run = 1")
    runs.database.conn.commit()
    found = compare(runs, 1, 2)
    assert {each["better"] for each in found["metrics"]} == {None}
    assert found["unranked"] == "Nothing is ranked: run 1 is stopped at 0.1 s, so it was measured over less than a whole run."
    assert compare(runs, 2, 2)["unranked"] == ""


def test_several_are_compared_with_the_first(sample, tmp_path):
    """It says what the comparison of two says; a kind that only one uses is told, and one that has changed is shown line by line."""
    runs = open_runs(tmp_path / "runs.db")
    name = "applications.platoon.parameters.headway"
    for changes in ({}, {name: 0.9}, {"applications.platoon.application": "acc"}):
        job.run(job.load(sample, {"clock.duration": 0.3} | changes), runs=runs)
    found = beside(runs, [1, 2, 3])
    assert [each["run"] for each in found["runs"]] == [1, 2, 3] and found["unranked"] == ["", "", ""]
    differing = {each["path"]: each["values"] for each in found["parameters"]}
    assert differing[name][:2] == [0.6, 0.9] and "clock.duration" not in differing
    assert "clock.duration" in {each["path"] for each in beside(runs, [1, 2], everything=True)["parameters"]}
    for place, other in enumerate((2, 3), 1):
        pairs = {each["name"]: each for each in compare(runs, 1, other)["metrics"]}
        for each in found["metrics"]:
            pair = pairs[each["name"]]
            assert (each["values"][0], each["values"][place], each["relative"][place]) == (pair["a"], pair["b"], pair["relative"])
            assert each["stands"][place] == {"a": "worse", "b": "better"}.get(pair["better"], pair["better"])
    assert {(each["kind"], each["only"]) for each in found["sources"]} == {
        ("application.cacc", 1),
        ("message.awareness", 1),
        ("application.acc", 3),
    }
    digest, text = runs.rows("select digest, files from kinds where name = 'cacc'")[0].values()
    kept = next(iter(json.loads(text).values()))
    changed = runs.keep(runs.text(kept) + "# another line\n")
    runs.database.table("kinds").insert({"digest": "other", "kind": "application", "name": "cacc", "files": text.replace(kept, changed)})
    runs.database.conn.execute("update runs set kinds = replace(kinds, ?, 'other') where run = 2", [digest])
    (source,) = [each for each in beside(runs, [1, 2])["sources"] if each["file"]]
    assert source["run"] == 2 and source["diff"].splitlines()[-1] == "+# another line"


@pytest.mark.parametrize("numbers", [[], [1, 1], list(range(1, 10))])
def test_what_cannot_stand_beside_each_other(kept, numbers):
    with pytest.raises(UnknownError, match="cannot stand beside"):
        beside(kept[0], numbers)


def test_settings_of_runs_that_have_not_set_them(sample, tmp_path):
    """Every run has a value of what one of them has set, as its own scenario had it; of what it does not have, none."""
    runs = open_runs(tmp_path / "runs.db")
    headway, gain = (f"applications.platoon.parameters.{name}" for name in ("headway", "gap_gain"))
    short, alone = {"clock.duration": 0.1}, {"applications": {}, "radio.buildings": False}
    for changes in ({}, {headway: 0.9}, {"applications.platoon.application": "acc", gain: 0.2}, alone):
        job.run(job.load(sample, short | changes), runs=runs)
    job.run(job.load(sample, short), seed=7, runs=runs)
    found = settings(runs, runs.select())
    assert [found[run].get(headway) for run in (1, 2, 3, 4, 5)] == [0.6, 0.9, 0.6, None, 0.6]
    assert [found[run].get(gain) for run in (1, 3)] == [None, 0.2]
    assert [found[run]["radio.buildings"] for run in (1, 4)] == [True, False]
    assert [found[run].get("applications.platoon.application") for run in (1, 3, 4)] == ["cacc", "acc", None]
    assert found[1]["clock.duration"] == 0.1 and settings(runs, []) == {}


def test_the_schema_is_not_made_again_for_every_difference(sample, tmp_path, monkeypatch):
    """Two scenarios differ in hundreds of places; the schema of each model is made once."""
    runs = open_runs(tmp_path / "runs.db")
    for path in (sample, sample.with_name("stepping_out.yaml")):
        job.run(job.load(path, {"clock.duration": 0.1}), runs=runs)
    made, make = [], BaseModel.model_json_schema.__func__
    monkeypatch.setattr(BaseModel, "model_json_schema", classmethod(lambda model: made.append(model) or make(model)))
    json_schema.cache_clear()
    assert len(compare(runs, 1, 2)["parameters"]) > 100
    assert made and len(made) == len(set(made))


@pytest.mark.parametrize("wrong", [99, -1])
def test_an_unknown_run(kept, wrong):
    with pytest.raises(UnknownError, match=f"no run {wrong}.*newest is 2"):
        kept[0].find(wrong)


def test_an_unknown_channel(kept):
    with pytest.raises(UnknownError, match=r"did you mean 'leader\.speed'"):
        kept[0].trace(1, ["leader.sped"])


def test_an_unknown_parent_leaves_no_row(kept, sample):
    runs, _ = kept
    with pytest.raises(UnknownError):
        job.run(job.load(sample, {"clock.duration": 1}), runs=runs, parent=77)
    assert len(runs.select()) == 2


def test_a_refused_scenario_leaves_no_row(kept, sample):
    runs, _ = kept
    with pytest.raises(Exception, match="beyond the end"):
        job.run(job.load(sample, {"vehicles.leader.position.along": 1e5}), runs=runs)
    assert len(runs.select()) == 2


def test_decimation_keeps_the_peaks():
    time_ = np.linspace(0, 60, 3001)
    values = np.sin(time_)
    values[1234] = 9.0
    thin = trace.decimate({"time": time_, "a": values}, 200)
    assert thin["time"].size <= 202 and thin["a"].max() == 9.0
    assert thin["time"][0] == 0 and thin["time"][-1] == 60
    assert (np.diff(thin["time"]) > 0).all()


@pytest.mark.parametrize("points", [2, 20, 200, 1000])
def test_decimation_keeps_rows_whole_and_the_peaks_of_every_channel(points):
    draw = np.random.default_rng(7)
    long = {"time": np.arange(3001) / 50.0} | {name: draw.normal(size=3001) for name in "abc"}
    thin = trace.decimate(long, points)
    rows = np.searchsorted(long["time"], thin["time"])
    assert len(rows) <= max(points, 3 * 4) + 2
    for name, values in long.items():
        np.testing.assert_array_equal(thin[name], values[rows])
        assert (thin[name].min(), thin[name].max()) == (values.min(), values.max())


def test_decimation_keeps_a_gap_and_the_peak_beside_missing_values():
    time_ = np.linspace(0, 60, 3001)
    values = np.where((time_ > 20) & (time_ < 40), np.nan, np.sin(time_))
    values[[0, 1501]] = np.nan, 9.0
    thin = trace.decimate({"time": time_, "a": values}, 200)
    inside = (thin["time"] > 21) & (thin["time"] < 39)
    assert np.nanmax(thin["a"]) == 9.0 and np.nanmin(thin["a"]) == np.nanmin(values)
    assert np.isnan(thin["a"][inside]).sum() == inside.sum() - 1 > 10


def test_decimation_of_no_channel_leaves_the_ends():
    assert trace.decimate({"time": np.arange(3001.0)}, 200)["time"].tolist() == [0.0, 3000.0]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"hello, I am a text file of some length" * 10, "not a database"),
        (b"SQLite format 3\0" + b"x" * 200, "cannot be used|not a database"),
    ],
)
def test_a_file_that_is_no_database(tmp_path, content, words):
    path = tmp_path / "runs.db"
    path.write_bytes(content)
    with pytest.raises(StoreError, match=words):
        open_runs(path)
    assert path.read_bytes() == content


def test_somebody_elses_database(tmp_path):
    path = tmp_path / "music.db"
    connection = sqlite3.connect(path)
    connection.execute("create table songs (name text)")
    connection.commit()
    connection.close()
    with pytest.raises(StoreError, match="songs"):
        open_runs(path)


def test_a_folder_and_a_missing_folder(tmp_path):
    with pytest.raises(StoreError, match="folder"):
        open_runs(tmp_path)
    with pytest.raises(StoreError, match="cannot be opened"):
        open_runs(tmp_path / "no" / "runs.db")


def as_one_who_may_not_write(code, path):
    """What a process says that gives up root, if it has it, once everything is imported; neither file nor folder can be written."""
    path.chmod(0o444)
    path.parent.chmod(0o555)
    imports = "import importlib.metadata, os, pathlib, sqlite_utils; from studio.store.runs import open_runs, read_runs"
    code = f"{imports}; os.getuid() or os.setuid(65534); path = pathlib.Path({str(path)!r}); {code}"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    path.parent.chmod(0o755)
    return told


def test_a_read_only_database(sample):
    """It can be read all the same."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "runs.db"
        runs = open_runs(path)
        job.run(job.load(sample, {"clock.duration": 0.1}), runs=runs)
        runs.close()
        written = as_one_who_may_not_write("open_runs(path)", path)
        read = as_one_who_may_not_write("print([row.status for row in read_runs(path).select()])", path)
    assert "StoreError" in written.stderr and "read-only" in written.stderr, written.stderr
    assert read.stdout == "['done']\n", read.stderr


def test_a_killed_run_says_so(sample, tmp_path):
    """A process is killed half-way; its row says killed, and later runs are not disturbed."""
    db = tmp_path / "runs.db"
    code = (
        "from studio import job; from studio.store.runs import open_runs;"
        f"job.run(job.load({str(sample)!r}, {{'clock.duration': 3600}}), runs=open_runs({str(db)!r}))"
    )
    process = subprocess.Popen([sys.executable, "-c", code])
    until(lambda: db.exists() and open_runs(db).select(), "the run's row")
    runs = open_runs(db)
    assert runs.find(1).status == "running"
    process.send_signal(signal.SIGKILL)
    process.wait()
    row = runs.find(1)
    assert row.status == "killed" and "process" in row.error
    assert row.metrics == {} and runs.channels(1) == []
    assert job.run(job.load(sample, {"clock.duration": 1}), runs=runs).row.run == 2


def test_what_is_too_long_for_one_value_stands_in_pieces(sample, tmp_path, monkeypatch):
    """SQLite takes a thousand million bytes; here a value holds a thousand."""
    from studio.store import runs as module

    monkeypatch.setattr(module, "PIECE", 1000)
    runs = open_runs(tmp_path / "runs.db")
    result = job.run(job.load(sample, {"clock.duration": 1}), runs=runs)
    assert runs.rows("select max(length(parquet)) as most from traces")[0]["most"] == 1000
    assert runs.trace(1, ["leader.speed"])["leader.speed"].tobytes() == result.trace("leader.speed").tobytes()
    assert runs.messages(1).kinds == result.record.messages.kinds and runs.record(1).vehicles == result.record.vehicles


def test_what_would_not_fit_into_memory_is_refused_before_it_begins(sample, tmp_path):
    runs = open_runs(tmp_path / "runs.db")
    wanted = {"clock.duration": 3600, "recording.traffic": True, "traffic.count": 100}
    with pytest.raises(ScenarioError, match=r"(?s)too much.*GB.*105 vehicles for 3600 s.*recording.period"):
        job.run(job.load(sample, wanted), runs=runs)
    assert runs.select() == []
    job.check_recording(job.prepare(job.load(sample, wanted | {"recording.traffic": False})))


def test_only_the_wanted_channels_are_kept(sample, tmp_path):
    runs = open_runs(tmp_path / "runs.db")
    job.run(job.load(sample, {"clock.duration": 1, "recording.channels": ["speed"]}), runs=runs)
    assert {each["name"].partition(".")[2] for each in runs.channels(1)} == {"speed"}
    assert runs.find(1).metrics["min_gap"].value > 0  # metrics see everything
    with pytest.raises(Exception, match=r"recording\.channels\.0.*did you mean 'speed'"):
        job.run(job.load(sample, {"recording.channels": ["sped"]}), runs=runs)


def test_all_of_it_or_nothing(sample, tmp_path, monkeypatch):
    """When writing the metrics fails, the run is not done either."""
    from studio.store import runs as module

    runs = open_runs(tmp_path / "runs.db")
    monkeypatch.setattr(module, "metric_rows", lambda run, metrics: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        job.run(job.load(sample, {"clock.duration": 0.1}), runs=runs)
    row = runs.find(1)
    assert row.status == "failed" and row.sim_time_s is None and runs.channels(1) == []


def test_a_finished_run_is_never_killed(kept):
    runs, first = kept
    runs.end(first.row.run, "killed", "too late")
    assert runs.find(first.row.run).status == "done"


def test_events_are_as_they_happened(sample, tmp_path):
    """Kind, units, place and numbers too."""
    runs = open_runs(tmp_path / "runs.db")
    result = job.run(job.load(sample, {"clock.duration": 3, "script.hard_brake.when.at": 1}), runs=runs)
    events = (*result.record.happenings, happening(HIT, 2.5, ("leader", "cone_1 of a"), place=(1.0, 2.0), impact_speed=3.0))
    assert runs.events(1) == list(result.record.happenings) and events[0].kind == "script_begun" and events[0].x is not None
    assert [event_of(event_row(1, each)) for each in events] == list(events)


def test_a_file_of_the_first_layout_keeps_its_events(tmp_path):
    """Its events had a time, a text and a vehicle; they still have, and newer ones stand beside them."""
    path = tmp_path / "runs.db"
    open_runs(path).close()
    old = sqlite3.connect(path)
    old.executescript(
        "drop table events; create table events (run integer, time float, text text, vehicle text); pragma user_version = 1;"
        "insert into runs (run, scenario, seed, status, code_version, created, parameters, unmet)"
        " values (1, 'old', 1, 'done', '1', '', '{}', '[]');"
        "insert into events values (1, 20.0, 'brake: brake with 6 m/s²', 'leader');"
    )
    old.close()
    for _ in range(2):  # the second time it has the present layout
        runs = open_runs(path)
        assert runs.events(1) == [Happening(20.0, "brake: brake with 6 m/s²", "leader")]
        runs.close()
    runs = open_runs(path)
    newer = happening(HIT, 21.0, ("a", "b"), impact_speed=2.0)
    with runs.writing():
        runs.database.table("events").insert(event_row(1, newer))
    assert runs.events(1)[1] == newer and runs.find(1).status == "done"


def test_a_damaged_digest_is_told(sample, tmp_path):
    """One that is a number, larger than any of SQLite's."""
    runs = open_runs(tmp_path / "runs.db")
    row = job.run(job.load(sample, {"clock.duration": 0.1}), runs=runs).row
    runs.database.execute("update runs set kinds = ?", ['{"driver.attentive": 99999999999999999999999}'])
    runs.database.conn.commit()
    with pytest.raises(StoreError, match=f"Run {row.run} is damaged"):
        runs.sources(runs.find(row.run))


def test_metrics_written_by_sqlite_are_those_that_are_kept(tmp_path):
    """To the last bit from 1e-12 to 1e12; what is no number is none, and what is damaged of one does not hold up the list."""
    runs = open_runs(tmp_path / "runs.db")
    run = runs.begin(
        scenario="stern", title="Stern", document={}, scenario_hash="0" * 64, map_digest="", parent=None, seed=1,
        parameters={}, provenance=Provenance((), "1", "host", {}, ()),
    )  # fmt: skip
    random = np.random.default_rng(1)
    values = [*(random.uniform(-1, 1, 400) * 10.0 ** random.integers(-12, 12, 400)), float("inf"), None, 0.0]
    told = {"run": run, "unit": "m", "goal": None, "subject": '["a"]', "time": None, "kind": "m", "about": 'é"'}
    rows = [told | {"name": f"m{i}", "value": value} for i, value in enumerate(values)]
    rows.append(rows[0] | {"name": "damaged", "subject": "[", "time": 0.1 + 0.2})
    with runs.writing():
        runs.database.table("metrics").insert_all(rows)
    found = json.loads(runs.metrics_as_text([run])[run])
    assert [found[f"m{i}"]["value"] for i in range(len(values))] == [None if value == float("inf") else value for value in values]
    assert found["m0"]["subject"] == ["a"] and found["m0"]["about"] == 'é"' and found["damaged"]["subject"] == []
    assert found["damaged"]["time"] == 0.1 + 0.2
