"""Kinds of sensors against closed forms: tracks, receivers, markings, maps, lights; presets; and nothing of others without a sensor."""

from math import hypot, pi, sqrt

import numpy as np
import pytest
import yaml
from pydantic import ValidationError

from studio import job
from studio.kind import registry
from studio.kind.number import numbers
from studio.model import satellite
from studio.model.random import normal
from studio.road.drawn.motorway import motorway
from studio.road.network.signals import GREEN, RED, RED_AMBER
from studio.scenario.schema import Vehicle
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import A_X, DELTA, PSI, V_X, YAW_RATE, X, Y
from studio.workshop.stage import CARS, SCENARIO, stage, vehicle
from studio.world.build import build
from studio.world.table.mind import OFFSET, STATION
from studio.world.table.unit import FAILS, OWN_SPEED, OWN_STEERING
from studio.world.tick import gather, sense, tick
from tests.conftest import ROOT

TICK = 0.02
SENSORS = sorted(registry.known("sensor"))
EXACT = {
    name: {each: 0.0 for each in registry.find("sensor", name).module.Settings.model_fields if "noise" in each or "growth" in each}
    for name in SENSORS
}


def one(kind, ticks=1, **settings):
    """A stage after some ticks with one sensor on `own`, and the sensor."""
    run = stage(vehicles={"own": {"sensors": {"mine": {"kind": kind} | settings}}})
    for _ in range(ticks):
        tick(run.world)
    (each,) = run.world.units.mounted
    return run.world, each


def targets(each, i=0):
    """What a sensor gives, as Readings."""
    reading = each.kind.module.Reading
    size = len(reading._fields)
    return [reading(*each.out[i, 1 + k * size : 1 + (k + 1) * size].tolist()) for k in range(int(each.out[i, 0]))]


# -- tracks --------------------------------------------------------------------------------------------


def test_targets_come_by_distance_with_tracks_of_their_own():
    """Numbers in the order in which they were seen first, the nearest first; after n looks the existence is 1 - 0.5ⁿ."""
    _, each = one("object_sensor", ticks=3, opening_angle=2 * pi, range=100, **EXACT["object_sensor"])
    found = targets(each)
    assert len(found) == 4 and [target.range for target in found] == sorted(target.range for target in found)  # one is hidden
    assert [target.track for target in found] == [1.0, 2.0, 3.0, 4.0]
    assert {target.existence for target in found} == {1.0 - 0.5**3} and {round(target.lasted, 9) for target in found} == {0.04}


def test_a_track_keeps_its_number_while_it_is_missed_and_ends_when_it_is_forgotten():
    """Hidden for two looks: the same number with less existence; for ten: another one."""
    world, each = one("object_sensor", ticks=6, opening_angle=0.2, **EXACT["object_sensor"])
    number = targets(each)[0].track
    place = world.column("ahead")
    for gone, same in ((2, True), (10, False)):
        x = world.vehicles.state[X, place]
        world.vehicles.state[X, place] = -9000.0
        for _ in range(gone):
            look(world)
        assert number not in [target.track for target in targets(each)]
        world.vehicles.state[X, place] = x
        look(world)
        assert (targets(each)[0].track == number) == same


def look(world):
    """One look of all sensors, while nobody moves."""
    gather(world)
    sense(world)
    world.clock.k += 1


def test_a_share_of_the_targets_is_missed():
    """0.3 of the looks at one car, within four standard errors of 2000."""
    world, each = one("object_sensor", opening_angle=0.2, missed=0.3)
    seen = []
    for _ in range(2000):
        look(world)
        seen.append(any(target.range < 40.0 for target in targets(each)))
    assert np.mean(seen) == pytest.approx(0.7, abs=4.0 * sqrt(0.3 * 0.7 / 2000))


def prepared(folder, names, sensor, seed=1):
    """The setting of a stage whose file names the vehicles in an order."""
    (folder / "motorway.xodr").write_text(motorway(), encoding="utf-8")
    vehicles = {name: vehicle(*CARS[name]) for name in names}
    vehicles["own"] |= {"sensors": {"mine": sensor}}
    path = folder / "stage.yaml"
    path.write_text(yaml.safe_dump(SCENARIO | {"seed": seed, "vehicles": vehicles}, sort_keys=False), encoding="utf-8")
    return job.prepare(job.load(path))


