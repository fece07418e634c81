"""Front radar: the nearest car or barrier in the own driving corridor, as a radar with target selection reports it.

The corridor is the arc that the own motion predicts (studio/model/sensor.py). Range and range rate carry white noise, as in Massow &
Radusch 2018, section 2.3; the direction is exact. A cone of plastic sends nothing back.
"""

from math import atan2, sqrt
from typing import Annotated, NamedTuple

from studio.compiled import inlined, lean
from studio.kind.settings import Part, number
from studio.model import sensor
from studio.vehicle.state import ACTIVE, V_X
from studio.world.passes.collision import reach_along
from studio.world.passes.neighbour import COS, REAR_X, REAR_Y, SIN
from studio.world.table.street import BARRIER, O_HEADING, O_KIND, O_LENGTH, O_WIDTH, O_X, O_Y, OBJECT
from studio.world.view import around, draw_normal, report

KIND = "sensor"
TITLE = "Front radar with one target"
CAPACITY = 1
RANGE_NOISE, RATE_NOISE = range(2)  # draws
FIRST_LOOK = 30.0  # [m]


class Settings(Part):
    """The radar that looks ahead. A reach of 0 sees nothing."""

    range: float = number(120.0, unit="m", title="Reach", ge=0, le=300)
    opening_angle: float = number(0.7, unit="rad", title="Opening angle", description="from edge to edge", gt=0, le=3.2)
    range_noise: float = number(0.1, unit="m", title="Noise of the range", description="standard deviation", ge=0, le=10)
    rate_noise: float = number(0.05, unit="m/s", title="Noise of the range rate", description="standard deviation", ge=0, le=5)


class Reading(NamedTuple):
    """The target."""

    range: Annotated[float, "m", "front bumper to the target's rear"] = 0.0
    rate: Annotated[float, "m/s", "change of the range, negative when coming nearer"] = 0.0
    azimuth: Annotated[float, "rad", "left positive"] = 0.0


@inlined
def nearest_car(view, me, settings, kappa):
    """Column of the nearest car in view and in the own corridor, with its place; -1 when there is none.

    Near cars are looked at first: where one is seen, none that is farther can be nearer.
    """
    best, best_forward, best_left = -1, settings.range, 0.0
    for reach in (min(FIRST_LOOK, settings.range), settings.range):
        if best_forward < reach:
            break
        ahead = me.front + reach + view.longest
        bow = min(max(0.5 * kappa * reach * reach, -ahead), ahead)  # of the corridor at its end
        left, right = max(bow, 0.0) + sensor.CORRIDOR + view.longest, min(bow, 0.0) - sensor.CORRIDOR - view.longest
        for i in range(around(view, me, -view.longest, ahead, right, left)):
            other = view.found[i]
            if other == me.vehicle or view.state[ACTIVE, other] == 0.0:
                continue
            forward, aside = sensor.turned(view.places[REAR_X, other] - me.x, view.places[REAR_Y, other] - me.y, me.cosine, me.sine)
            forward -= me.front
            if forward >= best_forward or not sensor.in_corridor(forward, aside, kappa):
                continue
            if sensor.in_view(forward, aside, settings.range, 0.5 * settings.opening_angle):
                best, best_forward, best_left = other, forward, aside
    return best, best_forward, best_left


@lean
def nearest_barrier(view, me, settings, kappa, best, best_forward, best_left):
    """The same among the barriers that stand there, of which the radar sees the near edge."""
    first, table = view.first_object[me.world], view.table
    for i in range(first, first + view.object_count[me.world]):
        if view.standing[i] == 0 or table[O_KIND, i] != BARRIER:
            continue
        forward, left = sensor.turned(table[O_X, i] - me.x, table[O_Y, i] - me.y, me.cosine, me.sine)
        forward -= me.front + reach_along(table[O_HEADING, i] - me.heading, table[O_LENGTH, i], table[O_WIDTH, i])
        if forward >= best_forward or not sensor.in_corridor(forward, left, kappa):
            continue
        if sensor.in_view(forward, left, settings.range, 0.5 * settings.opening_angle):
            best, best_forward, best_left = OBJECT - i, forward, left
    return best, best_forward, best_left


@inlined
def closing_rate(view, me, other, forward, left):
    """Change of the distance [m/s] to a car, or an object at rest, seen in that direction."""
    distance = max(sqrt(forward * forward + left * left), 1e-6)
    east, north = -me.speed * me.cosine, -me.speed * me.sine
    if other >= 0:
        speed = view.state[V_X, other]
        east, north = speed * view.places[COS, other] + east, speed * view.places[SIN, other] + north
    ahead, aside = sensor.turned(east, north, me.cosine, me.sine)
    return (ahead * forward + aside * left) / distance


@inlined
def measure(view, me, settings, memory, out):
    """One sensor at one tick. A barrier that is nearer than the car takes its place."""
    if settings.range <= 0.0:
        return 0
    kappa = sensor.own_curvature(me.speed, me.yaw_rate)
    other, forward, left = nearest_car(view, me, settings, kappa)
    if view.object_count[me.world] > 0:
        other, forward, left = nearest_barrier(view, me, settings, kappa, other, forward, left)
    if other == -1:
        return 0
    seen = sqrt(forward * forward + left * left) + settings.range_noise * draw_normal(view, me, RANGE_NOISE)
    rate = closing_rate(view, me, other, forward, left) + settings.rate_noise * draw_normal(view, me, RATE_NOISE)
    report(out, me, 0, Reading(max(seen, 0.0), rate, atan2(left, forward)))
    return 1
