"""Iterations of a validation project in runs.db: every calibration and every validation, each with the one that it goes on from.

`vehicle` is the digest of the project's vehicle before any calibration: values that were found for another car are not taken over.
`changes` are all values found so far, `used` the digests of all runs that they were found with. Rows go in whole, once a step is over.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from typing import Any

from studio.errors import Problem, UnknownError
from studio.source import code_version
from studio.store.runs import Runs

VALIDATION = "validation"  # the step of a row that is no calibration
TEXTS = ("document", "changes", "used", "result")


@dataclass(frozen=True)
class Iteration:
    """One step of a project: what it was, from which it goes on, and what came out."""

    iteration: int
    project: str
    step: str
    parent: int | None
    created: str
    code_version: str
    vehicle: str
    document: dict[str, Any] = field(default_factory=dict)
    changes: dict[str, float] = field(default_factory=dict)
    used: list[str] = field(default_factory=list)
    result: dict[str, Any] = field(default_factory=dict)

    @property
    def is_calibration(self) -> bool:
        """Whether values were found."""
        return self.step != VALIDATION

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


def keep(
    runs: Runs, *, project: str, step: str, parent: int | None, vehicle: str, document: Mapping[str, Any], changes: Mapping[str, float],
    used: Sequence[str], result: Mapping[str, Any],
) -> int:  # fmt: skip
    """Keeps an iteration whole; its number. Raises StoreError."""
    texts = {"document": document, "changes": changes, "used": used, "result": result}
    row = {
        "project": project, "step": step, "parent": parent, "created": datetime.now(UTC).isoformat(timespec="milliseconds"),
        "code_version": code_version(), "vehicle": vehicle,
    } | {name: json.dumps(each, ensure_ascii=False) for name, each in texts.items()}  # fmt: skip
    with runs.writing():
        number = runs.database.table("iterations").insert(row, pk="iteration").last_pk
    assert number is not None, "a row that was inserted has a key"
    return int(number)


def history(runs: Runs, project: str) -> list[Iteration]:
    """All iterations of a project, the first first."""
    return [of(row) for row in runs.rows("select * from iterations where project = ? order by iteration", [project])]


def find(runs: Runs, iteration: int) -> Iteration:
    """One iteration; raises UnknownError."""
    for row in runs.rows("select * from iterations where iteration = ?", [iteration]):
        return of(row)
    raise UnknownError(f"There is no iteration {iteration}.", [Problem("iteration", "does not exist", str(iteration))])


def latest(runs: Runs, project: str, vehicle: str) -> Iteration | None:
    """The last calibration of a project and its vehicle, which the next step goes on from."""
    found = [each for each in history(runs, project) if each.is_calibration and each.vehicle == vehicle]
    return found[-1] if found else None


def of(row: dict[str, Any]) -> Iteration:
    """An iteration of a row."""
    return Iteration(**row | {name: json.loads(row[name]) for name in TEXTS})
