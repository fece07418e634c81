"""Live runs: orders, news, what a crash leaves behind."""

import gc
import json
import os
import signal
import time
from math import inf

import psutil
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from studio.process import Child, spawn
from studio.server import live, serve, worker
from studio.server.news import News
from studio.store.runs import read_runs
from tests.broken import HANGING
from tests.patience import PATIENCE
from tests.patience import until as wait_until
from tests.server.server import served

SCENARIO = "grosser_stern_platoon"
LONG = {"clock.duration": 600}  # no run that is looked at ends before that


def start(client, **options):
    answer = client.post("/api/live", json={"scenario": SCENARIO, **options})
    assert answer.status_code == 201, answer.text
    return answer.json()["run"]


def news(client, run, **options):
    """The socket of a live run."""
    address = str(client.base_url).replace("http", "ws").rstrip("/")
    return connect(f"{address}/api/live/{run}/socket", open_timeout=PATIENCE, ping_timeout=PATIENCE, **options)


def described(text):
    """A message, which the description of the API knows with all that it holds."""
    message = json.loads(text)
    assert News.model_validate(message, strict=True).model_dump(mode="json") == message
    return message


def until(socket, wanted):
    """Messages up to the first that is wanted."""
    seen, end = [], time.monotonic() + PATIENCE
    while time.monotonic() < end:
        seen.append(described(socket.recv(timeout=PATIENCE)))
        if wanted(seen[-1]):
            return seen
    raise AssertionError(f"waited in vain; last: {seen[-1:]}")


def is_state(status):
    return lambda message: message["type"] == "state" and message["status"] == status


def test_pause_step_pace_stop(client):
    run = start(client, set=LONG, paused=True)
    with news(client, run) as socket:
        paused = until(socket, is_state("paused"))[-1]
        assert paused["time"] == 0.0 and paused["duration_s"] == 600
        client.post(f"/api/live/{run}/step")
        assert until(socket, lambda m: m["type"] == "state" and m["time"] > 0)[-1]["time"] == pytest.approx(0.02)
        client.post(f"/api/live/{run}/pace", json={"pace": 8})
        client.post(f"/api/live/{run}/resume")
        running = until(socket, lambda m: m["type"] == "state" and m["time"] > 2)[-1]
        assert running["pace"] == 8
        client.post(f"/api/live/{run}/stop")
        end = until(socket, lambda m: m["type"] == "end")[-1]
    assert end["status"] == "stopped"
    row = client.get(f"/api/runs/{run}").json()
    assert row["status"] == "stopped" and row["metrics"]["min_gap"]["value"] > 0 and row["sim_time_s"] < 600
    assert client.post(f"/api/live/{run}/pause").status_code == 409


def test_pauses_are_no_part_of_how_long_it_took(client):
    began = time.monotonic()
    run = start(client, set={"clock.duration": 1}, paused=True, pace="fast")
    with news(client, run) as socket:
        until(socket, is_state("paused"))
        time.sleep(3.0)
        client.post(f"/api/live/{run}/resume")
        until(socket, lambda m: m["type"] == "end")
    row = client.get(f"/api/runs/{run}").json()
    assert row["status"] == "done" and 0.0 < row["wall_time_s"] < time.monotonic() - began - 2.9


def test_pace_is_kept(client):
    """At pace 2 nothing happens earlier than at twice the real time, and it goes on; how late depends on the machine."""
    began = time.monotonic()
    run = start(client, set=LONG, pace=2)
    seen = []
    with news(client, run) as socket:
        while not seen or seen[-1][1] < 5:
            state = until(socket, lambda m: m["type"] == "state")[-1]
            seen.append((time.monotonic() - began, state["time"]))
            assert state["pace"] == 2
    client.post(f"/api/live/{run}/stop")
    assert all(simulated <= 2 * real for real, simulated in seen)


def test_samples_and_events(client):
    """As fast as possible; a late listener gets everything so far."""
    run = start(client, set={"clock.duration": 22}, pace="fast")
    with news(client, run) as socket:
        until(socket, lambda m: m["type"] == "end")
    with news(client, run) as late:
        seen = until(late, lambda m: m["type"] == "end")
    channels, samples = seen[:2]
    assert {"name": "follower_1.front.range", "unit": "m", "label": "Range of front"} in channels["channels"]
    assert samples["channels"].keys() == {each["name"] for each in channels["channels"]}
    assert len(samples["channels"]["follower_1.front.range"]) == len(samples["time"])
    assert samples["type"] == "samples" and samples["time"][0] == 0 and samples["time"][-1] == pytest.approx(22)
    assert len(samples["channels"]["follower_1.gap"]) == len(samples["time"]) > 200
    assert any(
        each["type"] == "event" and each["kind"] == "script_begun" and "hard_brake" in each["text"] and each["time"] == 20 for each in seen
    )


