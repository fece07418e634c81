"""Runs in the database: begin, finish, find, compare their inputs.

A run has its row from its first moment, with the process that works on it. When that process is gone and the row still
says "running", the run was killed; the row says so as soon as somebody looks.

What only traces need is imported with them: a list of runs waits neither for pyarrow nor for the simulator.
"""

import hashlib
import json
import os
import sqlite3
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import psutil
from sqlite_utils import Database

from studio.assess.metric import Measured
from studio.errors import UnknownError
from studio.execution.happening import Happening, Number
from studio.store.tables import open_database, reopen_database, unusable

if TYPE_CHECKING:
    import numpy as np

    from studio.execution.message import Messages
    from studio.execution.record import Record
    from studio.kind.registry import Kind
    from studio.provenance import Provenance

LARGEST_RUN = 2**63 - 1  # that SQLite can count to
CLOCK_SLACK = 2.0  # [s] start times of processes are compared with this tolerance


@dataclass(frozen=True)
class Row:
    """A run as it stands in the database. `parameters` are those that were set, by path; `kinds` the digests of all that it used.

    `revisions` say what git has told of the folders of its code, each with the digest of its patch. Runs of an older studio have none.
    """

    run: int
    scenario: str
    scenario_hash: str
    parent: int | None
    seed: int
    status: str
    error: str | None
    state_hash: str | None
    code_version: str
    created: str
    sim_time_s: float | None
    wall_time_s: float | None
    parameters: dict[str, Any] = field(default_factory=dict)
    unmet: list[str] = field(default_factory=list)
    metrics: dict[str, Measured] = field(default_factory=dict)
    kinds: dict[str, str] = field(default_factory=dict)
    host: str | None = None
    versions: dict[str, str] = field(default_factory=dict)
    revisions: list[dict[str, Any]] = field(default_factory=list)

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


