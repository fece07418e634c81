"""Tables of runs.db, and opening it.

    scenarios   hash → document            what was run, by content
    runs        run → scenario, parent, seed, status, ...
    metrics     run, name → value, unit, goal, subject, time, kind, about
    events      run → time, kind, text, vehicle, units, x, y, numbers, words
    traces      run → one Parquet file with a column per channel
    pieces      run, column, number → the rest of a file that is too long for one value of SQLite
    messages    run → two Parquet files: what was sent, and what became of it at everybody in range
    kinds       digest → sort, name, the digests of its texts by file; a run has the digests of those that it used
    texts       digest → text                  files of kinds, and patches; equal ones stand once
    verdicts    run → verdict, reason, who, when; one after another, the last one counts
    remarks     run → name, tags, note
    columns     column → name                  channels in one number that somebody wants to see of every run
    cells       column, run → value, unit, time, why   that number of each run, or why there is none
    iterations  iteration → project, step, parent, changes, used, result   calibrations and validations of a vehicle, one after another

SQLite in WAL mode: readers never wait for the writer. A number in `user_version` tells which layout a file has.
"""

import sqlite3
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path

from studio.errors import Problem, StoreError
from studio.store.sqlite import Database

LAYOUT = 8
PATIENCE = 30.0  # [s] for another process to finish writing

TABLES = {
    "scenarios": ({"hash": str, "title": str, "document": str, "map_digest": str}, "hash", ()),
    "runs": (
        {
            "run": int,
            "scenario": str,
            "scenario_hash": str,
            "parent": int,
            "seed": int,
            "status": str,
            "error": str,
            "state_hash": str,
            "code_version": str,
            "created": str,
            "sim_time_s": float,
            "wall_time_s": float,
            "parameters": str,
            "unmet": str,
            "process": int,
            "process_started": float,
            "process_mark": str,
            "kinds": str,
            "host": str,
            "versions": str,
            "revisions": str,
        },
        "run",
        (("scenario_hash", "scenarios", "hash"), ("parent", "runs", "run")),
    ),
    "metrics": (
        {
            "run": int,
            "name": str,
            "value": float,
            "unit": str,
            "goal": str,
            "subject": str,
            "time": float,
            "kind": str,
            "about": str,
        },
        ("run", "name"),
        (("run", "runs", "run"),),
    ),
    "events": (
        {
            "run": int,
            "time": float,
            "text": str,
            "vehicle": str,
            "kind": str,
            "units": str,
            "x": float,
            "y": float,
            "numbers": str,
            "words": str,
        },
        None,
        (("run", "runs", "run"),),
    ),
    "traces": ({"run": int, "parquet": bytes}, "run", (("run", "runs", "run"),)),
    "messages": ({"run": int, "sent": bytes, "entries": bytes}, "run", (("run", "runs", "run"),)),
    "pieces": ({"run": int, "column": str, "number": int, "bytes": bytes}, ("run", "column", "number"), (("run", "runs", "run"),)),
    "kinds": ({"digest": str, "kind": str, "name": str, "files": str}, "digest", ()),
    "texts": ({"digest": str, "text": str}, "digest", ()),
    "verdicts": ({"run": int, "verdict": str, "reason": str, "who": str, "when": str}, None, (("run", "runs", "run"),)),
    "remarks": ({"run": int, "name": str, "tags": str, "note": str}, "run", (("run", "runs", "run"),)),
    "columns": ({"column": int, "name": str}, "column", ()),
    "cells": (
        {"column": int, "run": int, "value": float, "unit": str, "time": float, "why": str},
        ("column", "run"),
        (("column", "columns", "column"), ("run", "runs", "run")),
    ),
    "iterations": (
        {
            "iteration": int,
            "project": str,
            "step": str,
            "parent": int,
            "created": str,
            "code_version": str,
            "vehicle": str,
            "document": str,
            "changes": str,
            "used": str,
            "result": str,
        },
        "iteration",
        (("parent", "iterations", "iteration"),),
    ),
}  # fmt: skip


def open_database(path: Path) -> Database:
    """The database in a file, made when there is none, to be written. Raises StoreError when it cannot be used."""
    refuse_folder(path)
    try:
        connection = sqlite3.connect(path, timeout=PATIENCE, check_same_thread=False)
        with refusing(connection):
            return prepared(Database(connection), path)
    except sqlite3.Error as error:
        raise unusable(path, error) from None


def read_database(path: Path) -> Database:
    """The database in a file that is there, for who only reads: nothing is written, and nobody waits for writers.

    Only a file of an older layout gets what is new first. Raises StoreError when it cannot be used.
    """
    refuse_folder(path)
    try:
        database = reopen_database(path)
        with refusing(database.conn):
            return database if checked_layout(database, path) == LAYOUT else prepared(database, path)
    except sqlite3.Error as error:
        raise unusable(path, error) from None


@contextmanager
def refusing(connection: sqlite3.Connection) -> Generator[None]:
    """Closes a connection that is of no use, and with it what SQLite keeps beside the file."""
    try:
        yield
    except BaseException:
        connection.close()
        raise


