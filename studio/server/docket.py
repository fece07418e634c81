"""Docket: errands of the server, a process each; some go on at a time, the others wait for their turn.

Errand    one of them: how far it is, how it ended, and its process
Docket    all of a kind, in their order; whoever has errands says what they do and what they leave behind
"""

import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf
from typing import Any, Generic, TypeVar

from studio.errors import Problem, StudioError, UnknownError
from studio.process import Child
from studio.server.answer import ImportStatus

PAUSE = 0.02  # [s] between two looks whether processes have ended


@dataclass(kw_only=True)
class Errand(ABC):
    """One errand. `status` is running, done, failed or cancelled; while it waits it counts as running."""

    id: int
    status: ImportStatus = "running"
    stage: str
    share: float | None = None
    problem: StudioError | None = None
    began: float = field(default_factory=time.monotonic)
    ended: float = inf
    process: Child | None = None
    lock: threading.RLock = field(default_factory=threading.RLock)

    @property
    def is_over(self) -> bool:
        """Whether it has ended."""
        return self.status != "running"

    def told(self) -> dict[str, Any]:
        """What is told of every errand."""
        return {
            "id": self.id,
            "status": self.status,
            "stage": self.stage,
            "share": self.share,
            "seconds": round(min(self.ended, time.monotonic()) - self.began, 2),
            "problem": self.problem.as_json() if self.problem else None,
        }

    def end(self, status: ImportStatus, problem: StudioError | None = None) -> bool:
        """It is over, unless it has been before: then nothing changes, and the answer is no."""
        with self.lock:
            if self.is_over:
                return False
            self.status, self.stage, self.problem, self.ended = status, status, problem, time.monotonic()
            self.share = 1.0 if status == "done" else self.share
            return True

    def note(self, stage: str, share: float | None) -> None:
        """What is being done, and how far it is."""
        with self.lock:
            if not self.is_over:
                self.stage, self.share = stage, share

    def start(self, work: Callable[..., None], order: Any) -> Child | None:
        """Starts the process, unless it has been cancelled."""
        with self.lock:
            if not self.is_over:
                self.stage, self.share = "starting", None
                self.process = Child.begin(work, order)
            return self.process

    def cancel(self) -> None:
        """Ends it with its process."""
        with self.lock:
            self.end("cancelled")
            if self.process is not None:
                self.process.kill()

    @abstractmethod
    def work(self) -> None:
        """Sees it through; afterwards it is over."""


E = TypeVar("E", bound=Errand)


@dataclass
class Docket(Generic[E]):
    """All errands of a kind on this server."""

    at_a_time: int = 1  # processes
    most_kept: int = 50  # errands that are over
    patience: float = 3.0  # [s] for processes to end with the server
    what: str = "job"  # what one is called
    jobs: dict[int, E] = field(default_factory=dict)
    working: set[int] = field(default_factory=set)
    last: int = 0
    closed: bool = False
    lock: threading.RLock = field(default_factory=threading.RLock)

    def rows(self) -> list[E]:
        """All errands, newest first."""
        with self.lock:
            return [job for _, job in sorted(self.jobs.items(), reverse=True)]

    def find(self, job: int) -> E:
        """An errand; raises UnknownError."""
        with self.lock:
            if job not in self.jobs:
                known = ", ".join(map(str, sorted(self.jobs))) or "there is none"
                raise UnknownError(f"There is no {self.what} {job}.", [Problem("job", "does not exist", str(job), known)])
            return self.jobs[job]

    @property
    def waiting(self) -> list[E]:
        """Those that are not over."""
        return [job for job in self.jobs.values() if not job.is_over]

    def add(self, make: Callable[[int], E]) -> E:
        """An errand with a number of its own; the oldest that are over are forgotten."""
        with self.lock:
            self.last += 1
            job = self.jobs[self.last] = make(self.last)
            over = [number for number, each in sorted(self.jobs.items()) if each.is_over and number not in self.working]
            for number in over[: max(0, len(over) - self.most_kept)]:
                del self.jobs[number]
            return job

    def cancel(self, job: int) -> E:
        """Cancels an errand; one that is over stays as it is. Raises UnknownError."""
        found = self.find(job)
        found.cancel()
        self.proceed()
        return found

    def may_begin(self, job: E) -> bool:
        """Whether an errand may go on beside those that do."""
        return True

    def proceed(self) -> None:
        """Starts those that may start now."""
        with self.lock:
            for number, job in sorted(self.jobs.items()):
                is_next = not (job.is_over or job.process is not None or number in self.working or self.closed)
                if is_next and len(self.working) < self.at_a_time and self.may_begin(job):
                    self.working.add(number)
                    threading.Thread(target=self.see_through, args=(job,), name=f"{self.what} {number}", daemon=True).start()

    def see_through(self, job: E) -> None:
        """Sees one through, then starts the next."""
        try:
            job.work()
        finally:
            with self.lock:
                self.working.discard(job.id)
            self.proceed()

    def close(self) -> None:
        """Cancels all; what cannot be cancelled any more is waited for."""
        with self.lock:
            self.closed = True
            jobs = list(self.jobs.values())
        for job in jobs:
            job.cancel()
        deadline = time.monotonic() + self.patience
        while self.working and time.monotonic() < deadline:
            time.sleep(PAUSE)
