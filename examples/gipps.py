"""The driver of Gipps: fast enough to stop in time if the car ahead brakes hard, and no slower.

    v_free = v + 2.5 a τ (1 - v/V) sqrt(0.025 + v/V)
    v_safe = -b τ + sqrt(b² τ² + b (2 s - v τ + v_ahead²/b_ahead))

P. G. Gipps, A behavioural car-following model for computer simulation, Transportation Research Part B 15 (1981) 105, Eqs. 1 and 2, with
positive b. Steering as in studio/model/helm.py.
"""

from math import inf, sqrt

from studio.compiled import compiled
from studio.kind.driver import Driver, Wish
from studio.kind.settings import number
from studio.model import helm

KIND = "driver"
TITLE = "Driver of Gipps"
SLOWEST = 0.1  # [m/s] wanted speed below which he stands
HARDEST = 8.0  # [m/s²]


class Settings(Driver):
    """What such a driver is like, besides what every driver has."""

    expected_reaction: float = number(0.0, unit="s", title="Reaction besides τ", ge=0, le=2)
    reaction_time: float = number(0.7, unit="s", title="Reaction time τ", ge=0.1, le=3)
    expected_braking: float = number(3.0, unit="m/s²", title="Braking b_ahead that he expects of others", ge=0.5, le=9)


@compiled
def free_speed(settings, sees):
    """The speed [m/s] after τ with nobody ahead."""
    share = max(sees.speed, 0.0) / max(sees.desired_speed, SLOWEST)
    return sees.speed + 2.5 * settings.acceleration * settings.reaction_time * (1.0 - share) * sqrt(0.025 + share)


@compiled
def safe_speed(settings, sees, gap, ahead_speed, ahead_braking):
    """The speed [m/s] after τ from which he can still stop behind somebody."""
    b, tau, v = settings.deceleration, settings.reaction_time, max(sees.speed, 0.0)
    room = 2.0 * (gap - settings.standstill_gap) - v * tau + ahead_speed * ahead_speed / ahead_braking
    return -b * tau + sqrt(max(b * b * tau * tau + b * room, 0.0))


@compiled
def decide(settings, sees):
    """One tick."""
    v = free_speed(settings, sees)
    if sees.ahead_gap < inf:
        v = min(v, safe_speed(settings, sees, sees.ahead_gap, sees.ahead_speed, settings.expected_braking))
    if sees.first_gap < inf:
        v = min(v, safe_speed(settings, sees, sees.first_gap, sees.first_speed, settings.expected_braking))
    if sees.stop_distance < inf:
        v = min(v, safe_speed(settings, sees, sees.stop_distance, 0.0, 1.0))
    acceleration = min(max((v - sees.speed) / settings.reaction_time, -HARDEST), settings.acceleration)
    return Wish(acceleration, helm.path_steering(sees, 2.0, 0.1))