def reopen_database(path: Path) -> Database:
    """Another connection to a file that has been opened before: no look at its layout, no waiting for writers."""
    try:
        connection = connected(path)
        connection.execute("pragma foreign_keys = on")
        return Database(connection)
    except sqlite3.Error as error:
        raise unusable(path, error) from None


def connected(path: Path) -> sqlite3.Connection:
    """A connection. SQLite keeps a file beside one that it reads; where there is no room or right for that, and nothing waits to be
    written into the database, it is read as it stands."""
    connection = sqlite3.connect(path, timeout=PATIENCE, check_same_thread=False)
    try:
        connection.execute("pragma schema_version").fetchone()
        return connection
    except sqlite3.OperationalError:
        log = path.with_name(f"{path.name}-wal")
        if not path.is_file() or (log.exists() and log.stat().st_size):
            raise
        connection.close()
        return sqlite3.connect(f"{path.absolute().as_uri()}?immutable=1", uri=True, check_same_thread=False)


def refuse_folder(path: Path) -> None:
    """Raises StoreError for a folder."""
    if path.is_dir():
        raise StoreError(f"{path} is a folder, not a run database.", [Problem(str(path), "is a folder", remedy="name a file with --db")])


def prepared(database: Database, path: Path) -> Database:
    """With its tables, in WAL mode, writable."""
    layout = checked_layout(database, path)
    if layout < LAYOUT:
        make_tables(database)
    database.execute("pragma foreign_keys = on")
    database.execute("begin immediate")  # notices a read-only file now, not after an hour's run
    database.execute("commit")
    return database


def checked_layout(database: Database, path: Path) -> int:
    """The layout of a file; raises StoreError for one that is too new, or not ours."""
    layout = database.execute("pragma user_version").fetchone()[0]
    if layout > LAYOUT:
        raise StoreError(
            f"{path} was written by a newer studio.",
            [Problem(str(path), "has an unknown layout", str(layout), f"≤ {LAYOUT}", "update the studio, or use --db")],
        )
    if layout == 0:
        refuse_foreign(database, path)
    return layout


def refuse_foreign(database: Database, path: Path) -> None:
    """A database that holds other tables belongs to somebody else."""
    foreign = sorted(set(database.table_names()) - set(TABLES))
    if foreign:
        raise StoreError(
            f"{path} is not a run database.",
            [Problem(str(path), "holds other tables", ", ".join(foreign[:5]), remedy="name another file with --db")],
        )


def make_tables(database: Database) -> None:
    """Tables, columns and indices of this layout that are not there; another process may be doing the same.

    A layout only ever adds: what an older studio has written stays, and is empty in the columns that it did not know.
    """
    patiently(database.enable_wal)
    patiently(lambda: database.conn.execute("begin immediate"))
    with database.conn:
        for name, (columns, key, foreign) in TABLES.items():
            table = database.table(name).create(columns, pk=key, foreign_keys=foreign, if_not_exists=True)
            for column in [each for each in columns if each not in table.columns_dict]:
                table.add_column(column, columns[column])
        database.table("events").create_index(["run"], if_not_exists=True)
        database.table("runs").create_index(["scenario"], if_not_exists=True)
        database.table("verdicts").create_index(["run"], if_not_exists=True)
        database.table("columns").create_index(["name"], unique=True, if_not_exists=True)
        database.execute(f"pragma user_version = {LAYOUT}")


def patiently(action: Callable[[], object], patience: float = PATIENCE) -> None:
    """Repeats what SQLite refuses without waiting while another process uses the file or changes its mode."""
    until = time.monotonic() + patience
    while True:
        try:
            action()
            return
        except sqlite3.OperationalError as error:
            if "locked" not in str(error) or time.monotonic() > until:
                raise
            time.sleep(0.02)


def unusable(path: Path, error: sqlite3.Error) -> StoreError:
    """What to tell about a file that SQLite refuses."""
    text = str(error)
    remedy = "name another file with --db"
    if "not a database" in text:
        return StoreError(f"{path} is not a database.", [Problem(str(path), "is no SQLite file", remedy=remedy)])
    if "readonly" in text:
        return StoreError(f"{path} is read-only.", [Problem(str(path), "cannot be written", remedy=f"make it writable, or {remedy}")])
    if "full" in text:
        return StoreError(f"There is no room left for {path}.", [Problem(str(path), "does not fit on the disk", remedy="make room")])
    if "locked" in text or "busy" in text:
        what = f"is held by another program for more than {PATIENCE:g} s"
        return StoreError(f"{path} cannot be written now.", [Problem(str(path), what, remedy="end that program, or wait")])
    if "unable to open" in text:
        return StoreError(f"{path} cannot be opened.", [Problem(str(path), text, remedy="make its folder, or " + remedy)])
    return StoreError(f"{path} cannot be used.", [Problem(str(path), text, remedy=remedy)])
