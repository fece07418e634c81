"""Faults: what is done to a studio that works, and what must be true afterwards.

Nothing that was finished is lost or changed, no process is left, no row says "running" of a run that is not, and the next run
gives the bits that the first one gave.
"""

import os
import random
import resource
import shutil
import signal
import socket
import sqlite3
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import psutil
from websockets.sync.client import connect

from tests.campaign.applications import APPLICATIONS
from tests.campaign.station import ORPHAN_TIME, QUICK, SCENARIO, Station, quick_run
from tests.campaign.table import Row
from tests.patience import PATIENCE, until

ANSWER_TIME = 1.0  # [s] for the server to tell what it knows while something hangs
END_TIME = 10.0  # [s] for a server to end at SIGTERM
NEXT_RUN = 2  # processes: a guard and its worker
SERVANTS = ("multiprocessing.resource_tracker", "multiprocessing.forkserver")  # of the server, for as long as it lives
OVER = ("done", "failed", "stopped", "killed")
LONG = {"clock.duration": 60}
ENDLESS = ("hanging", "deaf", "sleeping", "forking", "stopping")  # have to be stopped
LARGEST = 12_000_000  # [B] that a file may grow to: a short run finds room, a longer one does not


@dataclass(frozen=True)
class Fault:
    """One kind of fault: what is done, on which studio, and whether it is quick enough for the short form."""

    name: str
    do: Callable[[Station, random.Random], None]
    is_short: bool = False
    place: Callable[[Path], Any] | None = None  # a context that gives settings of the studio
    settings: dict[str, Any] = field(default_factory=dict)


# -- what must be true -------------------------------------------------------------------------------


def finished(station: Station) -> dict[int, tuple[str, str | None]]:
    """Status and hash of every run that is over, as the history tells them."""
    runs = station.client.get("/api/runs").json()
    return {each["run"]: (each["status"], each["state_hash"]) for each in runs if each["status"] in OVER}


def nobody_runs(station: Station) -> None:
    """No run is said to go on that does not."""
    live = {each["run"] for each in station.client.get("/api/live").json() if each["status"] not in OVER}
    until(
        lambda: {each["run"] for each in station.client.get("/api/runs").json() if each["status"] == "running"} <= live, "rows to be over"
    )


def at_rest(station: Station) -> None:
    """No more processes of runs are left, in time, than a server has that does nothing."""
    until(lambda: station.client.get("/api/info").json()["compiling"] is None, "everything to be compiled")
    with station.within(ORPHAN_TIME, "processes to end"):
        until(lambda: len(of_runs(station)) <= NEXT_RUN, "processes to end")


def of_runs(station: Station) -> list[psutil.Process]:
    """The processes that have begun with a run, and that of the next: neither the server nor a servant of it."""
    return [each for each in station.family() if not is_of_the_server(each, station)]


def is_of_the_server(process: psutil.Process, station: Station) -> bool:
    """Whether a process is the server or one that it has once. Who has ended is as good as one."""
    server = station.process.pid if station.process else 0
    try:
        return process.pid == server or (process.ppid() == server and any(each in str(process.cmdline()) for each in SERVANTS))
    except psutil.Error:
        return True


def answers(station: Station) -> None:
    """The server tells what it knows at once."""
    with station.within(ANSWER_TIME, "an answer"):
        station.client.get("/api/kinds").raise_for_status()


# -- applications --------------------------------------------------------------------------------------


def misbehaving(name: str) -> Callable[[Station, random.Random], None]:
    """A run with an application that misbehaves: it ends, by itself or when it is stopped, and leaves nobody."""

    def do(station: Station, chance: random.Random) -> None:
        run = station.live(name, set=LONG if name in ENDLESS else {"clock.duration": 2})
        if name in ENDLESS:
            time.sleep(1.0 + chance.random())
            for _ in range(chance.choice((0, 100))):
                station.client.post(f"/api/live/{run}/step")
            answers(station)
            assert station.client.post(f"/api/live/{run}/stop").status_code == 200
        assert station.over(run) in OVER
        at_rest(station)

    return do


# -- signals -------------------------------------------------------------------------------------------


def workers(station: Station) -> list[psutil.Process]:
    """The processes that work on runs: those that have no child of their own."""
    family = station.family()
    parents = {each.ppid() for each in family}
    assert station.process
    return [each for each in family if each.pid not in parents and not is_of_the_server(each, station)]


