"""Front radar: the nearest car or barrier in the own driving corridor, as a radar with target selection reports it.

The corridor is the arc that the own motion predicts (studio/model/sensor.py); a car is in it when its front, middle or rear is. What is
nearer hides it, and so do buildings: of the bearings that its outline covers, a share of `visible` must be seen. Measured is the nearest
point that is seen. Range, rate and azimuth carry white noise, which grows with the distance, as in Massow & Radusch 2018, section 2.3 and
Table 3. A cone of plastic sends nothing back.

Presets: 3GPP TR 22.837 (long range: 250 m, ±9 to 15°, 0.1 to 0.4 m, 0.03 to 0.12 m/s, 0.1 to 0.3°, 5 to 20 Hz; short range: 30 to
100 m, ±60 to 85°, 0.02 to 0.1 m, 0.3 to 5°, 20 to 50 Hz). Delays of 0.06 to 0.1 s and the growth of the noise are estimated, as is the
range noise of a camera, 5 % of the range.
"""

from math import atan2
from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Looking
from studio.kind.settings import number
from studio.model import sensor
from studio.model.sight import far, grown
from studio.vehicle.parameter import LENGTH
from studio.vehicle.state import ACTIVE
from studio.world.passes.neighbour import COS, REAR_X, REAR_Y, SIN
from studio.world.passes.sight import NEAR, SEEN_X, SEEN_Y, TURNED_COS, TURNED_SIN, is_thing, put_object, put_vehicle, speed_of
from studio.world.table.street import OBJECT
from studio.world.view import around, draw_four, glimpse, is_on_other_level, report

KIND = "sensor"
TITLE = "Front radar with one target"
CAPACITY = 1
NOISE = 0  # draws
FIRST_LOOK = 30.0  # [m]
ASIDE = 1.0  # [m] by which what hides a car in the corridor may stand beside it


class Settings(Looking):
    """The radar that looks ahead. A reach of 0 sees nothing."""

    range_noise: float = number(0.1, unit="m", title="Noise of the range", description="standard deviation", ge=0, le=10)
    rate_noise: float = number(0.05, unit="m/s", title="Noise of the range rate", description="standard deviation", ge=0, le=5)
    azimuth_noise: float = number(0.0, unit="rad", title="Noise of the azimuth", description="standard deviation", ge=0, le=0.5)
    range_growth: float = number(0.0, unit="1", title="Growth of the range noise", description="per metre of distance", ge=0, le=0.5)
    rate_growth: float = number(0.0, unit="1/s", title="Growth of the rate noise", description="per metre of distance", ge=0, le=0.1)
    azimuth_growth: float = number(
        0.0, unit="rad/m", title="Growth of the azimuth noise", description="per metre of distance", ge=0, le=0.01
    )
    visible: float = number(
        0.1, unit="1", title="Share that must be seen", description="of the bearings of an outline, else it is hidden; 0: nothing hides",
        ge=0, le=1,
    )  # fmt: skip


TR_22837 = "3GPP TR 22.837; delay and growth estimated"
PRESETS = {
    "long_range_radar": Preset("Long range radar", TR_22837, {
        "range": 250.0, "opening_angle": 0.35, "range_noise": 0.15, "range_growth": 0.001, "rate_noise": 0.05, "azimuth_noise": 0.0017,
        "delay": 0.08, "delay_variation": 0.01, "period": 0.06,
    }),
    "series_acc_radar": Preset("Radar of a series ACC", f"{TR_22837}; delay with the tracking filter, estimated together with the ACC's", {
        "range": 150.0, "opening_angle": 0.35, "range_noise": 0.15, "range_growth": 0.001, "rate_noise": 0.05, "azimuth_noise": 0.0017,
        "delay": 0.17, "delay_variation": 0.02, "period": 0.06,
    }),
    "short_range_radar": Preset("Short range radar", TR_22837, {
        "range": 80.0, "opening_angle": 2.4, "range_noise": 0.05, "range_growth": 0.001, "rate_noise": 0.1, "azimuth_noise": 0.017,
        "delay": 0.06, "delay_variation": 0.01, "period": 0.04,
    }),
    "camera": Preset("Camera", "range noise 5 % of the range, 30 Hz, delay 0.08 to 0.12 s: estimated, as usual for one camera", {
        "range": 120.0, "opening_angle": 0.9, "range_noise": 0.3, "range_growth": 0.05, "rate_noise": 0.3, "rate_growth": 0.01,
        "azimuth_noise": 0.003, "delay": 0.1, "delay_variation": 0.01, "period": 0.033, "visible": 0.3,
    }),
}  # fmt: skip


class Reading(NamedTuple):
    """The target."""

    range: Annotated[float, "m", "from the sensor to the nearest point of it that is seen"] = 0.0
    rate: Annotated[float, "m/s", "change of the range, negative when coming nearer"] = 0.0
    azimuth: Annotated[float, "rad", "of that point from the direction of the sensor, left positive"] = 0.0


