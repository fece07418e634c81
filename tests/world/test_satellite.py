"""Satellite positions: the process in closed form, in the world, and to whom they are told."""

from math import exp, sqrt

import numpy as np
import pytest

from studio import job
from studio.application.contract import Own
from studio.bound import Chain, Link
from studio.model import satellite
from studio.road.network import Building, shadow
from studio.vehicle.state import ACTIVE, VEHICLE, X, Y
from studio.world.build import build
from studio.world.channel import CHANNELS, sampler
from studio.world.passes import satellite as receiver
from studio.world.table.unit import (
    CANYON,
    DRIFT_SIGMA,
    DRIFT_TIME,
    GPS_EAST,
    GPS_NORTH,
    GPS_SET,
    GPS_SIGMA,
    OWN_FIRST,
    S_NUMBER,
    S_TIME,
    S_X,
    S_Y,
    SATELLITE,
    SENT,
)  # fmt: skip
from studio.world.tick import meet, tick

TICK = 0.02
COURT = Building(np.array([[-50.0, 50.0, 50.0, -50.0], [-50.0, -50.0, 50.0, 50.0]]), (), 10.0, 0.0, "")


def wandered(ticks, *, n=2000, seeds=(1,), buildings=(), **values):
    """Errors [tick, axis, car] of cars that stand at the origin, n in each world."""
    cars = n * len(seeds)
    state, found, gps = np.zeros((len(VEHICLE), cars)), np.zeros((len(SATELLITE), cars)), np.zeros((len(GPS_SET), cars))
    state[ACTIVE] = 1.0
    gps[:] = np.array([{"drift": 2.0, "correlation_time": 1.0, "noise": 0.0, "canyon_factor": 5.0, **values}[row.name] for row in GPS_SET])[
        :, None
    ]
    hidden = shadow.shadow(buildings)
    worlds, entity = np.repeat(np.arange(len(seeds)), n), np.tile(np.arange(n), len(seeds))
    errors = []
    for k in range(ticks):
        receiver.fix(k, TICK, state, gps, worlds, entity, np.array(seeds, dtype=np.uint64), np.zeros(len(seeds), int), hidden, found)
        errors.append(found[[GPS_EAST, GPS_NORTH]].copy())
    return np.array(errors)


def test_the_steps_of_a_minute_long_process():
    """Correlation time 60 s, step 0.1 s: phi 0.99833, and the draw counts 0.0577."""
    phi = satellite.kept(0.1, 60.0)
    assert phi == pytest.approx(0.99833, abs=5e-6)
    assert satellite.drift(0.0, phi, 1.0) == pytest.approx(0.0577, abs=5e-5)


def test_the_slow_error_keeps_its_variance():
    """From the first tick on, within four standard errors of 4000 samples."""
    errors = wandered(101)
    for k in (0, 1, 50, 100):
        assert errors[k].var() == pytest.approx(4.0, rel=4.0 * sqrt(2.0 / errors[k].size))
        assert abs(errors[k].mean()) < 4.0 * 2.0 / sqrt(errors[k].size)


@pytest.mark.parametrize("tau", [0.5, 1.0, 60.0])
def test_the_slow_error_is_forgotten_exponentially(tau):
    errors = wandered(101, correlation_time=tau)
    for lag in (1, 25, 50, 100):
        rho = exp(-lag * TICK / tau)
        found = np.corrcoef(errors[0].ravel(), errors[lag].ravel())[0, 1]
        assert found == pytest.approx(rho, abs=min(4.0 * (1.0 - rho**2) / sqrt(errors[0].size) + 1e-6, 0.05))


def test_east_and_north_are_independent():
    east, north = wandered(1)[0]
    assert abs(np.corrcoef(east, north)[0, 1]) < 4.0 / sqrt(east.size)


def test_white_noise_is_white():
    errors = wandered(2, drift=0.0, noise=0.3)
    assert errors[0].std() == pytest.approx(0.3, rel=4.0 * sqrt(0.5 / errors[0].size))
    assert abs(np.corrcoef(errors[0].ravel(), errors[1].ravel())[0, 1]) < 4.0 / sqrt(errors[0].size)


def test_both_errors_add_up():
    both, slow, white = wandered(5, noise=0.3), wandered(5), wandered(5, drift=0.0, noise=0.3)
    np.testing.assert_allclose(both, slow + white, atol=1e-12)


@pytest.mark.parametrize("factor", [1.0, 5.0])
def test_without_sky_the_slow_error_is_larger_by_its_factor(factor):
    """The same draws in a house and in the open; white noise stays as it is."""
    hidden, clear = wandered(5, buildings=[COURT], canyon_factor=factor), wandered(5, canyon_factor=factor)
    np.testing.assert_allclose(hidden, factor * clear, rtol=1e-12)
    assert satellite.spread(2.0, factor, 0.5) == pytest.approx(2.0 * (1.0 + factor) / 2.0)
    white = [wandered(2, n=10, drift=0.0, noise=1.0, buildings=each) for each in ((), [COURT])]
    assert np.array_equal(*white)


