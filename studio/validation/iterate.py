"""Iterations of a project: calibrate a step, or validate, from the file to the row in runs.db. Command line and REST call these.

Each goes on from the last calibration of the same project and vehicle. What was found with a run is never validated with it: the digests
of all runs that the values go back to are kept with them. A row is written when a step is over, and no part of one before.
"""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace

from studio.errors import Problem, ScenarioError, nearest
from studio.scenario import catalogue
from studio.store import iteration
from studio.store.iteration import VALIDATION, Iteration
from studio.store.runs import Runs
from studio.validation import calibration, judge
from studio.validation.calibration import Calibrated, Estimate
from studio.validation.judge import Result
from studio.validation.project import Loaded

Progress = Callable[[float], None]


@dataclass(frozen=True)
class Step:
    """A project as it stands: with the values of the calibration that it goes on from."""

    loaded: Loaded
    vehicle: str
    before: Iteration | None

    @property
    def changes(self) -> dict[str, float]:
        """All values found so far."""
        return dict(self.before.changes) if self.before else {}

    @property
    def used(self) -> list[str]:
        """Digests of the runs that they were found with."""
        return list(self.before.used) if self.before else []


def begin(loaded: Loaded, runs: Runs, *, afresh: bool = False) -> Step:
    """A project with what was calibrated before; `afresh` leaves that aside. Raises StudioError."""
    vehicle = hashlib.sha256(loaded.model.values.model_dump_json().encode()).hexdigest()
    before = None if afresh else iteration.latest(runs, loaded.project.title, vehicle)
    if before is not None:
        loaded = replace(loaded, model=catalogue.changed(loaded.model, before.changes))
    return Step(loaded, vehicle, before)


def calibrate(step: Step, name: str, runs: Runs, progress: Progress = lambda share: None) -> tuple[int, Calibrated]:
    """Calibrates one step of the project; the number of the iteration, and what was found. Raises StudioError, and keeps nothing then."""
    steps = step.loaded.project.calibration
    if name not in steps:
        remedy = nearest(name, steps) if steps else "add `calibration:` with a step, its parameters and their ranges"
        raise ScenarioError(
            "The project has no such step of calibration.", [Problem("calibration", "has no such step", name, remedy=remedy)]
        )
    found = calibration.calibrate(step.loaded, name, progress)
    digests = [each.digest for each in calibration.runs_of(step.loaded, name)]
    number = kept(step, runs, name, changes=step.changes | found.changes, used=sorted({*step.used, *digests}), result=found.as_json())
    return number, found


def validate(step: Step, runs: Runs, progress: Progress = lambda share: None) -> tuple[int, Result]:
    """Validates; the number of the iteration, and the result. Raises StudioError, and keeps nothing then."""
    unused(step)
    found = judge.validate(step.loaded, progress)
    return kept(step, runs, VALIDATION, changes=step.changes, used=step.used, result=found.as_json()), found


def kept(step: Step, runs: Runs, name: str, *, changes: dict, used: list[str], result: dict) -> int:
    """Keeps an iteration."""
    loaded, parent = step.loaded, step.before.iteration if step.before else None
    return iteration.keep(
        runs, project=loaded.project.title, step=name, parent=parent, vehicle=step.vehicle, document=loaded.document, changes=changes,
        used=used, result=result,
    )  # fmt: skip


def estimates(runs: Runs, number: int) -> dict[str, Estimate]:
    """What is known of every value that was found up to an iteration, by path: of one found twice, the later finding."""
    found, now = {}, iteration.find(runs, number)
    while True:
        found = {each["path"]: Estimate(**each) for each in now.result.get("estimates", ())} | found
        if now.parent is None:
            return found
        now = iteration.find(runs, now.parent)


def unused(step: Step) -> None:
    """Refuses to validate with a run that the values were found with, whatever the project says of it now; raises ScenarioError."""
    used = set(step.used)
    found = [
        Problem(
            f"maneuvers.{name}.validation[{i}]",
            "was used for the calibration that this goes on from",
            each.name,
            remedy="validate with another run",
        )
        for name, each_runs in step.loaded.validation.items()
        for i, each in enumerate(each_runs)
        if each.digest in used
    ]
    if found:
        raise ScenarioError("A run that calibrates cannot validate: it would prove what it was fitted to.", found)
