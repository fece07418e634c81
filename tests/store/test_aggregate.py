"""A channel of stored runs in a few numbers: the same by command and REST as of what was recorded."""

import json

import numpy as np
import pytest

from studio import job
from studio.cli import app
from studio.errors import UnknownError
from studio.store.aggregate import aggregated
from studio.store.runs import open_runs
from tests.conftest import ROOT

CHANNEL = "follower_1.speed"


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """A database with two runs of a platoon that differ in their seed."""
    made = open_runs(tmp_path_factory.mktemp("aggregate") / "runs.db")
    for seed in (1, 2):
        job.run(job.load(ROOT / "scenarios" / "grosser_stern_platoon.yaml", {"clock.duration": 3, "seed": seed}), runs=made)
    return made


def values(found):
    return {each.kind: each.value for each in found.aggregates}


def test_they_are_those_of_the_recorded_samples(runs):
    kept = runs.trace(2, [CHANNEL])
    inside = (kept["time"] >= 1) & (kept["time"] <= 2)
    (found,) = aggregated(runs, [2], CHANNEL, begin=1, end=2)
    own = kept[CHANNEL][inside]
    assert found.samples == own.size
    assert found.unit == "m/s"
    assert (found.begin, found.end) == (kept["time"][inside][0], kept["time"][inside][-1])
    assert values(found) == {
        "min": own.min(), "max": own.max(), "mean": own.mean(), "p5": np.percentile(own, 5), "p95": np.percentile(own, 95),
        "at_event": None,
    }  # fmt: skip


def test_at_an_event_is_the_sample_of_its_time(runs):
    event = runs.events(1)[0]
    (found,) = aggregated(runs, [1], CHANNEL, event=event.kind)
    kept = runs.trace(1, [CHANNEL])
    assert found.moment == event.time
    assert values(found)["at_event"] == kept[CHANNEL][kept["time"] <= event.time + 1e-6][-1]


def test_the_command_says_the_same(runs, capsys):
    app(["aggregate", "1,2", CHANNEL, "--begin", "1", "--db", str(runs.path), "--json"], standalone_mode=False)
    told = json.loads(capsys.readouterr().out)
    for one, other in zip(told, aggregated(runs, [1, 2], CHANNEL, begin=1), strict=True):
        assert one["run"] == other.run
        assert {each["kind"]: each["value"] for each in one["aggregates"]} == values(other)
    app(["aggregate", "1,2", CHANNEL, "--db", str(runs.path)], standalone_mode=False)
    assert "5th percentile" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("asked", "word"),
    [
        ({"channel": "follower_1.sped"}, "follower_1.speed"),
        ({"channel": CHANNEL, "begin": 2, "end": 1}, "hold no sample"),
        ({"channel": CHANNEL, "begin": 99}, "hold no sample"),
        ({"channel": CHANNEL, "event": "script_bigun"}, "has not happened"),
    ],
)
def test_what_is_not_there_is_told(runs, asked, word):
    with pytest.raises(UnknownError) as refused:
        aggregated(runs, [1], **asked)
    assert word in str(refused.value) + str(refused.value.problems)
