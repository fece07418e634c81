"""The command line as a user types it."""

import json
import re
import socket
import subprocess
import sys

import pytest

from tests.broken import BROKEN
from tests.patience import PATIENCE

COMPILING = 12.0 * PATIENCE  # [s] everything, on a busy machine


def studio(*arguments, cwd, patience=PATIENCE):
    """Runs the command; returns exit code, output, errors."""
    done = subprocess.run(
        [sys.executable, "-m", "studio.cli", *map(str, arguments)], capture_output=True, text=True, cwd=cwd, timeout=patience
    )
    return done.returncode, done.stdout, done.stderr


SHORT = ("--set", "clock.duration=3")


@pytest.fixture(scope="module")
def folder(tmp_path_factory, sample):
    """A working folder with a run of 3 s and its child with another headway."""
    cwd = tmp_path_factory.mktemp("work")
    first = studio("run", sample, *SHORT, "--json", cwd=cwd, patience=COMPILING)  # it may be the first of all that needs anything
    child = studio("run", sample, *SHORT, "--set", "applications.platoon.parameters.headway=0.9", "--parent", 1, "--json", cwd=cwd)
    assert first[0] == child[0] == 0, first[2] + child[2]
    return cwd, json.loads(first[1]), json.loads(child[1])


def test_run_prints_one_object(folder):
    _, run, _ = folder
    wanted = {
        "run",
        "scenario",
        "scenario_hash",
        "seed",
        "status",
        "state_hash",
        "code_version",
        "sim_time_s",
        "wall_time_s",
        "parameters",
        "metrics",
    }
    assert wanted <= set(run)
    assert run["status"] == "done" and run["sim_time_s"] == 3.0 and run["parameters"] == {"clock.duration": 3}
    gap = run["metrics"]["min_gap"]
    assert (gap["unit"], gap["goal"], gap["kind"]) == ("m", "higher", "min_gap")
    assert len(gap["subject"]) == 2 and 0 <= gap["time"] <= 3 and gap["about"].startswith(" behind ".join(gap["subject"]))
    assert run["metrics"]["mean_speed"]["subject"] == [] and run["metrics"]["mean_speed"]["time"] is None
    assert re.fullmatch("[0-9a-f]{64}", run["state_hash"])


def test_a_fresh_process_gives_the_same_bits(folder, sample):
    cwd, run, child = folder
    again = json.loads(studio("run", sample, *SHORT, "--json", "--db", "other.db", cwd=cwd)[1])
    other = json.loads(studio("run", sample, *SHORT, "--seed", 2, "--json", "--db", "other.db", cwd=cwd)[1])
    assert again["state_hash"] == run["state_hash"] and again["metrics"] == run["metrics"]
    assert other["state_hash"] != run["state_hash"] and child["state_hash"] != run["state_hash"]


def test_python_finds_the_same(folder, sample):
    """The example of the package's docstring; its run has the command line's bits."""
    import studio as package

    scenario = package.load(sample, {"clock.duration": 3})
    run = package.run(scenario, seed=1)
    assert run.state_hash == folder[1]["state_hash"]
    assert run.metrics["min_ttc"].value == folder[1]["metrics"]["min_ttc"]["value"]
    assert run.trace("follower_1.speed").shape == run.time.shape == (151,)


def test_list_show_compare(folder):
    cwd, run, child = folder
    listed = json.loads(studio("runs", "--json", cwd=cwd)[1])
    assert [each["run"] for each in listed] == [2, 1] and listed[0]["parent"] == 1
    assert json.loads(studio("show", 2, "--json", cwd=cwd)[1]) == child
    compared = json.loads(studio("compare", 1, 2, "--json", cwd=cwd)[1])
    assert [each["path"] for each in compared["parameters"]] == ["applications.platoon.parameters.headway"]
    assert compared["parameters"] == [{"path": "applications.platoon.parameters.headway", "a": 0.6, "b": 0.9, "unit": "s"}]
    assert {each["name"] for each in compared["metrics"]} == set(run["metrics"])


