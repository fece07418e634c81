"""Backup and restore of a run database, each in one go, while others use it.

    back_up(db, target)     a copy of all that is in it at one moment, and of the results that wait beside it
    restore(source, db)     a copy takes the place of a database, and the one before is kept beside it

A backup is a run database like any other, in one file; the history of edits of scenarios, where there is one, is copied to a file beside
it and comes back with it. What is recorded of a run that goes on is not in it: that has not come into
the database yet. A file is whole, or it is not there: both are made beside and renamed.
"""

import os
import sqlite3
from collections.abc import Callable, Generator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from studio.errors import Problem, StoreError, UnknownError
from studio.store import waiting
from studio.store.runs import Runs, read_runs
from studio.store.sqlite import Database
from studio.store.tables import checked_layout, connected, open_database, patiently, refuse_folder, refusing, reopen_database, unusable

PAGES = 2048  # copied between two words about how far it is
IN_USE = 5.0  # [s] for those who use a database to let go of it
BESIDE = ("-wal", "-shm", "-journal")  # what SQLite keeps beside a file
Report = Callable[[float], None]


@dataclass(frozen=True)
class Copied:
    """What has been copied: into which file, how many runs, the newest, those that went on, its size [B]; what was there before."""

    file: Path
    runs: int
    newest: int
    going: list[int]
    size: int
    before: Path | None = None


def back_up(db: Path, target: Path, report: Report = lambda share: None) -> Copied:
    """Copies a run database to a file that is not there yet. Raises StoreError, or UnknownError when there is no database."""
    with closing(opened(db)) as source:
        waits = [result for _, result in waiting.results(db)]  # before the copy: what goes in meanwhile is in one of both
        for each in (target, edits_of(target)):
            if each.exists():
                raise StoreError(f"{each} is there already.", [Problem("backup", "would be overwritten", str(each), "a new file", OTHER)])
        copy_edits(db, target)
        with made(target) as beside:
            copy(source, beside, target, report)
            with closing(Runs(beside, open_database(beside))) as runs:
                for each in waits:
                    runs.takes(each)
            refuse_damage(beside, db)
    return described(target)


def restore(source: Path, db: Path, *, replace: bool, report: Report = lambda share: None) -> Copied:
    """Puts a copy of a run database in the place of `db`; what stands there is kept beside, and only touched with `replace`.

    Raises StoreError, also when somebody uses `db`, or UnknownError when there is no such backup.
    """
    with closing(opened(source)) as copied:
        is_whole = may_be_replaced(db, source, replace)
        with made(db) as beside:
            copy(copied, beside, db, report)
            open_database(beside).conn.close()  # brings one of an older layout up
            refuse_damage(beside, source)
            before = set_aside(db, is_whole) if db.exists() else None
        bring_edits(source, db)
    return described(db, before)


# -- the history of edits ----------------------------------------------------------------------------


def edits_of(db: Path) -> Path:
    """Where the history of edits of scenarios lies that belongs to a run database."""
    return db.with_name(f"{db.stem}.edits.db")


def copy_edits(db: Path, target: Path) -> bool:
    """Copies the history of edits beside one database beside another, in the place of what is there; whether there is one."""
    edits = edits_of(db)
    if not edits.is_file():
        return False
    with made(edits_of(target)) as beside, closing(connected(edits)) as source:
        copy(source, beside, edits_of(target), lambda share: None)
    return True


def bring_edits(source: Path, db: Path) -> None:
    """The history of edits that a backup has beside it takes the place of that of the database, which is kept beside."""
    here = edits_of(db)
    if not edits_of(source).is_file():
        return
    if here.exists():
        with closing(connected(here)) as found, made(free(here.with_name(f"{here.name}.before-{stamp()}"))) as beside:
            copy(found, beside, here, lambda share: None)
    copy_edits(source, db)


# -- what is looked at first -------------------------------------------------------------------------

OTHER = "name another file"


def opened(path: Path) -> sqlite3.Connection:
    """A connection to a run database that is there, to be read. Raises UnknownError, or StoreError for what is none."""
    if not path.exists():
        raise UnknownError(f"There is no run database {path}.", [Problem(str(path), "does not exist", remedy="name the file of one")])
    refuse_folder(path)
    database = reopen_database(path)
    try:
        with refusing(database.conn):
            if checked_layout(database, path) == 0:
                raise StoreError(f"{path} is not a run database.", [Problem(str(path), "is an empty database", remedy=OTHER)])
    except sqlite3.Error as error:
        raise unusable(path, error) from None
    return database.conn


def may_be_replaced(db: Path, source: Path, replace: bool) -> bool:
    """Whether a database that may be replaced is whole. Raises StoreError when it may not: without a word, or while runs go on."""
    if not db.exists():
        return False
    refuse_folder(db)
    if source.samefile(db):
        raise StoreError(
            f"{source} is the database itself.", [Problem("backup", "is the file that it would replace", str(source), remedy=OTHER)]
        )
    if not replace:
        problem = Problem(
            "--db", "would be replaced", str(db), remedy="say --replace, and it is kept beside; or name another file with --db"
        )
        raise StoreError(f"There is a database {db}.", [problem])
    if damage(db):
        return False
    with closing(read_runs(db)) as runs:
        refuse_going(runs)
    return True