def test_a_file_in_another_order_and_a_batch_give_the_same(tmp_path):
    """Three worlds at once, and the cars in reverse: the targets of `own` to the last bit; another seed gives others."""
    sensor = {"kind": "object_sensor", "opening_angle": 3.0, "missed": 0.2, "delay": 0.05, "delay_variation": 0.02, "drop_out": 0.1}
    setting, other = prepared(tmp_path, list(CARS), sensor), prepared(tmp_path, list(CARS), sensor, seed=2)
    turned = prepared(tmp_path, list(reversed(CARS)), sensor)
    assert turned.names == tuple(reversed(setting.names))
    worlds = [build([setting]), build([turned]), build([other, setting, other])]
    for world in worlds:
        for _ in range(40):
            tick(world)
    alone, reverse, batch = (world.units.mounted[0].out for world in worlds)
    assert alone.any() and np.array_equal(alone[0], reverse[0]) and np.array_equal(alone[0], batch[1])
    assert np.array_equal(batch[0], batch[2]) and not np.array_equal(batch[0], batch[1])
    assert worlds[0].digest(0) == worlds[2].digest(1)


# -- blind spot, region camera -------------------------------------------------------------------------


def test_the_blind_spot_tells_place_speed_and_length():
    """`beside` is 12 m ahead on the lane to the right: its middle from the own front bumper, its length, its speed."""
    world, each = one("blind_spot", yaw=-1.0, left=-0.8, **EXACT["blind_spot"])
    state, parameter, own, other = world.vehicles.state, world.vehicles.parameter, world.column("own"), world.column("beside")
    look(world)
    found = targets(each)
    length = parameter[LENGTH, other]
    ahead = state[X, other] - state[X, own] + parameter[FRONT, other] - length / 2.0 - parameter[FRONT, own]
    match = min(found, key=lambda target: abs(target.ahead - ahead))
    assert match.ahead == pytest.approx(ahead, abs=1e-3) and match.left == pytest.approx(state[Y, other] - state[Y, own], abs=1e-3)
    assert match.length == pytest.approx(length) and match.rate == pytest.approx(state[V_X, other] - state[V_X, own], abs=1e-3)


def test_the_region_camera_tells_where_everybody_is():
    """On a station in the middle, without noise: all cars within reach, in the coordinates of the map, also those behind others."""
    station = {
        "position": {"x": -2328.0, "y": -1100.0},
        "sensors": {"camera": {"kind": "region_camera", "range": 60} | EXACT["region_camera"]},
    }
    run = stage(stations={"post": station})
    tick(run.world)
    look(run.world)
    (each,) = run.world.units.mounted
    state, parameter = run.world.vehicles.state, run.world.vehicles.parameter
    ahead = parameter[FRONT] - parameter[LENGTH] / 2.0
    middles = {(round(float(x), 6), round(float(y), 6)) for x, y in zip(state[X] + ahead * np.cos(state[PSI]), state[Y], strict=True)}
    found = targets(each)
    assert len(found) == sum(hypot(x + 2328.0, y + 1100.0) < 58.0 for x, y in middles) >= 4
    for target in found:
        near = min(hypot(target.x - x, target.y - y) for x, y in middles)
        assert near < 1e-3 and target.speed == pytest.approx(25.0, abs=0.2) and target.heading == pytest.approx(0.0, abs=1e-3)


# -- what a car knows of itself ------------------------------------------------------------------------


def test_the_receiver_wanders_like_the_process_says():
    """Slow error 1.5 m, 60 s, white 0.3 m, 100 000 samples: changes over 1, 10, 60, 300 s, and two receivers, within 3 %."""
    for dt, expected in ((1.0, 0.504), (10.0, 0.933), (60.0, 1.739), (300.0, 2.156)):
        phi, n = satellite.kept(dt, 60.0), 100_000
        z = np.array([normal(1, 0, 50, i) for i in range(n)])
        w = np.array([normal(1, 0, 51, i) for i in range(n)])
        white = np.array([normal(1, 0, 52, i) - normal(1, 0, 53, i) for i in range(n)])
        change = 1.5 * (satellite.drift.py_func(z, phi, w) - z) + 0.3 * white
        assert np.sqrt(np.mean(change**2)) == pytest.approx(expected, rel=0.03)
    assert sqrt(2.0) * sqrt(1.5**2 + 0.3**2) == pytest.approx(2.163, abs=5e-4)


