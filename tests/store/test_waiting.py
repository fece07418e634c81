"""A result that cannot go into its database waits beside it, and goes in later; reading writes nothing and waits for nobody."""

import sqlite3

import pytest

from studio import job
from studio.errors import StoreError
from studio.store import waiting
from studio.store.runs import KILLED, open_runs, read_runs

LOCKED, FULL = "begin immediate", "pragma max_page_count = 1"


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch):
    """The user's own folder is one of this test's."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "state"


def short(sample):
    return job.load(sample, {"clock.duration": 0.1})


def run_refused(sample, db, order):
    """A run whose database refuses its result; gives what it brought, and who holds the database."""
    runs, holder = open_runs(db), sqlite3.connect(db, check_same_thread=False)
    (holder if order == LOCKED else runs.database.conn).execute("pragma busy_timeout = 10")
    runs.database.execute("pragma busy_timeout = 10")
    result = job.run(short(sample), runs=runs, progress=lambda _: refuse(holder if order == LOCKED else runs.database.conn, order))
    return result, holder


def refuse(connection, order):
    if not connection.in_transaction:
        connection.execute(order)


@pytest.mark.parametrize("order", [LOCKED, FULL])
def test_a_result_waits_and_goes_in_later(sample, tmp_path, order):
    db = tmp_path / "runs.db"
    result, holder = run_refused(sample, db, order)
    (file,) = waiting.found(db)
    assert file.parent == tmp_path / "runs.db.waiting"
    holder.close()
    runs = open_runs(db)
    row = runs.find(1)
    assert (row.status, row.error, row.state_hash, row.metrics) == ("done", None, result.state_hash, result.metrics)
    assert runs.trace(1, ["leader.speed"])["leader.speed"].tobytes() == result.trace("leader.speed").tobytes()
    assert runs.events(1) == list(result.record.happenings) and runs.messages(1).kinds == result.record.messages.kinds
    assert not list(waiting.found(db))


@pytest.mark.parametrize("process", ["lives", "has gone"])
def test_what_waits_is_seen(sample, tmp_path, process):
    """Before it is taken in, whoever holds the database, and whether the process that ran it lives."""
    db = tmp_path / "runs.db"
    result, holder = run_refused(sample, db, LOCKED)
    assert result.row.status == "done" and str(tmp_path / "runs.db.waiting") in result.row.error
    if process == "has gone":
        holder.execute(f"update runs set process = {NOBODY}")
        holder.commit()
        holder.execute(LOCKED)
    row = read_runs(db).find(1)
    assert (row.status, row.state_hash) == ("done", result.state_hash) and "waits" in row.error
    holder.close()


NOBODY = 2**22 + 1  # larger than any number of a process


def test_looking_writes_nothing_and_waits_for_nobody(sample, tmp_path):
    """A run was killed, and somebody holds the database: the list tells, and the file stays as it is."""
    db = tmp_path / "runs.db"
    job.run(short(sample), runs=open_runs(db))
    holder = sqlite3.connect(db)
    holder.execute(f"update runs set status = 'running', process = {NOBODY}")
    holder.commit()
    holder.execute(LOCKED)
    (row,) = read_runs(db).select()
    assert (row.status, row.error) == ("killed", KILLED)
    holder.rollback()
    assert holder.execute("select status from runs").fetchall() == [("running",)]


def test_without_room_beside_it_goes_to_the_users_own_folder(sample, tmp_path, own_folder):
    db = tmp_path / "runs.db"
    (tmp_path / "runs.db.waiting").touch()  # nothing can lie in it
    result, holder = run_refused(sample, db, LOCKED)
    (file,) = waiting.found(db)
    assert file.is_relative_to(own_folder)
    holder.close()
    assert open_runs(db).find(1).state_hash == result.state_hash


def test_what_can_be_kept_nowhere_is_told(sample, tmp_path, own_folder):
    db = tmp_path / "runs.db"
    for each in (tmp_path / "runs.db.waiting", own_folder):
        each.touch()
    with pytest.raises(StoreError, match=r"lost: There is no room left(.|\n)*make room") as told:
        run_refused(sample, db, FULL)
    assert "does not fit on the disk" in str(told.value)


def test_a_result_goes_into_no_other_database(sample, tmp_path):
    """Not even when that has taken the place of its own, and has a run of the same number."""
    db = tmp_path / "runs.db"
    _, holder = run_refused(sample, db, LOCKED)
    holder.close()
    for each in tmp_path.glob("runs.db*"):
        if each.is_file():
            each.unlink()
    first = job.run(short(sample), runs=open_runs(db))
    assert open_runs(db).find(1) == first.row
    assert len(list(waiting.found(db))) == 1


@pytest.mark.parametrize(
    "damage", ["delete from runs", "insert into runs select * from runs", "alter table runs drop column created", "no SQLite file"]
)
def test_a_damaged_result_is_told_and_holds_up_nobody(sample, tmp_path, damage):
    """What waits there waits on; the list can be read, other results go in, and new runs begin."""
    db = tmp_path / "runs.db"
    _, holder = run_refused(sample, db, LOCKED)
    holder.close()
    (file,) = waiting.found(db)
    if damage == "no SQLite file":
        file.write_bytes(b"noise" * 1000)
    else:
        with sqlite3.connect(file) as connection:
            connection.executescript(f"create table kept as select * from runs; drop table runs; alter table kept rename to runs; {damage}")
    with sqlite3.connect(db) as connection:
        connection.execute(f"update runs set process = {NOBODY}")
    (row,) = read_runs(db).select()
    assert row.status == "killed" and str(file) in row.error
    runs = open_runs(db)
    assert job.run(short(sample), runs=runs).row.status == "done"
    assert list(waiting.found(db)) == [file]
