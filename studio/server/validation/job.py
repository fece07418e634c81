"""Errands about projects as the server sees them: a process each, one at a time, the others wait.

Of one that is cancelled nothing is kept but the steps of a calibration that were over before.
"""

import shutil
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from studio.errors import Problem, ScenarioError, ServerError, StudioError
from studio.process import Child, Gone
from studio.server.docket import Docket, Errand
from studio.server.validation import answer
from studio.server.validation import worker as errand
from studio.server.validation.worker import Order

MOST_WAITING = 16
MOST_KEPT = 50  # errands that are over, with what came out
END_PATIENCE = 3.0  # [s] for a process to end by itself
COMPILING, WAITING = "waiting for the first compilation", "waiting for others"
MODELLESS = ("look",)  # what a log holds is seen without any vehicle, and so while the first compilation goes on
PAUSE = 0.1  # [s] between two looks at the compilation


@dataclass(kw_only=True)
class ProjectJob(Errand):
    """One errand about a project."""

    project: str
    order: Order
    is_compiled: Callable[[], bool]
    stage: str = WAITING
    outcome: dict[str, Any] | None = None
    is_swept: bool = False

    def row(self) -> answer.ProjectJob:
        """The errand as it is told."""
        with self.lock:
            task, found = self.order.job.task, self.outcome
            return answer.ProjectJob(
                **self.told(), project=self.project, task=task,
                looked=answer.Looked(**found) if found and task == "look" else None,
                kept=answer.Kept(**found) if found and task != "look" else None,
            )  # fmt: skip

    def cancel(self) -> None:
        """Ends it with its process."""
        with self.lock:
            super().cancel()
            if self.process is None:
                self.sweep()

    def work(self) -> None:
        """Runs it in a process, once the models are compiled if it drives any."""
        while self.order.job.task not in MODELLESS and not self.is_compiled() and not self.is_over:
            self.note(COMPILING, None)
            time.sleep(PAUSE)
        try:
            if child := self.start(errand.main, self.order):
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

    def listen(self, child: Child) -> None:
        """Hears the process out."""
        try:
            word, *values = child.hear()
            while word == "stage":
                self.note(*values)
                word, *values = child.hear()
            (value,) = values
            self.finish(value) if word == "done" else self.end("failed", value)
        except Gone as end:
            self.end("failed", gone(end.code))
        child.end(END_PATIENCE)

    def finish(self, outcome: dict[str, Any]) -> None:
        """It is done, unless it has been cancelled before."""
        with self.lock:
            self.outcome = outcome if self.end("done") else None


def gone(code: int | None) -> StudioError:
    """The problem of a process that ended without a word."""
    why = "was ended by the system, perhaps for want of memory" if code == -9 else "crashed"
    return ScenarioError("It came to no end.", [Problem("process", why, f"code {code}", remedy="try a shorter log")])


class ProjectJobs(Docket[ProjectJob]):
    """All errands about projects of this server."""

    def __init__(self, db: Path, is_compiled: Callable[[], bool], kinds: tuple[Path, ...] = ()) -> None:
        super().__init__(most_kept=MOST_KEPT, patience=2 * END_PATIENCE)
        self.db, self.is_compiled, self.kinds = db, is_compiled, kinds

    def begin(self, project: str, folder: Path, new: answer.NewJob) -> ProjectJob:
        """An errand with a number of its own. Raises ServerError when too many wait."""
        with self.lock:
            if self.closed or len(self.waiting) >= MOST_WAITING:
                problem = Problem("jobs", "are too many", allowed=f"{MOST_WAITING} at once", remedy="wait for one, or cancel it")
                raise ServerError("The studio has enough to do.", [problem])
            order = Order(new, folder, self.db, self.kinds)
            job = self.add(lambda number: ProjectJob(id=number, project=project, order=order, is_compiled=self.is_compiled))
        self.proceed()
        return job
