"""Sensors, radio and actuators in the world."""

import numpy as np
import pytest

from studio import job
from studio.application.contract import LEAVE, Command
from studio.execution.simulation import simulation
from studio.world.build import build
from studio.world.state import ACTIVE, DELTA, DETECTED, RANGE, RING, SENT, STEER_MAX, X
from studio.world.tick import tick


def received(sample, ticks=500, **radio):
    """Send times of the newest message on the first link, tick by tick."""
    changes = {f"radio.{name}": value for name, value in radio.items()} | {"traffic.count": 0}
    world = build([job.prepare(job.load(sample, changes))])
    seen = []
    for _ in range(ticks):
        tick(world)
        seen.append(world.units.inbox[SENT, 0])
    return np.array(seen)


def test_messages_come_after_their_delay(sample):
    """Period 0.1 s, delay 0.06 s without variation, no loss: each send time appears 0.06 s later, in order."""
    seen = received(sample, delay=0.06, delay_variation=0, loss=0)
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


def test_a_sender_that_left_is_silent(sample):
    """No old message comes to life again under a new number."""
    world = build([job.prepare(job.load(sample, {"radio.loss": 0.5, "traffic.count": 0}))])
    for _ in range(100):
        tick(world)
    world.vehicles.state[ACTIVE, 0] = 0.0  # the leader leaves
    for _ in range(10):
        tick(world)
    last = world.units.inbox[SENT, 0]
    for _ in range(40 * RING):
        tick(world)
    assert world.units.inbox[SENT, 0] == last


def test_the_sensor_sees_the_car_ahead(sample):
    """Range to the predecessor's rear, within its noise; nothing ahead, nothing measured."""
    run = simulation(job.prepare(job.load(sample, {"traffic.count": 0})))
    for _ in range(10):
        run.advance()
    sensors, state = run.world.units.sensors, run.world.vehicles.state
    gap = np.hypot(*(state[:2, 0] - state[:2, 1])) - 4.508
    assert sensors[DETECTED, 1] == 1 and sensors[RANGE, 1] == pytest.approx(gap, abs=0.5)
    assert sensors[DETECTED, 0] == 0 and np.isnan(sensors[RANGE, 0])


def test_an_application_cannot_turn_the_wheels_too_far(sample):
    """A request of 5 rad ends at the steering's stop."""
    run = simulation(job.prepare(job.load(sample, {"traffic.count": 0})))
    (hosted,) = run.world.hosted

    def turn(columns, parameters, memory, observed, commands):
        commands[0, columns], commands[1, columns] = Command(LEAVE, 5.0)

    hosted.run = turn
    for _ in range(250):
        run.advance()
    assert run.world.vehicles.state[DELTA, 1] <= run.world.vehicles.parameter[STEER_MAX, 1]
    assert np.isfinite(run.world.vehicles.state[X]).all()
