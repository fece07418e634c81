"""A closed loop of known truth: calibration finds what was changed, the right car passes, and each wrong one fails where it should."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from studio.errors import ScenarioError
from studio.scenario import catalogue
from studio.store import iteration
from studio.store.runs import open_runs
from studio.validation import calibration, iterate, judge, sample
from studio.validation.project import load
from tests.validation.truth import CAR, TRUE, Ground, Instrument, j_turns, lane_changes, stops

LATERAL = {
    "tyres.front_cornering": {"low": 0.5, "high": 1.6},
    "tyres.rear_cornering": {"low": 0.5, "high": 1.6},
    "body.yaw_inertia": {"low": 1200.0, "high": 3000.0},
}


@pytest.fixture(scope="module")
def ground(tmp_path_factory):
    made = Ground(tmp_path_factory.mktemp("truth"))
    made.drive("turn", "j_turn", j_turns(12), calibrates=4, seed=10)
    made.drive("change", "double_lane_change", lane_changes(12), calibrates=4, seed=11)
    return made


@pytest.fixture(scope="module")
def project(ground):
    return ground.project(calibration={"lateral": {"parameters": LATERAL}})


def failed(path, **changes):
    """The criteria that fail with a vehicle."""
    loaded = load(path)
    if changes:
        loaded = replace(loaded, model=catalogue.changed(loaded.model, changes))
    found = judge.validate(loaded)
    return [f"{each.maneuver}: {each.criterion}" for each in found.verdicts if each.verdict == "fail"], found


def test_the_right_car_passes_and_says_for_what(project):
    wrong, found = failed(project, **TRUE)
    assert wrong == [] and found.is_valid and len(found.verdicts) > 40
    low, high = found.span.speed
    assert 13.0 < low < 13.9 and 20.0 < high < 20.8
    assert found.span.lateral_acceleration[1] > 4.0 and found.span.acceleration[1] < 1.0


def test_calibration_finds_what_was_changed(project):
    """From the catalogue's car, 18 % and 10 % and 17 % away, within three of the standard deviations that are told."""
    found = calibration.calibrate(load(project), "lateral")
    for each in found.estimates:
        assert abs(each.value - TRUE[each.path]) < 3.0 * each.spread, each
        assert each.spread < 0.03 * each.value, each
    assert found.warnings == []
    assert all(after < 0.5 * before for before, after in found.misfit.values())


def test_the_sample_to_learn_with_has_its_truth_within_what_is_told(tmp_path):
    """A speed that was held less closely in the replay than on the drive once bent it by four standard deviations."""
    sample.write(tmp_path)
    (found,) = calibration.calibrate(load(tmp_path / "project.yaml"), "lateral").estimates
    assert abs(found.value - sample.TRUTH) < 2.0 * found.spread < 0.002


def test_a_range_without_what_the_car_has_is_told(project):
    """What it had, and how well that followed, are the car's own, wherever the search began."""
    path, value = "tyres.front_cornering", catalogue.find_vehicle(CAR).values.tyres.front_cornering
    other = project.with_name("other.yaml")

    def calibrated(low, high):
        document = yaml.safe_load(project.read_text()) | {"calibration": {"lateral": {"parameters": {path: {"low": low, "high": high}}}}}
        other.write_text(yaml.safe_dump(document))
        return calibration.calibrate(load(other), "lateral")

    wide, narrow = calibrated(0.5, 1.6), calibrated(value + 0.1, value + 0.3)
    assert narrow.estimates[0].start == pytest.approx(value) == wide.estimates[0].start
    assert {name: before for name, (before, _) in narrow.misfit.items()} == pytest.approx(
        {name: before for name, (before, _) in wide.misfit.items()}
    )
    assert [path in each and "outside of what is allowed" in each for each in narrow.warnings].count(True) == 1


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"tyres.front_cornering": 0.6}, "turn: steady yaw_rate, mean in the interval"),
        ({"tyres.rear_cornering": 0.7}, "change: yaw_rate, first extremum, averaged simulation"),
        ({"steering.ratio": 16.0}, None),
    ],
)
def test_a_wrong_tyre_fails_by_its_gain(project, changes, where):
    """What is fed past, as the steering's ratio where road wheels are recorded, changes nothing."""
    wrong, _ = failed(project, **(TRUE | changes))
    assert where in wrong if where else wrong == []


