"""Light vehicles in a town: who has them, among full ones, in a record, in a snapshot, side by side; and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.application.contract import ENGINE_TORQUE
from studio.assess.cause import explain
from studio.assess.danger import with_dangers
from studio.assess.measure import measure_all
from studio.cli.running import print_traffic
from studio.errors import ScenarioError
from studio.execution.about import about, of_about
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import simulation
from studio.kind import registry
from studio.vehicle.parameter import TAU_STEER
from studio.vehicle.state import GEAR, RATIO, V_X
from studio.world.build import build
from studio.world.snapshot import restore, snapshot
from studio.world.tick import tick
from tests.conftest import ROOT

SAMPLE = ROOT / "scenarios" / "urban_grid.yaml"
MIXED = {
    "traffic.types": {"light": {"model": "suv", "dynamics": "light"}, "full": {"model": "bmw_320i"}},
    "traffic.mix": {"light": 1.0, "full": 1.0},
    "vehicles.straight.dynamics": "light",
}
ALL_LIGHT = {"traffic.dynamics": "light"} | {
    f"vehicles.{name}.dynamics": "light" for name in ("straight", "left_turner", "north", "ring", "quiet")
}
BRAKES = {"stop": {"when": {"kind": "time", "at": 2.0}, "do": {"kind": "brake", "vehicle": "north", "deceleration": 7.0, "duration": 1.0}}}


def loaded(seconds=8.0, **changes):
    """The sample with its traffic recorded."""
    return job.load(SAMPLE, {"clock.duration": seconds, "recording.traffic": True} | changes)


def run(seconds=8.0, **changes):
    """It has been run."""
    made = simulation(job.prepare(loaded(seconds, **changes)))
    as_fast_as_possible(made)
    assert made.cases[0].status == "done", made.cases[0].error
    return made


@pytest.fixture(scope="module")
def mixed():
    """A town with both, for half a minute."""
    return run(30.0, **MIXED)


# -- who has them ----------------------------------------------------------------------------------


def test_types_and_vehicles_say_who_is_light(mixed):
    """And the record says it afterwards, also when it is read again."""
    cars, manned = mixed.cases[0].setting.cars, of_about(about(mixed.record()))["cast"].manned
    assert {name: each.dynamics for name, each in manned.items()} == {car.name: "light" if car.is_light else "full" for car in cars}
    assert {car.model.name for car in cars[5:] if car.is_light} == {"suv"} and cars[0].is_light and not cars[1].is_light
    light = mixed.world.vehicles.light.tolist()
    assert light == [v for v, car in enumerate(cars) if car.is_light] and 5 < len(light) < len(cars) - 5
    assert sorted([*light, *mixed.world.vehicles.order]) == list(range(len(cars)))


def test_left_out_all_are_full_and_a_type_has_the_dynamics_of_the_traffic():
    assert build([job.prepare(loaded())]).vehicles.light.size == 0
    types = {
        "traffic.types": {"plain": {"model": "suv"}, "whole": {"model": "suv", "dynamics": "full"}},
        "traffic.mix": {"plain": 1, "whole": 1},
    }
    cars = job.prepare(loaded(**types, **{"traffic.dynamics": "light"})).cars[5:]
    assert 0 < sum(car.is_light for car in cars) < len(cars)


def test_nothing_else_differs():
    """The same cars with the same drivers on the same ways, whoever is light."""
    full, light = (job.prepare(loaded(**each)).cars for each in ({}, ALL_LIGHT))
    assert all(car.is_light for car in light) and len(full) == len(light)
    for one, other in zip(full, light, strict=True):
        assert replace(one, path=None, is_light=True) == replace(other, path=None)
        assert (one.path.points == other.path.points).all()


def test_the_list_of_the_traffic_tells_it(capsys):
    print_traffic(job.prepare(loaded(**MIXED)))
    told = capsys.readouterr().out
    assert "dynamics" in told and " light " in told and " full " in told


# -- how they drive --------------------------------------------------------------------------------


def test_they_drive_as_the_full_ones_do(mixed):
    """Nobody hits anybody or leaves the road; on the same ways light cars are as fast to 2 % and as near to their paths to 5 cm."""
    found = measure_all(mixed.record())
    assert found["collisions"].value == found["left_road"].value == found["passed_at_red"].value == 0.0
    full, light = (measure_all(run(20.0, **{"traffic.count": 0} | each).record()) for each in ({}, ALL_LIGHT))
    assert light["mean_speed"].value == pytest.approx(full["mean_speed"].value, rel=0.02)
    assert light["max_lateral_offset"].value == pytest.approx(full["max_lateral_offset"].value, abs=0.05)
    assert light["energy"].value == pytest.approx(full["energy"].value, rel=0.1)


def test_they_have_no_gears(mixed):
    state, light = mixed.world.vehicles.state, mixed.world.vehicles.light
    assert (state[RATIO, light] == 0.0).all() and (state[GEAR, light] == 1.0).all()


# -- what they do not know -------------------------------------------------------------------------


def test_what_they_do_not_know_is_recorded_as_no_number(mixed):
    record = mixed.record()
    is_light = np.array([record.cast.manned[name].dynamics == "light" for name in record.vehicles])
    for channel in ("engine_speed", "engine_torque", "adhesion_front_left", "tyres_sliding"):
        values = record.channel(channel)
        assert np.isnan(values[is_light]).all() and np.isfinite(values[~is_light]).any(axis=1).all(), channel
    for channel in ("speed", "acceleration", "drive_torque", "brake_torque", "steering", "yaw_rate"):
        assert np.isfinite(record.channel(channel)).any(axis=1).all(), channel


def test_measures_of_tyres_are_of_full_ones(mixed):
    """Where there are none they say so."""
    found = measure_all(mixed.record())
    assert found["max_adhesion"].value > 0.0 and found["nonlinear_tyre_time"].value is not None
    assert mixed.record().cast.manned[found["max_adhesion"].subject[0]].dynamics == "full"
    none = measure_all(run(2.0, **ALL_LIGHT).record())
    for name in ("max_adhesion", "nonlinear_tyre_time"):
        assert (none[name].value, none[name].about) == (None, "light vehicles have no tyres")
    assert none["max_deceleration"].value is not None and none["energy"].value > 0.0


def test_why_something_happened_tells_that_a_light_vehicle_has_no_tyres():
    record = with_dangers(run(5.0, script=BRAKES, **ALL_LIGHT).record())
    found = next(each for each in explain(record, ["hard_brake"]) if "north" in each.event.units)
    assert found.without_tyres == ("north",) and "north is a light vehicle, without tyres" in found.lines
    assert found.not_recorded == () and not any("limit" in line for line in found.lines)


# -- the same bits ---------------------------------------------------------------------------------


def test_side_by_side_they_are_as_alone():
    each = [loaded(4.0, **some) for some in (MIXED, ALL_LIGHT, {})]
    together = simulation(*map(job.prepare, each))
    as_fast_as_possible(together)
    for number, one in enumerate(each):
        alone = simulation(job.prepare(one))
        as_fast_as_possible(alone)
        assert alone.cases[0].state_hash == together.cases[number].state_hash
        np.testing.assert_array_equal(alone.record().values, together.record(number).values)


def test_a_snapshot_goes_on_with_the_same_bits():
    world = build([job.prepare(loaded(**MIXED))])
    for _ in range(100):
        tick(world)
    kept = snapshot(world)
    ends = []
    for _ in range(2):
        for _ in range(100):
            tick(world)
        ends.append(world.arena.tobytes())
        restore(world, kept)
    assert ends[0] == ends[1] and (world.vehicles.state[V_X, world.vehicles.light] > 1.0).any()


# -- what is refused, and what fails ---------------------------------------------------------------


@pytest.mark.parametrize("path", ["vehicles.straight.dynamics", "traffic.dynamics"])
def test_other_dynamics_are_refused(path):
    with pytest.raises(ScenarioError) as caught:
        loaded(**{path: "medium"})
    (problem,) = caught.value.problems
    assert problem.where.endswith(path) and "full" in str(problem) and "light" in str(problem)


def test_an_application_that_commands_what_they_have_not_is_refused(monkeypatch):
    acc = registry.find("application", "acc").module
    monkeypatch.setattr(acc, "COMMANDS", ENGINE_TORQUE)
    with pytest.raises(ScenarioError, match="is light, and 'acc' commands its engine_torque") as caught:
        job.prepare(loaded(**ALL_LIGHT))
    assert "write vehicles.straight.dynamics: full" in str(caught.value)


def test_a_state_that_is_none_is_named():
    made = simulation(job.prepare(loaded(**ALL_LIGHT)))
    made.advance(10)
    made.world.vehicles.parameter[TAU_STEER, 2] = np.nan
    as_fast_as_possible(made)
    assert made.cases[0].status == "failed" and made.cases[0].error == "steering of north is not finite any more at 0.220 s"