def test_what_is_told_live_is_what_is_kept(client):
    """Dangers too, which are told when they are over, or at the end of the run."""
    run = start(client, set={"clock.duration": 5, "script.hard_brake.when.at": 0.5, "script.hard_brake.do.deceleration": 8}, pace="fast")
    with news(client, run) as socket:
        seen = until(socket, lambda m: m["type"] == "end")
    live = sorted((each["time"], each["kind"], each["text"]) for each in seen if each["type"] == "event")
    kept = sorted((each["time"], each["kind"], each["text"]) for each in client.get(f"/api/runs/{run}").json()["events"])
    assert live == kept and "hard_brake" in [kind for _, kind, _ in live]


def test_a_live_run_has_the_bits_of_any_other(client):
    changes = {"clock.duration": 3}
    run = start(client, set=changes, pace=8)
    with news(client, run) as socket:
        until(socket, lambda m: m["type"] == "end")
    again = start(client, set=changes, pace="fast")
    with news(client, again) as socket:
        until(socket, lambda m: m["type"] == "end")
    hashes = {client.get(f"/api/runs/{each}").json()["state_hash"] for each in (run, again)}
    assert len(hashes) == 1


def test_an_application_that_raises_fails_its_run_only(client):
    run = start(client, set={"applications.platoon.application": "broken"}, pace="fast")
    with news(client, run) as socket:
        end = until(socket, lambda m: m["type"] == "end")[-1]
    assert end["status"] == "failed" and "the idea was not so good" in end["error"]
    assert "broken.py" in client.get(f"/api/runs/{run}").json()["error"]
    assert client.get("/api/info").status_code == 200


def test_a_process_that_is_killed_ends_its_run_only(client, server):
    run = start(client, set=LONG)
    with news(client, run) as socket:
        until(socket, lambda m: m["type"] == "state" and m["time"] > 0.5)
        for child in psutil.Process(server[2].pid).children(recursive=True):
            if any(each.path.endswith("runs.db") for each in child.open_files()):
                os.kill(child.pid, signal.SIGKILL)
        end = until(socket, lambda m: m["type"] == "end")[-1]
    assert end["status"] == "failed" and "-9" in end["error"]
    assert client.get(f"/api/runs/{run}").json()["status"] == "killed"
    assert client.get("/api/info").status_code == 200


def test_the_scene_shows_a_scenario_and_a_run(client):
    cast = client.post("/api/scene", json={"scenario": SCENARIO}).json()
    assert [each["name"] for each in cast["vehicles"][:2]] == ["leader", "follower_1"] and len(cast["vehicles"]) == 25
    assert cast["attribution"] == "© OpenStreetMap contributors"
    run = start(client, set=LONG)
    assert len(client.post("/api/scene", json={"run": run}).json()["vehicles"]) == 25
    client.post(f"/api/live/{run}/stop")


def test_a_foreign_page_cannot_listen(client):
    run = start(client, set={"clock.duration": 1}, pace="fast")
    for path in (f"/api/live/{run}/socket", "/scene/"):
        address = str(client.base_url).replace("http", "ws").rstrip("/") + path
        with pytest.raises(InvalidStatus) as refusal, connect(address, origin="http://evil.example", open_timeout=PATIENCE):
            pass
        assert refusal.value.response.status_code == 403


def test_an_unknown_live_run(client):
    with news(client, 999) as socket:
        assert "999" in json.loads(socket.recv(timeout=PATIENCE))["message"]


def test_the_scene_may_change_while_a_run_goes_on(client):
    """Another cast on stage must not disturb a run whose frames keep coming."""
    run = start(client, set=LONG)
    client.post("/api/scene", json={"run": run})
    for count in (3, 20, 0):
        answer = client.post("/api/scene", json={"scenario": SCENARIO, "set": {"traffic.count": count}})
        assert len(answer.json()["vehicles"]) == 5 + count
        client.post("/api/scene", json={"run": run})
    with news(client, run) as socket:
        before = until(socket, is_state("running"))[-1]["time"]
        until(socket, lambda m: m["type"] == "state" and m["time"] > before + 1)
        client.post(f"/api/live/{run}/stop")
        assert until(socket, lambda m: m["type"] == "end")[-1]["status"] == "stopped"


def test_steps_end_with_the_run(client):
    run = start(client, set={"clock.duration": 0.04}, paused=True)
    for _ in range(6):
        client.post(f"/api/live/{run}/step")
    with news(client, run) as socket:
        until(socket, lambda m: m["type"] == "end")
    assert client.get(f"/api/runs/{run}").json()["sim_time_s"] == 0.04


def test_an_application_that_hangs_can_be_stopped(client, server):
    hangs = server[1].parent / "kinds" / "hanging.sign"
    run = start(client, set={"applications.platoon.application": "hanging"})
    with news(client, run) as socket:
        wait_until(hangs.exists, "the application that hangs")
        client.post(f"/api/live/{run}/stop")
        end = until(socket, lambda m: m["type"] == "end")[-1]
    assert end["status"] == "stopped" and "did not react" in end["error"]
    assert client.get(f"/api/runs/{run}").json()["status"] == "stopped"