def to_worker(number: int) -> Callable[[Station, random.Random], None]:
    """A signal to every worker, at any moment of a run."""

    def do(station: Station, chance: random.Random) -> None:
        run = station.live(set=LONG, pace=5)
        time.sleep(chance.random())
        for each in workers(station):
            with suppress(psutil.Error):
                each.send_signal(number)
        if number == signal.SIGSTOP:
            answers(station)
            station.client.post(f"/api/live/{run}/stop")
        assert station.over(run) in OVER

    return do


def to_guard(station: Station, chance: random.Random) -> None:
    """kill -9 to whoever watches over a worker."""
    run = station.live(set=LONG, pace=5)
    time.sleep(chance.random())
    guards = {each.ppid() for each in workers(station)} - {os.getpid()}
    assert station.process
    for each in guards - {station.process.pid}:
        os.kill(each, signal.SIGKILL)
    assert station.over(run) in OVER


def to_nursery(station: Station, chance: random.Random) -> None:
    """kill -9 to whom the processes of runs are split off: a run that goes on ends, and the next has a process again."""
    quick_run(station)
    at_rest(station)
    quick_run(station)
    run = station.live(set=LONG, pace=5)
    time.sleep(chance.random())
    assert station.process
    [nursery] = [each for each in psutil.Process(station.process.pid).children() if SERVANTS[1] in str(each.cmdline())]
    nursery.kill()
    assert station.over(run) in OVER
    at_rest(station)


def to_server(number: int) -> Callable[[Station, random.Random], None]:
    """A signal to the server at any moment, with runs that go on, stand still, and have just ended."""

    def do(station: Station, chance: random.Random) -> None:
        kept = finished(station)
        station.live(set=LONG, pace=5)
        station.live(set=LONG, paused=True)
        if chance.random() < 0.5:
            station.live("hanging", set=LONG)
        last = station.live(set=QUICK)
        if chance.random() < 0.5:
            station.over(last)
            kept |= finished(station)
        time.sleep(0.5 * chance.random())
        ended(station, number)
        station.leaves_nobody()
        station.start()
        assert kept.items() <= finished(station).items(), "what was finished is lost or another"

    return do


def ended(station: Station, number: int) -> None:
    """The server has got a signal and has ended in time."""
    assert station.process
    with station.within(END_TIME, "the server to end"):
        station.process.send_signal(number)
        station.process.wait(PATIENCE)


