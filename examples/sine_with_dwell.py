"""Sine with dwell: the steering of the test for electronic stability control, one period of a sine that waits at its second peak.

0.7 Hz with a dwell of 0.5 s: 49 CFR 571.126 (FMVSS 126), S7.9. The test raises the amplitude from run to run; the pedals stay with
application or driver.
"""

from math import pi, sin

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.world.maneuver import over, steer

KIND = "action"
TITLE = "Sine with dwell"


class Settings(Part):
    """Who, and how far."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    amplitude: float = number(0.01, unit="rad", title="Amplitude", description="of the road wheel angle, to the left first", ge=0, le=0.3)
    frequency: float = number(0.7, unit="Hz", title="Frequency", ge=0.1, le=2)
    dwell: float = number(0.5, unit="s", title="Dwell", description="at the second peak", ge=0, le=2)


@compiled
def act(settings, sees):
    """Three quarters of a period, the dwell, the last quarter."""
    peak = 0.75 / settings.frequency
    time = sees.elapsed if sees.elapsed < peak else max(sees.elapsed - settings.dwell, peak)
    if time >= 1.0 / settings.frequency:
        return over()
    return steer(settings.amplitude * sin(2.0 * pi * settings.frequency * time))


def told(settings):
    """In words."""
    return f"sine with dwell of {settings.amplitude:g} rad"