def test_an_application_that_hangs_holds_up_nobody_and_ends_with_the_server(tmp_path, sample):
    """However many orders it gets; and when the server is killed, the next one finds its row."""
    folder = tmp_path / "kinds"
    folder.mkdir()
    (folder / "hanging.py").write_text(HANGING)
    options = ("--kinds", folder, "--scenarios", sample.parent)
    with served(tmp_path, *options) as (client, _, process):
        run = start(client, set={"applications.platoon.application": "hanging"})
        wait_until((folder / "hanging.sign").exists, "the application that hangs")
        steps = [client.post(f"/api/live/{run}/step") for _ in range(600)]
        assert {each.status_code for each in steps} == {200, 422} and "does not react" in steps[-1].text
        assert client.get("/api/kinds").status_code == 200
        left = psutil.Process(process.pid).children(recursive=True)
        process.kill()
        wait_until(lambda: not any(each.is_running() and each.status() != psutil.STATUS_ZOMBIE for each in left), "the end of all")
    with served(tmp_path, *options) as (client, _, _):
        assert client.get(f"/api/runs/{run}").json()["status"] == "killed"


@pytest.mark.parametrize("says", ["running", "stopped"])
def test_a_run_that_has_stopped_is_not_ended_while_it_saves(says, tmp_path):
    """However long that takes; one that does not react is."""
    process = Child.begin(sleep)
    run = live.LiveRun(1, SCENARIO, 60.0, process, lambda *news: None, None, tmp_path / "runs.db")
    run.on_state_news(says, 3.0, 1.0, 1.0)
    run.give_up()
    if says == "running":
        wait_until(lambda: not process.is_alive(), "the end of the process")
        assert process.exit_code() == -signal.SIGKILL and run.given_up
    else:
        assert process.is_alive() and not run.given_up
    process.end(0.0)


def test_a_run_without_room_to_begin_says_so_in_words(sample, tmp_path, monkeypatch):
    monkeypatch.setattr("studio.store.recording.MOST", 10.0)
    ours, line = spawn.Pipe()
    text = sample.read_text(encoding="utf-8")
    worker.start(line, worker.Order(sample, text, {}, None, None, inf, paused=False, db=tmp_path / "runs.db"))
    (began, run, _), (ended, status, why) = ours.recv(), ours.recv()
    assert (began, run, ended, status) == ("begun", 1, "end", "failed")
    assert "record" in why and "Traceback" not in why
    row = read_runs(tmp_path / "runs.db").find(1)
    assert (row.status, row.error) == ("failed", why)


def sleep(line):
    """A process that does not react."""
    time.sleep(PATIENCE)


def test_a_spare_process_that_died_is_replaced(client, server):
    """The one that is killed is what is left when the only run is over."""
    over = ("done", "stopped", "failed")
    wait_until(
        lambda: len(workers(server)) <= 1 and all(each["status"] in over for each in client.get("/api/live").json()), "the end of all"
    )
    run = start(client, set=LONG, paused=True)
    wait_until(lambda: len(workers(server)) == 2, "the process that waits for the next run")
    client.post(f"/api/live/{run}/stop")
    (spare,) = wait_until(lambda: len(left := workers(server)) == 1 and left, "the end of the run's process")
    spare.kill()
    run = start(client, set={"clock.duration": 0.1}, pace="fast")
    with news(client, run) as socket:
        assert until(socket, lambda m: m["type"] == "end")[-1]["status"] == "done"


def test_nothing_is_left_of_runs_that_are_over(client, server):
    """Neither descriptors nor threads in the server, nor more than some of their news."""
    wait_until(
        lambda: client.get("/api/info").json()["compiling"] is None, "the end of the warm-up: what processes are split off starts then"
    )
    own = psutil.Process(server[2].pid)
    left = []
    for _ in range(live.MOST_OVER + 3):
        run = start(client, set={"clock.duration": 0.02}, pace="fast")
        with news(client, run) as socket:
            until(socket, lambda m: m["type"] == "end")
        wait_until(lambda: len(workers(server)) == 1, "the process that waits for the next run")
        left.append((own.num_fds(), own.num_threads()))
    del left[0]  # after which it has started
    wait_until(lambda: own.num_fds() <= left[0][0] and own.num_threads() <= left[0][1], f"what was there before: {left}")
    assert len(client.get("/api/live").json()) <= live.MOST_OVER + 1
    assert client.get(f"/api/live/{run}").status_code == 200


def workers(server):
    """The processes of live runs, and the one that waits."""
    children = psutil.Process(server[2].pid).children()
    split = [each for origin in children if "forkserver" in command(origin) for each in origin.children()]
    return [each for each in children if "spawn_main" in command(each)] + split


def command(process):
    """How a process was started; "" when it has just gone."""
    try:
        return " ".join(process.cmdline())
    except psutil.Error:
        return ""


def test_what_requests_leave_is_cleared_up_soon(tmp_path, sample):
    """Each leaves things that refer to each other: a server that waits for very many of them seems to grow for hours."""
    before = gc.get_threshold()
    try:
        serve.inner(tmp_path / "runs.db", sample.parent, None, 1)
        assert gc.get_threshold()[0] == serve.COLLECTED_AFTER < 5000 and gc.get_freeze_count()
    finally:
        gc.unfreeze()
        gc.set_threshold(*before)
