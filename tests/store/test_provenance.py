"""A run's row tells of what code it was made: kinds with their texts, versions, the machine, what git says."""

import json
import os
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

from studio import job, provenance
from studio.kind import registry
from studio.store.runs import open_runs
from studio.store.tables import LAYOUT
from tests.patience import PATIENCE

APPLICATION = '''"""Brakes by what its helper says."""
from typing import NamedTuple
from studio.kind.settings import Part
from studio.application.contract import ACCELERATION, Command, Own, accelerate
from studio.compiled import compiled
{line}
KIND = "application"
TITLE = "Helped"
COMMANDS = ACCELERATION
class Parameters(Part):
    """None."""
class Memory(NamedTuple):
    """None."""
    idle: float = 0.0
class Sees(NamedTuple):
    """The own car."""
    own: Own
class Does(NamedTuple):
    """Brakes."""
    command: Command
@compiled
def decide(parameters, memory, sees):
    """One tick."""
    return memory, Does(accelerate(braking(sees.own.speed)))
'''
HELPER = """from studio.compiled import compiled
@compiled
def braking(speed):
    return -{strength}
"""


def ran(folder, sample, *more):
    """A run in a fresh process; its row as the command line prints it."""
    done = subprocess.run(
        [sys.executable, "-m", "studio.cli", "run", sample, "--kinds", "kinds", "--json", "--set", "clock.duration=2",
         "--set", "applications.platoon.application=helped", *more],
        cwd=folder, capture_output=True, text=True, timeout=12 * PATIENCE,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("line", ["from .helper import braking", "from helper import braking"])
def test_a_changed_helper_is_compiled_anew_and_makes_another_code_version(tmp_path, sample, line):
    """In fresh processes; what has not changed stays."""
    kinds = tmp_path / "kinds"
    kinds.mkdir()
    (kinds / "helped.py").write_text(APPLICATION.format(line=line))
    helper = kinds / "helper.py"
    helper.write_text(HELPER.format(strength="0.5"))
    before, again = ran(tmp_path, sample), ran(tmp_path, sample)
    helper.write_text(HELPER.format(strength="2.5"))
    after = ran(tmp_path, sample)
    assert before["state_hash"] == again["state_hash"] != after["state_hash"]
    assert before["metrics"]["max_deceleration"]["value"] < 1.5 < after["metrics"]["max_deceleration"]["value"]
    assert before["code_version"] == again["code_version"] != after["code_version"]
    assert before["kinds"] == again["kinds"]
    changed = {name for name in before["kinds"] if before["kinds"][name] != after["kinds"][name]}
    assert changed == {"application.helped"}
    runs = open_runs(tmp_path / "runs.db")
    texts = [runs.sources(runs.find(number))["application.helped"] for number in (1, 2, 3)]
    assert list(texts[0]) == ["helped.py", "helper.py"] and texts[0] == texts[1]
    assert "0.5" in texts[0]["helper.py"] and texts[2]["helper.py"] == helper.read_text()
    count = "select count(*) from texts where text like '%TITLE = \"Helped\"%'"
    assert runs.database.execute(count).fetchone() == (1,)
    assert before["host"] and {"python", "numba", "numpy", "llvmlite", "pydantic"} <= set(before["versions"])


def test_every_kind_of_a_run_stands_in_its_row(sample, tmp_path):
    runs = open_runs(tmp_path / "runs.db")
    loaded = job.load(sample, {"clock.duration": 0.1})
    row = job.run(loaded, runs=runs).row
    named = {"application.cacc", "message.awareness", "sensor.front_radar", "driver.attentive", "radio.ad_hoc"}
    named |= {"condition.time", "action.brake"}
    judging = {f"{sort}.{name}" for sort in ("metric", "channel") for name in registry.known(sort)}
    assert set(row.kinds) == named | judging
    assert row.kinds["application.cacc"] == registry.find("application", "cacc").digest
    assert row == runs.find(row.run) and set(runs.sources(row)) == set(row.kinds)
    assert runs.sources(row)["application.cacc"]["cacc.py"].startswith('"""Cooperative adaptive')
    assert row.code_version == provenance.code_version()


# -- git ---------------------------------------------------------------------------------------------


def git(folder, *arguments):
    """A command of git by somebody."""
    who = {f"GIT_{role}_{what}": "a@b.c" for role in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
    return subprocess.run(
        ["git", "-C", folder, *arguments], check=True, capture_output=True, text=True, env=os.environ | who
    ).stdout.strip()


@pytest.fixture
def repository(tmp_path):
    """A repository with a folder of kinds in it."""
    folder = tmp_path / "kinds"
    folder.mkdir()
    (folder / "mine.py").write_text("one = 1\n")
    git(tmp_path, "init", "-q")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "-qm", "one")
    provenance.revision.cache_clear()
    yield folder
    provenance.revision.cache_clear()


def test_the_commit_and_what_has_changed_since(repository):
    commit = git(repository, "rev-parse", "HEAD")
    assert provenance.revision(repository) == provenance.Revision(str(repository), commit, "")
    provenance.revision.cache_clear()
    (repository / "mine.py").write_text("one = 2\n")
    found = provenance.revision(repository)
    assert found.commit == commit and "+one = 2" in found.patch and not found.is_cut


def test_a_long_patch_is_cut_and_says_so(repository):
    (repository / "mine.py").write_text("ä = 2\n" * 300_000)
    found = provenance.revision(repository)
    assert found.is_cut and len(found.patch.encode()) <= provenance.LONGEST_PATCH


def test_where_git_says_nothing(repository, tmp_path, monkeypatch):
    ignored = tmp_path / ".venv"
    ignored.mkdir()
    (tmp_path / ".gitignore").write_text(".venv\n")
    assert provenance.revision(ignored) is None
    bare = Path(shutil.copytree(repository, tmp_path.parent / f"{tmp_path.name}_bare"))
    assert provenance.revision(bare) is None
    monkeypatch.setenv("PATH", str(tmp_path))
    assert provenance.revision(repository) is None


def test_patches_are_kept(sample, tmp_path, monkeypatch):
    runs = open_runs(tmp_path / "runs.db")
    revision = provenance.Revision("here", "f" * 40, "+ one line", False)
    monkeypatch.setattr(provenance, "revision", lambda folder: revision)
    row = job.run(job.load(sample, {"clock.duration": 0.1}), runs=runs).row
    (kept,) = row.revisions
    assert kept["commit"] == "f" * 40 and runs.text(kept["patch"]) == "+ one line"


# -- databases of an older studio --------------------------------------------------------------------

OLD = """
create table scenarios (hash text primary key, title text, document text, map_digest text);
create table runs (run integer primary key, scenario text, scenario_hash text references scenarios(hash),
  parent integer references runs(run), seed integer, status text, error text, state_hash text, code_version text, created text,
  sim_time_s float, wall_time_s float, parameters text, unmet text, process integer, process_started float);
create table metrics (run integer references runs(run), name text, value float, unit text, goal text, primary key (run, name));
create table events (run integer references runs(run), time float, text text, vehicle text);
create table traces (run integer primary key references runs(run), parquet blob);
insert into scenarios values ('abc', 'Old', '{}', '');
insert into runs values (1, 'old', 'abc', null, 1, 'done', null, 'h', '0.1', '2026', 1.0, 1.0, '{}', '[]', 1, 1.0);
pragma user_version = 1;
"""


def test_a_database_of_an_older_studio_gets_what_is_new(sample, tmp_path):
    path = tmp_path / "runs.db"
    connection = sqlite3.connect(path)
    connection.executescript(OLD)
    connection.close()
    runs = open_runs(path)
    old = runs.find(1)
    assert (old.status, old.kinds, old.host, old.versions, old.revisions) == ("done", {}, None, {}, []) and runs.sources(old) == {}
    row = job.run(job.load(sample, {"clock.duration": 0.1}), runs=runs, parent=1).row
    assert row.run == 2 and row.kinds and runs.sources(row)
    assert runs.database.execute("pragma user_version").fetchone() == (LAYOUT,)
    assert open_runs(path).find(1) == old
