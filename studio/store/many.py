"""What is said of many runs at once: of all of them or, when one of them refuses, of none.

Tags are put on and taken off, so that nobody's other tags, name and note are touched; what was really changed is told, and the opposite of
that takes it back.
"""

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from studio.store.runs import Runs
from studio.store.verdict import Verdict, as_remark, checked, remark_of


@dataclass(frozen=True)
class Given:
    """A verdict on one of them."""

    run: int
    verdict: str
    reason: str


@dataclass(frozen=True)
class Retag:
    """Tags that are put on a run, and such that are taken off it."""

    run: int
    add: tuple[str, ...] = ()
    remove: tuple[str, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


def judge_all(runs: Runs, given: Sequence[Given], who: str = "") -> list[Verdict]:
    """Verdicts on many runs, under the rules of `judge`; raises what it raises, and then none is given."""
    made = [checked(runs, each.run, each.verdict, each.reason, who) for each in given]
    with runs.writing():
        rows = ({"run": each.run, **verdict.as_json()} for each, verdict in zip(given, made, strict=True))
        runs.database.table("verdicts").insert_all(rows)
    return made


def retag(runs: Runs, wanted: Iterable[Retag]) -> list[Retag]:
    """Puts tags on runs and takes them off; what was changed, without runs where nothing was. Raises what `remark` raises."""
    with runs.writing():
        return [made for each in wanted if (made := retag_one(runs, each)).add or made.remove]


def retag_one(runs: Runs, wanted: Retag) -> Retag:
    """The tags of one run, within a transaction; what was changed."""
    had = remark_of(runs, wanted.run)
    kept = [tag for tag in had.tags if tag not in wanted.remove]
    made = as_remark(name=had.name, tags=[*kept, *wanted.add], note=had.note)
    row = {"run": wanted.run, "name": made.name, "tags": json.dumps(made.tags, ensure_ascii=False), "note": made.note}
    runs.database.conn.execute("insert or replace into remarks (run, name, tags, note) values (:run, :name, :tags, :note)", row)
    return Retag(wanted.run, without(made.tags, had.tags), without(had.tags, made.tags))


def without(tags: Iterable[str], others: Sequence[str]) -> tuple[str, ...]:
    """Tags that are not among others."""
    return tuple(tag for tag in tags if tag not in others)
