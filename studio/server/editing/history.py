"""The history of scenario files as they were edited: every change by name, with the text before and after it, on the disk.

It lies beside runs.db, so it outlives the server. Texts are kept once each, by digest. A change is never taken out: what was undone is a
change of its own, so that the numbers of changes, the revisions, only grow, and everybody can say which one he has seen.

    add(scenario, change, texts)  →  its revision
    changes(scenario)             →  Change, oldest first
    steps(changes)                →  what can be undone, what can be done again
"""

import sqlite3
import threading
import zlib
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

from studio.errors import Problem, StoreError
from studio.scenario.text.document import digest

Sort = Literal["edit", "undo", "redo", "elsewhere"]
TABLES = """
CREATE TABLE IF NOT EXISTS texts (digest TEXT PRIMARY KEY, text BLOB NOT NULL) STRICT;
CREATE TABLE IF NOT EXISTS changes (
    scenario TEXT NOT NULL, revision INTEGER NOT NULL, sort TEXT NOT NULL, name TEXT NOT NULL, who TEXT NOT NULL, time TEXT NOT NULL,
    before TEXT NOT NULL, after TEXT NOT NULL, PRIMARY KEY (scenario, revision)
) STRICT;
"""
WAIT = 10.0  # [s] for another process that writes


@dataclass(frozen=True)
class Change:
    """One change of a file: its number, what it was, its name, by whom, when, and the digests of the texts before and after it."""

    revision: int
    sort: Sort
    name: str
    who: str
    time: str
    before: str
    after: str


@dataclass(frozen=True)
class History:
    """The history of all scenarios of a desk, in one SQLite file."""

    path: Path
    lock: threading.Lock = field(default_factory=threading.Lock)

    @contextmanager
    def opened(self) -> Iterator[sqlite3.Connection]:
        """The database, for one thing; raises StoreError when it cannot be used."""
        try:
            with self.lock, closing(sqlite3.connect(self.path, timeout=WAIT)) as found, found:
                found.executescript(TABLES)
                yield found
        except sqlite3.Error as error:
            problem = Problem(str(self.path), str(error), remedy="mend or remove this file; the scenario files do not need it")
            raise StoreError("The history of edits cannot be used.", [problem]) from None

    def changes(self, scenario: str) -> list[Change]:
        """All changes of a scenario, the oldest first."""
        with self.opened() as found:
            rows = found.execute(
                "SELECT revision, sort, name, who, time, before, after FROM changes WHERE scenario = ? ORDER BY revision", (scenario,)
            )
            return [Change(*row) for row in rows]

    def text(self, wanted: str) -> str:
        """A text by its digest; raises StoreError when it is gone."""
        with self.opened() as found:
            row = found.execute("SELECT text FROM texts WHERE digest = ?", (wanted,)).fetchone()
        if row is None:
            raise StoreError("The history of edits lacks a text.", [Problem(str(self.path), "holds no text of this digest", wanted)])
        return zlib.decompress(row[0]).decode()

    def add(self, scenario: str, sort: Sort, name: str, who: str, *, before: str, after: str) -> int:
        """Writes down a change from one text to another; returns its number, which is one more than the last."""
        when = datetime.now(UTC).isoformat(timespec="seconds")
        with self.opened() as found:
            found.executemany("INSERT OR IGNORE INTO texts VALUES (?, ?)", map(packed, (before, after)))
            (last,) = found.execute("SELECT coalesce(max(revision), 0) FROM changes WHERE scenario = ?", (scenario,)).fetchone()
            row = (scenario, last + 1, sort, name, who, when, digest(before), digest(after))
            found.execute("INSERT INTO changes VALUES (?, ?, ?, ?, ?, ?, ?, ?)", row)
            return last + 1

    def rename(self, scenario: str, name: str) -> None:
        """The history goes with its file, which has another name now."""
        with self.opened() as found:
            found.execute("DELETE FROM changes WHERE scenario = ?", (name,))
            found.execute("UPDATE changes SET scenario = ? WHERE scenario = ?", (name, scenario))

    def forget(self, scenario: str) -> None:
        """A new file has this name: what was done to an older one is not its history."""
        with self.opened() as found:
            found.execute("DELETE FROM changes WHERE scenario = ?", (scenario,))


def packed(text: str) -> tuple[str, bytes]:
    """A text as it is kept."""
    return digest(text), zlib.compress(text.encode())


def steps(changes: Iterable[Change]) -> tuple[list[Change], list[Change]]:
    """What can be undone and what can be done again, each with the next one last."""
    done: list[Change] = []
    undone: list[Change] = []
    for each in changes:
        if each.sort == "undo" and done:
            undone.append(done.pop())
        elif each.sort == "redo" and undone:
            done.append(undone.pop())
        elif each.sort in ("edit", "elsewhere"):
            done.append(each)
            undone.clear()
    return done, undone
