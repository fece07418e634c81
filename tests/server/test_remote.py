"""A studio elsewhere from Python: the same runs, bits and refusals as REST and the database have."""

import json

import numpy as np
import pytest

import studio
from studio.errors import ServerError, StudioError, UnknownError
from studio.store.runs import read_runs
from tests.server.server import served

SCENARIO = "grosser_stern_platoon"
SHORT = {"clock.duration": 1}


@pytest.fixture(scope="module")
def there(tmp_path_factory, sample):
    """A studio, and its database."""
    with (
        served(tmp_path_factory.mktemp("remote"), "--scenarios", sample.parent) as (client, db, _),
        studio.connect(str(client.base_url)) as found,
    ):
        yield found, db


def test_a_run_is_what_the_database_has(there):
    found, db = there
    looks = []
    run = found.run(SCENARIO, set=SHORT, seed=4, progress=looks.append)
    row = read_runs(db).find(run.number)
    assert run.status == "done" and run.row["state_hash"] == row.state_hash and row.seed == 4
    assert {name: each.value for name, each in run.metrics.items()} == {name: each.value for name, each in row.metrics.items()}
    assert run.metrics["min_gap"].subject == tuple(row.metrics["min_gap"].subject) and run.metrics["min_gap"].unit == "m"
    kept, told = read_runs(db).trace(run.number, ["leader.speed", "follower_1.gap"]), run.trace("leader.speed", "follower_1.gap")
    assert all(np.array_equal(kept[name], told[name], equal_nan=True) for name in kept) and told["time"].size == 51
    assert run.trace("leader.speed", begin=0.5, end=0.6)["time"].tolist() == pytest.approx([0.48, 0.5, 0.52, 0.54, 0.56, 0.58, 0.6, 0.62])


def test_it_is_compared_decided_and_found(there):
    found, db = there
    first = found.run(SCENARIO, set=SHORT)
    child = found.run(SCENARIO, set=SHORT | {"applications.platoon.parameters.headway": 0.9}, parent=first.number)
    (differing,) = found.compare(first.number, child.number)["parameters"]
    assert differing["path"] == "applications.platoon.parameters.headway" and child.row["parent"] == first.number
    child.judge("candidate", "shorter", "Ada").remark(name="x", tags=["y"]).remark(note="z")
    told = found.find(child.number).row
    assert (told["verdict"], told["reason"], told["name"], told["tags"], told["note"]) == ("candidate", "shorter", "x", ["y"], "z")
    assert [each.number for each in found.runs(SCENARIO)][:2] == [child.number, first.number] and read_runs(db).find(
        child.number
    ).name == "x"
    assert "shorter" in child.report() and SCENARIO in [each["id"] for each in found.scenarios()]


def test_the_cells_of_a_notebook_run_and_read_what_is_there(there, monkeypatch):
    """All that stands in its cells of Python is executed, without a screen, as a notebook would."""
    monkeypatch.setenv("MPLBACKEND", "Agg")
    found, db = there
    parent = found.run(SCENARIO, set=SHORT)
    run = found.run(SCENARIO, set=SHORT | {"applications.platoon.parameters.headway": 0.7}, parent=parent.number)
    made = json.loads(run.notebook())
    assert (made["nbformat"], made["nbformat_minor"]) == (4, 5) and len({each["id"] for each in made["cells"]}) == len(made["cells"])
    names: dict = {}
    for cell in made["cells"]:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)
    assert names["run"].number == run.number and names["there"].url == found.url
    assert np.array_equal(names["trace"]["leader.speed"], read_runs(db).trace(run.number, ["leader.speed"])["leader.speed"], equal_nan=True)
    assert names["rows"][0, 0].get_ylabel() == "speed [m/s]"


def test_what_is_refused_is_raised_with_its_problems(there):
    found, _ = there
    with pytest.raises(StudioError) as refused:
        found.run(SCENARIO, set={"clock.duration": -1})
    assert any("clock.duration" in each.where for each in refused.value.problems)
    assert found.check(SCENARIO) == [] and "clock.duration" in found.check(SCENARIO, {"clock.duration": -1})[0]
    for act in (lambda: found.find(999), lambda: found.run("nowhere"), lambda: found.compare(1, 999)):
        with pytest.raises(UnknownError):
            act()
    run = found.run(SCENARIO, set=SHORT)
    with pytest.raises(StudioError, match="said of a run"):
        run.judge("candidate", " ")
    with pytest.raises(StudioError):
        run.trace("leader.nothing")


def test_a_run_is_cancelled(there):
    found, _ = there
    run = found.start(SCENARIO, set={"clock.duration": 3600})
    run.cancel()
    assert run.wait().status in ("stopped", "cancelled")


def test_nobody_there_and_nobody_let_in(tmp_path, sample):
    with pytest.raises(ServerError, match=r"no studio at http://127\.0\.0\.1:9"):
        studio.connect("http://127.0.0.1:9")
    token = "a-token-that-is-long-enough"
    with served(tmp_path, "--scenarios", sample.parent, "--host", "0.0.0.0", STUDIO_TOKEN=token) as (client, _, _):
        address = f"http://127.0.0.1:{client.base_url.port}"
        with pytest.raises(StudioError, match="token"):
            studio.connect(address)
        assert studio.connect(address, token).scenarios()
