"""Vehicle state: what the own car's sensors put on its bus, each with noise; delay and period as every sensor has them.

The noise of series sensors: wheel speeds 0.05 m/s, acceleration 0.1 m/s², yaw rate 0.1 °/s, steering 0.1 ° (H. Winner et al., Handbook
of Driver Assistance Systems, 2016, ch. 15; the figures are rounded). `Own` of an application is the same without noise; what is written
against this sensor runs on a real bus.
"""

from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Sensor
from studio.kind.settings import number
from studio.vehicle.state import A_X, A_Y, DELTA, GEAR, V_X, YAW_RATE
from studio.world.view import draw_four, report

KIND = "sensor"
TITLE = "Vehicle state with noise"
MOTION, STEERING = range(2)  # draws


class Settings(Sensor):
    """Standard deviations."""

    speed_noise: float = number(0.05, unit="m/s", title="Noise of the speed", description="standard deviation", ge=0, le=5)
    acceleration_noise: float = number(0.1, unit="m/s²", title="Noise of the accelerations", description="standard deviation", ge=0, le=5)
    yaw_rate_noise: float = number(0.0017, unit="rad/s", title="Noise of the yaw rate", description="standard deviation", ge=0, le=0.5)
    steering_noise: float = number(0.0017, unit="rad", title="Noise of the steering", description="standard deviation", ge=0, le=0.5)


PRESETS = {
    "series": Preset("Series car", "bus at 50 Hz, 0.02 s late: estimated, as usual", {"delay": 0.02, "period": 0.02}),
    "reference": Preset("Reference system", "Euro NCAP: 0.1 km/h, 0.1 °/s, 100 Hz or more", {
        "speed_noise": 0.028, "acceleration_noise": 0.03, "yaw_rate_noise": 0.0017, "steering_noise": 0.0005,
    }),
}  # fmt: skip


class Reading(NamedTuple):
    """What the bus tells."""

    speed: Annotated[float, "m/s", "along the car"] = 0.0
    acceleration: Annotated[float, "m/s²", "forward"] = 0.0
    lateral_acceleration: Annotated[float, "m/s²", "to the left"] = 0.0
    yaw_rate: Annotated[float, "rad/s", "to the left"] = 0.0
    steering: Annotated[float, "rad", "road wheel angle, to the left"] = 0.0
    gear: Annotated[float, "1", "that is engaged"] = 0.0


@inlined
def measure(view, me, settings, memory, out):
    """The own signals at one tick; a station has none."""
    if me.vehicle < 0:
        return 0
    state, v = view.state, me.vehicle
    a, b, c, d = draw_four(view, me, MOTION)
    e, _, _, _ = draw_four(view, me, STEERING)
    report(
        out, me, 0,
        Reading(
            state[V_X, v] + settings.speed_noise * a,
            state[A_X, v] + settings.acceleration_noise * b,
            state[A_Y, v] + settings.acceleration_noise * c,
            state[YAW_RATE, v] + settings.yaw_rate_noise * d,
            state[DELTA, v] + settings.steering_noise * e,
            state[GEAR, v],
        ),
    )  # fmt: skip
    return 1
