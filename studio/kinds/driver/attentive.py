"""The attentive driver: keeps a speed, follows what is ahead, lets others go first, stops at red, steers along the path.

Following: Intelligent Driver Model, M. Treiber, A. Hennecke, D. Helbing, Phys. Rev. E 62 (2000) 1805.
Steering: the controller of G. Hoffmann, C. Tomlin, M. Montemerlo, S. Thrun, ACC 2007, Eqs. 5 and 9, and a way back to the path.
The laws stand in studio/model/driver.py and helm.py.
"""

from math import inf

from studio.compiled import inlined
from studio.kind.driver import Driver, Wish
from studio.kind.settings import number
from studio.model import driver, helm

KIND = "driver"
TITLE = "Attentive driver"


class Settings(Driver):
    """What an attentive driver is like."""

    steering_gain: float = number(2.0, unit="1/s", title="Steering gain", description="how fast an offset is steered away", ge=0.1, le=10)
    yaw_damping: float = number(0.1, unit="s", title="Yaw damping", ge=0, le=1)


@inlined
def behind(settings, sees, gap, speed):
    """Acceleration [m/s²] behind somebody `gap` [m] ahead who drives with `speed` [m/s]."""
    return driver.following_acceleration(
        sees.speed, sees.desired_speed, gap, sees.speed - speed, settings.standstill_gap, settings.time_headway,
        settings.acceleration, settings.deceleration,
    )  # fmt: skip


@inlined
def towards(settings, sees):
    """Acceleration [m/s²] towards a stop line."""
    return driver.stopping_acceleration(sees.speed, sees.stop_distance, settings.acceleration, settings.deceleration)


@inlined
def pedals(settings, sees):
    """Acceleration [m/s²] that nobody and nothing forbids."""
    u = driver.free_acceleration(sees.speed, sees.desired_speed, settings.acceleration, settings.deceleration)
    if sees.ahead_gap < inf:
        u = min(u, behind(settings, sees, sees.ahead_gap, sees.ahead_speed))
    if sees.first_gap < inf:
        u = min(u, max(behind(settings, sees, sees.first_gap, sees.first_speed), -driver.COURTESY))
    if sees.stop_distance < inf:
        u = min(u, towards(settings, sees))
    return u


@inlined
def decide(settings, sees):
    """One tick."""
    return Wish(pedals(settings, sees), helm.path_steering(sees, settings.steering_gain, settings.yaw_damping))
