"""A packed run is repeated elsewhere to the same bits, or it is told why it cannot be; a page about it says what is in the database."""

import json
import os
import shutil
import subprocess
import sys
from html.parser import HTMLParser

import numpy as np
import pytest

from studio import job
from studio.errors import StoreError, UnknownError
from studio.execution.record import Body
from studio.kind import registry
from studio.parcel import plan
from studio.parcel.pack import pack
from studio.parcel.repeat import repeat
from studio.parcel.report import limits, report, value
from studio.store.comparison import beside
from studio.store.runs import open_runs
from studio.store.verdict import judge, remark
from tests.broken import EVERY, FLAWLESS

SHORT = {"clock.duration": 2}
LEADER = "vehicles.leader.sensors.front"


@pytest.fixture
def place(sample, tmp_path):
    """A folder with the motorway sample and its map, and a database with a run and a child of it."""
    folder = tmp_path / "scenarios"
    (folder / "maps").mkdir(parents=True)
    shutil.copy(sample.with_name("motorway_platoon.yaml"), folder)
    shutil.copy(sample.parent / "maps" / "motorway.xodr", folder / "maps")
    runs = open_runs(tmp_path / "runs.db")
    file = folder / "motorway_platoon.yaml"
    job.run(job.load(file, SHORT), runs=runs)
    job.run(job.load(file, SHORT | {"applications.platoon.parameters.headway": 0.9}), runs=runs, seed=7, parent=1)
    return folder, runs


def elsewhere(folder, *words):
    """`studio repeat` in a process that knows nothing of this one."""
    command = [sys.executable, "-m", "studio.cli", "repeat", str(folder), *words]
    return subprocess.run(command, cwd=folder.parent, capture_output=True, text=True, env=os.environ)


def test_a_packed_run_has_the_same_bits_elsewhere(place, tmp_path):
    folder, runs = place
    judge(runs, 2, "candidate", "shorter", "Ada")
    parcel = pack(runs, 2, tmp_path / "parcel", folder)
    assert set(parcel.files) == {"scenario.yaml", "maps/motorway.xodr", "run.json", "traces.parquet", "report.html"} and not parcel.notes
    told = json.loads((parcel.folder / "run.json").read_text())
    assert (told["seed"], told["verdicts"][0]["who"], told["state_hash"]) == (7, "Ada", runs.find(2).state_hash)
    shutil.rmtree(folder)  # nothing is left of where it came from
    done = elsewhere(parcel.folder.rename(tmp_path / "moved"), "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {
        "is_same": True, "expected": told["state_hash"], "found": told["state_hash"], "environment": {}, "metrics": {}
    }  # fmt: skip


def test_what_differs_is_told(place, tmp_path):
    folder, runs = place
    parcel = pack(runs, 1, tmp_path / "parcel", folder)
    told = json.loads((parcel.folder / "run.json").read_text())
    told["versions"]["numpy"] = "1.0"
    (parcel.folder / "run.json").write_text(json.dumps(told))
    text = (parcel.folder / "scenario.yaml").read_text()
    assert "headway: 0.6" in text
    (parcel.folder / "scenario.yaml").write_text(text.replace("headway: 0.6", "headway: 1.1"))
    found = repeat(parcel.folder)
    assert not found.is_same and found.environment == {"numpy": ("1.0", np.__version__)} and "mean_gap" in found.metrics
    done = elsewhere(parcel.folder)
    assert done.returncode == 1 and "another" in done.stdout and "numpy" in done.stdout


def test_a_kind_of_ones_own_goes_along(place, tmp_path):
    folder, runs = place
    (tmp_path / "kinds").mkdir()
    (tmp_path / "kinds" / "flawless.py").write_text(FLAWLESS)
    registry.load_folder(tmp_path / "kinds")
    front = EVERY | {"kind": "flawless", "range": 80, "opening_angle": 0.5, "patience": 3}
    job.run(job.load(folder / "motorway_platoon.yaml", SHORT | {LEADER: front}), runs=runs)
    parcel = pack(runs, 3, tmp_path / "parcel", folder)
    assert (parcel.folder / "kinds" / "flawless.py").read_text() == FLAWLESS
    done = elsewhere(parcel.folder, "--json")
    assert done.returncode == 0 and json.loads(done.stdout)["is_same"], done.stderr


def changed_map(folder, runs):
    file = folder / "maps" / "motorway.xodr"
    file.write_text(file.read_text().replace("<road ", "<!-- wider --><road ", 1).replace('a="3.', 'a="4.', 1))


def gone_map(folder, runs):
    (folder / "maps" / "motorway.xodr").unlink()


def failed(folder, runs):
    with runs.writing():
        runs.database.table("runs").update(1, {"status": "failed", "state_hash": None})


@pytest.mark.parametrize(("harm", "words"), [(changed_map, "are others"), (gone_map, "is gone"), (failed, "did not come to its end")])
def test_what_cannot_be_repeated_is_not_packed(place, tmp_path, harm, words):
    folder, runs = place
    harm(folder, runs)
    with pytest.raises(StoreError) as refused:
        pack(runs, 1, tmp_path / "parcel", folder)
    assert words in str(refused.value) and not (tmp_path / "parcel").exists()