def test_tables_for_people(folder):
    cwd, *_ = folder
    assert "min TTC [s]" in studio("runs", cwd=cwd)[1]
    assert "min_gap [m]" in studio("show", 1, cwd=cwd)[1]
    compared = studio("compare", 1, 2, cwd=cwd)[1]
    assert "applications.platoon.parameters.headway [s]" in compared and "same: differs by less than 1 %" in compared


def test_goals_are_told_with_what_was_wanted(folder):
    """The sample wants two things; a third that no run can keep is told as not met, with its value."""
    cwd, run, _ = folder
    assert run["unmet"] == []
    assert "2 of 2 goals met" in studio("show", 1, cwd=cwd)[1]
    compared = studio("compare", 1, 2, cwd=cwd)[1]
    assert "run 1: 2 of 2 goals met" in compared and "run 2: 2 of 2 goals met" in compared


def test_explain(sample, tmp_path):
    """A leader that brakes with 8 m/s² at 0.2 s: for people in sentences, for scripts as a list; what there is not is refused."""
    brake = ("script.hard_brake.do.deceleration=8", "script.hard_brake.when.at=0.2", "clock.duration=4")
    assert studio("run", sample, *(part for each in brake for part in ("--set", each)), cwd=tmp_path)[0] == 0
    code, out, _ = studio("explain", 1, "--json", cwd=tmp_path)
    found = json.loads(out)
    assert code == 0 and {"event", "time", "units", "known", "commanded_by", "tyre_at_limit"} <= set(found[0])
    known = next(each for one in found if one["units"][0] == "follower_1" for each in one["known"])
    assert (known["unit"], known["about"]) == ("follower_1", "leader") and {"source", "age", "lost"} <= set(known)
    assert json.loads(studio("explain", 1, 1, "--json", cwd=tmp_path)[1]) == found[:1]
    text = studio("explain", 1, "hard_brake", cwd=tmp_path)[1]
    assert "leader: brakes hard" in text and "follower_1 knew leader by front" in text
    assert studio("explain", 1, "collision", cwd=tmp_path)[1].strip() == "Run 1: no collision."  # a hard brake there was
    assert studio("explain", 1, "hard_brak", cwd=tmp_path)[0] == 2 and studio("explain", 1, 77, cwd=tmp_path)[0] == 2


def test_check_and_schema(folder, sample):
    cwd, *_ = folder
    code, out, _ = studio("check", sample, cwd=cwd)
    assert code == 0 and "25 vehicles" in out and "© OpenStreetMap contributors" in out
    code, out, _ = studio("check", sample, "--traffic", "--set", "traffic.count=3", cwd=cwd)
    assert code == 0 and all(each in out for each in ("traffic_03", "ford_escort", "speed_factor", "time_headway"))
    schema = json.loads(studio("schema", cwd=cwd)[1])
    assert schema["$defs"]["Clock"]["properties"]["duration"]["unit"] == "s"


OLD = """\
# Mine
title: Old
map: {file: maps/motorway.xodr}
routes: {along: {roads: [motorway]}}  # eastbound
vehicles: {a: {route: along, position: {along: 50}, speed: 20}}
road: {friction: 0.5}
"""


def test_an_old_scenario_is_read_told_and_rewritten(tmp_path, sample):
    (tmp_path / "maps").symlink_to(sample.parent / "maps")
    path = tmp_path / "old.yaml"
    path.write_text(OLD)
    code, out, told = studio("check", path, cwd=tmp_path)
    assert code == 0 and "1 vehicles" in out
    assert "version 1 to 2: `road.friction` is `weather.friction`" in told and f"`studio migrate {path}` rewrites it" in told
    assert path.read_text() == OLD
    code, out, _ = studio("migrate", path, cwd=tmp_path)
    assert code == 0 and "is of version 3 now" in out
    assert path.read_text() == OLD.replace("title", "version: 3\ntitle").replace("road: {", "weather: {")
    assert studio("migrate", path, cwd=tmp_path)[1] == f"{path} is of version 3 already\n"
    code, out, told = studio("check", path, cwd=tmp_path)
    assert code == 0 and told == ""