def test_receivers_differ_as_their_errors_say():
    """Two receivers on each of 6 cars, 20 seeds: 2.163 m apart per axis, within four standard errors of 240."""
    differences = []
    receivers = {name: {"kind": "satellite_receiver"} for name in ("one", "other")}
    for seed in range(20):
        run = stage(vehicles={name: {"sensors": receivers} for name in CARS}, seed=seed)
        tick(run.world)
        (each,) = run.world.units.mounted
        differences.append((each.out[::2, 1:3] - each.out[1::2, 1:3]).T)
    found = np.array(differences)
    assert np.sqrt(np.mean(found**2)) == pytest.approx(2.163, rel=4.0 / sqrt(2.0 * found.size))


def test_presets_of_receivers_are_as_good_as_they_say():
    """Standard deviations of the position each way: 1.53, 0.73, 0.018 m."""
    module = registry.find("sensor", "satellite_receiver").module
    given = {name: module.Settings.model_validate(each.values) for name, each in module.PRESETS.items()}
    spread = {name: hypot(each.drift, each.noise) for name, each in given.items()}
    assert {name: round(each, 3) for name, each in spread.items()} == {"gnss": 1.53, "dgnss": 0.728, "rtk": 0.018}


def test_odometry_follows_the_way_and_errs_by_its_scale():
    """Without errors the way driven; with an error of the scale all of it is longer or shorter by one factor."""
    world, each = one("odometry", scale_error=0.0, yaw_offset=0.0, yaw_noise=0.0)
    own = world.column("own")
    begun = float(stage().world.vehicles.state[X, own])
    for _ in range(100):
        tick(world)
    look(world)
    (exact,) = targets(each)
    assert exact.distance == pytest.approx(world.vehicles.state[X, own] - begun, abs=0.1)
    assert hypot(exact.x, exact.y) == pytest.approx(exact.distance, abs=1e-3)
    world, each = one("odometry", ticks=101, scale_error=0.05, yaw_offset=0.0, yaw_noise=0.0)
    look(world)
    (wrong,) = targets(each)
    factor = wrong.distance / exact.distance
    assert 1e-4 < abs(factor - 1.0) < 0.2 and wrong.x / exact.x == pytest.approx(factor, rel=1e-6)


def test_the_state_has_noise_around_the_truth():
    world, each = one("vehicle_state", speed_noise=0.1, acceleration_noise=0.2, yaw_rate_noise=0.01, steering_noise=0.02)
    own, errors = world.column("own"), []
    for _ in range(2000):
        look(world)
        (found,) = targets(each)
        errors.append((found.speed - world.vehicles.state[V_X, own], found.yaw_rate - world.vehicles.state[YAW_RATE, own]))
    np.testing.assert_allclose(np.std(errors, axis=0), [0.1, 0.01], rtol=4.0 / sqrt(4000))


def test_the_bus_has_noise_where_it_is_asked_for():
    """Of 2000 ticks the deviation of each signal, within four standard errors; without any the truth; sensors look from the true motion."""
    noise = {"speed_noise": 0.1, "acceleration_noise": 0.2, "yaw_rate_noise": 0.01, "steering_noise": 0.02}
    radar = {"front": {"kind": "front_radar"} | EXACT["front_radar"]}
    run = stage(vehicles={"own": {"bus": noise, "sensors": radar}, "behind": {"sensors": radar}})
    tick(run.world)
    rows, state = slice(OWN_SPEED, OWN_STEERING + 1), run.world.vehicles.state
    own, other, errors = run.world.column("own"), run.world.column("behind"), []
    (each,) = run.world.units.mounted
    for _ in range(2000):
        look(run.world)
        now = run.world.units.now[rows]
        errors.append(now[:, own] - state[[V_X, A_X, YAW_RATE, DELTA], own])
        assert np.array_equal(now[:, other], state[[V_X, A_X, YAW_RATE, DELTA], other])
        assert each.out[1, 2] == pytest.approx(state[V_X, run.world.column("ahead")] - state[V_X, own], abs=1e-3)
    np.testing.assert_allclose(np.std(errors, axis=0), [0.1, 0.2, 0.01, 0.02], rtol=4.0 / sqrt(4000))


# -- road ----------------------------------------------------------------------------------------------