def while_starting(station: Station, chance: random.Random) -> None:
    """kill -9 while a server starts."""
    ended(station, signal.SIGTERM)
    process = station.begin("--port", "0", *station.options, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(2 * chance.random())
    process.kill()
    process.wait()
    station.leaves_nobody()
    station.start()


def command_line(number: int) -> Callable[[Station, random.Random], None]:
    """A signal to a run of the command line, on the database of the server."""

    def do(station: Station, chance: random.Random) -> None:
        process = station.begin("run", f"scenarios/{SCENARIO}.yaml", "--db", str(station.db), stdout=subprocess.DEVNULL)
        time.sleep(3 * chance.random())
        process.send_signal(number)
        said = process.communicate()[1]
        assert number == signal.SIGKILL or "Traceback" not in said, said[-500:]

    return do


def without_a_reader(station: Station, chance: random.Random) -> None:
    """A command whose reader has gone, as in `studio list | head -1`: it ends, and says nothing of its own insides."""
    for words in (("list",), ("run", f"scenarios/{SCENARIO}.yaml", "--set", "clock.duration=0.2")):
        process = station.begin(*words, "--db", str(station.db))
        assert process.stdout and process.stderr
        process.stdout.close()
        said = process.stderr.read()
        process.wait(PATIENCE)
        assert "Traceback" not in said and "BrokenPipe" not in said, said[-1500:]


def without_cache(station: Station, chance: random.Random) -> None:
    """A server where no cache can be made says so in one sentence."""
    (station.folder / "no-folder").write_text("x")
    refused(
        station,
        "--port",
        "0",
        *station.options,
        says="made again",
        env=station.environment | {"STUDIO_CACHE": str(station.folder / "no-folder")},
    )


def on_a_taken_port(station: Station, chance: random.Random) -> None:
    """A second server on the port of the first says so in one sentence."""
    refused(station, "--port", str(station.client.base_url.port), *station.options, says="port")


def suspended(station: Station, chance: random.Random) -> None:
    """The server stands still for some seconds, as with a machine that sleeps: its runs go on, and end as usual."""
    run = station.live(set={"clock.duration": 20}, pace=8)
    assert station.process
    station.process.send_signal(signal.SIGSTOP)
    time.sleep(2.0 + 2.0 * chance.random())
    station.process.send_signal(signal.SIGCONT)
    answers(station)
    assert station.over(run) == "done"


def with_a_queue(number: int) -> Callable[[Station, random.Random], None]:
    """A signal to the server while runs wait for their turn: they are said to have left the queue, and none waits for ever."""

    def do(station: Station, chance: random.Random) -> None:
        kept = finished(station)
        first, *waiting = [station.live(set=LONG, pace=5) for _ in range(4)]
        assert station.status(waiting[0]) == "waiting" or station.status(first) in OVER
        time.sleep(0.5 * chance.random())
        ended(station, number)
        station.leaves_nobody()
        station.start()
        found = {each["run"]: each["status"] for each in station.client.get("/api/runs").json()}
        assert {found[each] for each in waiting} == {"cancelled"} and found[first] in OVER, found
        assert kept.items() <= finished(station).items(), "what was finished is lost or another"
        assert station.client.get("/api/queue").json() == []

    return do


def second_server(station: Station, chance: random.Random) -> None:
    """kill -9 of a second server on the same database: the runs of the first go on, and those of both are told rightly."""
    folder = station.folder / f"second-{chance.randrange(10**6)}"
    folder.mkdir()
    run = station.live(set={"clock.duration": 60}, pace=8)
    with Station(folder, db=station.db) as other:
        done, killed = other.live(set=QUICK), other.live(set=LONG, pace=5)
        assert other.over(done) == "done"
        other.kill()
        other.leaves_nobody()
    assert (station.over(run), station.over(killed), station.status(done)) == ("done", "killed", "done")


def while_importing(station: Station, chance: random.Random) -> None:
    """kill -9 of the server while a map is imported."""
    from tests.campaign import place

    station.client.post(f"/api/maps?name=here{chance.randrange(10**6)}.osm", content=place.xml()).raise_for_status()
    time.sleep(chance.random())
    ended(station, signal.SIGKILL)
    station.leaves_nobody()
    station.start()
    assert all(each["problem"] is None for each in station.client.get("/api/maps").json())


# -- the database --------------------------------------------------------------------------------------


@contextmanager
def held(db: Path) -> Iterator[None]:
    """The database is held by another program."""
    with closing(sqlite3.connect(db, timeout=30, isolation_level=None)) as connection:
        connection.execute("begin immediate")
        yield
        connection.execute("rollback")


def locked(station: Station, chance: random.Random) -> None:
    """Somebody holds the database for some seconds while a run begins and ends: it waits for that, and others are answered."""
    with held(station.db):
        asked = threading.Thread(target=quick_run, args=(station,))
        asked.start()
        time.sleep(1.0 + chance.random())
        answers(station)
        assert station.client.get("/api/runs").status_code == 200
    asked.join()


def locked_for_long(station: Station, chance: random.Random) -> None:
    """Somebody holds it for longer than anybody waits: the result waits beside it, and goes in with the next run."""
    run = station.live(set=QUICK, paused=True)
    with held(station.db):
        station.client.post(f"/api/live/{run}/resume")
        until(lambda: station.client.get(f"/api/live/{run}").json()["status"] in OVER, "the end of the run")
        row = station.row(run)
        assert (row["status"], "waits" in (row["error"] or "")) == ("done", True), row
    quick_run(station)
    assert {each["run"]: each["status"] for each in station.rows()}[run] == "done"


def many_writers(station: Station, chance: random.Random) -> None:
    """Eight programs write at once, while the server does: each has its number, and all of them are done."""
    count, run = len(finished(station)), station.live(set={"clock.duration": 20}, pace=8)
    command = ("run", f"scenarios/{SCENARIO}.yaml", "--set", "clock.duration=0.2", "--db", str(station.db))
    processes = [station.begin(*command, "--seed", str(each), stdout=subprocess.DEVNULL) for each in range(8)]
    said = [each.communicate(timeout=PATIENCE)[1] for each in processes]
    assert not [each for each in said if "Traceback" in each] and {each.returncode for each in processes} == {0}, said
    assert station.over(run) == "done" and len(finished(station)) == count + 9


def backed_up(station: Station, chance: random.Random) -> None:
    """A backup while runs go on and end: it is whole, and has all that was finished before."""
    kept, copy = finished(station), station.folder / f"backup-{chance.randrange(10**6)}.db"
    runs = [station.live(set=QUICK), station.live(set={"clock.duration": 20}, pace=8)]
    assert station.command("backup", str(copy), "--db", str(station.db))[0] == "0"
    with closing(sqlite3.connect(copy)) as connection:
        found = dict(connection.execute("select run, state_hash from runs where status in ('done', 'failed', 'stopped')"))
        assert connection.execute("pragma integrity_check").fetchall() == [("ok",)]
    assert {run: state for run, (status, state) in kept.items() if status == "done"}.items() <= found.items()
    assert [station.over(each) for each in runs] == ["done", "done"]


def doctored(station: Station, chance: random.Random) -> None:
    """The doctor mends what he can while runs go on: they are none of his business."""
    run = station.live(set=LONG, pace=8)
    station.command("doctor", "--yes", "--port", "9", "--db", str(station.db))
    assert station.status(run) == "running" or station.over(run) == "done"
    assert station.over(run) == "done"


def recordings(station: Station, run: int) -> list[Path]:
    """The folder in which a run is recorded, while it is."""
    return list(station.db.parent.glob(f"{station.db.name}.recording/run-{run}-*"))


def recording_gone(station: Station, chance: random.Random) -> None:
    """What a run records is taken away as it begins, or while it goes on: it ends, and says why."""
    run = station.live(set=LONG, pace=8)
    if chance.random() < 0.7:
        until(lambda: station.client.get(f"/api/live/{run}").json()["time"] > 1.0, "the run to go on")
    for each in recordings(station, run):
        shutil.rmtree(each)
    answers(station)
    assert station.over(run) in OVER
    told_plainly(station, run)


def recording_damaged(station: Station, chance: random.Random) -> None:
    """A worker is killed, and one of the files in which it has recorded is noise: it is set aside, or read as far as it goes."""
    run = station.live(set=LONG, pace=5)
    time.sleep(1.0 + chance.random())
    to_stop = workers(station)
    for each in to_stop:
        each.suspend()
    (folder,) = recordings(station, run)
    chosen = chance.choice(sorted(folder.iterdir()))
    chosen.write_bytes(chance.randbytes(chance.choice((0, 10, chosen.stat().st_size))))
    for each in to_stop:
        each.kill()
    until(lambda: not recordings(station, run), "the recording to be taken in, or to be set aside")
    assert station.over(run) in OVER
    told_plainly(station, run)


def killed_and_kept(station: Station, chance: random.Random) -> None:
    """kill -9 of a worker in the middle of a run: what it had recorded is there, as it was."""
    run = station.live(set=LONG, pace=5, seed=1)
    until(lambda: station.client.get(f"/api/live/{run}").json()["time"] > 2.0, "two seconds of the run")
    for each in workers(station):
        with suppress(psutil.Error):
            each.kill()
    assert station.over(run) in ("killed", "failed")
    trace = station.client.get(f"/api/runs/{run}/trace?channels=leader.speed").json()
    assert max(trace["time"]) > 1.5 and "is kept" in station.row(run)["error"]


def told_plainly(station: Station, run: int) -> None:
    """Why a run has ended is told in words."""
    error = station.row(run)["error"] or ""
    assert "Traceback" not in error, error[-1500:]
    for address in (f"/api/runs/{run}/trace?channels=leader.speed", f"/api/runs/{run}/events", "/api/runs", "/api/queue"):
        assert station.client.get(address).status_code in (200, 404, 503)


def damaged(how: Callable[[Path, random.Random], None]) -> Callable[[Station, random.Random], None]:
    """Something happens to the file while the server is up: it says so, stays up, and goes on when the file is back."""

    def do(station: Station, chance: random.Random) -> None:
        ended(station, signal.SIGTERM)
        with closing(sqlite3.connect(station.db)) as connection:
            connection.execute("pragma wal_checkpoint(truncate)")
        good = station.db.read_bytes()
        station.start()
        how(station.db, chance)
        for address in ("/api/runs", "/api/runs/1", "/api/runs/1/trace?channels=leader.speed", "/api/compare?a=1&b=1"):
            answer = station.client.get(address)
            assert answer.status_code in (200, 404, 503) and "Traceback" not in answer.text, answer.text[:300]
        answer = station.client.post("/api/runs", json={"scenario": SCENARIO, "set": QUICK})
        assert answer.status_code in (202, 503), answer.text[:300]
        ended(station, signal.SIGTERM)
        for rest in station.db.parent.glob(f"{station.db.name}-*"):
            rest.unlink()
        station.db.write_bytes(good)
        station.start()

    return do


def noise(db: Path, chance: random.Random) -> None:
    """Noise stands in it."""
    db.write_bytes(chance.randbytes(200_000))


def torn(db: Path, chance: random.Random) -> None:
    """The rest is missing."""
    os.truncate(db, chance.randrange(db.stat().st_size))


def gone(db: Path, chance: random.Random) -> None:
    """It is gone."""
    for each in db.parent.glob(f"{db.name}*"):
        if each.is_file():
            each.unlink()


def spotted(db: Path, chance: random.Random) -> None:
    """Some of its pages are noise."""
    with db.open("r+b") as file:
        for _ in range(5):
            file.seek(chance.randrange(100, db.stat().st_size))
            file.write(chance.randbytes(50))


def a_folder(db: Path, chance: random.Random) -> None:
    """A folder stands in its place."""
    gone(db, chance)
    db.mkdir()
    threading.Timer(3.0, db.rmdir).start()


def begun_on_noise(station: Station, chance: random.Random) -> None:
    """A server that is started on what is no database says so in one sentence."""
    bad = station.folder / "noise.db"
    bad.write_bytes(chance.randbytes(chance.choice((1, 100, 100_000))))
    refused(station, "--port", "0", "--no-browser", "--db", str(bad), says="noise.db")


def refused(station: Station, *words: str, says: str, **how: Any) -> None:
    """A command that is refused, and says why."""
    said = station.command(*words, **how)
    assert said[0] != "0" and says in said, said[-500:]


# -- the disk ------------------------------------------------------------------------------------------


@contextmanager
def small_disk(folder: Path, options: str = "size=40m") -> Iterator[dict[str, Any]]:
    """A small disk of its own for the database."""
    disk = folder / "disk"
    disk.mkdir()
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "campaign", str(disk)], capture_output=True, text=True)
    if done.returncode:
        raise PermissionError(f"no disk can be mounted here: {done.stderr.strip()}")
    try:
        yield {"db": disk / "runs.db", "XDG_STATE_HOME": str(disk / "state")}
    finally:
        until(lambda: subprocess.run(["umount", str(disk)], capture_output=True).returncode == 0, "the disk to be free")