def test_what_is_wrong_in_a_file_has_its_line_and_in_an_old_one_its_migration(tmp_path):
    path = tmp_path / "old.yaml"
    path.write_text(OLD.replace("0.5", "5").replace("route: along", "rute: along"))
    code, _, told = studio("check", path, cwd=tmp_path)
    assert code == 2 and "old.yaml, line 5, column 16: vehicles.a.rute: is not a field that exists here; did you mean 'route'" in told
    assert "old.yaml: weather.friction" in told and "old.yaml: version 1 to 2: `road.friction` is `weather.friction`" in told
    code, _, told = studio("check", path, "--set", "a=1", cwd=tmp_path)
    assert code == 2 and "line 5" in told
    path.write_text("version: 9\n")
    code, _, told = studio("migrate", path, cwd=tmp_path)
    assert code == 2 and "newer than this studio" in told and path.read_text() == "version: 9\n"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("run", "{sample}", "--set", "clock.duration=on"), ["--set clock.duration", "YAML 1.1 and 1.2", "write true"]),
        (("run", "{sample}", "--set", "clock.duraton=3"), ["clock.duraton", "did you mean 'clock.duration'"]),
        (("run", "{sample}", "--set", "clock.duration=-3"), ["clock.duration", "-3", "> 0"]),
        (("run", "{sample}", "--set", "nonsense"), ["--set", "PATH=VALUE"]),
        (("run", "{sample}", "--seed", "-1"), ["seed", "-1"]),
        (("run", "{sample}", "--parent", "99"), ["99", "the newest is 2"]),
        (("run", "missing.yaml"), ["missing.yaml", "does not exist"]),
        (("run", "{sample}", "--db", "no/such/runs.db"), ["runs.db", "cannot be opened"]),
        (("run", "{sample}", "--kinds", "nowhere"), ["nowhere", "folder"]),
        (("kinds", "--kinds", "nowhere"), ["nowhere", "folder"]),
        (("new", "metric", "min_ttc"), ["min_ttc", "built in"]),
        (("conform", "nowhere.py"), ["nowhere.py", "does not exist"]),
        (("show", "99"), ["no run 99", "the newest is 2"]),
        (("compare", "1", "99"), ["no run 99"]),
        (("runs", "--db", "absent.db"), ["absent.db", "does not exist"]),
        (("check", "runs.db"), ["runs.db", "text file"]),
        (("serve", "--scenarios", "nowhere", "--no-browser", "--port", "0"), ["nowhere", "folder"]),
        (("serve", "--db", "{sample}", "--no-browser", "--port", "0"), ["not a database"]),
        (("serve", "--host", "203.0.113.7", "--no-browser"), ["203.0.113.7"]),
    ],
)
def test_bad_input_ends_with_code_2_and_a_clear_message(folder, sample, arguments, words):
    cwd, *_ = folder
    code, out, errors = studio(*[each.format(sample=sample) for each in arguments], cwd=cwd)
    assert code == 2, out + errors
    for word in words:
        assert word in errors
    assert "Traceback" not in errors and out == ""
    assert len(json.loads(studio("runs", "--json", cwd=cwd)[1])) == 2  # nothing was written


def test_a_port_in_use(folder):
    cwd, *_ = folder
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        code, _, errors = studio("--port", port, "--no-browser", cwd=cwd)
    assert code == 2 and f"port {port}" in errors and f"--port {port + 1}" in errors


def test_an_application_that_raises_fails_its_run(folder, sample, tmp_path):
    cwd, *_ = folder
    (tmp_path / "broken.py").write_text(BROKEN)
    code, out, _ = studio(
        "run", sample, "--applications", tmp_path, "--set", "applications.platoon.application=broken", *SHORT,
        "--db", tmp_path / "failed.db", "--json", cwd=cwd,
    )  # fmt: skip
    run = json.loads(out)
    assert code == 1 and run["status"] == "failed"
    assert "the idea was not so good" in run["error"] and "broken.py" in run["error"] and "Traceback" in run["error"]
    assert 0.5 <= run["sim_time_s"] < 0.6


