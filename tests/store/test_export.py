"""Trajectories for other programs: what stands in them is what was recorded, in the other program's frame."""

import csv
import io
import os
import subprocess
import sys
from math import cos, radians, sin
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pyproj
import pytest
import sumo

from studio import job
from studio.cli import app
from studio.cli.running import format_of
from studio.errors import StoreError, UnknownError
from studio.store.export import export, lane_beside
from studio.store.runs import open_runs
from tests.conftest import ROOT

CHANGES = {"clock.duration": 4, "traffic.count": 3, "recording.traffic": True, "recording.period": 0.1}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The runs of a database with one of the town, and that run."""
    runs = open_runs(tmp_path_factory.mktemp("export") / "runs.db")
    return runs, job.run(job.load(ROOT / "scenarios" / "urban_grid.yaml", CHANGES), runs=runs)


def document(made, **options):
    """The floating car data as elements."""
    runs, run = made
    return ElementTree.fromstring("".join(export(runs, run.row.run, "fcd", **options)))


def test_sumo_itself_reads_it(made, tmp_path):
    """Its schema has every attribute, and its exporter for network simulators takes the file: so many nodes as there are vehicles."""
    runs, run = made
    schema = ElementTree.parse(Path(sumo.SUMO_HOME) / "data" / "xsd" / "fcd_file.xsd")
    (kind,) = [each for each in schema.getroot() if each.get("name") == "vehicle"]
    assert set(document(made)[0][0].attrib) <= {each.get("name") for each in kind.iter("{http://www.w3.org/2001/XMLSchema}attribute")}
    (tmp_path / "run.fcd.xml").write_text("".join(export(runs, run.row.run, "fcd")))
    exporter = Path(sumo.SUMO_HOME) / "tools" / "traceExporter.py"
    command = [sys.executable, exporter, "--fcd-input", "run.fcd.xml", "--ns2mobility-output", "out.ns2", "--penetration", "1"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, env=os.environ | {"SUMO_HOME": sumo.SUMO_HOME})
    assert (tmp_path / "out.ns2").read_text().count("set X_") == len(run.record.vehicles)


def rows(made, **options):
    """The table as dictionaries."""
    runs, run = made
    return list(csv.DictReader(io.StringIO("".join(export(runs, run.row.run, "csv", **options)))))


def test_fcd_has_a_timestep_for_every_sample_and_everybody(made):
    _, run = made
    root = document(made)
    assert root.tag == "fcd-export"
    assert [float(each.get("time")) for each in root] == pytest.approx(run.time.tolist())
    assert {each.get("id") for each in root[0]} == set(run.record.vehicles)
    assert set(root[0][0].attrib) == {"id", "x", "y", "angle", "type", "speed", "pos", "lane", "slope"}


def test_place_and_angle_are_those_of_the_front(made):
    """The middle of the front bumper; degrees clockwise from north."""
    _, run = made
    for each in document(made)[20]:
        name = each.get("id")
        x, y, heading = (run.trace(f"{name}.{channel}")[20] for channel in ("x", "y", "heading"))
        front = run.record.bodies[name].front
        assert float(each.get("x")) == pytest.approx(x + front * cos(heading), abs=0.006)
        assert float(each.get("y")) == pytest.approx(y + front * sin(heading), abs=0.006)
        angle = radians(float(each.get("angle")))
        assert (sin(angle), cos(angle)) == pytest.approx((cos(heading), sin(heading)), abs=2e-4)
        assert float(each.get("speed")) == pytest.approx(run.trace(f"{name}.speed")[20], abs=0.006)


def test_lane_and_position_lie_where_the_car_is(made):
    """In a junction the lane is the junction, as SUMO names it."""
    setting = job.prepare(job.load(ROOT / "scenarios" / "urban_grid.yaml", CHANGES))
    network = setting.network
    for each in rows(made):
        if each["lane"].startswith(":"):
            continue
        road, _, index = each["lane"].rpartition("_")
        lane = network.lanes_of(road)[int(index)]
        assert 0.0 <= float(each["pos"]) <= lane.length + 0.01
        distance = min((float(each["x"]) - x) ** 2 + (float(each["y"]) - y) ** 2 for x, y in dense(lane.centre)) ** 0.5
        assert distance < 4.0


def test_who_has_changed_lanes_is_on_the_one_beside():
    assert [lane_beside(each, 1) for each in ("12_3#1_0", ":12_3", ":junction")] == ["12_3#1_1", ":12_3", ":junction"]
    assert lane_beside("-92_2", -2) == "-92_0" and lane_beside("-92_2", 0) == "-92_2"


def dense(line):
    """Points of a line every few decimetres."""
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line)))])
    at = np.linspace(0.0, s[-1], max(int(s[-1] / 0.5), 2))
    return zip(np.interp(at, s, line[0]), np.interp(at, s, line[1]), strict=True)


def test_degrees_are_those_of_the_projection(made):
    """Longitude and latitude by the transverse Mercator projection about the map's origin, to a centimetre."""
    _, run = made
    latitude, longitude = run.record.cast.origin
    to_metres = pyproj.Proj(f"+proj=tmerc +lat_0={latitude:.9f} +lon_0={longitude:.9f} +k=1 +ellps=WGS84 +units=m")
    for metres, angles in zip(rows(made)[:40], rows(made, as_degrees=True)[:40], strict=True):
        x, y = to_metres(float(angles["x"]), float(angles["y"]))
        assert (x, y) == pytest.approx((float(metres["x"]), float(metres["y"])), abs=0.01)


