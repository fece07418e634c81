"""Whom a driver minds: of all that are ahead, whoever permits least, however far; the record and the event of a hard brake name him."""

import pytest
import yaml

from studio import job
from studio.assess.danger import hard_brakes
from studio.kind import registry
from studio.road.drawn.motorway import motorway
from tests.world.test_intervention import PARKED

SPEED = 25.0


@pytest.fixture(scope="module")
def road(tmp_path_factory):
    """A car, another one 60 m ahead that drives as fast, and one that stands 105 m ahead."""
    folder = tmp_path_factory.mktemp("minding")
    (folder / "parked.py").write_text(PARKED)
    registry.load_file(folder / "parked.py")
    (folder / "motorway.xodr").write_text(motorway(length=600.0, lanes=2), encoding="utf-8")
    document = {
        "version": 3,
        "title": "somebody behind somebody",
        "map": {"file": "motorway.xodr"},
        "clock": {"duration": 1.5},
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": SPEED}]}},
        "vehicles": {
            "car": {"route": "way", "position": {"along": 100}, "speed": SPEED},
            "nearest": {"route": "way", "position": {"along": 160}, "speed": SPEED},
            "standing": {"route": "way", "position": {"along": 205}, "speed": 0, "driver": {"kind": "parked"}},
        },
    }
    (folder / "minding.yaml").write_text(yaml.safe_dump(document))
    return folder / "minding.yaml"


def test_a_hard_brake_names_whom_the_driver_minds(road):
    """He brakes for the standing one, while another is nearer; who has nobody ahead minds nobody."""
    record = job.run(job.load(road)).record
    row = record.vehicles.index("car")
    assert (record.minded(row, 1), record.ahead(row, 1)) == ("standing", "nearest")
    assert record.minded(record.vehicles.index("standing"), 1) == ""
    named = {event.vehicle: event.units[1:] for event in hard_brakes(record)}
    assert named["car"] == ("standing",)


def test_numbers_of_a_record_go_by_names(road):
    """Whatever the order in the file: nearest 1, standing 2, after them the objects of the script, from -2 on downwards."""
    script = {
        name: {"do": {"kind": "mover", "who": "box", "route": "way", "line": [[at, 20.0]]}} for name, at in (("zed", 300), ("ann", 320))
    }
    told = []
    for turn in (1, -1):
        document = yaml.safe_load(road.read_text(encoding="utf-8")) | {"script": dict(list(script.items())[::turn])}
        document["vehicles"] = dict(list(document["vehicles"].items())[::turn])
        turned = road.with_name("turned.yaml")
        turned.write_text(yaml.safe_dump(document, sort_keys=False), encoding="utf-8")
        made = job.run(job.load(turned))
        told.append(made)
        assert made.record.called == {0: "car", 1: "nearest", 2: "standing", -2: "ann", -3: "zed"}
        assert set(made.record.trace("car.ahead")[1:-1]) <= {1.0} and made.record.trace("car.minded")[1] == 2.0
    one, other = told
    assert one.metrics == other.metrics
    for name in one.record.names():
        assert one.record.trace(name).tobytes() == other.record.trace(name).tobytes(), name


def test_where_an_application_brakes_the_nearest_is_named(road):
    """It does not ask whom the driver minds."""
    acc = {"application": "acc", "units": ["car"], "parameters": {"headway": 0.8}}
    do = {"kind": "brake", "vehicle": "car", "deceleration": 8, "duration": 1}
    brake = {"when": {"kind": "time", "at": 0}, "do": do}
    record = job.run(job.load(road, {"applications": {"cruise": acc}, "script": {"brake": brake}})).record
    assert next(event.units for event in hard_brakes(record) if event.vehicle == "car") == ("car", "nearest")
