"""The queue: runs wait in the order in which they were asked for, and are cancelled while they wait and while they go on."""

import json
import os
import signal
import subprocess
import sys

import psutil
import pytest

from studio import job
from studio.store.queue import queue
from studio.store.runs import LEFT, open_runs, read_runs
from tests.broken import HANGING
from tests.patience import PATIENCE
from tests.patience import until as wait_until
from tests.server.server import served

SCENARIO = "grosser_stern_platoon"
LONG = {"clock.duration": 3600}


@pytest.fixture(scope="module")
def small(tmp_path_factory, sample):
    """A server that does two runs at a time, with an application that hangs."""
    folder = tmp_path_factory.mktemp("queue")
    (folder / "kinds").mkdir()
    (folder / "kinds" / "hanging.py").write_text(HANGING)
    with served(folder, "--kinds", folder / "kinds", "--scenarios", sample.parent, "--at-once", "2") as running:
        yield running


def ask(client, **changes):
    """Asks for a run as fast as possible."""
    answer = client.post("/api/runs", json={"scenario": SCENARIO, "set": changes})
    assert answer.status_code == 202, answer.text
    return answer.json()


def paused(client):
    """A run that stands, and holds its place."""
    answer = client.post("/api/live", json={"scenario": SCENARIO, "set": LONG, "paused": True})
    assert answer.status_code == 201, answer.text
    return answer.json()["run"]


def status(client, run):
    return client.get(f"/api/runs/{run}").json()["status"]


def in_queue(client):
    """Number, status and position of all in the queue."""
    return [(each["run"], each["status"], each["position"]) for each in client.get("/api/queue").json()]


def cancelled(client, run, expected):
    """Cancels a run; it ends as expected."""
    assert client.post(f"/api/runs/{run}/cancel").status_code == 200
    wait_until(lambda: status(client, run) == expected, f"run {run}, {expected}")


def test_runs_wait_in_order_and_are_cancelled(small):
    client, db, _ = small
    one, two = paused(client), paused(client)
    asked = [ask(client, **{"clock.duration": 0.1}) for _ in range(3)]
    three, four, five = (each["run"] for each in asked)
    assert [each["position"] for each in asked] == [1, 2, 3]
    waiting = [(three, "waiting", 1), (four, "waiting", 2), (five, "waiting", 3)]
    assert in_queue(client) == [(one, "running", 0), (two, "running", 0), *waiting]
    late = client.post("/api/live", json={"scenario": SCENARIO, "set": LONG}).json()
    assert (late["status"], late["position"]) == ("waiting", 4)
    assert client.post(f"/api/live/{late['run']}/pause").status_code == 422
    cancelled(client, four, "cancelled")
    assert [each[0] for each in in_queue(client)] == [one, two, three, five, late["run"]]
    told = subprocess.run([sys.executable, "-m", "studio.cli", "queue", "--db", db, "--json"], capture_output=True, text=True, check=True)
    assert [(each["run"], each["position"]) for each in json.loads(told.stdout)][2:] == [(three, 1), (five, 2), (late["run"], 3)]
    done = subprocess.run([sys.executable, "-m", "studio.cli", "cancel", str(late["run"]), "--db", db], capture_output=True, text=True)
    assert done.returncode == 0 and "cancelled" in done.stdout, done.stderr
    assert len(in_queue(client)) == 4
    cancelled(client, one, "stopped")
    wait_until(lambda: [status(client, each) for each in (three, five)] == ["done", "done"], "those that waited")
    rows = [client.get(f"/api/runs/{each}").json() for each in (three, five)]
    assert rows[0]["created"] < rows[1]["created"] and all(each["metrics"]["min_gap"]["value"] > 0 for each in rows)
    wait_until(lambda: client.get(f"/api/live/{late['run']}").json()["status"] == "cancelled", "what the server knows of it")
    cancelled(client, two, "stopped")
    again = client.post(f"/api/runs/{two}/cancel")
    assert again.status_code == 409 and "is over" in again.text
    assert client.post("/api/runs/999/cancel").status_code == 404 and in_queue(client) == []