def full(station: Station, chance: random.Random) -> None:
    """The disk is full when a run begins, or ends: that is told, the history can be read; with room again all is as before."""
    run = station.live(set=QUICK, paused=True)
    ballast = station.db.with_name("ballast")
    fill(ballast, station.db.parent)
    station.client.post(f"/api/live/{run}/resume")
    until(lambda: station.client.get(f"/api/live/{run}").json()["status"] in OVER, "the end of the run")
    assert station.client.get("/api/runs").status_code == 200
    told = station.client.post("/api/live", json={"scenario": SCENARIO, "set": QUICK})
    assert told.status_code in (201, 503), told.text[:300]
    if told.status_code == 201:
        until(lambda: station.client.get(f"/api/live/{told.json()['run']}").json()["status"] in OVER, "the end of the run")
    ballast.unlink()


def full_in_the_middle(station: Station, chance: random.Random) -> None:
    """The disk is full in the middle of a run: it ends and says so; with room again, what it had recorded is there."""
    run = station.live(set={"clock.duration": 600}, pace="fast")
    time.sleep(chance.random())
    ballast = station.db.with_name("ballast")
    fill(ballast, station.db.parent)
    until(lambda: station.client.get(f"/api/live/{run}").json()["status"] in OVER, "the end of the run")
    assert station.client.get("/api/runs").status_code == 200
    answers(station)
    ballast.unlink()
    assert quick_run(station) == station.first
    row = station.row(run)
    assert row["status"] == "failed" and "room" in row["error"] and "Traceback" not in row["error"], row
    assert station.client.get(f"/api/runs/{run}/trace?channels=leader.speed").status_code == 200


