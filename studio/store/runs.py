"""Runs in the database: begin, finish, find, compare their inputs.

A run has its row from its first moment, with the process that works on it. When that process is gone and the row still
says "running", the run was killed; whoever looks is told so, and nothing is written by looking. What it had recorded until then lies
beside the database (recording.py), is read there, and taken in by the next process that writes. A result that cannot go in, for want
of room or because somebody holds the file, waits beside it too (waiting.py).

What only traces need is imported with them: a list of runs waits neither for pyarrow nor for the simulator.
"""

import hashlib
import json
import os
import sqlite3
import weakref
from collections.abc import Generator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from studio.assess.metric import Measured
from studio.errors import Problem, StoreError, StudioError, UnknownError, short
from studio.execution.happening import Happening, Number
from studio.store import owner, recording, waiting
from studio.store.sqlite import Database
from studio.store.tables import open_database, read_database, reopen_database, unusable

if TYPE_CHECKING:
    import numpy as np

    from studio.execution.message import Messages
    from studio.execution.record import Record
    from studio.execution.shelf import Folder
    from studio.kind.registry import Kind
    from studio.provenance import Provenance

PIECE = 50_000_000  # [B] of a file that stand in one value; SQLite takes 1e9 in a row
LARGEST_RUN = 2**63 - 1  # that SQLite can count to
WAITS = "The result waits in {} and is taken in by the next run, as soon as the database takes it."
KILLED = "The process that ran it ended before the run did."
LEFT = "The server in whose queue it waited ended before its turn came."
UNTIL = "What was recorded until {:g} s is kept."
METRICS_AS_TEXT = """select run, json_group_object(name, json_object(
    'value', iif(abs(value) < 1e308, json(printf('%!.17g', value)), null), 'unit', unit, 'goal', goal,
    'subject', iif(json_valid(subject), json(subject), json_array()),
    'time', iif(abs(time) < 1e308, json(printf('%!.17g', time)), null), 'kind', coalesce(kind, ''), 'about', coalesce(about, '')
)) as metrics from metrics where run in ({}) group by run"""


