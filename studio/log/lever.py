"""From the place of a sensor to the centre of gravity: what a rigid body's points do differently.

A sensor at d = (x, y, z), from the centre of gravity forward, left and up, moves with the body, whose angular velocity is w = (p, q, r).
The velocities and accelerations of two points of a rigid body differ by (Goldstein, Poole, Safko, "Classical Mechanics", 3rd edition,
chapter 4; [ , ] is the cross product, a dot the change)

    v_P = v + [w, d]           a_P = a + [ẇ, d] + [w, [w, d]]

With q = 0, a pitch that is slow beside the others, the centre of gravity has

    v_x = v_xP + r y
    v_y = v_yP - r x + p z
    a_x = a_xP + r² x + ṙ y - p r z
    a_y = a_yP - ṙ x + (p² + r²) y + ṗ z

Without a recorded roll rate p = 0, so that z does not count. The rates are smoothed, without delay, before they are differentiated.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.log.smooth import smooth

Place = tuple[float, float, float]


@dataclass(frozen=True)
class Turning:
    """How the body turns: yaw rate r and roll rate p [rad/s], and their changes [rad/s²], sample by sample."""

    r: np.ndarray
    p: np.ndarray
    r_dot: np.ndarray
    p_dot: np.ndarray


OFF: dict[str, Callable[[Turning, float, float, float], np.ndarray]] = {  # what the centre of gravity has more than the sensor shows
    "speed": lambda w, x, y, z: w.r * y,
    "lateral_speed": lambda w, x, y, z: -w.r * x + w.p * z,
    "acceleration": lambda w, x, y, z: w.r**2 * x + w.r_dot * y - w.p * w.r * z,
    "lateral_acceleration": lambda w, x, y, z: -w.r_dot * x + (w.p**2 + w.r**2) * y + w.p_dot * z,
}


def centred(name: str, time: np.ndarray, signals: Mapping[str, np.ndarray], places: Mapping[str, Place]) -> dict[str, np.ndarray]:
    """All signals on one clock [s], those of sensors at a place [m] brought to the centre of gravity; raises ScenarioError."""
    if not places:
        return dict(signals)
    if "yaw_rate" not in signals:
        remedy = "map yaw_rate too, or leave `at` out"
        problem = Problem(f"signals.{next(iter(places))}.at", "needs the yaw rate", remedy=remedy)
        raise ScenarioError(f"{name} does not tell how the body turns.", [problem])
    body = turning(time, signals)
    return dict(signals) | {each: signals[each] + OFF[each](body, *at) for each, at in places.items()}


def turning(time: np.ndarray, signals: Mapping[str, np.ndarray]) -> Turning:
    """How the body turns by what was recorded of it."""
    r = smooth(time, signals["yaw_rate"])
    p = smooth(time, signals["roll_rate"]) if "roll_rate" in signals else np.zeros(time.size)
    return Turning(r, p, np.gradient(r, time), np.gradient(p, time))
