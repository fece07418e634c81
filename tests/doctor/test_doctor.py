"""The doctor finds what is wrong, mends what can be mended, and loses nothing that has finished."""

import json
import os
import pty
import socket
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

from studio import compiled
from studio.doctor import cache, installation, machine
from studio.doctor.database import database as looked_into
from studio.doctor.finding import Finding, Patient
from studio.doctor.visit import examined, mended
from studio.errors import StoreError
from studio.road import kept
from studio.store import waiting
from studio.store.runs import KILLED, open_runs, read_runs
from studio.store.tables import LAYOUT
from tests.patience import until
from tests.server.server import served
from tests.store.test_backup import NOBODY, begun, content, damaged, database, result_of

TOKEN = "a-token.of_16~or-more"


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch):
    """The user's own folders are those of this test."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))


def found(db: Path, *, is_named: bool = True) -> dict[str, list[Finding]]:
    """What the doctor says of a database, by name."""
    said: dict[str, list[Finding]] = {}
    for each in looked_into(Patient(db, is_named, "127.0.0.1", 8000)):
        said.setdefault(each.name, []).append(each)
    return said


def only(said: dict[str, list[Finding]], name: str) -> Finding:
    (finding,) = said[name]
    return finding


def died(db: Path) -> int:
    """A run of a process that has gone."""
    runs = open_runs(db)
    number = begun(runs)
    runs.database.execute(f"update runs set process = {NOBODY} where run = {number}")
    runs.database.conn.commit()
    runs.close()
    return number


def keep_waiting(db: Path, run: int, **changes) -> None:
    """A result of a run that waits beside."""
    runs = open_runs(db)
    known = runs.rows(f"select {', '.join(waiting.OWNER)} from runs where run = ?", [run])[0]
    runs.close()
    waiting.keep(
        db,
        result_of(run) | {"runs": [{"run": run, "status": "done", "error": None, "state_hash": "abc"} | known | changes]},
        StoreError("full"),
    )


# -- the database -----------------------------------------------------------------------------------


def test_a_database_that_is_well_is_left_as_it_is(tmp_path):
    db = database(tmp_path / "runs.db")
    goes = begun(open_runs(db))
    before = content(db)
    said = found(db)
    assert all(each.is_good and each.mend is None for one in said.values() for each in one)
    assert f"4 runs, the newest {goes}" in only(said, "database").what and content(db) == before


def test_runs_of_dead_processes_are_marked(tmp_path):
    """Looking changes nothing; one that goes on, and those that are over, stay as they are."""
    db = database(tmp_path / "runs.db")
    dead, lives = [died(db), died(db)], begun(open_runs(db))
    before = content(db)
    finding = only(found(db), "dead runs")
    assert not finding.is_good and "2 say" in finding.what and content(db) == before
    assert mended(finding) == (True, "2 are marked")
    rows = dict(sqlite3.connect(db).execute("select run, status || ' ' || coalesce(error, '') from runs"))
    assert rows == {1: "done ", 2: "done ", 3: "done "} | dict.fromkeys(dead, f"killed {KILLED}") | {lives: "running "}
    assert only(found(db), "dead runs").is_good


def test_results_that_wait_are_taken_in(tmp_path):
    """The run is done then, not dead, whichever is mended first."""
    db = database(tmp_path / "runs.db")
    run = died(db)
    keep_waiting(db, run)
    said = found(db)
    assert only(said, "dead runs").is_good and "1 wait" in only(said, "results").what
    assert mended(only(said, "results")) == (True, "all are in")
    assert read_runs(db).find(run).state_hash == "abc" and read_runs(db).parquet(run) == bytes([run]) * 50_000
    assert only(found(db), "results").is_good


@pytest.mark.parametrize("case", ["of another database", "unreadable", "without a row"])
def test_what_cannot_be_taken_in_stays(tmp_path, case):
    db = database(tmp_path / "runs.db")
    if case == "of another database":
        keep_waiting(db, died(db), created="another time")
    else:
        (file := waiting.folders(db)[0] / "run-7.db").parent.mkdir()
        file.write_text("nothing") if case == "unreadable" else sqlite3.connect(file).execute("create table runs(run)").connection.close()
    (file,) = waiting.found(db)
    finding = only(found(db), "results")
    assert not finding.is_good and finding.mend is None and str(file) in finding.what and "stays where it is" in finding.remedy
    assert file.exists()


def test_empty_pages_are_given_back(tmp_path):
    """Not under a run that goes on, whose result would have to wait."""
    db = database(tmp_path / "runs.db")
    runs = open_runs(db)
    big = begun(runs)
    piece = {"run": big, "column": "sent", "number": 1, "bytes": os.urandom(80_000_000)}
    runs.put(result_of(big) | {"runs": [{"run": big, "status": "done"}], "events": [], "pieces": [piece]})
    with runs.writing():
        runs.database.conn.execute("delete from pieces")
    number = begun(runs)
    finding = only(found(db), "file")
    assert not finding.is_good and finding.what.startswith("80.")
    assert mended(finding) == (False, f"Runs go on: {number}.")
    runs.end(number, "stopped", "")
    before = content(db)
    assert mended(finding)[0] and content(db) == before and db.stat().st_size < 2e6
    assert only(found(db), "file").is_good


def test_rows_that_belong_to_nothing_are_told(tmp_path):
    db = database(tmp_path / "runs.db")
    connection = sqlite3.connect(db)
    connection.execute("insert into events(run, time, text) values (99, 1.0, 'of nobody')")
    connection.commit()
    finding = only(found(db), "rows")
    assert not finding.is_good and "events" in finding.what and "restore" in finding.remedy


def test_an_older_layout_is_brought_up(tmp_path):
    db = database(tmp_path / "runs.db")
    sqlite3.connect(db).execute("pragma user_version = 4").connection.close()
    said = found(db)
    assert "layout 4" in only(said, "database").what and list(said) == ["database"]
    assert mended(only(said, "database"))[0] and only(found(db), "database").is_good


@pytest.mark.parametrize("harm", ["first page", "inner page", "no database", "cut"])
def test_damage_is_told_with_what_helps(tmp_path, harm):
    db = database(tmp_path / "runs.db", 20)
    db.write_bytes(damaged(db.read_bytes(), harm))
    finding = only(found(db), "database")
    assert not finding.is_good and finding.mend is None and "studio restore" in finding.remedy and "\n" not in finding.what


@pytest.mark.parametrize(
    ("statement", "words"), [("create table bookmarks(url)", "other tables"), (f"pragma user_version = {LAYOUT + 1}", "newer")]
)
def test_what_is_not_ours_is_told_and_the_rest_is_looked_at(tmp_path, statement, words):
    db = tmp_path / "other.db"
    sqlite3.connect(db).execute(statement).connection.close()
    said = list(examined(Patient(db, True, "127.0.0.1", 8000), lambda share: None))
    (finding,) = [each for each in said if each.name == "database"]
    assert not finding.is_good and words in finding.what and said[-1].name == "port"
    with pytest.raises(StoreError, match="is a folder"):
        found(tmp_path)


def test_a_database_that_is_not_there_is_wrong_only_when_it_was_named(tmp_path):
    assert not only(found(tmp_path / "runs.db"), "database").is_good
    assert only(found(tmp_path / "runs.db", is_named=False), "database").is_good and not list(tmp_path.iterdir())


# -- the cache --------------------------------------------------------------------------------------


def test_torn_old_and_left_over_files_of_maps_go(tmp_path, monkeypatch):
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path))
    for name in ("whole", "torn", "old"):
        kept.keep("maps", name, list(range(1000)))
    torn = kept.kept_at("maps", "torn")
    torn.write_bytes(torn.read_bytes()[:-1])
    (tmp_path / "maps" / "tmpabc").touch()
    (tmp_path / "maps" / "tmpnew").touch()
    for name in ("old.pickle", "tmpabc"):
        os.utime(tmp_path / "maps" / name, (0, 0))
    (finding,) = cache.maps(Patient(tmp_path, False, "", 0))
    assert not finding.is_good and "3 files" in finding.what
    assert mended(finding)[0] and {each.name for each in (tmp_path / "maps").iterdir()} == {"whole.pickle", "tmpnew"}
    assert next(iter(cache.maps(Patient(tmp_path, False, "", 0)))).is_good


def test_machine_code_of_other_sources_goes_when_it_is_much_and_unused(tmp_path, monkeypatch):
    """That of these sources stays, however old, and so does what somebody has used today."""
    monkeypatch.setattr(compiled, "CACHE", tmp_path)
    monkeypatch.setattr(cache, "MOST_STALE", 1000)
    own = compiled.folder_of(Path(compiled.__file__).parent / "model" / "brake.py")
    for folder in (own, tmp_path / "unused", tmp_path / "used"):
        folder.mkdir()
        (folder / "code.nbc").write_bytes(b"x" * 2000)
    for folder in (own, tmp_path / "unused"):
        os.utime(folder, (0, 0))
    (finding,) = cache.code(Patient(tmp_path, False, "", 0))
    assert not finding.is_good and mended(finding)[0]
    assert {each.name for each in tmp_path.iterdir()} == {own.name, "used"}


# -- installation and machine ------------------------------------------------------------------------


def test_packages_that_are_missing_or_too_old_are_told():
    wanted = ["numpy>=2.2", "numpy<1", "there-is-no-such-package>=3", 'there-is-none-either; extra == "dev"']
    assert [each.partition(" ")[0] for each in installation.unmet(wanted)] == ["numpy<1", "there-is-no-such-package>=3"]
    assert "missing" in installation.unmet(wanted)[1]


def test_a_page_that_is_not_built_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(installation, "BUNDLE", tmp_path)
    (finding,) = installation.page(Patient(tmp_path, False, "", 0))
    assert not finding.is_good and "not been built" in finding.what and finding.remedy


def test_a_port_of_another_program_is_told(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as other:
        number = other.getsockname()[1]
        other.close()
        (free,) = machine.port(Patient(tmp_path, False, "127.0.0.1", number))
    with subprocess.Popen(
        [sys.executable, "-m", "http.server", "--bind", "127.0.0.1", str(number)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as other:
        until(lambda: machine.refused("127.0.0.1", number), "the other program")
        until(lambda: answers(number), "its answers")
        (taken,) = machine.port(Patient(tmp_path, False, "127.0.0.1", number))
        other.terminate()
    assert free.is_good and not taken.is_good and "--port" in taken.remedy
    assert not next(iter(machine.port(Patient(tmp_path, False, "203.0.113.7", number)))).is_good


def answers(number: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", number)) == 0


def test_too_little_room_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(machine, "LEAST_FREE", 1e18)
    said = list(machine.space(Patient(tmp_path / "runs.db", False, "", 0)))
    assert said and not any(each.is_good for each in said) and all("make room" in each.remedy for each in said)


# -- the command ------------------------------------------------------------------------------------


def doctor(*arguments, cwd, **options):
    return subprocess.run(
        [sys.executable, "-m", "studio.cli", "doctor", *map(str, arguments)], cwd=cwd, capture_output=True, text=True, **options
    )


def test_the_command_mends_only_with_a_word(tmp_path):
    """One line each; nothing is mended where nobody is there to answer; afterwards nothing is wrong that was mended."""
    run = died(database(tmp_path / "runs.db"))
    done = doctor(cwd=tmp_path, stdin=subprocess.DEVNULL)
    (line,) = [each for each in done.stdout.splitlines() if "dead runs" in each]
    assert done.returncode == 1 and line.startswith("bad ") and line.endswith("marks them as killed")
    assert sqlite3.connect(tmp_path / "runs.db").execute(f"select status from runs where run = {run}").fetchone() == ("running",)
    done = doctor("--yes", "--json", cwd=tmp_path)
    said = json.loads(done.stdout)
    assert [each["mended"] for each in said if each["name"] == "dead runs"] == ["1 are marked"]
    assert done.returncode == any(not each["good"] and not each["mended"] for each in said)
    assert all(each["good"] for each in json.loads(doctor("--json", cwd=tmp_path).stdout) if each["name"] == "dead runs")


@pytest.mark.parametrize(("answer", "status"), [("n", "running"), ("y", "killed")])
def test_it_asks_who_is_there(tmp_path, answer, status):
    run = died(database(tmp_path / "runs.db"))
    ours, theirs = pty.openpty()
    os.write(ours, f"{answer}\n".encode() * 20)
    done = doctor(cwd=tmp_path, stdin=theirs)
    os.close(ours)
    os.close(theirs)
    assert "Shall he?" in done.stdout
    assert sqlite3.connect(tmp_path / "runs.db").execute(f"select status from runs where run = {run}").fetchone() == (status,)


def test_a_server_and_its_run_go_on_meanwhile(tmp_path, sample):
    """The doctor mends, a backup is taken, and the run that goes on ends as it would have; the port is known as a studio's."""
    dead = died(database(tmp_path / "runs.db"))
    with served(tmp_path, "--scenarios", sample.parent) as (client, db, _):
        new = {"scenario": sample.stem, "set": {"clock.duration": 5}, "pace": 2.0}
        run = client.post("/api/live", json=new).raise_for_status().json()["run"]
        said = json.loads(doctor("--yes", "--json", "--port", client.base_url.port, cwd=tmp_path).stdout)
        copied = subprocess.run([sys.executable, "-m", "studio.cli", "backup", "copy.db"], cwd=tmp_path, capture_output=True, text=True)
        assert copied.returncode == 0, copied.stderr
        (port,) = [each for each in said if each["name"] == "port"]
        assert port["good"] and f"a studio serves {db.resolve()} there" in port["what"]
        assert client.get(f"/api/runs/{dead}").json()["error"] == KILLED
        until(lambda: client.get(f"/api/runs/{run}").json()["status"] != "running", "the end of the run")
        assert client.get(f"/api/runs/{run}").json()["status"] == "done"


def test_a_studio_that_wants_its_token_is_known(tmp_path):
    with served(tmp_path, "--host", "0.0.0.0", STUDIO_TOKEN=TOKEN) as (client, _, _):
        (finding,) = machine.port(Patient(tmp_path, False, "0.0.0.0", client.base_url.port))
    assert finding.is_good and "token" in finding.what


def test_a_cache_that_cannot_be_made_is_a_finding(tmp_path):
    done = doctor("--json", cwd=tmp_path, env=os.environ | {"STUDIO_CACHE": "/dev/null/cache"})
    said = {each["name"]: each for each in json.loads(done.stdout)}
    assert done.returncode == 1 and not said["compiled"]["good"] and said["database"]["good"]
