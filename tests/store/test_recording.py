"""What a run records is on the disk while it goes on: a run that is killed, that fails or for which there is no room keeps what it had."""

import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import psutil
import pytest

from studio import job
from studio.cli.running import interrupted
from studio.errors import ScenarioError, StoreError
from studio.execution import shelf
from studio.execution.salvage import begun, lay_down, recorded, salvaged
from studio.execution.simulation import simulation
from studio.store import recording
from studio.store.runs import open_runs, read_runs
from studio.world.channel import CHANNELS
from tests.patience import until

LONG = {"clock.duration": 3600}


def running(sample, db, changes):
    """A process that runs a scenario."""
    code = (
        "from studio import job; from studio.store.runs import open_runs;"
        f"job.run(job.load({str(sample)!r}, {changes!r}), runs=open_runs({str(db)!r}))"
    )
    return subprocess.Popen([sys.executable, "-c", code])


def recorded_until(db, time):
    """Up to when a run has been recorded, when that is later than a time."""
    return [last for _, folder in recording.found(db) if (last := recording.until(folder)) > time]


def test_a_killed_run_keeps_what_it_had(sample, tmp_path):
    """It is read where it lies, is in the database after the next start, and is what the same run has up to that time, bit by bit."""
    db = tmp_path / "runs.db"
    process = running(sample, db, LONG)
    until(lambda: recorded_until(db, 3.0) and list(tmp_path.glob("runs.db.recording/*/log_0.arrays")), "three seconds of the run")
    assert read_runs(db).trace(1, ["leader.speed"])["time"][-1] >= 3.0, "a run that goes on can be looked at"
    process.send_signal(signal.SIGKILL)
    process.wait()
    seen = read_runs(db)
    row, before = seen.find(1), seen.trace(1, ["leader.speed", "follower_1.gap", "follower_1.front.range"])
    last = before["time"][-1]
    assert (row.status, row.sim_time_s) == ("killed", round(last, 9)) and f"until {last:g} s is kept" in row.error
    assert {each["name"] for each in seen.channels(1)} >= {"leader.speed", "leader.time_gap"} and seen.record(1).time[-1] == last
    runs = open_runs(db)
    row, after = runs.find(1), runs.trace(1, list(before)[1:])
    assert (row.status, row.sim_time_s, row.state_hash) == ("killed", round(last, 9), None) and f"until {last:g} s is kept" in row.error
    assert row.metrics["min_gap"].value > 0 and not (tmp_path / "runs.db.recording").exists()
    whole = job.run(job.load(sample, {"clock.duration": float(np.ceil(last))}))
    for name, values in before.items():
        expected = (whole.time if name == "time" else whole.trace(name))[: values.size]
        assert values.tobytes() == after[name].tobytes() == expected.tobytes()
    sent = runs.messages(1)
    assert sent.time.size > 0 and np.array_equal(sent.time, whole.record.messages.time[: sent.time.size])
    lost = [[each for each in events if each.kind == "message_lost"] for events in (runs.events(1), whole.record.happenings)]
    assert lost[0] and lost[0] == lost[1][: len(lost[0])]


def test_a_run_that_goes_on_is_left_alone(sample, tmp_path):
    """Whoever opens the database meanwhile takes nothing in."""
    db = tmp_path / "runs.db"
    process = running(sample, db, LONG)
    until(lambda: recorded_until(db, 0.5), "half a second of the run")
    assert open_runs(db).find(1).status == "running" and recorded_until(db, 0.5)
    process.kill()
    process.wait()


def test_an_interrupted_run_keeps_what_it_had(sample, tmp_path):
    db = tmp_path / "runs.db"

    def interrupt(share):
        if share > 0.001:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        job.run(job.load(sample, LONG), runs=open_runs(db), progress=interrupt)
    row = read_runs(db).find(1)
    assert row.status == "stopped" and "KeyboardInterrupt" in row.error and row.sim_time_s >= 3.6
    assert read_runs(db).trace(1, ["leader.speed"])["time"][-1] == pytest.approx(row.sim_time_s, abs=1e-9) and row.metrics
    told = interrupted(open_runs(db), sample, db)
    assert f"run 1 is stopped, what was recorded until {row.sim_time_s:g} s is kept" in told
    assert f"studio show 1 --db {db}" in told and f"studio run {sample}" in told
    assert "nothing was kept" in interrupted(open_runs(tmp_path / "other.db"), sample, db)