def test_a_swapped_sign_fails_by_its_gains(ground, tmp_path):
    path = unknown(ground, tmp_path, Instrument(offset=0.0, delay=0.0, is_known=False))
    wrong, _ = failed(path, **TRUE)
    assert "turn: steady yaw_rate, averaged simulation" in wrong
    assert not any("lateral_acceleration" in each for each in wrong)


def test_a_shifted_clock_fails_by_its_lag(ground, tmp_path):
    path = unknown(ground, tmp_path, Instrument(offset=0.0, delay=0.15, sign=1, is_known=False))
    wrong, _ = failed(path, **TRUE)
    assert {"change: yaw_rate, lag of the first half wave, mean", "turn: yaw_rate, lag of the step, mean"} <= set(wrong)
    assert "turn: steady yaw_rate, averaged simulation" not in wrong
    assert not any("lateral_acceleration" in each for each in wrong)


def unknown(ground, folder, instrument):
    """The same drives, recorded by an instrument that nobody knows about."""
    made = Ground(folder, instrument)
    made.drive("turn", "j_turn", j_turns(8), seed=10)
    made.drive("change", "double_lane_change", lane_changes(8), seed=11)
    return made.project()


def test_a_wrong_mass_fails_in_braking(tmp_path):
    made = Ground(tmp_path)
    made.drive("stop", "braked_coasting", stops(6), seed=12)
    path = made.project()
    assert failed(path, **TRUE)[0] == []
    mass = catalogue.find_vehicle(CAR).values.body.mass
    wrong, _ = failed(path, **(TRUE | {"body.mass": 1.2 * mass}))
    assert "stop: acceleration, faster half, averaged simulation" in wrong


# -- iterations ------------------------------------------------------------------------------------------


def test_every_step_is_an_iteration_with_its_parent(project, tmp_path):
    runs = open_runs(tmp_path / "runs.db")
    first, _ = iterate.validate(iterate.begin(load(project), runs), runs)
    second, found = iterate.calibrate(iterate.begin(load(project), runs), "lateral", runs)
    third, result = iterate.validate(iterate.begin(load(project), runs), runs)
    history = iteration.history(runs, "Known truth")
    assert [(each.iteration, each.step, each.parent) for each in history] == [
        (first, "validation", None),
        (second, "lateral", None),
        (third, "validation", second),
    ]
    assert history[1].changes == found.changes == history[2].changes and len(history[1].used) == 8
    assert history[2].result["verdicts"] == [each.as_json() for each in result.verdicts]
    assert sum(each["verdict"] == "fail" for each in history[0].result["verdicts"]) > 5
    assert iterate.estimates(runs, third).keys() == LATERAL.keys()
    document = yaml.safe_load(project.read_text())
    document["maneuvers"]["turn"]["validation"].append(document["maneuvers"]["turn"]["calibration"].pop())
    moved = project.with_name("moved.yaml")
    moved.write_text(yaml.safe_dump(document))
    with pytest.raises(ScenarioError, match="cannot validate"):
        iterate.validate(iterate.begin(load(moved), runs), runs)
    assert len(iteration.history(runs, "Known truth")) == 3


def test_what_these_runs_cannot_tell_is_said(ground, tmp_path):
    """Mass and yaw inertia are felt, the inertia of the engine in neutral is not; front and rear together with the ratio are one."""
    path = ground.project(calibration={"vague": {"parameters": {"engine.inertia": {"low": 0.1, "high": 0.4}}}})
    found = calibration.calibrate(load(path), "vague")
    assert any("engine.inertia is hardly felt" in each for each in found.warnings)
    ground.project(calibration={"lateral": {"parameters": LATERAL}})
    assert np.isfinite(found.estimates[0].value)
