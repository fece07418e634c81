"""Recordings of runs that are not over: each a folder beside the database, which its process writes to while it runs.

    runs.db.recording/run-7-3f2a9c01/     what execution/shelf.py and salvage.py put there

The name says of which run it is, by number and owner, so a recording belongs to no run of the same number in another database. It goes when
the result of its run has gone into the database or waits beside it; a recording whose process has gone is read where it lies, and
taken in by the next process that writes.
"""

import hashlib
import re
import shutil
from collections.abc import Iterator
from contextlib import suppress
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from studio.errors import Problem, StoreError
from studio.execution.shelf import END, Folder, NoRoom

if TYPE_CHECKING:
    from studio.execution.record import Record

MOST = 4e9  # [B] that a run may record
WHY = "why"
SPARE, ROOM = "spare", 1 << 14  # a file that keeps room [B] for the reason on a disk that fills up
SHORT = 2000  # letters of a reason that fit in there, whatever they are
ENDINGS = ("failed", "killed", "stopped")  # of a run that brought no result


def folder_of(database: Path, row: dict[str, Any]) -> Path:
    """The folder of a run, whether it is there or not."""
    owner = hashlib.sha256(f"{row['created']} {row['process_mark']}".encode()).hexdigest()[:8]
    return database.with_name(f"{database.name}.recording") / f"run-{row['run']}-{owner}"


def found(database: Path) -> Iterator[tuple[int, Path]]:
    """The recordings beside a database, with the numbers of their runs."""
    for folder in sorted(database.with_name(f"{database.name}.recording").glob("run-*")):
        if number := re.fullmatch(r"run-(\d{1,18})-[0-9a-f]{8}", folder.name):
            yield int(number[1]), folder


def begin(folder: Path) -> Folder:
    """A new one. Raises StoreError when there is no room for it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / SPARE).write_bytes(bytes(ROOM))
    except OSError as error:
        problem = Problem(str(folder.parent), error.strerror or str(error), remedy="make room, or make it writable")
        raise StoreError(f"Nothing can be recorded beside {folder.parent.name.removesuffix('.recording')}.", [problem]) from None
    return Folder(folder, MOST)


def remove(folder: Path) -> None:
    """It is not needed any more. Who reads meanwhile finds all of it or nothing."""
    with suppress(OSError):
        folder.rename(folder.with_name(f"gone-{folder.name}"))
    for each in folder.parent.glob("gone-*"):
        shutil.rmtree(each, ignore_errors=True)
    with suppress(OSError):
        folder.parent.rmdir()  # when it was the last


def set_aside(folder: Path) -> Path:
    """Keeps one of which nothing can be made, where nobody looks for recordings; returns where."""
    return folder.rename(folder.with_name(f"damaged-{folder.name}"))


def put_down(folder: Path, status: str, error: str) -> None:
    """How its run has ended, for who finds it; on a full disk the beginning of that. When that fails too it is told as killed."""
    for text in (error, error[:SHORT]):
        with suppress(NoRoom, OSError):
            Folder(folder).write(WHY, [{"status": status, "error": text}])
            return
        with suppress(OSError):
            (folder / SPARE).unlink()
            (folder / f"{WHY}.jsonl").unlink()  # of which only a part may be there


def tell_to_end(folder: Path) -> None:
    """Tells the run that is recorded there to end; it looks now and then. Raises StoreError when that cannot be told."""
    try:
        (folder / END).touch()
    except OSError as error:
        raise StoreError("The run cannot be told to end.", [Problem(str(folder), error.strerror or str(error))]) from None


def ending(folder: Path) -> dict[str, Any]:
    """What was put down, if that was done and is whole."""
    with suppress(OSError, ValueError, LookupError, TypeError, RecursionError):
        found = Folder(folder).lines(WHY)[0]
        if found["status"] in ENDINGS and isinstance(found["error"], str):
            return {"status": found["status"], "error": found["error"]}
    return {}


def until(folder: Path) -> float:
    """Up to when there are samples [s]."""
    with suppress(OSError, ValueError):
        last = Folder(folder).progress()[1]
        return last if isfinite(last) else 0.0
    return 0.0


def record(folder: Path) -> "Record | None":
    """All of it as one record; nothing when there is none, or none any more: of one that goes while it is read, parts are missing."""
    from studio.execution import salvage

    try:
        found = salvage.salvaged(Folder(folder)) if folder.is_dir() else None
    except Exception:
        if folder.is_dir():
            raise
        return None
    return found if folder.is_dir() else None
