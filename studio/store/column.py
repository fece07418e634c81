"""A channel in one number as a column of the table of runs: worked out once for each run, and kept in the database from then on.

A column is called by what it tells, and the name says all of it:

    leader.speed.max              the greatest sample: vehicle.quantity.kind
    leader.speed.mean@5..20       from 5 s to 20 s; @5.. and @..20 are open
    leader.speed.at_collision     at the first event of that kind

Of runs that have no such number the reason is kept in its place, so that nobody looks for it again. Runs that go on have none yet.
"""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from studio.assess.aggregate import MEANINGS, Aggregate
from studio.errors import Problem, ScenarioError, StoreError, UnknownError, nearest, short
from studio.store.aggregate import one
from studio.store.runs import Runs

AT = "at_"
AT_EVENT = "at_event"
BATCH = 64  # runs that are worked out in one transaction
LONGEST = 300  # letters of a name
NO_NUMBER = "No sample of it is a number."


class Wanted(NamedTuple):
    """What a column tells: of which channel, which number, between which times [s], of which event."""

    channel: str
    kind: str
    begin: float | None
    end: float | None
    event: str

    @property
    def name(self) -> str:
        """What it is called."""
        what = f"{self.channel}.{AT}{self.event}" if self.event else f"{self.channel}.{self.kind}"
        return what if self.begin is None and self.end is None else f"{what}@{plain(self.begin)}..{plain(self.end)}"


class Cell(NamedTuple):
    """The number of one run, in its unit, and when it was [s] if it was at a time; or why there is none."""

    run: int
    value: float | None
    unit: str
    time: float | None
    why: str


def plain(time: float | None) -> str:
    """A time [s] as it stands in a name."""
    return "" if time is None else repr(time).removesuffix(".0")


def wanted(name: str) -> Wanted:
    """What a name says. Raises ScenarioError for one that says nothing."""
    what, at, span = name.rpartition("@")
    if not at or ".." not in span:
        what, span = name, ".."
    channel, _, kind = what.rpartition(".")
    event = kind.removeprefix(AT) if kind.startswith(AT) else ""
    begin, end = (bound(each, name) for each in span.split("..", 1))
    if not channel or not (event or kind in MEANINGS) or len(name) > LONGEST:
        raise unsaid(name, nearest(kind, [each for each in MEANINGS if each != AT_EVENT]))
    return Wanted(channel, AT_EVENT if event else kind, begin, end, event)


def bound(text: str, name: str) -> float | None:
    """A time [s] of a name; None where it is open. Raises ScenarioError for what is none."""
    try:
        found = float(text) if text else None
    except ValueError:
        raise unsaid(name, "") from None
    if found is not None and not math.isfinite(found):
        raise unsaid(name, "")
    return found


def unsaid(name: str, remedy: str) -> ScenarioError:
    """The refusal of a name."""
    allowed = f"vehicle.quantity, a dot, and {', '.join(each for each in MEANINGS if each != AT_EVENT)} or {AT}EVENT; @5..20 between times"
    return ScenarioError(f"There is no column {short(name)}.", [Problem("column", "says nothing", short(name), allowed, remedy)])


def kept(runs: Runs, column: Wanted) -> list[Cell]:
    """What is there of it already, newest run first."""
    query = "select run, value, unit, time, why from cells natural join columns where name = ? order by run desc"
    return [Cell(**row) for row in runs.rows(query, [column.name])]


def lacking(runs: Runs, column: Wanted) -> list[int]:
    """The runs that are over and have not been worked out, newest first."""
    known = "select run from cells natural join columns where name = ?"
    query = f"select run from runs where status not in ('running', 'waiting') and run not in ({known}) order by run desc"
    return [row["run"] for row in runs.rows(query, [column.name])]


def fill(runs: Runs, column: Wanted, numbers: Sequence[int]) -> list[Cell]:
    """Works it out of runs, and keeps it. Raises StoreError when the database does not take it."""
    found = [cell(runs, run, column) for run in numbers]
    with runs.writing():
        runs.database.table("columns").insert({"name": column.name}, pk="column", ignore=True)
        (key,) = runs.rows("select column from columns where name = ?", [column.name])
        rows = [key | each._asdict() for each in found]
        runs.database.table("cells").insert_all(rows, pk=("column", "run"), ignore=True)
    return found


def filled(runs: Runs, column: Wanted, numbers: Sequence[int]) -> dict[int, Cell]:
    """The same of runs by number, from what is kept as far as it is there; those that go on are left out."""
    missing = set(lacking(runs, column)) & set(numbers)
    for batch in batches(sorted(missing)):
        fill(runs, column, batch)
    return {each.run: each for each in kept(runs, column)}


def batches(numbers: Sequence[int]) -> Iterator[Sequence[int]]:
    """Some at a time."""
    return (numbers[first : first + BATCH] for first in range(0, len(numbers), BATCH))


def cell(runs: Runs, run: int, column: Wanted) -> Cell:
    """That of one run: what `aggregated` tells of it."""
    try:
        found = one(runs, run, column.channel, column.begin, column.end, column.event)
    except (UnknownError, StoreError) as error:
        return Cell(run, None, "", None, error.message)
    number = next((each for each in found.aggregates if each.kind == column.kind), Aggregate(column.kind, None))
    return Cell(run, number.value, found.unit, number.time, "" if number.value is not None else NO_NUMBER)
