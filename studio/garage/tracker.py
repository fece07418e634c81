"""A car along its way: where it takes itself to be, which way its wheels point, how fast it goes.

Where: dead reckoning of the rear axle's middle, x' = v cos(psi), y' = v sin(psi), psi' = r, and what the garage's cameras have seen,
brought to now by the same motion: a share GAIN of the difference is taken over (the first ones 1/n), a fix older than LATEST counts for
nothing.

Steering: e [m] to the left of the way, theta [rad] turned to its left; g = 1 forward, -1 backward; sigma the distance driven. For the
rear axle de/dsigma = g theta and dtheta/dsigma = g (kappa - kappa_w), so that kappa = kappa_w - 2 w g theta - w² e gives e'' + 2 w e' +
w² e = 0: both errors fade over 1/w metres, forward and backward alike. Road wheels: atan(L kappa).

Speed: v² = v_next² + 2 DECELERATION ds backward from every stop, at most the speed of the aisle or of a turn.
"""

from functools import cache
from math import atan, cos, sin, sqrt

import numpy as np

from studio.garage import way as ways
from studio.garage.plan import Plan, Pose
from studio.garage.reeds_shepp import wrapped
from studio.garage.way import Car, Way, error

GAIN, GAIN_HEADING = 0.06, 0.04  # [1] of a fix, against 0.15 m and 0.03 rad of noise every 0.07 s
LATEST = 0.6  # [s]
OMEGA = 0.9  # [1/m]
TURNING = 0.7  # [m/s] in turns and backward
DECELERATION = 0.5  # [m/s²]
TIGHT = 0.15  # [1/m] what is bent more is a turn of a maneuver
PREVIEW = 0.4  # [s] half of the time in which the wheels turn for a maneuver, at 0.6 rad/s
THERE = 0.04  # [m] from the end of a stretch
LIMIT = 0.62  # [rad] of the road wheels
ROOM = 0.8  # [m] beside the car in which a person counts as on its way


def reckoned(at: Pose, v: float, yaw_rate: float, dt: float) -> Pose:
    """A pose [m], [rad] so much time [s] later."""
    middle = at.heading + 0.5 * yaw_rate * dt
    return Pose(at.x + v * dt * cos(middle), at.y + v * dt * sin(middle), at.heading + yaw_rate * dt)


def fixed(at: Pose, fix: Pose, middle: float, fixes: float) -> Pose:
    """A pose of the rear axle with a fix of the outline's middle [m], brought to now, the n-th."""
    gain, turn = max(1.0 / (fixes + 1.0), GAIN), max(1.0 / (fixes + 1.0), GAIN_HEADING)
    heading = at.heading + turn * wrapped(fix.heading - at.heading) if fixes > 0.0 else fix.heading
    x, y = fix.x - middle * cos(heading), fix.y - middle * sin(heading)
    return Pose(at.x + gain * (x - at.x), at.y + gain * (y - at.y), heading)


@cache
def profile(deck: Plan, number: int, car: Car, is_back: bool, speed: float) -> tuple[Way, np.ndarray, np.ndarray]:
    """A way, the speed [m/s] at each of its points, and the last point of the stretch in one direction that each belongs to."""
    way = ways.out_of(deck, number, car) if is_back else ways.into(deck, number, car)
    ends = np.flatnonzero(np.append(np.diff(way.direction) != 0.0, True))
    last = ends[np.searchsorted(ends, np.arange(way.x.size))]
    v = np.where((way.direction < 0.0) | (np.abs(way.bend) > TIGHT), TURNING, speed)
    v[ends] = 0.0
    for k in range(way.x.size - 2, -1, -1):
        if k not in ends:
            v[k] = min(v[k], sqrt(v[k + 1] ** 2 + 2.0 * DECELERATION * (way.driven[k + 1] - way.driven[k])))
    if is_back:
        v[-1] = v[-2] = speed  # it is the driver's there, rolling
        v = np.maximum(v, np.where(way.driven > way.driven[-1] - 10.0, speed, 0.0))
    return way, v, last


def wheels(way: Way, k: int, at: Pose, v: float, wheelbase: float) -> float:
    """Road wheel angle [rad]."""
    ahead = min(k + round(PREVIEW * abs(v) / ways.STEP), way.x.size - 1)
    ahead = ahead if way.direction[ahead] == way.direction[k] else k
    e, theta = error(way, k, *at)
    kappa = way.bend[ahead] - 2.0 * OMEGA * way.direction[k] * theta - OMEGA * OMEGA * e
    return min(max(atan(wheelbase * kappa), -LIMIT), LIMIT)


def left_of(way: Way, k: int, last: int, at: Pose) -> float:
    """Distance [m] to the end of a stretch, negative beyond it."""
    psi, g = way.heading[last], way.direction[k]
    along = g * ((way.x[last] - at.x) * cos(psi) + (way.y[last] - at.y) * sin(psi))
    far = float(way.driven[last] - way.driven[k])
    return far if far > 1.0 else float(along)


def permitted(way: Way, k: int, car: Car, permit: float) -> float:
    """Distance [m] that a car may drive on until its front is at a station; backward it has what it needs."""
    if way.direction[k] < 0.0:
        return 1e3
    beyond = np.flatnonzero((way.station[k:] + car.wheelbase + car.front > permit) & (way.direction[k:] > 0.0))
    return float(way.driven[k + beyond[0]] - way.driven[k]) if beyond.size else 1e3


def before_persons(way: Way, k: int, last: int, car: Car, persons: list[tuple[float, float]], margin: float) -> float:
    """Distance [m] that a car may drive on until it is `margin` [m] before somebody who is on its way, within 10 m."""
    if not persons:
        return 1e3
    ahead = np.arange(k, min(k + round(10.0 / ways.STEP), last) + 1, 4)
    reach = car.wheelbase + car.front if way.direction[k] > 0.0 else car.rear
    psi = way.heading[ahead]
    shift = way.direction[k] * reach
    x, y = way.x[ahead] + shift * np.cos(psi), way.y[ahead] + shift * np.sin(psi)
    near = np.flatnonzero([any(np.hypot(a - px, b - py) < car.width / 2.0 + ROOM for px, py in persons) for a, b in zip(x, y, strict=True)])
    return float(way.driven[ahead[near[0]]] - way.driven[k]) - margin if near.size else 1e3


def allowed(v: float, left: float) -> float:
    """Speed [m/s] with which a car may still come to a stand within a distance [m]."""
    return min(v, sqrt(2.0 * DECELERATION * max(left - 0.5 * THERE, 0.0)))