def test_nothing_is_overwritten_and_nothing_outside_is_packed(place, tmp_path):
    folder, runs = place
    (tmp_path / "parcel").mkdir()
    (tmp_path / "parcel" / "mine").write_text("mine")
    with pytest.raises(StoreError, match="is there already"):
        pack(runs, 1, tmp_path / "parcel", folder)
    assert (tmp_path / "parcel" / "mine").read_text() == "mine"
    with pytest.raises(UnknownError):
        pack(runs, 99, tmp_path / "other", folder)
    with runs.writing():
        row = runs.rows("select document from scenarios")[0]
        document = json.loads(row["document"])
        document["map"]["file"] = "../../secret"
        runs.database.conn.execute("update scenarios set document = ?", [json.dumps(document)])
    with pytest.raises(StoreError, match="outside its folder"):
        pack(runs, 1, tmp_path / "other", folder)


@pytest.mark.parametrize("text", [None, "", "[]", "{}", '{"seed": 1}'])
def test_a_folder_that_is_no_parcel_is_told(tmp_path, text):
    if text is not None:
        (tmp_path / "run.json").write_text(text)
    with pytest.raises(StoreError, match="no packed run"):
        repeat(tmp_path)


# -- the page --------------------------------------------------------------------------------------------


class Page(HTMLParser):
    """What a browser would see: texts, and elements that are open at the end."""

    def __init__(self, text):
        super().__init__()
        self.texts, self.names, self.open = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.names.append(tag)
        if tag not in ("meta", "path", "use", "line", "rect"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag in self.open:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)


def test_the_page_says_what_is_in_the_database(place):
    _, runs = place
    judge(runs, 2, "candidate", "shorter <b>& safe</b>", "Ada")
    remark(runs, 2, name="<script>alert(1)</script>", tags=[], note="Look at 1 s.")
    page = Page(report(runs, 2))
    told, row = " ".join(page.texts), runs.find(2)
    for words in ("candidate", "shorter <b>& safe</b>", "Ada", "<script>alert(1)</script>", "Look at 1 s.", "What differs from run 1"):
        assert words in told
    assert "script" not in page.names and page.names.count("svg") == 6 and not page.open
    assert all(name in told and value(each.value) in told for name, each in row.metrics.items())
    assert row.state_hash in told and "applications.platoon.parameters.headway" in told
    assert "http://" not in report(runs, 2).replace("http://www.w3.org", "").replace("http://purl.org", "").replace(
        "http://creativecommons.org", ""
    )


def test_the_page_shows_the_paths_and_the_moment_of_the_least_gap(place):
    _, runs = place
    row = runs.find(2)
    found = plan.drive(runs, row)
    assert found.own == tuple(runs.document(row)["vehicles"]) and set(found.own) <= set(found.places)
    begin, least, end = plan.moments(found)
    gaps = {name: runs.trace(2, [f"{name}.gap"])[f"{name}.gap"] for name in found.gaps}
    (whose,) = least.around
    assert gaps[whose][least.sample] == min(np.nanmin(each) for each in gaps.values() if np.isfinite(each).any())
    assert found.time[begin.sample] == 0.0 and found.time[end.sample] == pytest.approx(2.0, abs=0.1)
    page = Page(report(runs, 2))
    told = " ".join(page.texts)
    assert "From above" in told and "Film strip" in told and f"{found.time[least.sample]:.2f} s: least gap" in told


def test_goals_are_counted_run_by_run(place):
    """The sample wants no collision, which these two seconds meet, and now a time to collision that none of its cars can have."""
    folder, runs = place
    job.run(job.load(folder / "motorway_platoon.yaml", SHORT | {"goals.min_ttc.least": 500}), runs=runs)
    first, third = beside(runs, [1, 3])["goals"]
    assert (third["met"], third["of"]) == (1, 2) and first["of"] == 2
    assert [each.split()[0] for each in third["missed"]] == ["min_ttc"]


def test_a_car_is_drawn_where_it_stands():
    """Heading to the north, its front 2 m before its centre: it reaches from 2 m behind to 2 m ahead, and 0.9 m to each side."""
    x, y = plan.outline(10.0, 20.0, np.pi / 2, Body(4.0, 1.8, 2.0, 1000.0, 0.3))
    assert (x.min(), x.max(), y.min(), y.max()) == pytest.approx((9.1, 10.9, 18.0, 22.0))


def test_numbers_are_short_and_an_axis_is_not_scaled_by_one_needle():
    assert [value(each) for each in (-0.0, -1e-9, 0, 12.3456, None, "x", True)] == ["0", "-1e-09", "0", "12.35", "–", "x", "True"]
    assert value(-0.0, signed=True) == "+0"
    needle = np.r_[np.linspace(1.0, 2.0, 1000), 500.0, np.nan]
    low, high = limits(needle)
    assert low < 1.0 and 2.0 < high < 10.0
    assert limits(np.full(3, np.nan)) is None and limits(np.full(9, 5.0))[0] < 5.0 < limits(np.full(9, 5.0))[1]