@dataclass
class Runs:
    """The runs of one database file."""

    path: Path
    database: Database

    def begin(self, *, scenario: str, title: str, document: dict, scenario_hash: str, map_digest: str, parent: int | None,
              seed: int, parameters: dict[str, Any], provenance: "Provenance") -> int:  # fmt: skip
        """A new row that says "running"; returns its number."""
        if parent is not None:
            self.find(parent)
        process = psutil.Process()
        row = {
            "scenario": scenario,
            "scenario_hash": scenario_hash,
            "parent": parent,
            "seed": seed,
            "status": "running",
            "code_version": provenance.code_version,
            "host": provenance.host,
            "versions": json.dumps(provenance.versions),
            "kinds": json.dumps({f"{kind.sort}.{kind.name}": kind.digest for kind in provenance.kinds}),
            "created": datetime.now(UTC).isoformat(timespec="milliseconds"),
            "parameters": json.dumps(parameters, ensure_ascii=False),
            "unmet": "[]",
            "process": process.pid,
            "process_started": process.create_time(),
        }
        with self.writing():
            kept = {"hash": scenario_hash, "title": title, "map_digest": map_digest}
            content = {key: value for key, value in document.items() if key != "seed"}
            kept["document"] = json.dumps(content, ensure_ascii=False)
            self.database.table("scenarios").insert(kept, pk="hash", ignore=True)
            self.keep_kinds(provenance.kinds)
            row["revisions"] = json.dumps([asdict(each) | {"patch": self.keep(each.patch)} for each in provenance.revisions])
            number = self.database.table("runs").insert(row, pk="run").last_pk
            assert number is not None, "a row that was inserted has a key"
            return int(number)

    def keep(self, text: str) -> str:
        """Keeps a text once, by its digest; nothing of nothing."""
        digest = hashlib.sha256(text.encode()).hexdigest() if text else ""
        if text:
            self.database.table("texts").insert({"digest": digest, "text": text}, pk="digest", ignore=True)
        return digest

    def keep_kinds(self, kinds: Sequence["Kind"]) -> None:
        """Keeps kinds with their texts, those that are not kept already."""
        present = {row["digest"] for row in self.database.query("select digest from kinds")}
        for kind in [each for each in kinds if each.digest not in present]:
            files = json.dumps({name: self.keep(text) for name, text in kind.texts.items()})
            kept = {"digest": kind.digest, "kind": kind.sort, "name": kind.name, "files": files}
            self.database.table("kinds").insert(kept, pk="digest", ignore=True)

    def finish(self, run: int, *, status: str, error: str | None, state_hash: str, record: "Record", sim_time_s: float,
               wall_time_s: float, metrics: dict[str, Measured], unmet: list[str], channels: Sequence[str] = ()) -> None:  # fmt: skip
        """Writes everything a run has brought, in one transaction: all of it or nothing."""
        from studio.store import message, trace

        ending = {
            "status": status,
            "error": error,
            "state_hash": state_hash,
            "sim_time_s": sim_time_s,
            "wall_time_s": wall_time_s,
            "unmet": json.dumps(unmet, ensure_ascii=False),
        }
        parquet, (sent, entries) = trace.write(record, channels), message.write(record.messages)
        with self.writing():
            self.database.table("runs").update(run, ending)
            self.database.table("metrics").insert_all(metric_rows(run, metrics), pk=("run", "name"), replace=True)
            self.database.table("events").insert_all(event_row(run, each) for each in record.happenings)
            self.database.table("traces").insert({"run": run, "parquet": parquet}, pk="run", replace=True)
            self.database.table("messages").insert({"run": run, "sent": sent, "entries": entries}, pk="run", replace=True)

    def end(self, run: int, status: str, error: str) -> None:
        """Marks a run that brought nothing; one that is over stays as it is."""
        change = "update runs set status = ?, error = ? where run = ? and status = 'running'"
        with self.writing():
            self.database.conn.execute(change, [status, error, run])

    @contextmanager
    def writing(self) -> Generator[None]:
        """One transaction: all of it or nothing. SQLite's refusals become StoreErrors."""
        connection = self.database.conn
        try:
            connection.execute("begin immediate")
            try:
                yield
                connection.commit()
            except BaseException:
                connection.rollback()
                raise
        except sqlite3.Error as error:
            raise unusable(self.path, error) from None

    def find(self, run: int) -> Row:
        """One run; raises UnknownError that says which there are."""
        rows = self.select(where="run = ?", values=[run]) if 0 < run <= LARGEST_RUN else []
        if not rows:
            last = self.database.execute("select max(run) from runs").fetchone()[0]
            have = f"the newest is {last}" if last else "there is none yet"
            raise UnknownError(f"There is no run {run} in {self.path}; {have}")
        return rows[0]

    def select(self, *, where: str = "1", values: Sequence[Any] = (), limit: int = -1) -> list[Row]:
        """Runs, newest first, with their metrics."""
        self.mark_killed()
        query = f"select * from runs where {where} order by run desc limit ?"
        rows = [dict(row) for row in self.rows(query, (*values, limit))]
        metrics = self.metrics_of([row["run"] for row in rows])
        return [row_of(row, metrics.get(row["run"], {})) for row in rows]

    def rows(self, query: str, values=()) -> list[dict[str, Any]]:
        """Rows of a query as dictionaries."""
        try:
            return list(self.database.query(query, list(values)))
        except sqlite3.Error as error:
            raise unusable(self.path, error) from None

    def metrics_of(self, runs: list[int]) -> dict[int, dict[str, Measured]]:
        """Metrics of many runs."""
        found: dict[int, dict[str, Measured]] = {}
        marks = ", ".join("?" * len(runs))
        for row in self.rows(f"select * from metrics where run in ({marks}) order by rowid", runs):
            found.setdefault(row["run"], {})[row["name"]] = measured_of(row)
        return found

    def mark_killed(self) -> None:
        """Rows that still say "running" although their process is gone."""
        query = "select run, process, process_started from runs where status = 'running'"
        for row in self.rows(query):
            if not is_alive(row["process"], row["process_started"]):
                self.end(row["run"], "killed", "The process that ran it ended before the run did.")

    def document(self, row: Row) -> dict[str, Any]:
        """The full scenario of a run, with its seed."""
        return json.loads(self.database.table("scenarios").get(row.scenario_hash)["document"]) | {"seed": row.seed}

    def sources(self, row: Row) -> dict[str, dict[str, str]]:
        """The texts of every kind that a run used, file by file, its own first."""
        found = {}
        for name, digest in row.kinds.items():
            files = json.loads(self.database.table("kinds").get(digest)["files"])
            found[name] = {file: self.text(text) for file, text in files.items()}
        return found

    def text(self, digest: str) -> str:
        """A text by its digest."""
        return self.database.table("texts").get(digest)["text"] if digest else ""

    def parquet(self, run: int) -> bytes:
        """The traces of a run as they are kept; raises UnknownError when there are none."""
        self.find(run)
        found = self.rows("select parquet from traces where run = ?", [run])
        if not found:
            raise UnknownError(f"Run {run} has no traces: it did not come to its end.")
        return found[0]["parquet"]

    def record(self, run: int) -> "Record":
        """All that is kept of a run in one piece, but for the ages of links; raises UnknownError when there is none."""
        from studio.store import trace

        return trace.record_of(self.parquet(run), self.events(run), self.messages(run))

    def messages(self, run: int) -> "Messages":
        """What was sent in a run, and what became of it; raises UnknownError when that was not kept."""
        from studio.store import message

        self.find(run)
        found = self.rows("select sent, entries from messages where run = ?", [run])
        if not found:
            raise UnknownError(f"Run {run} has no log of messages: it did not come to its end, or an older studio ran it.")
        return message.read(found[0]["sent"], found[0]["entries"])

    def channels(self, run: int) -> list[dict[str, str]]:
        """Recorded channels of a run; none when it has no traces."""
        from studio.store import trace

        found = self.rows("select parquet from traces where run = ?", [run])
        return trace.channels(found[0]["parquet"]) if found else []

    def trace(self, run: int, names: list[str]) -> dict[str, "np.ndarray"]:
        """Time and channels of a run."""
        from studio.store import trace

        return trace.read(self.parquet(run), names)

    def events(self, run: int) -> list[Happening]:
        """What happened in a run."""
        return [event_of(row) for row in self.rows("select * from events where run = ? order by time, rowid", [run])]

    def close(self) -> None:
        """Closes the file."""
        self.database.conn.close()