def test_markings_on_both_sides_of_the_car():
    """Lanes of 3.75 m: both distances together are that; the car stands where its offset says."""
    world, each = one("lane_markings", ticks=20, **EXACT["lane_markings"])
    world.vehicles.mind[OFFSET, world.column("own")] = 0.3
    sense(world)
    (found,) = targets(each)
    assert found.left == pytest.approx(3.75 / 2 - 0.3) and found.right == pytest.approx(3.75 / 2 + 0.3)
    assert found.look_ahead == 60.0 and abs(found.curvature) < 1e-4 and abs(found.heading) < 0.01


def test_the_map_knows_the_lanes_and_is_as_wrong_as_the_position():
    """`own` is on the middle of three lanes; 4 m to the left the map takes it to be on the left one, 9 m to the right on the right one."""
    gps = {"drift": 0.0, "noise": 0.0}
    run = stage(vehicles={"own": {"sensors": {"mine": {"kind": "digital_map"}}, "gps": gps}})
    world = run.world
    tick(world)
    (each,) = world.units.mounted
    assert targets(each)[0][:3] == (1.0, 1.0, 3.75) and targets(each)[0].limit == pytest.approx(36.11, abs=0.01)
    assert targets(each)[0].junction == 1e6
    own = world.column("own")
    assert targets(each)[0].heading == pytest.approx(world.vehicles.state[PSI, own], abs=1e-3) and targets(each)[0].sigma == 0.0
    for aside, lanes in ((4.0, (0.0, 2.0)), (-9.0, (2.0, 0.0)), (1.5, (1.0, 1.0))):
        world.vehicles.state[Y, own] += aside
        world.units.satellite[:] = 0.0
        world.vehicles.mind[OFFSET, own] = aside
        gather(world)
        sense(world)
        assert targets(each)[0][:2] == lanes
        world.vehicles.state[Y, own] -= aside


def test_the_map_knows_how_good_its_position_is():
    """Under an open sky: the slow error and the noise together, 0.7 and 0.24 m: 0.74 m."""
    run = stage(vehicles={"own": {"sensors": {"mine": {"kind": "digital_map"}}, "gps": {"drift": 0.7, "noise": 0.24}}})
    for _ in range(60):
        tick(run.world)
    assert targets(run.world.units.mounted[0])[0].sigma == pytest.approx(0.74)


@pytest.fixture(scope="module")
def town():
    """`straight` on the grid of streets, on its way to lights, with sensors that see them, and a map."""
    sensors = {"light": {"kind": "traffic_light", "reach": 300.0} | EXACT["traffic_light"], "map": {"kind": "digital_map"}}
    changes = {"traffic.count": 0, "applications": {}, "vehicles.straight.gps": {"drift": 0.0, "noise": 0.0}}
    return job.prepare(job.load(ROOT / "scenarios" / "urban_grid.yaml", changes | {"vehicles.straight.sensors": sensors}))


def test_the_light_and_the_junction_ahead(town):
    """At every tick the next stop line of the path and what its light shows; the junction behind it within 3 m, unless one comes before."""
    world, shown, before = build([town]), set(), []
    own, path = world.column("straight"), town.cars[0].path
    lamps = {kind.kind.name: kind for kind in world.units.mounted}
    for _ in range(2500):
        tick(world)
        bumper = world.vehicles.mind[STATION, own] + world.vehicles.parameter[FRONT, own]
        ahead = [(s - bumper, link) for s, link in path.stop_lines if 0.0 < s - bumper <= 300.0]
        found = targets(lamps["traffic_light"])
        assert len(found) == (1 if ahead else 0)
        if found:
            (light,), (distance, link) = found, ahead[0]
            state = int(world.roads.shown[link])
            shown.add(state)
            assert light.distance == pytest.approx(distance, abs=0.5) and light.red + light.green + light.amber >= 1.0
            assert (light.green == 1.0) == (state == GREEN) and (light.red == 1.0) == (state in (RED, RED_AMBER))
            (told,) = targets(lamps["digital_map"])
            before.append(distance + world.vehicles.parameter[FRONT, own] - told.junction)
    assert len(shown) >= 2 and min(before) > -3.0 and sum(abs(each) < 3.0 for each in before) > 50


def test_a_misread_light_is_dark(town):
    changed = town.scenario.vehicles["straight"].sensors["light"].model_copy(update={"misread": 1.0})
    town.scenario.vehicles["straight"].sensors["light"] = changed
    world = build([town])
    tick(world)
    assert targets(world.units.mounted[0])[0][1:] == (0.0, 0.0, 0.0)


