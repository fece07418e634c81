"""A new kind works as it was written: it conforms, its test passes, its scenario runs and uses it."""

import json
import subprocess
import sys

import pytest

from studio.errors import KindError
from studio.kind.sort import SORTS
from studio.workshop.draft import MAP, TEMPLATES, draft
from tests.patience import PATIENCE

LONGEST = 40  # lines of a template that are read at once


def done(*command, cwd):
    """A command in a folder; it must not fail."""
    made = subprocess.run([sys.executable, "-m", *map(str, command)], cwd=cwd, capture_output=True, text=True, timeout=12 * PATIENCE)
    assert made.returncode == 0, made.stdout + made.stderr
    return made.stdout


def test_every_sort_has_its_templates():
    wanted = {f"{sort}.{ending}.txt" for sort in SORTS for ending in ("py", "test.py", "yaml" if SORTS[sort].is_run else "log")}
    wanted |= {"message.talk.py.txt"}
    assert {path.name for path in TEMPLATES.iterdir()} == wanted


def test_templates_are_short():
    for path in TEMPLATES.iterdir():
        assert len(path.read_text(encoding="utf-8").splitlines()) <= LONGEST, path.name


def test_a_format_of_logs_reads_the_log_that_comes_with_it(tmp_path):
    written = draft("logformat", "rally", tmp_path)
    assert {path.name for path in written} == {"rally.py", "test_rally.py", "drive.rally"}
    done("pytest", "-q", "-p", "no:cacheprovider", "-c", "/dev/null", "test_rally.py", cwd=tmp_path)
    found = json.loads(done("studio.cli", "logs", "import", "drive.rally", "--kinds", ".", "--json", cwd=tmp_path))
    speed, yaw = found["ours"]
    assert (speed["high"], yaw["high"]) == pytest.approx((72.4 / 3.6, 0.033161), abs=1e-6) and speed["rate"] == pytest.approx(100.0)


@pytest.mark.parametrize("sort", [name for name, each in SORTS.items() if each.is_run])
def test_it_works_as_it_was_written(sort, tmp_path):
    name = f"my_{sort}"
    written = draft(sort, name, tmp_path)
    assert {path.name for path in written} >= {f"{name}.py", f"test_{name}.py", f"{name}.yaml", MAP}
    done("pytest", "-q", "-p", "no:cacheprovider", "-c", "/dev/null", f"test_{name}.py", cwd=tmp_path)
    run = json.loads(done("studio.cli", "run", f"{name}.yaml", "--kinds", ".", "--json", cwd=tmp_path))
    assert run["status"] == "done" and run["error"] is None and run["unmet"] == []
    assert f"{sort}.{name}" in run["kinds"]


@pytest.mark.parametrize(
    ("sort", "name", "words"),
    [
        ("metrics", "mine", "did you mean 'metric'"),
        ("metric", "My-Metric", "small letters"),
        ("metric", "class", "small letters"),
        ("metric", "7th", "small letters"),
        ("metric", "test_it", "small letters"),
        ("metric", "min_ttc", "built in"),
        ("channel", "speed", "a row of the world"),
    ],
)
def test_names_that_do_not_do_are_refused(sort, name, words, tmp_path):
    with pytest.raises(KindError, match=words):
        draft(sort, name, tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("there", ["mine.py", "test_mine.py", "mine.yaml"])
def test_nothing_is_overwritten(there, tmp_path):
    (tmp_path / there).write_text("precious")
    with pytest.raises(KindError, match="is there already"):
        draft("metric", "mine", tmp_path)
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [(there, "precious")]


def test_a_folder_must_be_there(tmp_path):
    with pytest.raises(KindError, match="make it first"):
        draft("metric", "mine", tmp_path / "none")


def test_a_second_kind_takes_the_map_of_the_first(tmp_path):
    draft("metric", "mine", tmp_path)
    (tmp_path / MAP).write_text("changed")
    assert tmp_path / MAP not in draft("channel", "other", tmp_path) and (tmp_path / MAP).read_text() == "changed"