def test_a_run_that_fills_the_disk_ends_and_keeps_what_it_had(sample, tmp_path):
    """Files of this process may have 20 MB each; the third chunk of samples finds no room."""
    changes = {"clock.duration": 60, "recording.traffic": True}
    code = f"""
import resource
from studio import job
from studio.store.runs import open_runs, read_runs
loaded = job.load({str(sample)!r}, {changes!r})
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000_000, 20_000_000))
print(job.run(loaded, runs=open_runs("runs.db")).status)
"""
    told = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert told.stdout == "failed\n"
    runs = read_runs(tmp_path / "runs.db")
    row, kept = runs.find(1), runs.trace(1, ["leader.speed"])
    assert row.status == "failed" and "no room left to record" in row.error and row.metrics["min_gap"].value > 0
    assert 10.0 < row.sim_time_s < 60.0 and abs(kept["time"][-1] - row.sim_time_s) < 0.021
    whole = job.run(job.load(sample, {"clock.duration": float(np.ceil(row.sim_time_s))}))
    assert kept["leader.speed"].tobytes() == whole.trace("leader.speed")[: kept["time"].size].tobytes()


def test_a_run_whose_recording_is_taken_away_says_so(sample, tmp_path, monkeypatch):
    """Neither its row nor who began it is told of anything else than that."""
    monkeypatch.setattr("studio.execution.record.CHUNK", 100_000)  # so that not all of it is mapped
    runs = open_runs(tmp_path / "runs.db")

    def take_away(share):
        shutil.rmtree(tmp_path / "runs.db.recording", ignore_errors=True)

    with pytest.raises(StoreError, match="cannot be read any more"):
        job.run(job.load(sample, {"clock.duration": 20}), runs=runs, progress=take_away)
    row = runs.find(1)
    assert row.status == "failed" and "What was recorded of this run cannot be read any more." in row.error


def test_a_run_that_has_recorded_as_much_as_may_be_ends(sample, tmp_path):
    loaded = job.load(sample, {"clock.duration": 40})
    run = simulation(job.prepare(loaded), shelf=shelf.Folder(tmp_path, most=14_000_000))
    while not run.is_over:
        run.advance(100)
    result = job.outcome(loaded, run)
    assert result.status == "failed" and "as much as may be" in result.error and result.metrics["min_gap"].value > 0


def test_memory_does_not_grow_with_the_run(sample, tmp_path):
    """What a process has of its own, beside files that are mapped, is the same after 100 MB as after 10."""
    loaded = job.load(sample, {"clock.duration": 3600, "recording.traffic": True, "traffic.count": 40, "recording.period": 0.02})
    run = simulation(job.prepare(loaded), shelf=shelf.Folder(tmp_path))
    own, sizes = psutil.Process(), []
    for _ in range(4):
        run.advance(2000)
        memory = own.memory_info()
        sizes.append(memory.rss - memory.shared)
    assert run.recorder.count == 8000 and sum(each.stat().st_size for each in tmp_path.iterdir()) > 100e6
    assert sizes[-1] - sizes[0] < 20e6


def test_a_run_for_which_there_is_no_room_is_refused(sample, tmp_path, monkeypatch):
    monkeypatch.setattr(job.shutil, "disk_usage", lambda path: job.shutil._ntuple_diskusage(100, 99, 1_000_000))
    size = 8 * len(CHANNELS) * 5 * 360 / 0.02 / 1e6  # [MB] a number of 8 bytes for every channel, vehicle and sample
    with pytest.raises(ScenarioError, match=rf"(?s)too much.*{size:.1f} MB: 5 vehicles.*at most 0\.2 MB.*free on the disk"):
        job.run(job.load(sample, {"clock.duration": 360}), runs=open_runs(tmp_path / "runs.db"))


def test_a_recording_that_cannot_be_read_is_set_aside(sample, tmp_path):
    """And holds up nobody."""
    db = tmp_path / "runs.db"
    process = running(sample, db, LONG)
    until(lambda: recorded_until(db, 0.5), "half a second of the run")
    process.kill()
    process.wait()
    ((_, folder),) = recording.found(db)
    (folder / "about.jsonl").write_text("{}\n")
    row = open_runs(db).find(1)
    assert row.status == "killed" and f"damaged-{folder.name}" in row.error
    assert (folder.parent / f"damaged-{folder.name}").is_dir() and open_runs(db).find(1) == row


