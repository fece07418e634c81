"""Drives in closed form: records of vehicles whose accelerations are given, integrated exactly over each sample."""

import numpy as np

from studio.execution.record import Body, Record
from studio.world.channel import CHANNELS

NAMES = [channel.name for channel in CHANNELS]
CAR = Body(length=4.5, width=1.8, front=2.25, mass=1500.0, radius=0.3)


def record(time, vehicles=("a", "b"), bodies=None, **channels):
    """A record with these channels, float64[vehicle, n] each; the others are zero, and nobody is ahead unless it is said."""
    values = np.zeros((len(NAMES), len(vehicles), len(time)))
    values[NAMES.index("gap")], values[NAMES.index("ahead")], values[NAMES.index("minded")] = np.nan, -1.0, -1.0
    for name, value in channels.items():
        values[NAMES.index(name)] = value
    bodies = bodies or dict.fromkeys(vehicles, CAR)
    return Record(np.asarray(time), values, tuple(vehicles), (), bodies=bodies, called=dict(enumerate(vehicles)))


def braking(time, speed, since, deceleration, least):
    """Way [m], speed [m/s] and acceleration [m/s²] of a car that brakes from a time on down to a speed."""
    lasts = np.clip(time - since, 0.0, (speed - least) / deceleration)
    now = speed - deceleration * lasts
    way = speed * np.minimum(time, since) + speed * lasts - 0.5 * deceleration * lasts**2
    way += least * np.maximum(time - since - (speed - least) / deceleration, 0.0)
    return way, now, np.where((time >= since) & (now > least), -deceleration, 0.0)


def behind(time, gap, leader, follower):
    """A record of two cars, b behind a: way, speed and acceleration of each, and the gap [m] at the start."""
    (x_l, v_l, a_l), (x_f, v_f, a_f) = leader, follower
    nobody = np.full(len(time), np.nan)
    x, ahead = np.array([gap + CAR.length + x_l, x_f]), np.array([nobody, np.zeros(len(time))])
    return record(
        time, x=x, gap=np.array([nobody, gap + x_l - x_f]), speed=np.array([v_l, v_f]), ahead_speed=np.array([nobody, v_l]),
        acceleration=np.array([a_l, a_f]), ahead=ahead, minded=ahead,
    )  # fmt: skip