def test_a_car_without_errors_knows_where_it_is():
    assert not wandered(5, n=3, drift=0.0, noise=0.0).any()


def test_a_receiver_looks_up_once_a_second():
    """At instants of its own: within any second each looks once, and no more than a few look at the same tick."""
    looks = np.array([[satellite.looks_up((k - 1) * TICK, k * TICK, unit) for k in range(1, 501)] for unit in range(200)])
    assert (looks.reshape(200, 10, 50).sum(axis=2) == 1).all()
    assert looks.sum(axis=0).max() <= 6


def test_errors_do_not_depend_on_the_batch():
    """Three worlds at once have bit for bit the errors that each has alone."""
    together = wandered(20, n=5, seeds=(3, 8, 3), noise=0.3)
    for i, seed in enumerate((3, 8, 3)):
        assert np.array_equal(together[:, :, 5 * i : 5 * i + 5], wandered(20, n=5, seeds=(seed,), noise=0.3))
    assert not np.array_equal(together[:, :, :5], together[:, :, 5:10])


# -- in the world ----------------------------------------------------------------------------------


@pytest.fixture
def world(sample):
    return build([job.prepare(job.load(sample, {"traffic.count": 3, "vehicles.leader.gps.drift": 4.0}))])


def test_messages_carry_the_measured_position(world):
    """What is sent is off by the error of its tick; the radio itself knows the antenna's place."""
    for _ in range(12):
        meet(world)
        state, units = world.vehicles.state, world.units
        (post,) = units.posts
        now = np.flatnonzero((np.abs(post.ring[S_TIME] - world.clock.time) < 1e-9) & (post.ring[S_NUMBER] >= 0))
        cars = units.vehicle[post.sender[now % post.sender.size]]
        x, y = post.ring[len(SENT)][now], post.ring[len(SENT) + 1][now]
        assert np.array_equal(post.ring[S_X][now], state[X, cars]) and np.array_equal(post.ring[S_Y][now], state[Y, cars])
        assert np.array_equal(x, (state[X] + units.satellite[GPS_EAST])[cars])
        assert np.array_equal(y, (state[Y] + units.satellite[GPS_NORTH])[cars])
        world.clock.k += 1


def test_an_application_sees_its_own_measured_position_only(world):
    tick(world)
    meet(world)
    (hosted,) = world.hosted
    rows = [OWN_FIRST + Own._fields.index(name) for name in ("gps_x", "gps_y")]
    errors = world.units.satellite[[GPS_EAST, GPS_NORTH]][:, hosted.column]
    assert np.array_equal(world.units.now[rows][:, hosted.unit], world.vehicles.state[[X, Y]][:, hosted.column] + errors)
    assert (np.abs(errors) > 0.0).all()


def test_settings_reach_their_cars(world):
    gps = world.units.gps_set
    assert gps[DRIFT_SIGMA].tolist() == [4.0, 1.5, 1.5, 1.5, 1.5, 0.0, 0.0, 0.0]
    assert (gps[GPS_SIGMA, :5] == 0.3).all() and (gps[DRIFT_TIME] == 60.0).all() and (gps[CANYON] == 5.0).all()
    tick(world)
    assert not world.units.satellite[[GPS_EAST, GPS_NORTH], 5:].any()


def test_errors_are_recorded(world):
    tick(world)
    names = [channel.name for channel in CHANNELS]
    values, times, count = np.zeros((1, len(CHANNELS), 5)), np.zeros(1), np.zeros(1, dtype=np.int64)
    Chain([Link(sampler(world, np.arange(5), count, times, values), lambda *told: pytest.fail(str(told)))])(0, 0.5)
    assert count[0] == 1 and times[0] == 0.5
    for name, row in (("gps_error_east", GPS_EAST), ("gps_error_north", GPS_NORTH)):
        assert np.array_equal(values[0, names.index(name)], world.units.satellite[row, :5])


def test_positions_do_not_touch_who_drives_by_range(sample):
    """The sample's platoon uses its radar and the others' intentions: its motion is bit for bit that of exact positions.

    Positions tell it only whether the radar sees the sender, which is left out of account here: `match` is as wide as it gets.
    """
    ends = []
    for drift in (0.0, 10.0):
        cars = {f"vehicles.{name}.gps.drift": drift for name in ("leader", "follower_1", "follower_2", "follower_3", "follower_4")}
        ran = build([job.prepare(job.load(sample, {**cars, "traffic.count": 0, "applications.platoon.parameters.match": 1000.0}))])
        for _ in range(250):
            tick(ran)
        ends.append(ran.vehicles.state.tobytes() + ran.vehicles.wheels.tobytes())
    assert ends[0] == ends[1]
