"""Whether a run database is well: whole, ours, with no runs of dead processes, no results outside, no empty pages."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

from studio.doctor.finding import Finding, Patient, good, in_one_line, size
from studio.errors import StoreError
from studio.store import waiting
from studio.store.backup import damage
from studio.store.runs import KILLED, Runs, open_runs
from studio.store.sqlite import Database
from studio.store.tables import LAYOUT, checked_layout, connected, open_database, refuse_folder, unusable

EMPTY_SHARE, EMPTY_LEAST = 0.25, 50e6  # of a file, and [B]: less of empty pages is soon used again
BACKUP = "studio restore BACKUP --replace puts a backup in its place, and keeps it beside"


def database(patient: Patient) -> Iterator[Finding]:
    """All about it; of one that is not there, not ours or damaged, only that."""
    db = patient.db
    refuse_folder(db)
    try:
        yield from looked_into(db, patient.is_named)
    except sqlite3.Error as error:
        raise unusable(db, error) from None


def looked_into(db: Path, is_named: bool) -> Iterator[Finding]:
    """The same, in SQLite's words where it refuses."""
    if not db.exists():
        yield Finding("database", not is_named, f"{db} is not there yet", "the first run makes it; --db names another")
    elif found := damage(db):
        yield Finding("database", False, f"{db} is damaged: {found}", BACKUP)
    elif (layout := layout_of(db)) < LAYOUT:
        yield Finding(
            "database", False, f"{db} has the layout {layout} of an older studio", f"brings it up to {LAYOUT}", lambda: bring_up(db)
        )
    else:
        yield from rows(db)


def layout_of(db: Path) -> int:
    """The layout of a database. Raises StoreError when it is not ours, or too new."""
    with closing(connected(db)) as connection:
        return checked_layout(Database(connection), db)


def bring_up(db: Path) -> str:
    """Adds what is new in this layout."""
    open_database(db).conn.close()
    return f"has the layout {LAYOUT}"


def rows(db: Path) -> Iterator[Finding]:
    """What stands in one of this layout, and beside it."""
    with closing(looked_at(db)) as runs:
        (count,) = runs.rows("select count(*) as runs, coalesce(max(run), 0) as newest from runs")
        yield good(
            "database", f"{db} is whole: {count['runs']} runs, the newest {count['newest']}, layout {LAYOUT}, {size(db.stat().st_size)}"
        )
        yield references(runs)
        yield from waits(runs)
        yield dead(runs)
        yield pages(runs)


def looked_at(db: Path) -> Runs:
    """The runs of a database, to be read."""
    return Runs(db, Database(connected(db)))


# -- rows --------------------------------------------------------------------------------------------


def references(runs: Runs) -> Finding:
    """Whether every row belongs to a run, and every run to a scenario."""
    tables = {row["table"] for row in runs.rows("pragma foreign_key_check")}
    if tables:
        return Finding("rows", False, f"some belong to nothing, in {', '.join(sorted(tables))}", BACKUP)
    return good("rows", "all belong to a run")


def waits(runs: Runs) -> Iterator[Finding]:
    """Results that could not go in when their runs ended."""
    found = {file: home(runs, file) for file in waiting.found(runs.path)}
    ours = [file for file, problem in found.items() if not problem]
    if ours:
        yield Finding("results", False, f"{len(ours)} wait beside the database", "takes them in", lambda: take_in(runs.path))
    for file, problem in found.items():
        if problem:
            yield Finding(
                "results", False, f"{file} {problem}", "it stays where it is; move it to the database that it is of, or remove it"
            )
    if not found:
        yield good("results", "none waits beside the database")


def home(runs: Runs, file: Path) -> str:
    """Why a result cannot go in; "" when it can."""
    try:
        (row,) = waiting.read(file)["runs"]
    except StoreError as error:
        return in_one_line(error.problems[0])
    known = runs.rows("select * from runs where run = ?", [row["run"]])
    return "" if any(waiting.belongs(row, each) for each in known) else "is of a run that this database does not wait for"


def take_in(db: Path) -> str:
    """Puts in all that can go in."""
    with closing(open_runs(db)) as runs:
        left = [file for file in waiting.found(db) if not home(runs, file)]
    if left:
        raise StoreError(f"The database does not take {len(left)} results: is there room, does somebody hold it?")
    return "all are in"


def dead(runs: Runs) -> Finding:
    """Runs that say "running", whose processes have gone."""
    numbers = dead_ones(runs)
    if not numbers:
        return good("dead runs", 'every run that says "running" goes on')
    what = f'{len(numbers)} say "running", and their processes have gone: {listed(numbers)}'
    return Finding("dead runs", False, what, "marks them as killed", lambda: bury(runs.path))


def dead_ones(runs: Runs) -> list[int]:
    """Their numbers; one whose result waits is none."""
    return [row.run for row in runs.select(where="status = 'running'") if row.status == "killed"]


def listed(numbers: list[int]) -> str:
    """Numbers for a line."""
    return ", ".join(map(str, sorted(numbers)[:10])) + (", …" if len(numbers) > 10 else "")


def bury(db: Path) -> str:
    """Marks them, after their results have had a chance to come in."""
    with closing(open_runs(db)) as runs:
        numbers = dead_ones(runs)
        for number in numbers:
            runs.end(number, "killed", KILLED)
    return f"{len(numbers)} are marked"


# -- pages -------------------------------------------------------------------------------------------


def pages(runs: Runs) -> Finding:
    """How much of the file is empty."""
    page, count, free = (runs.rows(f"pragma {name}")[0][name] for name in ("page_size", "page_count", "freelist_count"))
    what = f"{size(free * page)} of {size(count * page)} are empty pages"
    if free * page < max(EMPTY_LEAST, EMPTY_SHARE * count * page):
        return good("file", what)
    return Finding("file", False, what, "gives them back to the disk", lambda: vacuum(runs.path))


def vacuum(db: Path) -> str:
    """Makes the file as small as it can be. Raises StoreError while a run goes on, which would have to wait."""
    with closing(open_runs(db)) as runs:
        if going := [row.run for row in runs.select(where="status = 'running'") if row.status == "running"]:
            raise StoreError(f"Runs go on: {listed(going)}.")
    with closing(sqlite3.connect(db, isolation_level=None)) as connection:
        connection.execute("vacuum")
        connection.execute("pragma wal_checkpoint(truncate)")
    return f"the file has {size(db.stat().st_size)} now"