@dataclass(frozen=True)
class Row:
    """A run as it stands in the database. `parameters` are those that were set, by path; `kinds` the digests of all that it used.

    `revisions` say what git has told of the folders of its code, each with the digest of its patch. Runs of an older studio have none.
    `verdict` is the last that was given, with its `reason`; `name`, `tags` and `note` are those that somebody gave it.
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
    verdict: str = "open"
    reason: str = ""
    name: str = ""
    tags: list[str] = field(default_factory=list)
    note: str = ""

    @property
    def is_whole(self) -> bool:
        """Whether it came to its end: metrics of any other were measured over less, and are not to be ranked with those that did."""
        return self.status == "done"

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


@dataclass
class Runs:
    """The runs of one database file, which is let go when nobody has them any more: who is alone with it may replace it."""

    path: Path
    database: Database

    def __post_init__(self) -> None:
        # a Database refers to itself in circles, and would keep the file open until the next time that garbage is collected
        weakref.finalize(self, self.database.conn.close).atexit = False

    def begin(self, *, scenario: str, title: str, document: dict, scenario_hash: str, map_digest: str, parent: int | None,
              seed: int, parameters: dict[str, Any], provenance: "Provenance", status: str = "running",
              run: int | None = None) -> int:  # fmt: skip
        """A new row that says "running" or "waiting"; or that of a run that waited, whose turn has come. Returns its number.

        Raises UnknownError when there is no such parent, or the run does not wait any more.
        """
        if parent is not None:
            self.find(parent)
        row = {
            "scenario": scenario,
            "scenario_hash": scenario_hash,
            "parent": parent,
            "seed": seed,
            "status": status,
            "code_version": provenance.code_version,
            "host": provenance.host,
            "versions": json.dumps(provenance.versions),
            "kinds": json.dumps({f"{kind.sort}.{kind.name}": kind.digest for kind in provenance.kinds}),
            "created": datetime.now(UTC).isoformat(timespec="milliseconds"),
            "parameters": json.dumps(parameters, ensure_ascii=False),
            "unmet": "[]",
            "process": os.getpid(),
            "process_mark": owner.mark(os.getpid()),
        }
        with self.writing():
            kept = {"hash": scenario_hash, "title": title, "map_digest": map_digest}
            content = {key: value for key, value in document.items() if key != "seed"}
            kept["document"] = json.dumps(content, ensure_ascii=False)
            self.database.table("scenarios").insert(kept, pk="hash", ignore=True)
            self.keep_kinds(provenance.kinds)
            row["revisions"] = json.dumps([asdict(each) | {"patch": self.keep(each.patch)} for each in provenance.revisions])
            if run is not None:
                self.check_waiting(run)
                self.database.table("runs").update(run, row)
                return run
            number = self.database.table("runs").insert(row, pk="run").last_pk
            assert number is not None, "a row that was inserted has a key"
            return int(number)

    def check_waiting(self, run: int) -> None:
        """Raises UnknownError for a run that does not wait."""
        if not self.rows("select run from runs where run = ? and status = 'waiting'", [run]):
            raise UnknownError(f"Run {run} does not wait any more.", [Problem("run", "is not in the queue", str(run))])

    def take_out(self, run: int, why: str) -> bool:
        """Takes a run out of the queue; whether it waited."""
        change = "update runs set status = 'cancelled', error = ? where run = ? and status = 'waiting'"
        with self.writing():
            return self.database.conn.execute(change, [why, run]).rowcount == 1

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

    def finish(self, run: int, *, status: str, error: str | None, state_hash: str | None, record: "Record",
               sim_time_s: float, wall_time_s: float | None, metrics: dict[str, Measured], unmet: list[str],
               channels: Sequence[str] = ()) -> None:  # fmt: skip
        """Writes everything a run has brought, in one transaction: all of it or nothing. What cannot go in waits beside the database.

        Raises StoreError when it can be kept nowhere.
        """
        from studio.store import message, trace

        ending = {
            "status": status,
            "error": error,
            "state_hash": state_hash,
            "sim_time_s": sim_time_s,
            "wall_time_s": wall_time_s,
            "unmet": json.dumps(unmet, ensure_ascii=False),
        }
        known = self.rows(f"select {', '.join(waiting.OWNER)} from runs where run = ?", [run])[0]
        folder = recording.folder_of(self.path, known | {"run": run})
        parquet, (sent, entries) = trace.write_beside(folder, record, channels), message.write(record.messages)
        result = {
            "runs": [{"run": run} | ending],
            "metrics": metric_rows(run, metrics),
            "events": [event_row(run, each) for each in record.happenings],
            "traces": [{"run": run, "parquet": parquet[:PIECE]}],
            "messages": [{"run": run, "sent": sent[:PIECE], "entries": entries[:PIECE]}],
            "pieces": [*pieces(run, "parquet", parquet), *pieces(run, "sent", sent), *pieces(run, "entries", entries)],
        }
        try:
            self.put(result)
        except StoreError as refused:
            waiting.keep(self.path, result | {"runs": [{"run": run} | ending | known]}, refused)
        recording.remove(folder)

    def put(self, result: waiting.Result) -> None:
        """Puts the rows of a run that is over in their tables: all of them or none; of a run that has been put there already, none."""
        (row,) = result["runs"]
        with self.writing():
            if not self.rows("select run from runs where run = ? and status = 'running'", [row["run"]]):
                return
            self.database.table("runs").update(row["run"], {key: value for key, value in row.items() if key != "run"})
            self.database.table("metrics").insert_all(result["metrics"], pk=("run", "name"), replace=True)
            self.database.table("events").insert_all(result["events"])
            for name in ("traces", "messages"):
                self.database.table(name).insert_all(result[name], pk="run", replace=True)
            self.database.table("pieces").insert_all(result["pieces"], pk=("run", "column", "number"), replace=True)

    def take_in(self) -> None:
        """Takes in the results that wait beside the database, recordings whose runs were left, and who waits for a server that has gone.

        What cannot go in stays where it is.
        """
        for row in self.rows("select * from runs where status = 'waiting'"):
            if owner.is_gone(row["process"], row["process_mark"]):
                self.take_out(row["run"], LEFT)
        for file, result in waiting.results(self.path):
            with suppress(StoreError):
                if self.takes(result):
                    file.unlink()
        for run, folder in recording.found(self.path):
            for row in self.rows("select * from runs where run = ?", [run]):
                if folder == recording.folder_of(self.path, row) and (row["status"] != "running" or self.is_left(row)):
                    self.salvage(run)

    def is_left(self, row: dict[str, Any]) -> bool:
        """Whether a run was not finished, and will not be: its process has gone, and no result waits."""
        if row["status"] != "running" or not owner.is_gone(row["process"], row["process_mark"]):
            return False
        with suppress(StoreError):
            return not waiting.of(self.path, row)
        return True

    def shelf(self, run: int) -> "Folder":
        """Where a run that begins is recorded. Raises StoreError."""
        return recording.begin(self.folder(run))

    def folder(self, run: int) -> Path:
        """Where that lies."""
        (row,) = self.rows("select run, created, process_mark from runs where run = ?", [run])
        return recording.folder_of(self.path, row)

    def leave(self, run: int, status: str, error: str) -> None:
        """Puts down how a run ended that brought no result; what it had recorded is taken in by the next process that writes."""
        folder = self.folder(run)
        if folder.is_dir():
            recording.put_down(folder, status, error)
        else:
            self.end(run, status, error)

    def break_off(self, run: int, status: str, error: str) -> None:
        """The same, and takes it in at once. What cannot go in now is taken in later."""
        self.leave(run, status, error)
        if self.folder(run).is_dir():
            self.salvage(run)

    def salvage(self, run: int) -> None:
        """Puts the recording of a run into the database, with the metrics that can be measured, and removes it.

        One of which nothing can be made is set aside, and the row says where and why: nobody else is to fail over it.
        """
        folder, row = self.folder(run), self.rows("select * from runs where run = ?", [run])[0]
        ended = {"status": "killed", "error": KILLED} | recording.ending(folder)
        try:
            if row["status"] == "running":
                self.finish_with(run, recording.record(folder), **ended)
        except StoreError:
            raise
        except Exception as error:
            aside = recording.set_aside(folder)
            self.end(run, ended["status"], f"{ended['error']} What it had recorded is in {aside}, and cannot be assessed: {error!r}")
        recording.remove(folder)

    def finish_with(self, run: int, found: "Record | None", status: str, error: str) -> None:
        """Finishes a run with what was recorded of it, if anything."""
        from studio.assess.assessment import assessed
        from studio.scenario.schema import Scenario

        if found is None:
            self.end(run, status, error)
            return
        row = self.find(run)
        scenario = Scenario.model_validate(self.document(row))
        result = assessed(found, scenario)
        last = float(result.record.time[-1])
        self.finish(
            run,
            status=status,
            error="\n".join([f"{error} {UNTIL.format(last)}", *result.raised]),
            state_hash=None,
            record=result.record,
            sim_time_s=round(last, 9),
            wall_time_s=None,
            metrics=result.metrics,
            unmet=result.unmet,
            channels=scenario.recording.channels,
        )

    def takes(self, result: waiting.Result) -> bool:
        """Puts in a result that waits, and tells whether it is one of this database. Raises StoreError when it cannot go in."""
        (row,) = result["runs"]
        belongs = any(waiting.belongs(row, each) for each in self.rows("select * from runs where run = ?", [row["run"]]))
        if belongs:
            with self.intact(row["run"], "result"):
                self.put({name: [] for name in waiting.TABLES} | result)
        return belongs

    def end(self, run: int, status: str, error: str) -> None:
        """Marks a run that brought nothing; one that is over stays as it is."""
        change = "update runs set status = ?, error = ? where run = ? and status in ('running', 'waiting')"
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

    @contextmanager
    def intact(self, run: int, what: str) -> Generator[None]:
        """Reading of what was kept of a run; when that is not as it was written, raises StoreError."""
        try:
            yield
        except (StudioError, MemoryError):
            raise
        except Exception as error:  # what was damaged can be anything
            why = f"cannot be read ({type(error).__name__}: {short(str(error))})"
            problem = Problem(f"{what} of run {run}", why, remedy="run it again, or take a copy of the database")
            raise StoreError(f"Run {run} is damaged in {self.path}.", [problem]) from None

    def find(self, run: int) -> Row:
        """One run; raises UnknownError that says which there are."""
        rows = self.select(where="run = ?", values=[run]) if 0 < run <= LARGEST_RUN else []
        if not rows:
            last = self.rows("select max(run) as last from runs")[0]["last"]
            have = f"the newest is {last}" if last else "there is none yet"
            problem = Problem("run", "does not exist", short(run), f"1 to {last}" if last else "", "list the runs")
            raise UnknownError(f"There is no run {short(run)} in {self.path}; {have}", [problem])
        return rows[0]

    def select(self, *, where: str = "1", values: Sequence[Any] = (), limit: int = -1, measured: bool = True) -> list[Row]:
        """Runs, newest first, with their metrics where they are `measured`."""
        query = f"select * from runs where {where} order by run desc limit ?"
        try:
            with self.looking():
                rows = [self.seen(row) for row in self.rows(query, (*values, limit))]
                found = [row["run"] for row in rows]
                metrics, said = self.metrics_of(found) if measured else {}, self.said_of(found)
            return [row_of(row | UNSAID | said.get(row["run"], {}), metrics.get(row["run"], {})) for row in rows]
        except (LookupError, TypeError) as error:
            problem = Problem(
                "runs", f"have not the columns that they should have ({short(str(error))})", remedy="take a copy of the database"
            )
            raise StoreError(f"The list of runs is damaged in {self.path}.", [problem]) from None

    def by_scenario(self) -> dict[str, int]:
        """How many runs each scenario has."""
        return {row["scenario"]: row["runs"] for row in self.rows("select scenario, count(*) as runs from runs group by scenario")}

    def rename_scenario(self, old: str, new: str) -> None:
        """Runs of a scenario whose file has another name from now on."""
        with self.writing():
            self.database.conn.execute("update runs set scenario = ? where scenario = ?", [new, old])

    @contextmanager
    def looking(self) -> Generator[None]:
        """All that is read is of one moment, whoever writes meanwhile."""
        connection = self.database.conn
        is_alone = not connection.in_transaction
        if is_alone:
            connection.execute("begin")
        try:
            yield
        finally:
            if is_alone:
                connection.rollback()

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
            with self.intact(row["run"], "metrics"):
                found.setdefault(row["run"], {})[row["name"]] = measured_of(row)
        return found

    def metrics_as_text(self, runs: list[int]) -> dict[int, str]:
        """Metrics of many runs as JSON, each an object by name: SQLite writes half a million of them in half a second.

        What is damaged of one, or no number, is empty there: a list of all runs is not held up by it.
        """
        marks = ", ".join("?" * len(runs))
        return {row["run"]: row["metrics"] for row in self.rows(METRICS_AS_TEXT.format(marks), runs)}

    def said_of(self, runs: list[int]) -> dict[int, dict[str, Any]]:
        """The last verdict of many runs, their names, tags and notes."""
        marks = ", ".join("?" * len(runs))
        last = f"select max(rowid) from verdicts where run in ({marks}) group by run"
        found = {row.pop("run"): row for row in self.rows(f"select run, verdict, reason from verdicts where rowid in ({last})", runs)}
        for row in self.rows(f"select run, name, tags, note from remarks where run in ({marks})", runs):
            found.setdefault(row.pop("run"), {}).update(row)
        return found

    def seen(self, row: dict[str, Any]) -> dict[str, Any]:
        """A row as it is now: one that says "running" although its process has gone was killed, unless its result waits."""
        if row["status"] == "waiting" and owner.is_gone(row["process"], row["process_mark"]):
            return row | {"status": "cancelled", "error": LEFT}
        if row["status"] != "running":
            return row
        try:
            found, why = waiting.of(self.path, row), KILLED
        except StoreError as damaged:
            found, why = None, str(damaged)
        if found:
            return row | found[1] | {"error": f"{WAITS.format(found[0])} {found[1]['error'] or ''}".strip()}
        if not owner.is_gone(row["process"], row["process_mark"]):
            return row
        folder = recording.folder_of(self.path, row)
        seen = row | {"status": "killed", "error": why} | recording.ending(folder)
        last = recording.until(folder)
        return seen | {"error": f"{seen['error']} {UNTIL.format(last)}", "sim_time_s": round(last, 9)} if last else seen

    def document(self, row: Row) -> dict[str, Any]:
        """The full scenario of a run, with its seed."""
        with self.intact(row.run, "scenario"):
            (found,) = self.rows("select document from scenarios where hash = ?", [row.scenario_hash])
            return json.loads(found["document"]) | {"seed": row.seed}

    def sources(self, row: Row) -> dict[str, dict[str, str]]:
        """The texts of every kind that a run used, file by file, its own first."""
        found = {}
        for name, digest in row.kinds.items():
            with self.intact(row.run, "kinds"):
                (kept,) = self.rows("select files from kinds where digest = ?", [digest])
                found[name] = {file: self.text(text) for file, text in json.loads(kept["files"]).items()}
        return found

    def text(self, digest: str) -> str:
        """A text by its digest."""
        found = self.rows("select text from texts where digest = ?", [digest])
        return found[0]["text"] if found else ""

    def parquet(self, run: int) -> bytes:
        """The traces of a run as they are kept; raises UnknownError when there are none."""
        from studio.store import trace

        row = self.find(run)
        if (parquet := self.kept_parquet(run)) is not None:
            return parquet
        if (record := self.recorded(run)) is not None:
            return trace.write(record, self.document(row)["recording"]["channels"])
        if (parquet := self.kept_parquet(run)) is not None:  # taken in just now
            return parquet
        raise UnknownError(f"Run {run} has no traces: it did not come to its end.")

    def kept_parquet(self, run: int) -> bytes | None:
        """The traces of a run that is over."""
        found = self.rows("select parquet from traces where run = ?", [run])
        return self.whole(run, "parquet", found[0]["parquet"] or b"") if found else None

    def recorded(self, run: int) -> "Record | None":
        """What was recorded so far of a run whose result is not there; nothing when it was taken in meanwhile."""
        with self.intact(run, "recording"), suppress(FileNotFoundError):
            return recording.record(self.folder(run))
        return None

    def whole(self, run: int, column: str, first: bytes) -> bytes:
        """A file with the pieces that did not go into its first value."""
        query = "select bytes from pieces where run = ? and column = ? order by number"
        rest = [row["bytes"] for row in self.rows(query, [run, column])]
        return b"".join([first, *rest]) if rest else first

    def record(self, run: int) -> "Record":
        """All that is kept of a run in one piece, but for the ages of links; raises UnknownError when there is none."""
        from studio.store import trace

        self.find(run)
        found = self.recorded(run)
        if found is not None:
            return found
        parquet, events, messages = self.parquet(run), self.events(run), self.messages(run)
        with self.intact(run, "record"):
            return trace.record_of(parquet, events, messages)

    def messages(self, run: int) -> "Messages":
        """What was sent in a run, and what became of it; raises UnknownError when that was not kept."""
        from studio.store import message

        self.find(run)
        found = self.rows("select sent, entries from messages where run = ?", [run])
        if not found:
            raise UnknownError(f"Run {run} has no log of messages: it did not come to its end, or an older studio ran it.")
        with self.intact(run, "messages"):
            return message.read(*(self.whole(run, column, found[0][column]) for column in ("sent", "entries")))

    def channels(self, run: int) -> list[dict[str, str]]:
        """Recorded channels of a run; none when it has no traces."""
        from studio.store import trace

        try:
            parquet = self.parquet(run)
        except UnknownError:
            self.find(run)
            return []
        with self.intact(run, "traces"):
            return trace.channels(parquet)

    def trace(self, run: int, names: list[str]) -> dict[str, "np.ndarray"]:
        """Time and channels of a run."""
        from studio.store import trace

        parquet = self.parquet(run)
        with self.intact(run, "traces"):
            return trace.read(parquet, names)

    def events(self, run: int) -> list[Happening]:
        """What happened in a run."""
        found = self.rows("select * from events where run = ? order by time, rowid", [run])
        with self.intact(run, "events"):
            return [event_of(row) for row in found]

    def close(self) -> None:
        """Closes the file."""
        self.database.conn.close()


def open_runs(path: str | os.PathLike) -> Runs:
    """The runs of a database file, made when there is none; results that wait are taken in. Raises StoreError when it cannot be used."""
    path = Path(path)
    runs = Runs(path, open_database(path))
    runs.take_in()
    return runs


def read_runs(path: Path) -> Runs:
    """The runs of a database file that is there, for who only reads. Raises StoreError when it cannot be used."""
    return Runs(path, read_database(path))


def reopen_runs(path: Path) -> Runs:
    """Another connection to a database that `open_runs` has opened before, for one request."""
    return Runs(path, reopen_database(path))


def pieces(run: int, column: str, data: bytes | memoryview) -> list[dict[str, Any]]:
    """The rows of what of a file does not go into its first value."""
    starts = range(PIECE, len(data), PIECE)
    return [{"run": run, "column": column, "number": i, "bytes": data[at : at + PIECE]} for i, at in enumerate(starts)]


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


OF_PROCESS = ("process", "process_started", "process_mark")
STRUCTURED = {"parameters": dict, "unmet": list, "kinds": dict, "versions": dict, "revisions": list, "tags": list}
VERDICTS = ("open", "candidate", "discarded")  # as verdict.py says them
UNSAID = {"verdict": VERDICTS[0], "reason": "", "name": "", "tags": "[]", "note": ""}  # of a run about which nobody has said anything


def unpacked(text: str | None, kind: type) -> Any:
    """A value that is kept as JSON, an empty one where an older studio has kept none; None when it is damaged."""
    try:
        value = json.loads(text) if text else kind()
        return value if isinstance(value, kind) else None
    except ValueError:
        return None


def row_of(row: dict[str, Any], metrics: dict[str, Measured]) -> Row:
    """A Row from the database's row."""
    plain = {key: row[key] for key in row if key not in (*OF_PROCESS, *STRUCTURED)}
    structured = {key: unpacked(row[key], empty) for key, empty in STRUCTURED.items()}
    damaged = [key for key, value in structured.items() if value is None]
    if plain["verdict"] not in VERDICTS:
        damaged.append("verdict")
        plain["verdict"] = VERDICTS[0]
    if damaged:
        plain["error"] = f"Damaged in the database: {', '.join(damaged)}. {plain['error'] or ''}".strip()
    whole: dict[str, Any] = {key: STRUCTURED[key]() if value is None else value for key, value in structured.items()}
    return Row(**plain, **whole, metrics=metrics)
