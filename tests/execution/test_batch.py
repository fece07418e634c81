"""Several worlds side by side: each has the record, the events, the metrics and the bits that it has alone."""

import numpy as np
import pytest

from studio import job
from studio.errors import ScenarioError
from studio.execution import record as recording
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import simulation
from studio.kind import registry
from studio.vehicle.parameter import AREA
from tests.broken import BROKEN
from tests.conftest import ROOT

SAMPLE = ROOT / "scenarios" / "urban_grid.yaml"


def loaded(seed=1, **changes):
    """The sample with a seed, five seconds long."""
    return job.seeded(job.load(SAMPLE, {"clock.duration": 5} | changes), seed)


def outcomes(each):
    """Runs of some scenarios side by side."""
    together = simulation(*map(job.prepare, each))
    as_fast_as_possible(together)
    return [job.outcome(one, together, number) for number, one in enumerate(each)]


def same(one, other):
    """Whether two runs are the same in all that is kept of them."""
    assert one.state_hash == other.state_hash and (one.status, one.error) == (other.status, other.error)
    assert (
        one.record.happenings == other.record.happenings
        and one.record.links == other.record.links
        and np.array_equal(one.record.ages, other.record.ages, equal_nan=True)
    )
    assert one.record.vehicles == other.record.vehicles and one.record.chains == other.record.chains
    assert one.record.time.tobytes() == other.record.time.tobytes()
    np.testing.assert_array_equal(one.record.values, other.record.values)
    assert one.metrics == other.metrics and one.sim_time_s == other.sim_time_s


def test_three_seeds_are_as_three_runs():
    each = [loaded(seed) for seed in (1, 2, 3)]
    together = outcomes(each)
    for one, alone in zip(together, (outcomes([one])[0] for one in each), strict=True):
        same(one, alone)
    assert len({one.state_hash for one in together}) == 3


def test_worlds_with_different_radios():
    """What a radio remembers of channels, links and cells is its world's alone."""
    platoon = {"applications": {"pair": {"application": "cacc", "units": ["north"], "listens_to": ["straight"]}}, "radio.range": 5000.0}
    wlan = platoon | {"radio.kind": "wlan", "radio.preset": "urban", "radio.congestion_control": "oscar"}
    cellular = {"applications": platoon["applications"], "radio.kind": "cellular", "radio.bandwidth": 2000.0}
    each = [loaded(1, **wlan), loaded(2, **cellular), loaded(3, **platoon), loaded(4, **wlan)]
    for one, alone in zip(outcomes(each), (outcomes([one])[0] for one in each), strict=True):
        same(one, alone)
        assert one.status == "done" and one.record.messages.cause.size > 0


def test_variants_with_other_vehicles_and_applications():
    """One with a platoon and traffic that is recorded, one without applications: other numbers of columns and links."""
    platoon = {"application": "cacc", "units": ["north"], "listens_to": ["straight"]}
    each = [
        loaded(1, applications={"pair": platoon, "distance": {"application": "acc", "units": ["straight"]}}),
        loaded(2, applications={}, **{"traffic.count": 4}),
        loaded(3),
    ]
    for one, alone in zip(outcomes(each), (outcomes([one])[0] for one in each), strict=True):
        same(one, alone)


def test_a_world_that_fails_ends_by_itself(tmp_path):
    """An application raises in the middle world; its record ends there, and its neighbours do not notice."""
    (tmp_path / "failing.py").write_text(BROKEN)
    registry.load_folder(tmp_path)
    failing = {"distance": {"application": "failing", "units": ["straight"]}}
    each = [loaded(1), loaded(2, applications=failing), loaded(3)]
    together = outcomes(each)
    for one, alone in zip(together, (outcomes([one])[0] for one in each), strict=True):
        same(one, alone)
    assert [one.status for one in together] == ["done", "failed", "done"]
    assert together[1].record.time[-1] == pytest.approx(0.5) and "the idea was not so good" in together[1].error


def test_a_state_that_is_none_ends_its_world_only():
    each = [loaded(1), loaded(2)]
    together = simulation(*map(job.prepare, each))
    together.advance(10)
    together.world.vehicles.parameter[AREA, together.world.worlds.first[1] + 2] = np.nan
    as_fast_as_possible(together)
    same(job.outcome(each[0], together, 0), outcomes([each[0]])[0])
    failed = together.cases[1]
    assert failed.status == "failed" and failed.error.endswith("of north is not finite any more at 0.205 s")
    assert failed.happenings[-1].text.startswith("failed") and together.record(1).time.size == 11
    assert np.isfinite(together.world.vehicles.state).all()


def test_runs_of_different_clocks_are_refused():
    with pytest.raises(ScenarioError, match="side by side") as caught:
        simulation(job.prepare(loaded()), job.prepare(loaded(1, **{"clock.duration": 6, "recording.period": 0.1})))
    assert [problem.where for problem in caught.value.problems] == ["clock of run 2", "recording of run 2"]


@pytest.mark.parametrize("ticks", [1, 7, 1000])
def test_it_does_not_matter_how_often_one_looks(ticks):
    """Tick by tick or all at once: the same record and events."""
    one = loaded()
    stepped = simulation(job.prepare(one))
    while not stepped.is_over:
        stepped.advance(ticks)
    same(job.outcome(one, stepped), outcomes([one])[0])


@pytest.mark.parametrize("chunk", [1, 7, 251, 252])
def test_the_size_of_a_chunk_changes_nothing(monkeypatch, chunk):
    """251 samples in chunks that are filled just so, or not."""
    one = loaded()
    expected = outcomes([one])[0]
    monkeypatch.setattr(recording.Recorder, "room", chunk)
    found = outcomes([one])[0]
    same(found, expected)
    assert found.record.time.size == 251


def test_single_samples_are_those_of_the_record():
    run = simulation(job.prepare(loaded()))
    run.advance(200)
    some, whole = run.record_of([0, 3, 199]), run.record()
    assert some.time.tolist() == whole.time[[0, 3, 199]].tolist()
    np.testing.assert_array_equal(some.values, whole.values[:, :, [0, 3, 199]])