def damage(path: Path) -> str:
    """What SQLite finds wrong in a file, in one line; "" when it is whole."""
    try:
        with closing(connected(path)) as connection:
            return "; ".join(found for (found,) in connection.execute("pragma integrity_check(5)") if found != "ok").replace("\n", " ")
    except sqlite3.OperationalError:
        raise
    except sqlite3.DatabaseError as error:
        return str(error)


def refuse_damage(copy: Path, origin: Path) -> None:
    """Raises StoreError when a copy, and so what it is made of, is not whole."""
    if found := damage(copy):
        raise StoreError(f"{origin} is damaged.", [Problem(str(origin), found, remedy="take another backup; studio doctor tells more")])


# -- copies ------------------------------------------------------------------------------------------


@contextmanager
def made(target: Path) -> Generator[Path]:
    """A file beside the target that takes its place when all has gone well, and else is gone. Raises StoreError when it cannot be."""
    beside = target.with_name(f".{target.name}.{os.getpid()}.partial")
    try:
        beside.open("wb").close()
        yield beside
        os.replace(beside, target)
    except sqlite3.Error as error:
        raise unusable(target, error) from None
    except OSError as error:
        problem = Problem(str(target), error.strerror or str(error), remedy="make room, or name a file in a folder that can be written")
        raise StoreError(f"{target} cannot be written.", [problem]) from None
    finally:
        for each in ("", *BESIDE):
            with suppress(OSError):
                beside.with_name(f"{beside.name}{each}").unlink()


def copy(source: sqlite3.Connection, beside: Path, target: Path, report: Report) -> None:
    """All that a database holds at one moment: what others write meanwhile is not seen, and does not begin it anew."""
    try:
        with closing(sqlite3.connect(beside)) as to:
            source.execute("begin")
            source.execute("select count(*) from sqlite_master").fetchone()
            source.backup(to, pages=PAGES, progress=lambda _, left, of: report(1.0 - left / max(of, 1)))
            source.rollback()
    except sqlite3.Error as error:
        raise unusable(target, error) from None


def described(file: Path, before: Path | None = None) -> Copied:
    """What a copy holds."""
    with closing(Runs(file, Database(connected(file)))) as runs:
        (count,) = runs.rows("select count(*) as runs, coalesce(max(run), 0) as newest from runs")
        going = [row["run"] for row in runs.rows("select run from runs where status = 'running' order by run")]
    return Copied(file, count["runs"], count["newest"], going, file.stat().st_size, before)


# -- the database before -----------------------------------------------------------------------------


def set_aside(db: Path, is_whole: bool) -> Path:
    """Renames a database that nobody uses, a damaged one with what SQLite keeps beside it; returns where it lies now."""
    to = free(db.with_name(f"{db.name}.before-{stamp()}"))
    if not is_whole:
        for each in BESIDE:
            log = db.with_name(f"{db.name}{each}")
            if log.exists():
                log.rename(to.with_name(f"{to.name}{each}"))
        return db.rename(to)
    with alone(db):
        db.rename(to)
    with closing(sqlite3.connect(to)) as connection:
        connection.execute("pragma journal_mode = wal")
    return to


@contextmanager
def alone(db: Path) -> Generator[None]:
    """Holds a database that nobody else has open, in one file and whole. Raises StoreError when somebody has."""
    with closing(read_runs(db)) as runs:
        refuse_going(runs)
    with closing(sqlite3.connect(db, timeout=IN_USE)) as connection:
        try:
            # SQLite does this for who is alone with a file; what waits to be written into it is written
            patiently(lambda: connection.execute("pragma journal_mode = delete"), IN_USE)
            connection.execute("begin exclusive")
        except sqlite3.OperationalError as error:
            raise in_use(db, f"is open in another program ({error})") from None
        yield


def refuse_going(runs: Runs) -> None:
    """Raises StoreError when a run goes on: its result would be lost to the new database."""
    going = [str(row.run) for row in runs.select(where="status = 'running'") if row.status == "running"]
    if going:
        raise in_use(runs.path, f"has runs that go on: {', '.join(going)}")


def in_use(db: Path, what: str) -> StoreError:
    """What to tell who wants to replace a database that others use."""
    return StoreError(
        f"{db} is in use.", [Problem(str(db), what, remedy="stop them, or wait for their end; a server without runs may go on")]
    )


def stamp() -> str:
    """This moment, for the name of a file."""
    return datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")


def free(path: Path) -> Path:
    """A name that nothing has yet."""
    number = 1
    while (found := path if number == 1 else path.with_name(f"{path.name}-{number}")).exists():
        number += 1
    return found