def test_a_file_that_does_not_load_hurts_nobody_else(folder, sample, tmp_path):
    """It is told with its traceback; a scenario that needs it is refused with the same."""
    cwd, *_ = folder
    (tmp_path / "mine.py").write_text('KIND = "application"\nimport no_such_module')
    command = ("check", sample, "--kinds", tmp_path)
    code, out, errors = studio(*command, cwd=cwd)
    assert code == 0 and "is valid" in out and "mine.py" in errors and "Traceback" in errors and "no_such_module" in errors
    code, _, errors = studio(*command, "--set", "applications.platoon.application=mine", cwd=cwd)
    assert code == 2 and "applications.platoon.application" in errors and "cannot be used" in errors and "no_such_module" in errors


METRIC = '''"""Does something."""
KIND, TITLE, UNIT, BETTER = "metric", "Mine", "m", "higher"
def measure(record):
    """Number [m]."""
    return 1.0
'''


def test_kinds_are_listed(tmp_path):
    """Those of the studio and one's own, with where they come from; broken files too."""
    (tmp_path / "mine.py").write_text(METRIC)
    (tmp_path / "broken.py").write_text(METRIC.replace("measure", "measured"))
    (tmp_path / "helper.py").write_text("VALUE = 1")
    code, out, errors = studio("kinds", "--kinds", ".", "--json", cwd=tmp_path)
    listed = json.loads(out)
    assert code == 0 and all(set(each) == {"kind", "name", "title", "source"} for each in listed)
    assert {"kind": "metric", "name": "mine", "title": "Mine", "source": str(tmp_path / "mine.py")} in listed
    assert {"kind": "channel", "name": "time_gap", "title": "Time gap to the car ahead", "source": "built in"} in listed
    assert "broken.py: measure: is missing" in errors and "helper" not in out + errors
    code, out, _ = studio("kinds", "--applications", tmp_path, cwd=tmp_path)
    assert code == 0 and "broken file" in out and "mine.py" in out and "Least time to collision" in out
    assert studio("kinds", cwd=tmp_path)[1].count("mine") == 0


def test_a_kind_is_begun_and_tried(tmp_path):
    code, out, _ = studio("new", "metric", "mine", cwd=tmp_path)
    assert code == 0 and {path.name for path in tmp_path.iterdir()} == {"mine.py", "test_mine.py", "mine.yaml", "motorway.xodr"}
    assert "studio run mine.yaml --kinds ." in out
    code, out, _ = studio("conform", "mine.py", cwd=tmp_path)
    assert code == 0 and out.count("\nok ") >= 4 and "failed" not in out
    assert studio("new", "metric", "mine", cwd=tmp_path)[0] == 2
    (tmp_path / "mine.py").write_text(METRIC.replace("return 1.0", "return 1 / 0"))
    code, out, _ = studio("conform", "mine", "--kinds", ".", cwd=tmp_path)
    assert code == 1 and "failed" in out and "ZeroDivisionError" in out
    (tmp_path / "mine.py").write_text(METRIC.replace("UNIT", "UNITS"))
    code, out, _ = studio("conform", "mine.py", cwd=tmp_path)
    assert code == 1 and "UNIT: is missing" in out
    code, out, _ = studio("conform", "metric.min_ttc", cwd=tmp_path)
    assert code == 0 and out.startswith("metric min_ttc (built in)")
    assert "did you mean 'min_ttc'" in studio("conform", "min_tc", cwd=tmp_path)[2]


def test_vehicles(tmp_path):
    """The list has every catalogue vehicle; one vehicle has every value with unit and origin."""
    code, out, _ = studio("vehicles", cwd=tmp_path)
    assert code == 0 and all(name in out for name in ("smart_fortwo", "ford_escort", "bmw_320i", "suv", "truck", "electric_compact"))
    found = json.loads(studio("vehicles", "smart_fortwo", "--json", cwd=tmp_path)[1])
    mass = next(each for each in found["values"] if each["path"] == "body.mass")
    assert mass["value"] == 860 and mass["unit"] == "kg" and mass["origin"] == "published" and mass["source"]
    code, _, err = studio("vehicles", "smart_fortow", cwd=tmp_path)
    assert code == 2 and "did you mean 'smart_fortwo'" in err and "Traceback" not in err


