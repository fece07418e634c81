"""What every sensor has, whatever it measures: settings that the studio obeys for all kinds (studio/world/board/sensing.py).

A kind of sensor derives its settings from `Sensor`; one that looks around from `Looking`, and then measures from the place and along the
direction that its eye has (`me.eye_x` and so on). Both give other first values where they need them, and add what they alone have.

    delay        a measurement is given so long after the instant that it belongs to: max(0, mean + variation · w), with w of the standard
                 normal distribution, within LONGEST of its standard deviations. Times are continuous; applications see it at their tick
    period       from one measurement to the next; each is made at the first tick that is not before its turn
    drop_out     share of the measurements that fail: what was given before stays, and ages
"""

from math import pi

from studio.kind.settings import Part, number

LONGEST = 5.0  # standard deviations of the delay beyond its mean


class Sensor(Part):
    """When a sensor gives what it has measured. With all of it at 0 it gives at every tick what is so at that tick."""

    delay: float = number(0.0, unit="s", title="Delay", description="mean; what is given is so old", ge=0, le=2)
    delay_variation: float = number(
        0.0, unit="s", title="Variation of the delay", description="standard deviation; no delay is below 0", ge=0, le=1
    )
    period: float = number(0.0, unit="s", title="Period", description="from one measurement to the next; 0: every tick", ge=0, le=10)
    drop_out: float = number(
        0.0,
        unit="1",
        title="Drop-out",
        description="share of the measurements that fail; what was given before stays, and ages",
        ge=0,
        le=1,
    )


class Looking(Sensor):
    """Where a sensor is mounted, and what lies in its field."""

    forward: float = number(0.0, unit="m", title="Mounted ahead", description="of the front bumper; negative behind it", ge=-30, le=5)
    left: float = number(0.0, unit="m", title="Mounted to the left", description="of the middle; negative to the right", ge=-3, le=3)
    yaw: float = number(0.0, unit="rad", title="Turned to the left", description="from straight ahead", ge=-pi, le=pi)
    opening_angle: float = number(0.7, unit="rad", title="Opening angle", description="from edge to edge", gt=0, le=2 * pi)
    range: float = number(120.0, unit="m", title="Reach", description="0 sees nothing", ge=0, le=500)
