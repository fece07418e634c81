"""Errands about projects as the server sees them: a process each, one at a time, the others wait.

Of one that is cancelled nothing is kept but the steps of a calibration that were over before.
"""

import shutil
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf
from pathlib import Path
from typing import Any

from studio.errors import Problem, ScenarioError, ServerError, StudioError, UnknownError
from studio.process import Child, Gone
from studio.server.answer import ImportStatus
from studio.server.validation import answer
from studio.server.validation import worker as errand
from studio.server.validation.worker import Order

MOST_WAITING = 16
MOST_KEPT = 50  # errands that are over, with what came out
END_PATIENCE = 3.0  # [s] for a process to end by itself
COMPILING, WAITING = "waiting for the first compilation", "waiting for others"
PAUSE = 0.1  # [s] between two looks at the compilation


@dataclass
class ProjectJob:
    """One errand. `status` is running, done, failed or cancelled; while it waits it counts as running."""

    id: int
    project: str
    order: Order
    status: ImportStatus = "running"
    stage: str = WAITING
    share: float | None = None
    problem: StudioError | None = None
    outcome: dict[str, Any] | None = None
    began: float = field(default_factory=time.monotonic)
    ended: float = inf
    process: Child | None = None
    is_swept: bool = False
    lock: threading.RLock = field(default_factory=threading.RLock)

    @property
    def is_over(self) -> bool:
        """Whether it has ended."""
        return self.status != "running"

    def row(self) -> answer.ProjectJob:
        """The errand as it is told."""
        with self.lock:
            task, found = self.order.job.task, self.outcome
            return answer.ProjectJob(
                id=self.id, project=self.project, task=task, status=self.status, stage=self.stage, share=self.share,
                seconds=round(min(self.ended, time.monotonic()) - self.began, 2),
                problem=self.problem.as_json() if self.problem else None,
                looked=answer.Looked(**found) if found and task == "look" else None,
                kept=answer.Kept(**found) if found and task != "look" else None,
            )  # fmt: skip

    def end(self, status: ImportStatus, problem: StudioError | None = None, outcome: dict[str, Any] | None = None) -> None:
        """It is over, unless it has been before."""
        with self.lock:
            if not self.is_over:
                self.status, self.stage, self.problem, self.outcome, self.ended = status, status, problem, outcome, time.monotonic()
                self.share = 1.0 if status == "done" else self.share

    def cancel(self) -> None:
        """Ends it with its process."""
        with self.lock:
            self.end("cancelled")
            if self.process is not None:
                self.process.kill()
            else:
                self.sweep()

    def work(self, is_compiled: Callable[[], bool]) -> None:
        """Runs it in a process, once the models are compiled."""
        while not is_compiled() and not self.is_over:
            self.note(COMPILING, None)
            time.sleep(PAUSE)
        try:
            if child := self.start():
                self.listen(child)
        except OSError as error:
            self.end("failed", ServerError(f"The process did not start ({error.strerror or error})."))
        self.sweep()

    def sweep(self) -> None:
        """Removes the folder of a sample that came to nothing; once, for its name is free then."""
        with self.lock:
            if self.is_over and self.status != "done" and self.order.job.task == "sample" and not self.is_swept:
                self.is_swept = True
                shutil.rmtree(self.order.folder, ignore_errors=True)

    def note(self, stage: str, share: float | None) -> None:
        """What is being done, and how far it is."""
        with self.lock:
            if not self.is_over:
                self.stage, self.share = stage, share

    def start(self) -> Child | None:
        """Starts the process, unless it has been cancelled."""
        with self.lock:
            if not self.is_over:
                self.stage, self.share = "starting", None
                self.process = Child.begin(errand.main, self.order)
            return self.process

    def listen(self, child: Child) -> None:
        """Hears the process out."""
        try:
            word, *values = child.hear()
            while word == "stage":
                self.note(*values)
                word, *values = child.hear()
            (value,) = values
            self.end("done", outcome=value) if word == "done" else self.end("failed", value)
        except Gone as end:
            self.end("failed", gone(end.code))
        child.end(END_PATIENCE)


def gone(code: int | None) -> StudioError:
    """The problem of a process that ended without a word."""
    why = "was ended by the system, perhaps for want of memory" if code == -9 else "crashed"
    return ScenarioError("It came to no end.", [Problem("process", why, f"code {code}", remedy="try a shorter log")])


@dataclass
class ProjectJobs:
    """All errands of this server."""

    db: Path
    is_compiled: Callable[[], bool]
    kinds: tuple[Path, ...] = ()
    jobs: dict[int, ProjectJob] = field(default_factory=dict)
    working: ProjectJob | None = None
    last: int = 0
    closed: bool = False
    lock: threading.RLock = field(default_factory=threading.RLock)

    def rows(self) -> list[answer.ProjectJob]:
        """All errands, newest first."""
        with self.lock:
            return [job.row() for _, job in sorted(self.jobs.items(), reverse=True)]

    def find(self, job: int) -> ProjectJob:
        """An errand; raises UnknownError."""
        with self.lock:
            if job not in self.jobs:
                known = ", ".join(map(str, sorted(self.jobs))) or "there is none"
                raise UnknownError(f"There is no job {job}.", [Problem("job", "does not exist", str(job), known)])
            return self.jobs[job]

    def begin(self, project: str, folder: Path, new: answer.NewJob) -> answer.ProjectJob:
        """An errand with a number of its own. Raises ServerError when too many wait."""
        with self.lock:
            if self.closed or sum(not each.is_over for each in self.jobs.values()) >= MOST_WAITING:
                problem = Problem("jobs", "are too many", allowed=f"{MOST_WAITING} at once", remedy="wait for one, or cancel it")
                raise ServerError("The studio has enough to do.", [problem])
            self.last += 1
            job = self.jobs[self.last] = ProjectJob(self.last, project, Order(new, folder, self.db, self.kinds))
            self.forget()
        self.proceed()
        return job.row()

    def forget(self) -> None:
        """Forgets the oldest errands that are over."""
        over = [number for number, job in sorted(self.jobs.items()) if job.is_over]
        for number in over[: max(0, len(over) - MOST_KEPT)]:
            del self.jobs[number]

    def cancel(self, job: int) -> answer.ProjectJob:
        """Cancels an errand; one that is over stays as it is. Raises UnknownError."""
        found = self.find(job)
        found.cancel()
        return found.row()

    def proceed(self) -> None:
        """Starts the next errand, when none is going on."""
        with self.lock:
            waiting = [job for _, job in sorted(self.jobs.items()) if not job.is_over and job.process is None]
            if self.working is None and waiting and not self.closed:
                self.working = waiting[0]
                threading.Thread(target=self.work, args=(waiting[0],), name=f"job {waiting[0].id}", daemon=True).start()

    def work(self, job: ProjectJob) -> None:
        """Sees one errand through, then starts the next."""
        try:
            job.work(self.is_compiled)
        finally:
            with self.lock:
                self.working = None
            self.proceed()

    def close(self) -> None:
        """Cancels all errands."""
        with self.lock:
            self.closed = True
            jobs = list(self.jobs.values())
        for job in jobs:
            job.cancel()
        deadline = time.monotonic() + 2 * END_PATIENCE
        while self.working is not None and time.monotonic() < deadline:
            time.sleep(0.02)