def open_runs(path: str | os.PathLike) -> Runs:
    """The runs of a database file, made when there is none. Raises StoreError when it cannot be used."""
    path = Path(path)
    return Runs(path, open_database(path))


def reopen_runs(path: Path) -> Runs:
    """Another connection to a database that `open_runs` has opened before, for one request."""
    return Runs(path, reopen_database(path))


def metric_rows(run: int, metrics: dict[str, Measured]) -> list[dict[str, Any]]:
    """Metrics as rows."""
    return [
        {"run": run, "name": name, **asdict(each), "subject": json.dumps(each.subject, ensure_ascii=False)}
        for name, each in metrics.items()
    ]


def measured_of(row: dict[str, Any]) -> Measured:
    """A metric of the database's row, which tells no more than its value where it was written before there was more to tell."""
    subject = tuple(json.loads(row["subject"] or "[]"))
    return Measured(row["value"], row["unit"], row["goal"], subject, row["time"], row["kind"] or "", row["about"] or "")


def event_row(run: int, event: Happening) -> dict[str, Any]:
    """An event as a row; units, numbers and words as JSON."""
    plain = event.as_json()
    return {"run": run} | plain | {key: json.dumps(plain[key], ensure_ascii=False) for key in ("units", "numbers", "words")}


def event_of(row: dict[str, Any]) -> Happening:
    """An event of the database's row, which has no kind where it was written before there were any."""
    numbers = {name: Number(**each) for name, each in json.loads(row["numbers"] or "{}").items()}
    units, words = tuple(json.loads(row["units"] or "[]")), json.loads(row["words"] or "{}")
    plain = {key: row[key] for key in ("time", "text", "vehicle", "x", "y")}
    return Happening(**plain, kind=row["kind"] or "", units=units, numbers=numbers, words=words)


STRUCTURED = {"parameters": dict, "unmet": list, "kinds": dict, "versions": dict, "revisions": list}


def row_of(row: dict[str, Any], metrics: dict[str, Measured]) -> Row:
    """A Row from the database's row."""
    plain = {key: row[key] for key in row if key not in ("process", "process_started", *STRUCTURED)}
    structured: dict[str, Any] = {key: json.loads(row[key]) if row[key] else empty() for key, empty in STRUCTURED.items()}
    return Row(**plain, **structured, metrics=metrics)


def is_alive(process: int, started: float) -> bool:
    """Whether the process that began a run still lives; a number can be given to another process later."""
    try:
        found = psutil.Process(process)
        return found.status() != psutil.STATUS_ZOMBIE and abs(found.create_time() - started) < CLOCK_SLACK
    except psutil.NoSuchProcess:
        return False
