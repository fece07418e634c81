"""Results that could not go into their database: each waits in a file of its own, until they can.

The file is an SQLite file with the same tables, so that anything can open it. It lies beside the database, or, when there is no room
there either, in the user's own folder. Who opens the database next to write takes it in.
"""

import hashlib
import os
import sqlite3
from collections.abc import Iterator
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

import platformdirs

from studio.errors import Problem, StoreError
from studio.store.sqlite import Database
from studio.store.tables import TABLES

Result = dict[str, list[dict[str, Any]]]  # rows by table
OWNER = ("created", "process_mark")  # what tells a run from one of the same number in another database
KEYS = {name: key for name, (_, key, _) in TABLES.items()}


def folders(database: Path) -> tuple[Path, Path]:
    """Where results wait: beside the database, or in the user's own folder."""
    name = hashlib.sha256(str(database.resolve()).encode()).hexdigest()[:16]
    return database.with_name(f"{database.name}.waiting"), Path(platformdirs.user_state_dir("cooperative-adas-studio"), "waiting", name)


def found(database: Path) -> Iterator[Path]:
    """The files that wait."""
    for folder in folders(database):
        yield from sorted(folder.glob("run-*.db"))


def results(database: Path) -> Iterator[tuple[Path, Result]]:
    """What waits, file by file; what cannot be read waits on."""
    for file in found(database):
        with suppress(StoreError):
            yield file, read(file)


def of(database: Path, run: dict[str, Any]) -> tuple[Path, dict[str, Any]] | None:
    """The file in which the result of a run waits, and what its row will be. Raises StoreError when that file is damaged."""
    for file in [each for folder in folders(database) if (each := folder / file_name(run["run"])).is_file()]:
        row = read(file, ("runs",))["runs"][0]
        if belongs(row, run):
            return file, row
    return None


def belongs(result: dict[str, Any], run: dict[str, Any]) -> bool:
    """Whether a result is that of a run, which nobody has finished."""
    return run["status"] == "running" and all(result[name] == run[name] for name in OWNER)


def file_name(run: int) -> str:
    """The file of a run."""
    return f"run-{run}.db"


def keep(database: Path, result: Result, why: StoreError) -> Path:
    """Puts a result where there is room; returns the file. Raises StoreError when there is none."""
    run = result["runs"][0]["run"]
    for folder in folders(database):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            return written(folder / file_name(run), result)
        except (OSError, sqlite3.Error):
            continue
    remedy = f"make room, and run it again; tried {', '.join(map(str, folders(database)))}"
    raise StoreError(f"The result of run {run} is lost: {why.message}", [*why.problems, Problem("result", "cannot be kept", remedy=remedy)])


def written(file: Path, result: Result) -> Path:
    """Writes a file at once: it is whole, or not there."""
    beside = file.with_suffix(".partial")
    beside.unlink(missing_ok=True)
    try:
        with closing(sqlite3.connect(beside)) as connection:
            for name, rows in result.items():
                types = {column: kind for column, kind in TABLES[name][0].items() if rows and column in rows[0]}
                Database(connection).table(name).insert_all(rows, pk=KEYS[name], columns=types)
        os.replace(beside, file)
    finally:
        beside.unlink(missing_ok=True)
    return file


def read(file: Path, tables: tuple[str, ...] = tuple(TABLES)) -> Result:
    """What waits in a file. Raises StoreError."""
    try:
        with closing(sqlite3.connect(f"{file.absolute().as_uri()}?mode=ro", uri=True)) as connection:
            database = Database(connection)
            present = set(database.table_names())
            found = {name: list(database.table(name).rows) for name in tables if name in present}
    except (sqlite3.Error, UnicodeError) as error:
        raise damaged(file, str(error)) from None
    if len(found.get("runs", ())) != 1 or not found["runs"][0].keys() >= {"run", "status", "error", *OWNER}:
        raise damaged(file, "is not the result of one run")
    return found


def damaged(file: Path, why: str) -> StoreError:
    """What is told of a file that is not as it was written."""
    return StoreError(f"{file} cannot be read.", [Problem(str(file), why, remedy="move it elsewhere, and run it again")])
