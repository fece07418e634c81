"""Side radar: cars beside the own one, on both sides, the nearest first.

Reach and noise as of the short range radars in the rear corners that warn of lane changes: 24 and 77 GHz, up to 80 m, 0.2 m (H. Winner
et al., Handbook of Driver Assistance Systems, 2016, ch. 17).
"""

from math import sqrt
from typing import Annotated, NamedTuple

from studio.compiled import compiled
from studio.kind.sensor import Sensor
from studio.kind.settings import number
from studio.vehicle.state import V_X
from studio.world.passes.neighbour import COS, REAR_X, REAR_Y, SIN
from studio.world.view import around, draw_normal, report

KIND = "sensor"
TITLE = "Side radar"
CAPACITY = 4


class Settings(Sensor):
    """How far it sees along the car, and to the sides."""

    reach: float = number(40.0, unit="m", title="Reach along the car", description="to the front and to the rear", ge=1, le=80)
    width: float = number(6.0, unit="m", title="Reach to the sides", ge=1, le=20)
    noise: float = number(0.2, unit="m", title="Noise of the place", description="standard deviation", ge=0, le=5)


class Reading(NamedTuple):
    """One car: the middle of its rear bumper, seen from the own centre of gravity."""

    ahead: Annotated[float, "m", "forward, negative behind"] = 0.0
    left: Annotated[float, "m", "negative to the right"] = 0.0
    rate: Annotated[float, "m/s", "its speed minus the own one, along the own heading"] = 0.0


@compiled
def distance(view, me, other):
    """To the rear bumper of another car [m]."""
    return sqrt((view.places[REAR_X, other] - me.x) ** 2 + (view.places[REAR_Y, other] - me.y) ** 2)


@compiled
def measure(view, me, settings, memory, out):
    """The nearest CAPACITY cars in the box around the own one."""
    found, count, last = around(view, me, -settings.reach, settings.reach, -settings.width, settings.width), 0, -1.0
    while count < CAPACITY:
        best, nearest = -1, 1e9
        for i in range(found):
            other = view.found[i]
            far = distance(view, me, other)
            if other != me.vehicle and last < far < nearest:
                best, nearest = other, far
        if best < 0:
            break
        east, north = view.places[REAR_X, best] - me.x, view.places[REAR_Y, best] - me.y
        ahead, left = east * me.cosine + north * me.sine, north * me.cosine - east * me.sine
        along = view.places[COS, best] * me.cosine + view.places[SIN, best] * me.sine
        noise = settings.noise * draw_normal(view, me, count)
        report(out, me, count, Reading(ahead + noise, left, view.state[V_X, best] * along - me.speed))
        count, last = count + 1, nearest
    return count