def test_a_run_of_the_command_line_is_in_the_queue_and_can_be_cancelled(small, sample):
    client, db, _ = small
    command = [sys.executable, "-m", "studio.cli", "run", str(sample), "--db", str(db), "--set", "clock.duration=3600"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    (place,) = wait_until(lambda: [each for each in client.get("/api/queue").json() if each["time"] > 1], "the run of the command line")
    cancelled(client, place["run"], "stopped")
    assert process.wait(PATIENCE) == 0, process.stderr.read()
    assert client.get(f"/api/runs/{place['run']}").json()["sim_time_s"] >= 1


def test_what_is_wrong_is_told_before_it_waits(small):
    client, *_ = small
    runs = [paused(client), paused(client)]
    for change in (
        {"vehicles.leader.start.at": 1e6},
        {"clock.duration": 1e5, "recording.traffic": True},
        {"vehicles.leader.model": "none"},
    ):
        assert client.post("/api/runs", json={"scenario": SCENARIO, "set": change}).status_code == 422
    assert client.post("/api/runs", json={"scenario": SCENARIO, "parent": 999}).status_code == 404
    assert [each[0] for each in in_queue(client)] == runs
    for run in runs:
        cancelled(client, run, "stopped")


def test_a_run_waits_as_it_was_asked_for(small, tmp_path, sample):
    """Whatever becomes of the file meanwhile."""
    (tmp_path / "maps").symlink_to(sample.parent / "maps")
    file = tmp_path / sample.name
    file.write_text(sample.read_text())
    with served(tmp_path, "--scenarios", tmp_path, "--at-once", "1") as (client, _, _):
        first = paused(client)
        run = ask(client, **{"clock.duration": 0.1})["run"]
        file.write_text("title: [")
        client.post(f"/api/live/{first}/stop")
        wait_until(lambda: status(client, run) == "done", "the run that waited")


def test_a_process_that_is_killed_leaves_what_it_recorded(small):
    client, db, server = small
    run = ask(client, **LONG)["run"]
    wait_until(lambda: [each for each in client.get("/api/queue").json() if each["time"] > 1], "a second of the run")
    (worker,) = [
        each for each in psutil.Process(server.pid).children(recursive=True) if any("recording" in f.path for f in each.memory_maps())
    ]
    worker.kill()
    row = wait_until(lambda: (row := client.get(f"/api/runs/{run}").json())["metrics"] and row, "what was recorded, with its metrics")
    assert row["status"] == "killed" and "-9" in row["error"] and "is kept" in row["error"] and row["sim_time_s"] >= 1
    trace = client.get(f"/api/runs/{run}/trace", params={"channels": "leader.speed"}).json()
    assert trace["time"][-1] == pytest.approx(row["sim_time_s"]) and not (db.parent / "runs.db.recording").exists()


def test_the_server_ends_while_an_application_hangs(tmp_path, sample):
    """Within 10 s of SIGTERM; who waited is told so, and what was recorded before is kept."""
    folder = tmp_path / "kinds"
    folder.mkdir()
    (folder / "hanging.py").write_text(HANGING)
    options = ("--kinds", folder, "--scenarios", sample.parent, "--at-once", "1")
    with served(tmp_path, *options) as (client, _, process):
        changes = {"applications.platoon.application": "hanging"}
        run = client.post("/api/live", json={"scenario": SCENARIO, "set": changes}).json()["run"]
        wait_until((folder / "hanging.sign").exists, "the application that hangs")
        waits = ask(client, **LONG)["run"]
        for address in ("/api/kinds", "/api/queue", "/api/runs", "/api/live"):
            assert client.get(address, timeout=10).status_code == 200
        left = psutil.Process(process.pid).children(recursive=True)
        process.send_signal(signal.SIGTERM)
        process.wait(10)
        wait_until(lambda: not any(each.is_running() and each.status() != psutil.STATUS_ZOMBIE for each in left), "the end of all")
    seen = read_runs(tmp_path / "runs.db")
    assert (seen.find(waits).status, seen.find(waits).error) == ("cancelled", LEFT)
    assert seen.find(run).status == "killed" and "server ended" in seen.find(run).error
    with served(tmp_path, *options) as (client, _, _):
        assert (status(client, run), status(client, waits)) == ("killed", "cancelled") and in_queue(client) == []
        assert "server ended" in client.get(f"/api/runs/{run}").json()["error"]


@pytest.mark.parametrize("document", ["[]", "{", '{"clock": 5}', '{"clock": {"duration": "x"}}', '{"clock": {"duration": 1e999}}'])
def test_a_run_whose_scenario_is_damaged_holds_up_nobody(tmp_path, sample, document):
    runs, loaded = open_runs(tmp_path / "runs.db"), job.load(sample)
    job.begin(loaded, job.prepare(loaded), runs, None)
    assert [each.duration for each in queue(runs)] == [loaded.scenario.clock.duration]
    with runs.writing():
        runs.database.conn.execute("update scenarios set document = ?", [document])
    assert [(each.run, each.duration) for each in queue(runs)] == [(1, 0.0)]


def test_who_waited_for_a_server_that_was_killed_is_told_so(tmp_path, sample):
    with served(tmp_path, "--scenarios", sample.parent, "--at-once", "1") as (client, db, process):
        first, waits = paused(client), ask(client, **LONG)["run"]
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        wait_until(lambda: read_runs(db).find(first).status == "killed", "the end of the run")
        seen = read_runs(db).find(waits)
        assert (seen.status, seen.error) == ("cancelled", LEFT)
    assert open_runs(db).rows("select status from runs where run = ?", [waits]) == [{"status": "cancelled"}]


def test_a_run_that_does_not_react_is_ended_by_force(tmp_path, sample):
    folder = tmp_path / "kinds"
    folder.mkdir()
    (folder / "hanging.py").write_text(HANGING)
    db, studio = str(tmp_path / "runs.db"), [sys.executable, "-m", "studio.cli"]
    options = ["--db", db, "--kinds", str(folder)]
    process = subprocess.Popen([*studio, "run", str(sample), *options, "--set", "applications.platoon.application=hanging"])
    wait_until((folder / "hanging.sign").exists, "the application that hangs")
    refused = subprocess.run([*studio, "cancel", "1", *options], capture_output=True, text=True)
    assert refused.returncode == 2 and "--force" in refused.stderr and process.poll() is None
    ended = subprocess.run([*studio, "cancel", "1", *options, "--force"], capture_output=True, text=True)
    assert ended.returncode == 0 and "stopped" in ended.stdout and "did not react" in ended.stdout, ended.stderr
    assert process.wait(PATIENCE) == -signal.SIGKILL
