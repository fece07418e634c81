"""Several programs use one database at once: nothing is lost, numbers are given once, and nobody sees half of anything."""

import subprocess
import sys

from studio.store import recording, waiting
from studio.store.runs import open_runs, read_runs

PROCESSES, RUNS = 8, 3


def test_many_processes_write_finished_runs_at_once(sample, tmp_path):
    """They begin together, on a database that is not there yet; a reader looks all the while."""
    db, gate = tmp_path / "runs.db", tmp_path / "gate"
    code = f"""
import sys, time
from pathlib import Path
from studio import job
from studio.store.runs import open_runs
loaded = job.load({str(sample)!r}, {{"clock.duration": 0.2}})
job.run(loaded)
print("ready", flush=True)
while not Path({str(gate)!r}).exists():
    time.sleep(0.005)
for i in range({RUNS}):
    row = job.run(loaded, seed=int(sys.argv[1]) * 100 + i, runs=open_runs({str(db)!r})).row
    print(row.run, row.seed, row.status, row.state_hash, flush=True)
"""
    processes = [
        subprocess.Popen([sys.executable, "-c", code, str(each)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for each in range(PROCESSES)
    ]
    assert all(each.stdout.readline() == "ready\n" for each in processes)
    gate.touch()
    while any(each.poll() is None for each in processes):
        for row in read_runs(db).select() if db.exists() and db.stat().st_size else []:
            assert row.status in ("running", "done") and bool(row.metrics) == (row.status == "done")
    told = [line.split() for each in processes for line in each.communicate()[0].splitlines()]
    assert [each.returncode for each in processes] == [0] * PROCESSES
    runs, count = open_runs(db), PROCESSES * RUNS
    rows = {str(row.run): row for row in runs.select()}
    assert sorted(rows, key=int) == [str(i + 1) for i in range(count)] and len(told) == count
    for number, seed, status, state in told:
        row = rows[number]
        assert (str(row.seed), row.status, row.state_hash, row.error) == (seed, "done", state, None) and status == "done"
        trace = runs.trace(row.run, ["leader.speed"])
        assert trace["time"].size == 11 and len(row.metrics) > 20 and runs.messages(row.run).time.size
    assert runs.rows("pragma integrity_check") == [{"integrity_check": "ok"}] and runs.rows("pragma foreign_key_check") == []
    assert not list(waiting.found(db)) and not list(recording.found(db))
