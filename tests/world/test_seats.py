"""Drivers of one's own: a file in a folder is a kind of driver, with settings of its own; what does not fit is told."""

import numpy as np
import pytest
import yaml

from studio import job
from studio.errors import KindError, ScenarioError
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import simulation
from studio.kind import registry
from studio.road.drawn.motorway import motorway
from studio.vehicle.state import V_X
from studio.world.build import build
from studio.world.table.mind import OFFSET
from studio.world.tick import tick

FILE = '''
"""Drives with a speed of his own, a little beside the line. Source: none, this is a test."""
from studio.compiled import compiled
from studio.kind.driver import Driver, Wish
from studio.kind.settings import number
from studio.kinds.driver import attentive

KIND = "driver"
TITLE = "Cruiser"


class Settings(Driver):
    """What a cruiser is like."""

    cruise: float = number(12.0, unit="m/s", title="Speed", ge=1, le=40)
    is_hurried: bool = False
    steering_gain: float = number(2.0, unit="1/s", title="Steering gain", ge=0.1, le=10)
    yaw_damping: float = number(0.1, unit="s", title="Yaw damping", ge=0, le=1)


@compiled
def decide(settings, sees):
    wanted = settings.cruise + (5.0 if settings.is_hurried else 0.0)
    steering = attentive.decide(settings, sees).steering
    return Wish(0.5 * (wanted - sees.speed), steering)
'''


def document(**drivers):
    """A straight road with cars that have these drivers, 100 m apart."""
    return {
        "version": 3,
        "title": "drivers",
        "map": {"file": "motorway.xodr"},
        "clock": {"duration": 20},
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 20}]}},
        "vehicles": {
            name: {"route": "way", "position": {"along": 50 + 100 * i}, "speed": 15, "driver": driver}
            for i, (name, driver) in enumerate(drivers.items())
        },
    }