def test_who_reads_a_recording_that_goes_meanwhile_finds_all_of_it_or_nothing(sample, tmp_path, monkeypatch):
    """Whenever it is taken in: it is removed before each of the files that are read of it."""
    loaded = job.load(sample, {"clock.duration": 0.5})
    prepared, runs = job.prepare(loaded), open_runs(tmp_path / "runs.db")
    number = job.begin(loaded, prepared, runs, None)
    job.recorded(prepared, runs, number).advance(10)
    folder, opened = runs.folder(number), []

    def count(self, name):
        opened.append(name)
        if len(opened) == last:
            recording.remove(Path(self.path))
        return read(self, name)

    read, last = shelf.Folder.lines, 0
    monkeypatch.setattr(shelf.Folder, "lines", count)
    assert recording.record(folder).time.size == 10 and len(opened) > 3
    for last in range(1, len(opened) + 1):
        shutil.copytree(folder, copy := folder.with_name(f"copy-{last}"))
        opened.clear()
        assert recording.record(copy) is None and not copy.exists()


def test_a_run_whose_recording_is_taken_in_meanwhile_has_its_traces(sample, tmp_path, monkeypatch):
    """Between two looks: none is kept yet, and no recording is there any more."""
    runs = open_runs(tmp_path / "runs.db")
    number = job.run(job.load(sample, {"clock.duration": 0.2}), runs=runs).row.run
    kept, looks = type(runs).kept_parquet, []
    monkeypatch.setattr(
        type(runs), "kept_parquet", lambda self, run: None if not looks.append(run) and len(looks) == 1 else kept(self, run)
    )
    assert runs.parquet(number) == kept(runs, number) and len(looks) == 2


OTHERS = [b"{}", b"[]", b'{"status": [], "error": 1}', b'{"status": "done", "error": ""}', b"noise", b"\xff", b"[" * 10**5]


@pytest.mark.parametrize("why", OTHERS)
def test_a_reason_that_is_damaged_is_none(tmp_path, why):
    (tmp_path / "why.jsonl").write_bytes(why + b"\n")
    assert recording.ending(tmp_path) == {}
    recording.put_down(tmp_path / "new", "failed", "no folder")  # nobody can be told
    assert recording.ending(tmp_path / "new") == {}


@pytest.mark.parametrize("last", [np.nan, np.inf, 1e300])
def test_no_more_samples_are_read_than_there_are_times(tmp_path, last):
    """Whatever stands where it is told how far the recording is."""
    kept = shelf.Folder(tmp_path)
    kept.roll("times", (10,)).begin()
    kept.roll("progress", (2,)).begin()[:] = 1e15, last
    assert recorded(kept, [{"room": 10}]) == 10
    assert recording.until(tmp_path) == (last if np.isfinite(last) else 0.0)


def test_a_part_that_is_about_to_begin_has_no_sample_yet(sample, tmp_path):
    """Its place is in the file before it is told which sample is its first; who reads in that moment finds what was there before."""
    kept = shelf.Folder(tmp_path)
    running = simulation(job.prepare(job.load(sample, {"clock.duration": 100})), shelf=kept)
    lay_down(running, kept)
    running.advance(3200)
    before = salvaged(kept).probes
    assert begun(kept.roll("beginnings", (1,), np.int64)) == [0, 1024, 2048, 3072]
    kept.roll("beginnings", (1,), np.int64).begin()
    assert begun(kept.roll("beginnings", (1,), np.int64)) == [0, 1024, 2048, 3072]
    after = salvaged(kept).probes
    assert {name: each.values.tobytes() for name, each in after.items()} == {name: each.values.tobytes() for name, each in before.items()}


def test_what_was_not_written_whole_is_not_there(tmp_path):
    kept = shelf.Folder(tmp_path)
    kept.append("log", np.arange(3), np.ones((2, 2), np.float32))
    kept.write("events", [{"a": 1}])
    for name in ("log.jsonl", "events.jsonl"):
        with Path(tmp_path, name).open("a") as file:
            file.write('[12, [["<i8"')
    ((first, second),) = shelf.Folder(tmp_path).appended("log")
    assert first.tolist() == [0, 1, 2] and second.tolist() == [[1, 1], [1, 1]] and kept.lines("events") == [{"a": 1}]
