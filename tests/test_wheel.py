"""The wheel, installed where there is no checkout: page, samples and benchmark are in it."""

import json
import os
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from tests.server.server import served


@pytest.fixture(scope="module")
def installed(tmp_path_factory, root):
    """A folder with the installed wheel, built from this checkout; what it depends on comes from the environment of the tests."""
    made, target = tmp_path_factory.mktemp("wheel"), tmp_path_factory.mktemp("installed")
    command([sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(made)], cwd=root)
    (wheel,) = made.glob("*.whl")
    command([sys.executable, "-m", "pip", "install", "--no-deps", "--no-index", "--target", str(target), str(wheel)], cwd=made)
    return target


def command(words, cwd, **environment):
    """Runs a program; its output."""
    done = subprocess.run(words, cwd=cwd, env=os.environ | environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture
def studio(installed, tmp_path):
    """The installed `studio`, called in an empty folder."""
    return lambda *words: command([sys.executable, "-m", "studio.cli", *map(str, words)], tmp_path, PYTHONPATH=str(installed))


def test_it_is_the_installed_one(installed, tmp_path):
    script = "import studio, studio.sample; print(studio.__file__); print(studio.sample.folder())"
    package, samples = command([sys.executable, "-c", script], tmp_path, PYTHONPATH=str(installed)).split()
    assert Path(package) == installed / "studio" / "__init__.py" and Path(samples) == installed / "studio" / "_scenarios"


def test_the_samples_are_those_of_the_checkout(installed, root):
    packaged, ours = installed / "studio" / "_scenarios", root / "scenarios"
    kept = {path.relative_to(ours): path.read_bytes() for path in ours.rglob("*") if path.is_file()}
    assert {path.relative_to(packaged): path.read_bytes() for path in packaged.rglob("*") if path.is_file()} == kept


def test_commands_work(studio, installed):
    sample = installed / "studio" / "_scenarios" / "grosser_stern_platoon.yaml"
    assert "is valid" in studio("check", sample)
    run = json.loads(studio("run", sample, "--set", "clock.duration=0.5", "--json"))
    assert run["status"] == "done" and run["run"] == 1
    assert "grosser_stern_platoon" in studio("runs")


def test_the_benchmark_finds_its_sample(installed, tmp_path):
    """Its figures are of no interest here, so it repeats once for a moment."""
    script = (
        "from studio import bench, job, sample; bench.SPAN, bench.REPEATS, bench.FLEETS = 0.001, 1, (8,)\n"
        "print(bench.whole_tick(job.prepare(job.load(sample.first()))) > 0)"
    )
    assert command([sys.executable, "-c", script], tmp_path, PYTHONPATH=str(installed)).strip() == "True"


def test_page_and_samples_are_served(installed, tmp_path, monkeypatch, root):
    monkeypatch.setenv("PYTHONPATH", str(installed))
    with served(tmp_path) as (client, _, _):
        rows = client.get("/api/scenarios").json()
        assert {row["id"] for row in rows} == {path.stem for path in (root / "scenarios").glob("*.yaml")}
        assert not [row for row in rows if row["problem"]]
        assert '<div id="root">' in client.get("/").text
        assert client.get("/api/info").json()["scenarios_folder"] == str(installed / "studio" / "_scenarios")
        driven_among_samples_is_written_beside_ones_own(client, tmp_path, installed)


def driven_among_samples_is_written_beside_ones_own(client: httpx.Client, folder: Path, installed: Path):
    """The package's folder stays as it is; a copy of it in the user's own takes what is new."""
    before = sorted((installed / "studio" / "_scenarios").rglob("*"))
    made = client.post("/api/maps/urban_grid.osm/drive").json()["scenario"]
    assert (folder / "scenarios" / f"{made}.yaml").is_file() and (folder / "scenarios" / "maps" / "urban_grid.osm").is_file()
    assert sorted((installed / "studio" / "_scenarios").rglob("*")) == before
    assert {made, "grosser_stern_platoon"} <= {row["id"] for row in client.get("/api/scenarios").json()}
    assert client.get("/api/info").json()["scenarios_folder"] == str(folder / "scenarios")