def test_drive(tmp_path):
    (tmp_path / "in.csv").write_text("time_s,throttle\n0,1\n2,1\n")
    command = ("drive", "suv", "--inputs", "in.csv", "--out", "out.csv")
    code, out, err = studio(*command, "--speed", 5, "--set", "road.friction=0.5", cwd=tmp_path)
    assert code == 0, err
    assert "201 rows" in out
    head = (tmp_path / "out.csv").read_text().partition("\n")[0].split(",")
    assert head[:3] == ["time_s", "x_m", "y_m"] and "Fz_N_4" in head
    kept = (tmp_path / "out.csv").read_bytes()
    for wrong, words in (
        (("--speed", "fast"), "--speed"),
        (("--set", "body.mass=-1"), "body.mass"),
        (("--out", "in.csv"), "input"),
        (("--out", "nowhere/out.csv"), "nowhere"),
    ):
        code, _, err = studio(*command, *wrong, cwd=tmp_path)
        assert code == 2 and words in err and "Traceback" not in err, (wrong, err)
    assert (tmp_path / "out.csv").read_bytes() == kept
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.csv", "out.csv"]


def test_tyre(tmp_path, root):
    (tmp_path / "rows.csv").write_text("kappa,alpha_rad,gamma_rad,Fz_N\n0.1,0,0,3000\n0,0.05,0,3000\n")
    file = root / "studio" / "scenario" / "tyres" / "smart_175_55r15.tir"
    code, _, err = studio("tyre", file, "--rows", "rows.csv", "--out", "out.csv", "--plot", "plot.png", cwd=tmp_path)
    assert code == 0, err
    rows = (tmp_path / "out.csv").read_text().splitlines()
    assert rows[0] == "kappa,alpha_rad,gamma_rad,Fz_N,Fx_N,Fy_N,Mz_Nm" and len(rows) == 3
    assert float(rows[1].split(",")[4]) > 1500 and float(rows[2].split(",")[5]) < -500
    assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
    copied = tmp_path / "mine.tir"
    copied.write_bytes(file.read_bytes())
    code, _, err = studio("tyre", copied, "--plot", copied, cwd=tmp_path)
    assert code == 2 and ".png" in err and copied.read_bytes() == file.read_bytes()


def test_a_vehicle_file_is_part_of_the_scenarios_hash(tmp_path, sample, root):
    """The same scenario with another vehicle behind the same name is another scenario."""
    import yaml

    from studio import job

    document = yaml.safe_load(sample.read_text())
    document["map"]["file"] = str(sample.parent / document["map"]["file"])
    document["vehicles"]["leader"]["model"] = "./mine.yaml"
    path = tmp_path / "scenario.yaml"
    path.write_text(yaml.safe_dump(document))
    hashes = []
    for mass in (1090.0, 1100.0):
        vehicle = yaml.safe_load((root / "studio" / "scenario" / "vehicles" / "bmw_320i.yaml").read_text())
        vehicle["body"]["mass"] |= {"value": mass}
        (tmp_path / "mine.yaml").write_text(yaml.safe_dump(vehicle, allow_unicode=True))
        loaded = job.load(path)
        hashes.append(job.scenario_hash(loaded, job.prepare(loaded)))
    assert hashes[0] != hashes[1]


@pytest.mark.parametrize("place", ["/dev/null", "/dev/null/cache"])
def test_a_cache_that_cannot_be_is_told(tmp_path, monkeypatch, place):
    monkeypatch.setenv("STUDIO_CACHE", place)
    code, _, told = studio("runs", cwd=tmp_path)
    assert code == 2 and "STUDIO_CACHE" in told and place in told and "Traceback" not in told