def fill(ballast: Path, disk: Path) -> None:
    """Leaves no room on a disk."""
    room = os.statvfs(disk)
    with suppress(OSError), ballast.open("wb") as file:
        for _ in range(room.f_bavail * room.f_frsize // 4096 + 1):
            file.write(bytes(4096))
            file.flush()


def no_names(station: Station, chance: random.Random) -> None:
    """No file can be made any more."""
    made = [station.db.with_name(f"x{i}") for i in range(1000)]
    with suppress(OSError):
        for each in made:
            each.touch()
    assert station.client.get("/api/runs").status_code in (200, 503)
    station.client.post("/api/runs", json={"scenario": SCENARIO, "set": QUICK})
    for each in made:
        each.unlink(missing_ok=True)


def short_files() -> None:
    """In the server, before it begins: no file may grow beyond this."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST, LARGEST))


def files_that_cannot_grow(station: Station, chance: random.Random) -> None:
    """Runs whose recordings, or the database, cannot grow any more: that is told, and the history can be read."""
    for _ in range(6):
        run = station.client.post("/api/live", json={"scenario": SCENARIO, "set": LONG, "pace": "fast"})
        assert run.status_code in (201, 503), run.text[:300]
        if run.status_code == 201:
            number = run.json()["run"]
            until(lambda number=number: station.client.get(f"/api/live/{number}").json()["status"] in OVER, "the end of the run")
        assert station.client.get("/api/runs").status_code == 200
    rows = station.client.get("/api/runs").json()
    assert not [each for each in rows if each["status"] == "running"], rows
    assert [each for each in rows if each["status"] == "failed" and "room" in (each["error"] or "")], rows


def few_descriptors() -> None:
    """In the server, before it begins."""
    resource.setrlimit(resource.RLIMIT_NOFILE, (90, 90))


def crowd(station: Station, chance: random.Random) -> None:
    """More connections than there are descriptors: when they are gone, all is as before."""
    place = (station.client.base_url.host, station.client.base_url.port)
    lines: list[socket.socket] = []
    with suppress(OSError):
        lines.extend(socket.create_connection(place, timeout=1) for _ in range(200))
    time.sleep(0.5)
    for each in lines:
        each.close()
    until(lambda: is_answered(station), "an answer")


def is_answered(station: Station) -> bool:
    """Whether the server answers; a line that it could not take is closed without a word."""
    try:
        return station.client.get("/api/info").status_code == 200
    except httpx.TransportError:
        return False


# -- the line ------------------------------------------------------------------------------------------


def address_of(station: Station, run: int) -> str:
    """The socket of a live run."""
    return f"{str(station.client.base_url).replace('http', 'ws')}/api/live/{run}/socket".replace("//api", "/api")


def lost_sockets(station: Station, chance: random.Random) -> None:
    """Pages that listen are gone without a word; the run goes on."""
    run = station.live(set=LONG, pace=8)
    for _ in range(5):
        listener = connect(address_of(station, run), origin=None)
        listener.recv()
        listener.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
        listener.socket.close()
    answers(station)
    station.client.post(f"/api/live/{run}/stop")
    assert station.over(run) == "stopped"


def slow_reader(station: Station, chance: random.Random) -> None:
    """A page that listens and reads nothing; the run goes on, others are answered, and what is kept for it is bounded."""
    run = station.live(set={"clock.duration": 120})
    host, port = station.client.base_url.host, station.client.base_url.port
    line = socket.create_connection((host, port))
    line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    head = f"GET /api/live/{run}/socket HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\n"
    line.sendall(f"{head}Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
    before = station.held().memory
    assert station.over(run) == "done"
    answers(station)
    assert station.held().memory < before + 200, "what a slow page has not read fills the memory"
    line.close()


def slow_askers(station: Station, chance: random.Random) -> None:
    """Many who never come to the end of their question."""
    lines = [socket.create_connection((station.client.base_url.host, station.client.base_url.port)) for _ in range(100)]
    for each in lines:
        each.sendall(b"POST /api/runs HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 1000000\r\n")
    answers(station)
    quick_run(station)
    for each in lines:
        each.close()


def upload_that_breaks_off(station: Station, chance: random.Random) -> None:
    """A map that does not come to its end leaves nothing."""
    before = sorted(each.name for each in (station.folder / "scenarios" / "maps").iterdir())
    with socket.create_connection((station.client.base_url.host, station.client.base_url.port)) as line:
        line.sendall(
            b"POST /api/maps?name=half.osm HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 5000000\r\n\r\n"
            + bytes(chance.randrange(100_000))
        )
    until(lambda: sorted(each.name for each in (station.folder / "scenarios" / "maps").iterdir()) == before, "nothing to be left")


# -- the clock, and files ------------------------------------------------------------------------------


@contextmanager
def own_clock(folder: Path) -> Iterator[dict[str, Any]]:
    """A clock that can be stepped."""
    yield {"PYTHONPATH": str(Path(__file__).parent / "clock"), "STUDIO_CAMPAIGN_CLOCK": str(folder / "clock")}


def stepped(seconds: float) -> Callable[[Station, random.Random], None]:
    """The clock is stepped while a run goes on: it still goes on, and ends as usual."""

    def do(station: Station, chance: random.Random) -> None:
        run = station.live(set={"clock.duration": 4}, pace=2)
        (station.folder / "clock").write_text(str(seconds * chance.random()))
        time.sleep(0.5)
        assert station.status(run) == "running"
        assert station.over(run) == "done"

    return do


def files_gone(station: Station, chance: random.Random) -> None:
    """Scenario, map and kinds are gone while a run goes on: it ends as usual, and others are told."""
    run = station.live(set=LONG, pace=8)
    away = station.folder / "away"
    for name in ("scenarios", "kinds"):
        (station.folder / name).rename(station.folder / f"{away.name}-{name}")
    assert station.client.get("/api/scenarios").status_code == 200
    assert station.client.post("/api/live", json={"scenario": SCENARIO}).status_code == 404
    for name in ("scenarios", "kinds"):
        (station.folder / f"{away.name}-{name}").rename(station.folder / name)
    assert station.over(run) == "done"


def scenario_torn(station: Station, chance: random.Random) -> None:
    """A scenario is written by another program while it is read."""
    path = station.folder / "scenarios" / "patched.yaml"
    good = path.read_bytes()
    for _ in range(20):
        path.write_bytes(good[: chance.randrange(len(good))])
        answer = station.client.get("/api/scenarios/patched")
        assert answer.status_code in (200, 404, 422), answer.text[:300]
    path.write_bytes(good)


FAULTS = (
    *(
        Fault(f"worker: {each.name}", to_worker(each), each == signal.SIGKILL)
        for each in (signal.SIGKILL, signal.SIGTERM, signal.SIGSTOP, signal.SIGSEGV, signal.SIGHUP)
    ),
    Fault("guard: SIGKILL", to_guard),
    Fault("who runs are split off from: SIGKILL", to_nursery, True),
    Fault("worker: SIGKILL, and what it had recorded", killed_and_kept, True),
    *(
        Fault(f"server: {each.name}", to_server(each), each == signal.SIGKILL)
        for each in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
    ),
    Fault("server: SIGSTOP for a while", suspended),
    *(
        Fault(f"server with a queue: {each.name}", with_a_queue(each), False, None, {"more": ("--at-once", "1")})
        for each in (signal.SIGKILL, signal.SIGTERM)
    ),
    Fault("second server: SIGKILL", second_server),
    Fault("server on a port that is taken", on_a_taken_port),
    Fault("server without a cache", without_cache),
    Fault("server: SIGKILL while it starts", while_starting),
    Fault("server: SIGKILL while it imports a map", while_importing),
    *(Fault(f"command line: {each.name}", command_line(each)) for each in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)),
    Fault("command line without a reader", without_a_reader),
    Fault("eight programs write at once", many_writers),
    Fault("backup while runs go on", backed_up),
    Fault("doctor while runs go on", doctored),
    Fault("recording gone", recording_gone),
    Fault("recording damaged", recording_damaged),
    Fault("database held by another", locked, True),
    Fault("database held for longer than anybody waits", locked_for_long),
    *(
        Fault(f"database: {name}", damaged(how))
        for name, how in {
            "noise": noise,
            "cut off": torn,
            "gone": gone,
            "noise in some pages": spotted,
            "a folder instead": a_folder,
        }.items()
    ),
    Fault("server started on noise", begun_on_noise, True),
    Fault("full disk", full, False, small_disk),
    Fault("disk that fills up in a run", full_in_the_middle, False, lambda folder: small_disk(folder, "size=240m")),
    Fault("no room for names on the disk", no_names, False, lambda folder: small_disk(folder, "size=40m,nr_inodes=30")),
    Fault("files that cannot grow", files_that_cannot_grow, False, None, {"before": short_files}),
    Fault("more connections than descriptors", crowd, False, None, {"before": few_descriptors}),
    Fault("sockets lost", lost_sockets, True),
    Fault("slow reader", slow_reader),
    Fault("questions without an end", slow_askers),
    Fault("upload that breaks off", upload_that_breaks_off),
    Fault("clock stepped forwards", stepped(86400.0), False, own_clock),
    Fault("clock stepped backwards", stepped(-86400.0), False, own_clock),
    Fault("scenarios, maps and kinds gone", files_gone),
    Fault("scenario torn", scenario_torn, True),
    *(Fault(f"application: {name}", misbehaving(name), name == "interrupting") for name in ("raising", "hanging", *APPLICATIONS)),
)


def campaign(fault: Fault, folder: Path, *, seed: int, count: int) -> Row:
    """Tries a kind of fault that needs a studio of its own."""
    with (fault.place or nowhere_special)(folder) as special, Station(folder, **fault.settings, **special) as station:
        return on(station, fault, seed=seed, count=count)


@contextmanager
def nowhere_special(folder: Path) -> Iterator[dict[str, Any]]:
    """No special settings."""
    yield {}


def on(station: Station, fault: Fault, *, seed: int, count: int, seconds: float = 1e9) -> Row:
    """Tries one kind of fault so many times, on a studio."""
    row, end = Row("faults", fault.name, seed), time.monotonic() + seconds
    chance = random.Random(f"{seed}/{fault.name}")
    station.first = station.first or quick_run(station)
    for number in range(count):
        if number == 0 or time.monotonic() < end:
            with row.trying("as before"):
                tried(fault, station, chance)
    row.late, station.late = station.late, []
    return row


def tried(fault: Fault, station: Station, chance: random.Random) -> None:
    """One try, and what must be true afterwards."""
    kept, said = finished(station), len(station.log())
    fault.do(station, chance)
    assert kept.items() <= finished(station).items(), "what was finished is lost or another"
    nobody_runs(station)
    if fault.settings.get("before") is not short_files:
        assert quick_run(station) == station.first, "another result than before"
    new = station.log()[said:]
    assert "Traceback" not in new, f"a traceback in the server's log: {new[-1500:]}"


def rows(root: Path, *, seed: int, count: int, seconds: float = 1e9, only: str = "") -> Iterator[Row]:
    """All kinds of faults: those that need nothing special on one studio, which is another when a fault was too much for it."""
    chosen = [each for each in FAULTS if only in each.name]
    shared: Station | None = None
    try:
        for number, fault in enumerate(chosen):
            folder = root / str(number)
            try:
                if fault.place or fault.settings:
                    row = campaign(fault, made(folder), seed=seed, count=count)
                else:
                    shared = shared or Station(made(folder)).start()
                    row = on(shared, fault, seed=seed, count=count, seconds=seconds)
            except PermissionError as error:
                row = Row("faults", fault.name, seed)
                row.came[f"not tried: {error}"] += 1
            except Exception as error:
                row = Row("faults", fault.name, seed)
                row.blame(f"{type(error).__name__}: {str(error)[-1500:]}")
            if row.wrongs and shared:
                shared = closed(shared)
            yield row
        if shared:
            yield last(shared, seed)
    finally:
        if shared:
            closed(shared)


def made(folder: Path) -> Path:
    """A new folder."""
    folder.mkdir()
    return folder


def closed(station: Station) -> None:
    """Ends a studio that cannot be used any more."""
    station.__exit__()


def last(station: Station, seed: int) -> Row:
    """The end of a studio that has been through all that: in time, and nobody is left."""
    row = Row("faults", "the end of the server after all of them", seed)
    with row.trying("nobody left"):
        ended(station, signal.SIGTERM)
        station.leaves_nobody()
    return row
