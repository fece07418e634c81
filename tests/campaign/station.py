"""A studio in a process of its own, as a user starts it, that may be killed and started again; and what it holds."""

import os
import re
import shutil
import sqlite3
import subprocess
import sys
import threading
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

import httpx
import psutil

from tests.broken import BROKEN, HANGING
from tests.campaign.applications import APPLICATIONS
from tests.patience import PATIENCE, until

ROOT = Path(__file__).parent.parent.parent
SCENARIO = "motorway_platoon"
QUICK = {"clock.duration": 0.2}
NEXT_RUN = 2  # processes: a guard and its worker
SERVANTS = ("multiprocessing.resource_tracker", "multiprocessing.forkserver")  # of the server, for as long as it lives
ORPHAN_TIME = 5.0  # [s] for everything that a server has started to be gone
NOBODY = "http://127.0.0.1:9"  # no map server there


class Held(NamedTuple):
    """What a server holds."""

    memory: float  # [MB] that is its own
    descriptors: float
    threads: float
    processes: float


class Station:
    """A folder with scenarios and kinds, and the server in it. Everything that it starts can be told by a mark."""

    def __init__(
        self,
        folder: Path,
        *,
        before: Callable[[], None] | None = None,
        db: Path | None = None,
        more: tuple[str, ...] = (),
        **environment: str,
    ) -> None:
        self.folder, self.db, self.mark, self.before = folder, db or folder / "runs.db", uuid.uuid4().hex, before
        self.options = ("--no-browser", "--db", str(self.db), *more)
        self.environment = {
            **os.environ,
            "STUDIO_OVERPASS": NOBODY,
            "STUDIO_NOMINATIM": NOBODY,
            "STUDIO_CAMPAIGN": self.mark,
            "XDG_STATE_HOME": str(folder / "state"),
            **environment,
        }
        furnish(folder)
        self.process: subprocess.Popen[str] | None = None
        self.late: list[str] = []
        self.first = ""  # what a run has given when all was well
        self.client = httpx.Client(timeout=PATIENCE)

    # -- its life ------------------------------------------------------------------------------------

    def start(self) -> "Station":
        """Starts the server and waits until it answers."""
        with (self.folder / "server.log").open("a") as log:
            self.process = self.begin("--port", "0", "--kinds", "kinds", *self.options, stderr=log, preexec_fn=self.before)
        assert self.process.stdout
        said = self.process.stdout.readline()
        found = re.search(r"http://\S+", said)
        assert found, f"no address: {said} {self.log()}"
        threading.Thread(
            target=deque, args=(self.process.stdout, 0), daemon=True
        ).start()  # what applications print is read, as in a terminal
        self.client.base_url = httpx.URL(found.group())
        self.client.get("/api/scenarios").raise_for_status()
        return self

    def begin(self, *words: str, **how: Any) -> subprocess.Popen[str]:
        """Begins a command of the studio in its folder, with what it says in pipes."""
        usual = {"env": self.environment, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        return subprocess.Popen([sys.executable, "-m", "studio.cli", *words], cwd=self.folder, text=True, **usual | how)

    def command(self, *words: str, **how: Any) -> str:
        """The same, and waits for its end: what it has said of what is wrong, with what it has ended with."""
        process = self.begin(*words, **how)
        said = process.communicate(timeout=PATIENCE)[1]
        assert "Traceback" not in said, said[-1500:]
        return f"{process.returncode} {said}"

    def kill(self) -> None:
        """kill -9."""
        assert self.process
        self.process.kill()
        self.process.wait()

    def terminate(self) -> float:
        """SIGTERM; the seconds until it has ended."""
        assert self.process
        began = time.monotonic()
        self.process.terminate()
        self.process.wait(PATIENCE)
        return time.monotonic() - began

    def __enter__(self) -> "Station":
        return self.start()

    def __exit__(self, *_: object) -> None:
        if self.process and self.process.poll() is None:
            self.terminate()
        for each in self.family():
            with suppress(psutil.Error):
                each.kill()
        self.client.close()

    # -- what is asked of it ---------------------------------------------------------------------------

    def live(self, application: str = "", **wanted: Any) -> int:
        """Begins a live run, with an application of one's own in it; its number."""
        changes = wanted.pop("set", {}) | (
            {"applications.platoon": {"application": application, "units": ["leader"]}} if application else {}
        )
        answer = self.client.post("/api/live", json={"scenario": SCENARIO, "pace": "fast", "set": changes} | wanted)
        assert answer.status_code == 201, answer.text
        return answer.json()["run"]

    def status(self, run: int) -> str:
        """What the history says of a run."""
        return self.row(run)["status"]

    def row(self, run: int) -> dict[str, Any]:
        """All that it says."""
        answer = self.client.get(f"/api/runs/{run}")
        assert answer.status_code == 200, answer.text[:1000]
        return answer.json()

    def over(self, run: int) -> str:
        """Waits for the end of a run; how it ended."""
        return until(lambda: (found := self.status(run)) != "running" and found, f"the end of run {run}")

    def at(self, run: int, status: str) -> None:
        """Waits until a live run says so."""
        until(lambda: self.client.get(f"/api/live/{run}").json()["status"] == status, f"run {run} to be {status}")

    # -- what it leaves --------------------------------------------------------------------------------

    def log(self) -> str:
        """What the server has said."""
        return (self.folder / "server.log").read_text()

    def rows(self) -> list[dict[str, Any]]:
        """The runs as they stand in the database itself."""
        with closing(sqlite3.connect(self.db)) as connection:
            connection.row_factory = sqlite3.Row
            return [dict(row) for row in connection.execute("select * from runs order by run")]

    def family(self) -> list[psutil.Process]:
        """Every process that was started by the server, or by whom it has started, in whatever group or session."""
        return [each for each in psutil.process_iter() if self.is_ours(each)]

    def is_ours(self, process: psutil.Process) -> bool:
        """Whether a process has the mark and lives."""
        try:
            return process.environ().get("STUDIO_CAMPAIGN") == self.mark and process.status() != psutil.STATUS_ZOMBIE
        except psutil.Error:
            return False

    def of_runs(self) -> list[psutil.Process]:
        """The processes that have begun with a run, and those of the next: neither the server nor a servant of it."""
        return [each for each in self.family() if not self.owns(each)]

    def owns(self, process: psutil.Process) -> bool:
        """Whether a process is the server or one that it has once. Who has ended is as good as one."""
        server = self.process.pid if self.process else 0
        try:
            return process.pid == server or (process.ppid() == server and any(each in str(process.cmdline()) for each in SERVANTS))
        except psutil.Error:
            return True

    def leaves_nobody(self) -> None:
        """All that it has started is gone in time."""
        with self.within(ORPHAN_TIME, "everybody to be gone"):
            until(lambda: not self.family(), "everybody to be gone")

    @contextmanager
    def within(self, seconds: float, what: str) -> Iterator[None]:
        """Notes when something takes longer than it should: that depends on the machine, so no test fails by it."""
        began = time.monotonic()
        yield
        if (took := time.monotonic() - began) > seconds:
            self.late.append(f"it took {took:.1f} s instead of {seconds:g} s for {what}")

    def held(self) -> Held:
        """What the server holds now."""
        assert self.process
        server = psutil.Process(self.process.pid)
        memory = server.memory_full_info().uss / 1e6
        return Held(memory, server.num_fds(), server.num_threads(), len(self.family()))


def furnish(folder: Path) -> None:
    """Scenarios that may be changed, their maps, and kinds that misbehave."""
    scenarios, kinds = folder / "scenarios", folder / "kinds"
    if scenarios.exists():
        return
    (scenarios / "maps").mkdir(parents=True)
    shutil.copyfile(ROOT / "scenarios" / f"{SCENARIO}.yaml", scenarios / f"{SCENARIO}.yaml")
    shutil.copyfile(ROOT / "scenarios" / f"{SCENARIO}.yaml", scenarios / "patched.yaml")
    (scenarios / "bad.yaml").write_text("title: bad\nclok: {}\n")
    shutil.copyfile(ROOT / "scenarios" / "maps" / "motorway.xodr", scenarios / "maps" / "motorway.xodr")
    kinds.mkdir()
    for name, text in {"raising": BROKEN, "hanging": HANGING, **APPLICATIONS}.items():
        (kinds / f"{name}.py").write_text(text)


def quick_run(station: Station) -> str:
    """A run that does nothing special; the hash of its end."""
    run = station.live(set=QUICK, seed=1)
    assert station.over(run) == "done"
    return station.client.get(f"/api/runs/{run}").json()["state_hash"]