def test_who_has_left_is_not_there(made):
    """A sample has a line for everybody on the road and none for others."""
    _, run = made
    found = rows(made)
    assert len(found) == sum(int((run.trace(f"{name}.x") == run.trace(f"{name}.x")).sum()) for name in run.record.vehicles)


def test_what_each_driver_was_like_is_kept(made):
    """Of all vehicles, with the model; those of the traffic have what was drawn for them."""
    runs, run = made
    kept = runs.record(run.row.run).cast
    cars = {car.name: car for car in job.prepare(job.load(ROOT / "scenarios" / "urban_grid.yaml", CHANGES)).cars}
    assert {name: each.driver["speed_factor"] for name, each in kept.manned.items()} == {
        name: car.driver.speed_factor for name, car in cars.items()
    }
    assert kept == run.record.cast
    assert {each.model for each in kept.manned.values()} == {car.model.name for car in cars.values()}


def test_what_was_not_recorded_is_told(tmp_path):
    runs = open_runs(tmp_path / "runs.db")
    loaded = job.load(ROOT / "scenarios" / "urban_grid.yaml", CHANGES | {"clock.duration": 0.2, "recording.channels": ["speed"]})
    run = job.run(loaded, runs=runs)
    with pytest.raises(UnknownError, match=r"recording\.channels: did not keep x, y, heading, station"):
        export(runs, run.row.run, "fcd")
    with pytest.raises(UnknownError, match="99"):
        export(runs, 99, "csv")


def test_the_command_writes_the_same(made, tmp_path, capsys):
    runs, run = made
    out = tmp_path / "run.csv"
    app(["export", str(run.row.run), "--format", "csv", "--out", str(out), "--db", str(runs.path)], standalone_mode=False)
    assert out.read_text() == "".join(export(runs, run.row.run, "csv"))
    assert "trajectories of run 1" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("named", "ending", "found"),
    [
        (None, "fcd.xml", "fcd"), (None, "csv", "csv"), (None, "parquet", "parquet"), ("channels", "csv", "channels"),
        ("csv", "txt", "csv"),
        ("channels", "parquet", None), ("fcd", "csv", None), ("parquet", "xml", None), (None, "txt", None),
    ],
)  # fmt: skip
def test_what_is_written_is_what_the_ending_says(tmp_path, named, ending, found):
    """A format that is not named is that of the ending; one that contradicts it is refused with what is allowed."""
    out = tmp_path / f"run.{ending}"
    if found:
        assert format_of(out, named) == found
    else:
        with pytest.raises(StoreError, match=r"\.(csv|xml|parquet)"):
            format_of(out, named)
