"""The commands about recorded drives, as a script uses them; what is wrong is told, and keeps nothing."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from studio.cli import app
from studio.errors import ScenarioError, StudioError
from studio.scenario import catalogue
from studio.store import iteration
from studio.store.runs import open_runs
from studio.validation import calibration, known, project, replay
from tests.validation.truth import Ground, j_turns


@pytest.fixture(scope="module")
def ground(tmp_path_factory):
    made = Ground(tmp_path_factory.mktemp("commands"))
    made.drive("turn", "j_turn", j_turns(7), calibrates=2, changes={"tyres.front_cornering": 0.85}, seed=20)
    return made


@pytest.fixture
def path(ground):
    return ground.project(calibration={"lateral": {"parameters": {"tyres.front_cornering": {"low": 0.5, "high": 1.5}}}})


def studio(*arguments):
    return CliRunner().invoke(app, [str(each) for each in arguments])


def test_the_way_from_a_log_to_a_car_with_its_span(path, tmp_path):
    db, out, page = tmp_path / "runs.db", tmp_path / "car.yaml", tmp_path / "report.html"
    log = json.loads(studio("logs", "import", path.with_name("turn_0.csv"), "--mapping", path.with_name("mapping.yaml"), "--json").stdout)
    assert {"name", "unit", "rate", "gaps", "low", "high"} <= log["signals"][0].keys() and log["ours"][0]["rate"] == pytest.approx(100.0)
    before = studio("validate", path, "--db", db, "--json")
    assert before.exit_code == 1 and not json.loads(before.stdout)["valid"]
    (found,) = json.loads(studio("calibrate", path, "--db", db, "--json").stdout)
    assert found["changes"]["tyres.front_cornering"] == pytest.approx(0.85, abs=0.01)
    after = studio("validate", path, "--db", db, "--out", out, "--report", page, "--json")
    result = json.loads(after.stdout)
    assert after.exit_code == 0 and result["valid"] and "two-sided" in result["interval"]
    names = ["maneuver", "criterion", "ours", "theirs", "low", "high", "error", "limit", "verdict", "reason", "unit", "error_unit"]
    assert list(result["verdicts"][0]) == names and {"verdicts", "span", "interval"} <= result.keys()
    car = catalogue.find_vehicle(str(out))
    assert car.values.validated.model_dump() == result["span"]["whole"]
    assert car.origins["tyres.front_cornering"].source.startswith("calibrated: Known truth; 0.8")
    text = page.read_text()
    assert re.search(r"<td class=\"n\">0\.\d+ rad/s</td>.*?<td class=\"n\">[+-]\d[.\d]* %</td><td class=\"n\">5 %</td>", text)
    assert text.count("<svg") == 2 and "95 % confidence interval of the mean, two-sided" in text and "longitudinal acceleration" in text
    assert not any(word in text for word in ("<script", "<link", "<img", "@import", "url(http", 'src="'))


def test_the_report_is_a_pdf_where_it_is_named_so_and_else_nothing_is_begun(path, tmp_path):
    db = tmp_path / "runs.db"
    refused = studio("validate", path, "--db", db, "--report", tmp_path / "report.docx")
    assert "has an ending that no report has" in str(refused.exception) and not db.exists()
    done = studio("validate", path, "--db", db, "--report", tmp_path / "report.pdf")
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF-")
    row = next(line for line in done.stdout.splitlines() if "averaged simulation" in line and "yaw_rate" in line)
    assert re.search(r"0\.\d+ rad/s .* \+\d[.\d]* % .* 5 % .* fail", row)


def test_a_cut_is_told_as_a_project_takes_it(path):
    (found,) = json.loads(studio("logs", "cut", path.with_name("turn_0.csv"), "--mapping", path.with_name("mapping.yaml"), "--json").stdout)
    assert found["kind"] == "j_turn" and found["end"] - found["begin"] > 3.0


@pytest.mark.parametrize("times", [{"begin": 61.5, "end": 68.0}, {"end": 68.0}])
def test_a_cut_beyond_its_log_is_told_with_the_span_of_the_log(path, tmp_path, times):
    document = yaml.safe_load(path.read_text())
    document["maneuvers"]["turn"]["validation"][0] |= times
    bad = path.with_name("beyond.yaml")
    bad.write_text(yaml.safe_dump(document))
    done = studio("validate", bad, "--db", tmp_path / "runs.db")
    told = str(done.exception)
    assert "is beyond turn_2.csv" in told and re.search(r"allowed: 0 to \d+\.\d\d s", told), told


# -- bad input -------------------------------------------------------------------------------------------


def refusal(path, change):
    document = yaml.safe_load(path.read_text())
    change(document)
    bad = path.with_name("bad.yaml")
    bad.write_text(yaml.safe_dump(document))
    with pytest.raises(StudioError) as told:
        project.load(bad)
    return str(told.value)


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (lambda d: d["maneuvers"]["turn"].update(kind="j_tur"), "did you mean 'j_turn'?"),
        (lambda d: d["maneuvers"]["turn"].update(validation=[], calibration=[]), "has no runs"),
        (lambda d: d["maneuvers"]["turn"]["validation"].append(d["maneuvers"]["turn"]["calibration"][0]), "was used for calibration"),
        (lambda d: d["calibration"]["lateral"]["parameters"].update({"body.mas": {"low": 1, "high": 2}}), "did you mean 'body.mass'?"),
        (
            lambda d: d["calibration"]["lateral"]["parameters"].update({"body.mass": {"low": 2, "high": 1}}),
            "low 2 must be less than high 1",
        ),
        (lambda d: d["calibration"]["lateral"]["parameters"].update({"body.mass": {"low": 1, "high": 2, "prior": 1}}), "prior and spread"),
        (lambda d: d["calibration"]["lateral"].update(maneuvers=["turns"]), "did you mean 'turn'?"),
        (lambda d: d.update(overrides=[{"maneuver": "turn", "criterion": "a", "reason": "so"}]), "at least 10 characters"),
        (lambda d: d["maneuvers"]["turn"]["validation"].append({"log": "nowhere.csv"}), "does not exist"),
        (lambda d: d["maneuvers"]["turn"]["validation"].append({"log": "turn_3.csv", "begin": 90}), "is beyond turn_3.csv"),
        (
            lambda d: d["maneuvers"].update(stop={"kind": "braking", "validation": [{"log": "turn_3.csv"}]}),
            "has no brake_torque and no brake",
        ),
        (lambda d: d.update(vehicle="bmw_320"), "bmw_320i"),
    ],
)
def test_projects_that_are_none(path, change, what):
    assert what in refusal(path, change)


def test_a_copy_of_a_run_under_another_name_is_found(path):
    copy = path.with_name("other_day.csv")
    copy.write_bytes(path.with_name("turn_0.csv").read_bytes())
    told = refusal(path, lambda d: d["maneuvers"]["turn"]["validation"].append({"log": "other_day.csv"}))
    assert "maneuvers.turn.validation[5]: was used for calibration" in told


@pytest.mark.parametrize(
    "alter",
    [
        lambda rows: np.vstack([rows[:1] + [0.0, 1e-6, *[0.0] * (rows.shape[1] - 2)], rows[1:]]),
        lambda rows: np.round(rows, 4),
        lambda rows: rows[:-20],
    ],
    ids=["one sample", "fewer digits", "the end"],
)
def test_a_copy_that_was_altered_a_little_is_found(path, alter):
    original = path.with_name("turn_0.csv")
    head, rows = original.read_text().splitlines()[0], np.loadtxt(original, delimiter=",", skiprows=1)
    np.savetxt(path.with_name("altered.csv"), alter(rows), delimiter=",", header=head, comments="", fmt="%.9g")
    told = refusal(path, lambda d: d["maneuvers"]["turn"]["validation"].append({"log": "altered.csv"}))
    assert "maneuvers.turn.validation[5]: was used for calibration" in told


def test_a_gap_in_what_is_fed_is_refused_and_one_in_what_is_judged_is_not(path):
    loaded = project.load(path)
    run = loaded.validation["turn"][0]
    gap = (run.time > 2.0) & (run.time < 2.5)
    holed = lambda name: replace(run, signals=run.signals | {name: np.where(gap, np.nan, run[name])})  # noqa: E731
    with pytest.raises(ScenarioError, match=r"gap in road_wheel_angle \(got 2\.01 to 2\.49 s\)"):
        replay.replay(loaded.model, [holed("road_wheel_angle")], known.find("j_turn"), {})
    (made,) = replay.replay(loaded.model, [holed("yaw_rate")], known.find("j_turn"), {})
    assert np.isfinite(made["yaw_rate"]).all()


def test_what_is_wrong_keeps_nothing(path, tmp_path):
    document = yaml.safe_load(path.read_text())
    document["maneuvers"]["turn"]["validation"].append({"log": "nowhere.csv"})
    bad = path.with_name("bad.yaml")
    bad.write_text(yaml.safe_dump(document))
    for command in ("validate", "calibrate"):
        done = studio(command, bad, "--db", tmp_path / "runs.db")
        assert done.exit_code != 0 and not (tmp_path / "runs.db").exists()


def test_a_calibration_that_does_not_converge_keeps_nothing_and_says_what_to_do(path, tmp_path, monkeypatch):
    """One evaluation is too few to get anywhere from a start that is 18 % away."""
    monkeypatch.setattr(calibration, "MOST", 1)
    done = studio("calibrate", path, "--db", tmp_path / "runs.db")
    assert done.exit_code != 0 and "does not converge; nothing was kept" in str(done.exception)
    assert iteration.history(open_runs(tmp_path / "runs.db"), "Known truth") == []
