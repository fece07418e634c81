"""A backup holds all that a database holds at one moment, whoever writes; a restore loses nothing that was there."""

import gc
import json
import os
import sqlite3
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from studio.errors import StoreError, UnknownError
from studio.provenance import Provenance
from studio.server.editing.history import History
from studio.store import backup, waiting
from studio.store.backup import back_up, edits_of, restore
from studio.store.runs import KILLED, open_runs, read_runs
from studio.store.tables import LAYOUT
from tests.patience import PATIENCE
from tests.server.server import served

NOBODY = 2**22 + 1  # larger than any number of a process


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch):
    """The user's own folder is one of this test's."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))


def begun(runs, seed=1) -> int:
    return runs.begin(
        scenario="stern", title="Stern", document={"title": "Stern"}, scenario_hash="0" * 64, map_digest="", parent=None, seed=seed,
        parameters={}, provenance=Provenance((), "1", "host", {}, ()),
    )  # fmt: skip


def database(path: Path, count: int = 3, **ending) -> Path:
    """A database with runs that are done, each with a trace of its own."""
    runs = open_runs(path)
    for number in range(1, count + 1):
        begun(runs, seed=number)
        runs.put(result_of(number) | {"runs": [{"run": number, "status": "done"}]})
    runs.close()
    return path


def result_of(run: int) -> waiting.Result:
    trace = {"run": run, "parquet": bytes([run]) * 50_000}
    sent = {"run": run, "sent": b"sent", "entries": b"entries"}
    return {
        "runs": [],
        "metrics": [],
        "events": [{"run": run, "time": 1.0, "text": "something"}],
        "traces": [trace],
        "messages": [sent],
        "pieces": [],
    }


def content(path: Path) -> dict[str, list]:
    """All rows of all tables."""
    connection = sqlite3.connect(path)
    names = [name for (name,) in connection.execute("select name from sqlite_master where type = 'table'")]
    found = {name: connection.execute(f"select * from {name} order by rowid").fetchall() for name in names}
    connection.close()
    return found


# -- backup -----------------------------------------------------------------------------------------


def test_a_backup_holds_everything_and_is_one_file(tmp_path):
    db, target = database(tmp_path / "runs.db"), tmp_path / "copy.db"
    copied = back_up(db, target)
    assert (copied.file, copied.runs, copied.newest, copied.going) == (target, 3, 3, []) and copied.size == target.stat().st_size
    assert content(target) == content(db)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["copy.db", "runs.db"]


def test_the_history_of_edits_goes_along(tmp_path):
    db, target, other = database(tmp_path / "runs.db"), tmp_path / "copy.db", tmp_path / "other.db"
    History(edits_of(db)).add("stern", "edit", "Move leader", "Ada", before="a: 1", after="a: 2")
    back_up(db, target)
    (change,) = History(edits_of(target)).changes("stern")
    assert change.name == "Move leader" and History(edits_of(target)).text(change.after) == "a: 2"
    with pytest.raises(StoreError, match=r"copy.edits.db|copy.db"):
        back_up(db, target)
    database(other)
    History(edits_of(other)).add("stern", "edit", "Delete leader", "Ada", before="a: 2", after="")
    restore(target, other, replace=True)
    assert [each.name for each in History(edits_of(other)).changes("stern")] == ["Move leader"]
    (before,) = tmp_path.glob("other.edits.db.before-*")
    assert [each.name for each in History(before).changes("stern")] == ["Delete leader"]


def test_it_is_of_one_moment_whoever_writes(tmp_path, monkeypatch):
    """Another connection adds a run after every few pages: the copy has those of before, and comes to an end."""
    monkeypatch.setattr(backup, "PAGES", 4)
    db = database(tmp_path / "runs.db")
    writer, before = open_runs(db), content(db)
    copied = back_up(db, tmp_path / "copy.db", lambda share: begun(writer))
    assert content(tmp_path / "copy.db") == before and copied.runs == 3
    assert len(content(db)["runs"]) > 10


def test_writers_do_not_wait_for_a_backup(tmp_path):
    """Many backups while a process writes runs one after another: each is whole, and the runs in it are so too."""
    db, over = database(tmp_path / "runs.db"), threading.Event()
    copies = []

    def copy():
        while not over.is_set():
            copies.append(back_up(db, tmp_path / f"copy-{len(copies)}.db"))

    thread = threading.Thread(target=copy)
    thread.start()
    runs = open_runs(db)
    for _ in range(60):
        number = begun(runs)
        runs.put(result_of(number % 200) | {"runs": [{"run": number, "status": "done"}], "events": [], "messages": [], "traces": []})
    over.set()
    thread.join(PATIENCE)
    assert copies
    for each in copies:
        found = content(each.file)
        assert [row[0] for row in found["runs"]] == list(range(1, each.runs + 1)) and len(each.going) <= 1


def test_what_waits_beside_and_what_goes_on(tmp_path):
    """A result that could not go in is in the backup, and waits on; a run that goes on has begun there."""
    db = database(tmp_path / "runs.db", 1)
    runs = open_runs(db)
    waits, goes = begun(runs), begun(runs)
    known = runs.rows(f"select {', '.join(waiting.OWNER)} from runs where run = ?", [waits])[0]
    waiting.keep(
        db, result_of(waits) | {"runs": [{"run": waits, "status": "done", "error": None, "state_hash": "abc"} | known]}, StoreError("full")
    )
    (waiting.folders(db)[0] / "run-9.db").write_text("nothing of ours")
    copied = back_up(db, tmp_path / "copy.db")
    assert copied.going == [goes]
    assert read_runs(tmp_path / "copy.db").find(waits).state_hash == "abc"
    assert len(list(waiting.found(db))) == 2
    restored = restore(tmp_path / "copy.db", tmp_path / "new.db", replace=False)
    assert restored.runs == 3 and read_runs(tmp_path / "new.db").find(waits).status == "done"


# -- restore ----------------------------------------------------------------------------------------


def test_a_restore_makes_a_database_that_is_written_on(tmp_path):
    back_up(database(tmp_path / "runs.db"), tmp_path / "copy.db")
    restored = restore(tmp_path / "copy.db", tmp_path / "new.db", replace=False)
    assert restored.before is None and content(tmp_path / "new.db") == content(tmp_path / "runs.db")
    runs = open_runs(tmp_path / "new.db")
    assert begun(runs) == 4 and runs.database.execute("pragma journal_mode").fetchone() == ("wal",)


def test_what_was_there_is_kept_beside(tmp_path):
    """Nothing is replaced without a word; with it, the database of before can be restored in turn."""
    db = database(tmp_path / "runs.db", 2)
    back_up(db, tmp_path / "copy.db")
    runs = open_runs(db)
    runs.put(result_of(3) | {"runs": [{"run": begun(runs), "status": "done"}]})
    runs.close()
    later = content(db)
    with pytest.raises(StoreError, match=r"There is a database(.|\n)*--replace"):
        restore(tmp_path / "copy.db", db, replace=False)
    assert content(db) == later
    restored = restore(tmp_path / "copy.db", db, replace=True)
    assert content(db) == content(tmp_path / "copy.db") and content(restored.before) == later
    again = restore(restored.before, db, replace=True)
    assert content(db) == later and again.before != restored.before
    assert len([each for each in tmp_path.iterdir() if "before" in each.name]) == 2


@pytest.mark.parametrize("harm", ["first page", "inner page", "no database", "cut"])
def test_a_damaged_database_is_replaced_and_kept(tmp_path, harm):
    db = database(tmp_path / "runs.db", 20)
    back_up(db, tmp_path / "copy.db")
    whole = db.read_bytes()
    db.write_bytes(damaged(whole, harm))
    kept = restore(tmp_path / "copy.db", db, replace=True).before
    assert kept.read_bytes() == damaged(whole, harm)
    assert content(db) == content(tmp_path / "copy.db")


def damaged(whole: bytes, harm: str) -> bytes:
    if harm == "inner page":
        return whole[:8192] + os.urandom(0) + b"\xff" * 8192 + whole[16384:]
    return {"first page": b"\0" * 4096 + whole[4096:], "no database": b"title: a scenario\n", "cut": whole[: len(whole) // 2]}[harm]


def test_an_older_layout_is_brought_up(tmp_path):
    db = database(tmp_path / "runs.db")
    connection = sqlite3.connect(db)
    connection.execute("drop table pieces")
    connection.execute("pragma user_version = 4")
    connection.close()
    back_up(db, tmp_path / "copy.db")
    restore(tmp_path / "copy.db", tmp_path / "new.db", replace=False)
    assert sqlite3.connect(tmp_path / "new.db").execute("pragma user_version").fetchone() == (LAYOUT,)
    assert read_runs(tmp_path / "new.db").parquet(2) == bytes([2]) * 50_000


def test_nothing_is_replaced_under_a_run(tmp_path):
    """It says which goes on; when that has ended, or its process has gone, the restore goes through."""
    db = database(tmp_path / "runs.db")
    back_up(db, tmp_path / "copy.db")
    runs = open_runs(db)
    number = begun(runs)
    with pytest.raises(StoreError, match=f"in use(.|\n)*go on: {number}"):
        restore(tmp_path / "copy.db", db, replace=True)
    runs.database.execute(f"update runs set process = {NOBODY} where run = {number}")
    runs.database.conn.commit()
    runs.close()
    kept = restore(tmp_path / "copy.db", db, replace=True).before
    assert read_runs(kept).find(number).error == KILLED


def test_nothing_is_replaced_that_another_program_has_open(tmp_path, monkeypatch):
    monkeypatch.setattr(backup, "IN_USE", 0.2)
    db = database(tmp_path / "runs.db")
    back_up(db, tmp_path / "copy.db")
    other = sqlite3.connect(db)
    other.execute("select count(*) from runs").fetchone()
    with pytest.raises(StoreError, match=r"in use(.|\n)*open in another program"):
        restore(tmp_path / "copy.db", db, replace=True)
    assert other.execute("select count(*) from runs").fetchone() == (3,)
    other.close()
    assert restore(tmp_path / "copy.db", db, replace=True).before


# -- what is refused --------------------------------------------------------------------------------


def wrong(folder: Path) -> dict[str, tuple[Path, type[Exception], str]]:
    """Files that are no backup, and no database to back up: what is told of each."""
    foreign, empty, newer, broken = (folder / name for name in ("foreign.db", "empty.db", "newer.db", "broken.db"))
    sqlite3.connect(foreign).execute("create table bookmarks(url)").connection.close()
    empty.touch()
    connection = sqlite3.connect(database(newer))
    connection.execute(f"pragma user_version = {LAYOUT + 1}").connection.close()
    broken.write_bytes(damaged(database(broken, 20).read_bytes(), "inner page"))
    (folder / "text.db").write_text("title: a scenario\n" * 100)
    (folder / "a folder").mkdir()
    return {
        "missing": (folder / "nowhere.db", UnknownError, "does not exist"),
        "a folder": (folder / "a folder", StoreError, "is a folder"),
        "no database": (folder / "text.db", StoreError, "is no SQLite file"),
        "empty": (empty, StoreError, "is not a run database"),
        "of another program": (foreign, StoreError, "holds other tables"),
        "of a newer studio": (newer, StoreError, "written by a newer studio"),
        "damaged": (broken, StoreError, "is damaged"),
    }


CASES = ("missing", "a folder", "no database", "empty", "of another program", "of a newer studio", "damaged")


@pytest.mark.parametrize("case", CASES)
def test_what_is_no_run_database_is_neither_backed_up_nor_restored(tmp_path, case):
    file, error, words = wrong(tmp_path)[case]
    db = database(tmp_path / "runs.db")
    before, files = content(db), sorted(tmp_path.iterdir())
    with pytest.raises(error, match=words):
        restore(file, db, replace=True)
    with pytest.raises(error, match=words):
        back_up(file, tmp_path / "copy.db")
    assert content(db) == before and sorted(tmp_path.iterdir()) == files


@pytest.mark.parametrize("case", ["a folder", "of another program", "of a newer studio"])
def test_what_is_not_ours_is_not_replaced(tmp_path, case):
    file, error, words = wrong(tmp_path)[case]
    source = database(tmp_path / "runs.db")
    files = sorted(tmp_path.iterdir())
    with pytest.raises(error, match=words):
        restore(source, file, replace=True)
    assert sorted(tmp_path.iterdir()) == files


def test_a_backup_overwrites_nothing_and_wants_a_folder(tmp_path):
    db = database(tmp_path / "runs.db")
    (tmp_path / "there").write_text("mine")
    with pytest.raises(StoreError, match="is there already"):
        back_up(db, tmp_path / "there")
    with pytest.raises(StoreError, match="is the database itself"):
        restore(db, tmp_path / "runs.db", replace=True)
    with pytest.raises(StoreError, match=r"cannot be written(.|\n)*No such file(.|\n)*folder that can be written"):
        back_up(db, tmp_path / "nowhere" / "copy.db")
    assert (tmp_path / "there").read_text() == "mine"


LIMITED = (
    "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (40_000, 40_000)); from studio.cli import main; main(sys.argv[1:])"
)


def test_without_room_nothing_is_left_of_it(tmp_path):
    """A file may have 40 kB here: the backup needs more, and so does the restore, which leaves the database as it is."""
    db = database(tmp_path / "runs.db")
    back_up(db, tmp_path / "copy.db")
    before, files = content(db), sorted(tmp_path.iterdir())
    for arguments in (("backup", "other.db"), ("restore", "copy.db", "--replace")):
        done = subprocess.run([sys.executable, "-c", LIMITED, *arguments], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 2 and "Traceback" not in done.stderr and str(arguments[1].replace("copy", "runs")) in done.stderr
        assert content(db) == before and sorted(tmp_path.iterdir()) == files


# -- the commands -----------------------------------------------------------------------------------


def studio(*arguments, cwd):
    return subprocess.run([sys.executable, "-m", "studio.cli", *map(str, arguments)], cwd=cwd, capture_output=True, text=True)


def test_the_commands(tmp_path):
    """One each, with a name of its own; for people and for scripts; what is refused ends with 2."""
    database(tmp_path / "runs.db")
    done = studio("backup", cwd=tmp_path)
    (copy,) = tmp_path.glob("runs-*.db")
    assert done.returncode == 0 and copy.name in done.stdout and "3 runs, the newest 3" in done.stdout
    (tmp_path / "shelf").mkdir()
    told = json.loads(studio("backup", "shelf", "--json", cwd=tmp_path).stdout)
    assert Path(told["file"]).parent == Path("shelf") and told["runs"] == 3
    refused = studio("restore", copy, cwd=tmp_path)
    assert refused.returncode == 2 and "--replace" in refused.stderr
    done = studio("restore", copy, "--replace", cwd=tmp_path)
    assert done.returncode == 0 and "runs.db.before-" in done.stdout
    assert studio("backup", "--db", "nowhere.db", cwd=tmp_path).returncode == 2


def test_a_database_that_nobody_has_any_more_is_let_go(tmp_path):
    """Without waiting for the collector of garbage: a server that has looked at it holds nobody up."""
    db = database(tmp_path / "runs.db")
    back_up(db, tmp_path / "copy.db")
    gc.disable()
    try:
        for look in (read_runs, open_runs):
            assert len(look(db).select()) == 3
        assert restore(tmp_path / "copy.db", db, replace=True).before
    finally:
        gc.enable()


def test_a_server_goes_on_with_what_was_restored(tmp_path):
    """It has answered before, and answers from the new database at once."""
    back_up(database(tmp_path / "one.db", 1), tmp_path / "copy.db")
    database(tmp_path / "runs.db")
    (tmp_path / "scenarios").mkdir()
    with served(tmp_path) as (client, _, _):
        assert [each["run"] for each in client.get("/api/runs").json()] == [3, 2, 1]
        done = studio("restore", "copy.db", "--replace", cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert [each["run"] for each in client.get("/api/runs").json()] == [1]