@inlined
def is_in_way(view, me, other, kappa):
    """Whether the rear, the middle or the front of a car is in the own corridor."""
    forward, left = sensor.turned(view.places[REAR_X, other] - me.x, view.places[REAR_Y, other] - me.y, me.cosine, me.sine)
    half = 0.5 * view.parameter[LENGTH, other]
    ahead = half * (view.places[COS, other] * me.cosine + view.places[SIN, other] * me.sine)
    aside = half * (view.places[SIN, other] * me.cosine - view.places[COS, other] * me.sine)
    for i in range(3):
        x, y = forward - me.front + i * ahead, left + i * aside
        if x > 0.0 and sensor.in_corridor(x, y, kappa):
            return True
    return False


@inlined
def nearest_car(view, me, settings, kappa, beyond):
    """Column of the nearest car in the own corridor that is farther than `beyond` [m], and its distance; -1 when there is none.

    Near cars are looked at first: where one is seen, none that is farther can be nearer. Returned is also how many vehicles `view.found`
    holds: all that may stand before it.
    """
    best, nearest, found = -1, settings.range, 0
    for reach in (min(FIRST_LOOK, settings.range), settings.range):
        if nearest < reach:
            break
        ahead = me.front + reach + view.longest
        bow = min(max(0.5 * kappa * reach * reach, -ahead), ahead)  # of the corridor at its end
        left, right = max(bow, 0.0) + sensor.CORRIDOR + view.longest + ASIDE, min(bow, 0.0) - sensor.CORRIDOR - view.longest - ASIDE
        found = around(view, me, -view.longest, ahead, right, left)
        for i in range(found):
            other = view.found[i]
            if other == me.vehicle or view.state[ACTIVE, other] == 0.0 or not is_in_way(view, me, other, kappa):
                continue
            if is_on_other_level(view, me, other):
                continue
            put_vehicle(view, me, other, 0)
            if beyond < view.sight[NEAR, 0] < nearest:
                best, nearest = other, view.sight[NEAR, 0]
    return best, nearest, found


@inlined
def nearest_barrier(view, me, kappa, beyond, best, nearest):
    """The same among the barriers that stand there."""
    first, sight = view.first_object[me.world], view.sight
    for i in range(first, first + view.object_count[me.world]):
        if is_thing(view, me, i, False):
            put_object(view, me, i, 0)
            if (
                sight[SEEN_X, 0] > 0.0
                and sensor.in_corridor(sight[SEEN_X, 0], sight[SEEN_Y, 0], kappa)
                and beyond < sight[NEAR, 0] < nearest
            ):
                best, nearest = OBJECT - i, sight[NEAR, 0]
    return best, nearest


@inlined
def closing_rate(view, me, other, x, y):
    """Change of the distance [m/s] to the point x, y [m] of a car or an object, seen from the sensor."""
    distance = max(far(x, y), 1e-6)
    c, s = me.cosine * me.eye_cosine + me.sine * me.eye_sine, me.sine * me.eye_cosine - me.cosine * me.eye_sine
    ahead, aside = -me.speed * c, -me.speed * s
    speed = speed_of(view, other)
    ahead, aside = ahead + speed * view.sight[TURNED_COS, 0], aside + speed * view.sight[TURNED_SIN, 0]
    return (ahead * x + aside * y) / distance


@inlined
def measure(view, me, settings, memory, out):
    """One sensor at one tick: the nearest in the way that is not hidden."""
    if settings.range <= 0.0:
        return 0
    kappa, beyond = sensor.own_curvature(me.speed, me.yaw_rate), -1.0
    while True:
        other, nearest, found = nearest_car(view, me, settings, kappa, beyond)
        if view.object_count[me.world] > 0:
            other, nearest = nearest_barrier(view, me, kappa, beyond, other, nearest)
        if other == -1:
            return 0
        if other >= 0:
            put_vehicle(view, me, other, 0)
        else:
            put_object(view, me, OBJECT - other, 0)
        if glimpse(view, me, 0.5 * settings.opening_angle, False, settings.visible, found):
            break
        beyond = nearest
    x, y = view.sight[SEEN_X, 0], view.sight[SEEN_Y, 0]
    r = far(x, y)
    a, b, c, _ = draw_four(view, me, NOISE)
    seen = r + grown(settings.range_noise, settings.range_growth, r) * a
    rate = closing_rate(view, me, other, x, y) + grown(settings.rate_noise, settings.rate_growth, r) * b
    azimuth = atan2(y, x) + grown(settings.azimuth_noise, settings.azimuth_growth, r) * c
    report(out, me, 0, Reading(max(seen, 0.0), rate, azimuth))
    return 1
