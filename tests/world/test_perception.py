"""Sensors, radio and actuators in the world."""

from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.execution.simulation import simulation
from studio.road.network import Building
from studio.vehicle.command import RING
from studio.vehicle.parameter import STEER_MAX
from studio.vehicle.state import ACTIVE, DELTA, X, Y
from studio.world.build import build
from studio.world.table.unit import H_NUMBER, H_TIME
from studio.world.tick import tick


def newest(world):
    """When the newest message of the leader to its follower was sent [s]; minus infinity while none has come."""
    post, units = world.units.posts[0], world.units
    link = post.links[units.number("follower_1"), units.number("leader")]
    return post.inbox[H_TIME, link] if post.inbox[H_NUMBER, link] >= 0 else -np.inf


def received(sample, ticks=500, buildings=None, shadow=True, **radio):
    """Send times of the newest message of the leader, tick by tick; `buildings` stand there instead of the map's."""
    period = {"messages.awareness.period": radio.pop("period")} if "period" in radio else {}
    changes = {f"radio.{name}": value for name, value in radio.items()} | period | {"traffic.count": 0, "radio.buildings": shadow}
    setting = job.prepare(job.load(sample, changes))
    if buildings is not None:
        scenery = replace(setting.network.scenery, buildings=tuple(buildings))
        setting = replace(setting, network=replace(setting.network, scenery=scenery))
    world = build([setting])
    seen = []
    for _ in range(ticks):
        tick(world)
        seen.append(newest(world))
    return np.array(seen)


def test_messages_come_after_their_delay(sample):
    """Period 0.1 s, delay 0.0596 s without variation, 300 bytes at 6 Mbit/s, no loss: each send time appears 0.06 s later, in order."""
    seen = received(sample, delay=0.0596, delay_variation=0, loss=0)
    seen[np.isinf(seen)] = -1.0
    changes = np.flatnonzero(np.diff(seen) > 0) + 1
    assert np.allclose(changes * 0.02 - seen[changes], 0.06)
    assert np.allclose(np.diff(seen[changes]), 0.1)


@pytest.mark.parametrize("loss", [0.0, 0.2, 0.5, 1.0])
def test_every_message_is_lost_or_not_once(sample, loss):
    """Of 400 messages the share that comes is 1 - loss, within four standard errors; nothing is drawn twice."""
    seen = received(sample, ticks=2000, loss=loss, delay=0.02, period=0.1)
    came = np.unique(seen[np.isfinite(seen)]).size
    assert abs(came / 400 - (1 - loss)) <= 4 * (loss * (1 - loss) / 400) ** 0.5 + 1 / 400


def test_out_of_range_nothing_comes(sample):
    assert np.isinf(received(sample, range=10.0)).all()


def house_between(sample, *, height=10.0, base=0.0):
    """A house between the leader and the car behind it as they start: their line goes through the middle of its 4 m."""
    state = build([job.prepare(job.load(sample, {"traffic.count": 0}))]).vehicles.state
    (x, y), (a, b) = state[[X, Y], 0], state[[X, Y], 1]
    along = np.array([x - a, y - b]) / np.hypot(x - a, y - b)
    aside, middle = np.array([-along[1], along[0]]), np.array([x + a, y + b]) / 2.0
    corners = [middle + u * along + v * aside for u, v in ((-2, -30), (2, -30), (2, 30), (-2, 30))]
    return Building(np.array(corners).T, (), height, base, "")


def test_a_house_between_two_cars_takes_their_range(sample):
    """14.8 m through two walls and 4 m, 19.6 dB, are felt as 141 m where power falls with the square: in range or not."""
    house = [house_between(sample)]
    felt = 14.8 * 10 ** ((2 * 9 + 4 * 0.4) / 20)
    for reach, comes in ((felt - 3.0, False), (felt + 3.0, True)):
        seen = received(sample, ticks=6, buildings=house, range=reach, loss=0, delay=0, delay_variation=0)
        assert np.isfinite(seen).any() == comes
    assert np.isfinite(received(sample, ticks=6, buildings=house, range=20.0, loss=0, delay=0, delay_variation=0, shadow=False)).any()


def test_without_a_house_between_nothing_changes(sample):
    """No buildings, or one that hangs above: bit for bit the same messages."""
    free = received(sample, ticks=60, buildings=[], loss=0.3)
    assert np.array_equal(free, received(sample, ticks=60, buildings=[house_between(sample, base=3.0)], loss=0.3))
    hidden = received(sample, ticks=60, buildings=[house_between(sample)], loss=0.3, loss_per_metre=0.005)
    assert not np.array_equal(hidden, received(sample, ticks=60, buildings=[], loss=0.3, loss_per_metre=0.005))


def test_a_sender_that_left_is_silent(sample):
    """No old message comes to life again under a new number."""
    world = build([job.prepare(job.load(sample, {"radio.loss": 0.5, "traffic.count": 0}))])
    for _ in range(100):
        tick(world)
    world.vehicles.state[ACTIVE, 0] = 0.0  # the leader leaves
    for _ in range(10):
        tick(world)
    last = newest(world)
    for _ in range(40 * RING):
        tick(world)
    assert newest(world) == last


def test_the_sensor_sees_the_car_ahead(sample):
    """Range to the predecessor's rear, within its noise; nothing ahead, nothing measured."""
    run = simulation(job.prepare(job.load(sample, {"traffic.count": 0})))
    for _ in range(10):
        run.advance()
    (radars,), state = run.world.units.mounted, run.world.vehicles.state
    gap = np.hypot(*(state[:2, 0] - state[:2, 1])) - 4.508
    assert radars.out[1, 0] == 1 and radars.out[1, 1] == pytest.approx(gap, abs=0.5)
    assert not radars.out[0].any()


def test_an_application_cannot_turn_the_wheels_too_far(sample):
    """A request of 5 rad ends at the steering's stop."""
    run = simulation(job.prepare(job.load(sample, {"traffic.count": 0})))
    (hosted,) = run.world.hosted

    def turn(time, tick, fixed, now, commands, unit, column, *rest):
        commands[1, column] = 5.0
        return 0

    hosted.run = turn
    for _ in range(250):
        run.advance()
    assert run.world.vehicles.state[DELTA, 1] <= run.world.vehicles.parameter[STEER_MAX, 1]
    assert np.isfinite(run.world.vehicles.state[X]).all()