def scenario(folder, **drivers):
    """The file of this."""
    (folder / "motorway.xodr").write_text(motorway(length=1500.0, lanes=2), encoding="utf-8")
    (folder / "drivers.yaml").write_text(yaml.safe_dump(document(**drivers), sort_keys=False))
    return folder / "drivers.yaml"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a driver."""
    folder = tmp_path_factory.mktemp("drivers")
    (folder / "cruiser.py").write_text(FILE)
    kept = list(registry.every())
    registry.load_folder(folder)
    yield folder
    registry.restore(kept)


def test_a_driver_in_one_file_drives_beside_the_usual_one(folder):
    """Each with its own settings; the usual driver of the third car keeps the speed of the road."""
    drivers = {"slow": {"kind": "cruiser"}, "hurried": {"kind": "cruiser", "cruise": 20, "is_hurried": True}, "usual": {}}
    world = build([job.prepare(job.load(scenario(folder, **drivers)))])
    assert [(seats.kind.name, seats.columns.tolist()) for seats in world.seats] == [("cruiser", [0, 1]), ("attentive", [2])]
    for _ in range(900):
        tick(world)
    assert world.vehicles.state[V_X] == pytest.approx([12.0, 25.0, 20.0], abs=0.5)
    assert np.abs(world.vehicles.mind[OFFSET]).max() < 0.2


def test_another_kind_keeps_the_settings_that_both_have(folder):
    """Whether the file names a driver or leaves him to the usual one, and beside a change of his settings."""
    path = scenario(folder, told={"time_headway": 2.0, "steering_gain": 3.0, "speed_factor": 0.9}, usual={})
    changes = {"vehicles.told.driver.kind": "cruiser", "vehicles.told.driver.cruise": 14, "vehicles.usual.driver.kind": "cruiser"}
    told, usual = (each.driver for each in job.load(path, changes).scenario.vehicles.values())
    assert (told.kind, told.time_headway, told.steering_gain, told.cruise) == ("cruiser", 2.0, 3.0, 14.0)
    assert (usual.kind, usual.time_headway, usual.cruise) == ("cruiser", 1.2, 12.0)
    whole = {"kind": "cruiser", "cruise": 30, "time_headway": 3.0}
    last = (
        job.load(path, {"vehicles.told.driver": whole}).changed({"vehicles.told.driver.kind": "attentive"}).scenario.vehicles["told"].driver
    )
    assert (last.kind, last.time_headway, hasattr(last, "cruise")) == ("attentive", 3.0, False)
    crowd = job.load(path, {"traffic.driver.kind": "cruiser"})
    assert crowd.scenario.traffic.driver.kind == "cruiser"


def test_a_kind_does_not_know_its_batch(folder):
    """Worlds with different drivers side by side end as alone."""
    path = scenario(folder, one={}, other={})
    settings = [job.prepare(job.load(path, {"vehicles.one.driver": {"kind": kind}})) for kind in ("cruiser", "attentive")]

    def run(*settings):
        world = build(settings)
        for _ in range(200):
            tick(world)
        return [world.digest(number) for number in range(len(settings))]

    assert run(*settings) == [digest for one in settings for digest in run(one)] == run(*settings[::-1])[::-1]


@pytest.mark.parametrize(
    ("driver", "path", "what"),
    [
        ({"kind": "cruser"}, "vehicles.car.driver.kind", "did you mean 'cruiser'"),
        ({"kind": "cruiser", "cruise": 99}, "vehicles.car.driver.cruise", "less than or equal to 40"),
        ({"kind": "cruiser", "criuse": 9}, "vehicles.car.driver.criuse", "did you mean 'cruise'"),
        ({"cruise": 12}, "vehicles.car.driver.cruise", "not a field"),
    ],
)
def test_a_driver_that_does_not_fit_is_told_with_its_place(folder, driver, path, what):
    with pytest.raises(ScenarioError) as told:
        job.load(scenario(folder, car=driver))
    (problem,) = told.value.problems
    assert problem.where.startswith("drivers.yaml, line") and problem.where.endswith(path) and what in str(problem)


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (("class Settings(Driver)", "class Settings(Part)"), "is no Driver"),
        (("cruise: float = number(12.0", "cruise: str = Field('12'"), "cruise is str"),
        (("def decide(settings, sees)", "def decide(settings)"), "it is called with"),
        (("@compiled\n", ""), "is not compiled"),
    ],
)
def test_a_file_that_keeps_no_contract_is_told(tmp_path, change, what):
    text = FILE.replace("import number\n", "import Part, number\nfrom pydantic import Field\n").replace(*change)
    path = tmp_path / f"wrong_{abs(hash(what))}.py"
    path.write_text(text.replace('cruise: str = Field(\'12\', unit="m/s", title="Speed", ge=1, le=40)', "cruise: str = Field('12')"))
    with pytest.raises(KindError) as told:
        registry.load_file(path)
    assert what in str(told.value)


def test_a_wish_that_is_no_number_ends_its_own_run(tmp_path, folder):
    """0/0 after a while: the run fails and names driver, vehicle and time; the world beside it goes on."""
    (tmp_path / "dividing.py").write_text(
        FILE.replace("0.5 * (wanted - sees.speed)", "(sees.speed - sees.speed) / (0.0 if sees.speed > 18.0 else 1.0) + 1.0")
    )
    registry.load_file(tmp_path / "dividing.py")
    loaded = [job.load(scenario(folder, car={"kind": kind}), {"clock.duration": 5}) for kind in ("cruiser", "dividing")]
    together = simulation(*map(job.prepare, loaded))
    as_fast_as_possible(together)
    fine, failed = together.cases
    assert (fine.status, failed.status) == ("done", "failed") and 2.0 < failed.time < 4.5
    assert failed.error == (
        f"the driver 'dividing' of car wants an acceleration or steering that is not finite at {failed.time - 0.02:.3f} s"
    )


def test_what_is_returned_must_be_a_wish(tmp_path, folder):
    (tmp_path / "wordless.py").write_text(FILE.replace("return Wish(0.5 * (wanted - sees.speed), steering)", "return steering"))
    registry.load_file(tmp_path / "wordless.py")
    world = build([job.prepare(job.load(scenario(folder, car={"kind": "wordless"})))])
    with pytest.raises(KindError, match="'wordless' cannot be asked"):
        tick(world)