# -- presets -------------------------------------------------------------------------------------------

PRESETS = [(name, preset) for name in SENSORS for preset in getattr(registry.find("sensor", name).module, "PRESETS", {})]


@pytest.mark.parametrize(("kind", "preset"), PRESETS)
def test_a_preset_gives_what_is_not_given(kind, preset):
    """Its values, but for one that stands in the scenario; the document says which preset it is, and the world gets numbers only."""
    values = registry.find("sensor", kind).module.PRESETS[preset].values | {"delay": 0.123}
    given = Vehicle.model_validate(CAR | {"sensors": {"mine": {"kind": kind, "preset": preset, "delay": 0.123}}}).sensors["mine"]
    assert given.preset == preset and given.delay == 0.123
    assert {name: getattr(given, name) for name in values} == values
    assert len(numbers(given)) == len(numbers(registry.find("sensor", kind).module.Settings()))
    assert given.model_dump() == Vehicle.model_validate(CAR | {"sensors": {"mine": given.model_dump()}}).sensors["mine"].model_dump()


def test_a_preset_that_there_is_not_is_refused():
    with pytest.raises(ValidationError, match=r"sensors.mine.front_radar.preset(.|\n)*long_range_radar"):
        Vehicle.model_validate(CAR | {"sensors": {"mine": {"kind": "front_radar", "preset": "lidar"}}})


CAR = {"route": "along", "position": {"along": 0.0}, "speed": 20.0}


# -- nothing of others ---------------------------------------------------------------------------------


def test_without_sensors_and_radio_nothing_about_others_is_known(own_kinds, tmp_path):
    """An application that sees everything the contract has, from sensors that fail and a radio that reaches nobody, and drives by itself.

    Two worlds that differ in the others alone (their places, speeds, seeds of their errors) show it the same to the last bit, for 10 s.
    """
    (tmp_path / "witness.py").write_text(WITNESS, encoding="utf-8")
    own_kinds(tmp_path)
    seen = []
    for others in (0.0, 1.0):
        run = stage(vehicles=crowd(others), applications={"witness": {"application": "witness", "units": ["own"]}}, radio={"range": 1.0})
        for each in run.world.units.mounted:
            each.health[FAILS] = 1.0
        module = run.world.hosted[0].application.module
        module.SEEN.clear()
        run.advance(500)
        seen.append(list(module.SEEN))
        gap = run.record().trace("own.gap")
        assert np.isfinite(gap).all()
    assert len(seen[0]) == 500 and seen[0] == seen[1]


def crowd(others):
    """`own` with every kind of sensor; the others stand and drive differently in the one case and in the other."""
    sensors = {name: {"kind": name} for name in ("front_radar", "object_sensor", "blind_spot")}
    cars = {"own": {"sensors": sensors}}
    for i, name in enumerate(each for each in CARS if each != "own"):
        lane, along = CARS[name]
        place = {"road": "motorway", "lane": lane, "offset": along + others * (4.0 + i)}
        cars[name] = {"position": place, "speed": 25.0 - others * i, "gps": {"drift": 1.0 + others}}
    return cars


WITNESS = '''"""Keeps all that it is shown, and drives straight on by itself. Source: made up."""

from typing import Annotated, NamedTuple

from studio.application.contract import ACCELERATION, STEERING, Clock, Command, Inbox, Own, Targets, accelerate, also, steer
from studio.kind.settings import Part

KIND = "application"
TITLE = "Witness"
COMMANDS = ACCELERATION | STEERING
SEEN = []


class Parameters(Part):
    """Nothing."""


class Memory(NamedTuple):
    """Nothing."""


class Sees(NamedTuple):
    """Everything that there is."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    objects: Annotated[Targets, "object_sensor", 8]
    side: Annotated[Targets, "blind_spot", 8]
    heard: Annotated[Inbox, "awareness", 8]


class Does(NamedTuple):
    """Pedals and wheel."""

    command: Command


def decide(parameters, memory, sees):
    """Slower and faster, straight on."""
    SEEN.append(repr(sees))
    return memory, Does(also(accelerate(0.5 if sees.clock.time % 4.0 < 2.0 else -0.5), steer(0.0)))
'''
