"""Distances of responsibility-sensitive safety (S. Shalev-Shwartz, S. Shammah, A. Shashua, arXiv 1708.06374, definitions 1, 2 and 6).

For a response time rho [s] a car may still accelerate with a [m/s²]; then it brakes with at least b_min, while the one ahead may brake with
at most b_max. With v_rho = v + rho a, longitudinally, the rear car (r) behind the front car (f) in the same direction:

    d = [v_r rho + a rho²/2 + v_rho²/(2 b_min) - v_f²/(2 b_max)]⁺

Two cars (1, 2) that come towards each other, 1 in its own lane, so that it brakes gently with b_correct:

    d = (v_1 + v_1rho) rho/2 + v_1rho²/(2 b_correct) + (v_2 + v_2rho) rho/2 + v_2rho²/(2 b_min)

Laterally, 1 left of 2 and v counted to the right for both, with lateral a and b, a margin μ for swaying, v_1rho = v_1 + rho a and
v_2rho = v_2 - rho a:

    d = μ + [(v_1 + v_1rho) rho/2 + |v_1rho| v_1rho/(2 b) - (v_2 + v_2rho) rho/2 - |v_2rho| v_2rho/(2 b)]⁺

A situation is dangerous only while the longitudinal and the lateral distance are both too short.
"""

from collections.abc import Callable
from math import inf, nan

import numpy as np

from studio.assess.beside import Outlines, neighbours, outlines
from studio.execution.record import Record
from studio.kind.metric import Found, Scope
from studio.kind.settings import number


def longitudinal(v_r, v_f, *, rho: float, a: float, b_min: float, b_max: float) -> np.ndarray:
    """d [m] in the same direction."""
    v_rho = v_r + rho * a
    return np.maximum(v_r * rho + 0.5 * a * rho**2 + v_rho**2 / (2.0 * b_min) - v_f**2 / (2.0 * b_max), 0.0)


def opposite(v_1, v_2, *, rho: float, a: float, b_correct: float, b_min: float) -> np.ndarray:
    """d [m] in opposite directions, both speeds positive."""
    return stops_within(v_1, rho, a, b_correct) + stops_within(v_2, rho, a, b_min)


def stops_within(v, rho: float, a: float, b: float):
    """Way [m] of a car that accelerates for the response time and then brakes."""
    v_rho = v + rho * a
    return 0.5 * (v + v_rho) * rho + v_rho**2 / (2.0 * b)


def lateral(v_1, v_2, *, rho: float, a: float, b: float, margin: float) -> np.ndarray:
    """d [m] between two cars beside each other; 1 is the left one, speeds [m/s] are counted to the right."""
    return margin + np.maximum(sways(v_1, rho, a, b) - sways(v_2, rho, -a, b), 0.0)


def sways(v, rho: float, a: float, b: float):
    """Way [m] to the right of a car that accelerates to the right with a and then stops its lateral motion with b."""
    v_rho = v + rho * a
    return 0.5 * (v + v_rho) * rho + np.abs(v_rho) * v_rho / (2.0 * b)


# -- in a record ---------------------------------------------------------------------------------------


class Rules(Scope):
    """What RSS assumes. The first values are those of the open library of the paper's authors (ad-rss-lib), where the paper has none."""

    response_time: float = number(1.0, unit="s", title="Response time", ge=0, le=5)
    acceleration: float = number(3.5, unit="m/s²", title="Greatest acceleration during it", ge=0, le=20)
    least_braking: float = number(4.0, unit="m/s²", title="Braking that everybody does at least", gt=0.1, le=20)
    most_braking: float = number(8.0, unit="m/s²", title="Braking that nobody exceeds", gt=0.1, le=20)
    gentle_braking: float = number(3.0, unit="m/s²", title="Braking of who is in the right lane", gt=0.1, le=20)
    lateral_acceleration: float = number(0.2, unit="m/s²", title="Greatest lateral acceleration", ge=0, le=10)
    lateral_braking: float = number(0.8, unit="m/s²", title="Lateral braking that everybody does at least", gt=0.01, le=10)
    swaying: float = number(0.1, unit="m", title="Margin for swaying", ge=0, le=1)


def margin_behind(record: Record, rules: Rules) -> np.ndarray:
    """Gap minus the safe one [m] to what is ahead, float64[vehicle, n]."""
    safe = longitudinal(
        record.channel("speed"), record.channel("ahead_speed"), rho=rules.response_time, a=rules.acceleration,
        b_min=rules.least_braking, b_max=rules.most_braking,
    )  # fmt: skip
    return record.channel("gap") - safe


def least_margin(record: Record, reach: float, margin: Callable[[Outlines], np.ndarray], *, oncoming: bool = False) -> Found:
    """The least margin of any two vehicles that come within reach [m] of each other, of all or of oncoming ones."""
    best = Found(inf)
    for i, j, samples in neighbours(record, reach, oncoming=oncoming):
        seen = outlines(record, i, j, samples)
        values = margin(seen)
        values = np.where(np.isfinite(values), values, inf)
        place = int(values.argmin())
        if values[place] < best.value:
            best = Found(float(values[place]), (record.vehicles[i], record.vehicles[j]), float(seen.time[place]))
    return best if best.value < inf else Found(nan)


def oncoming_margin(seen: Outlines, rules: Rules) -> np.ndarray:
    """Distance minus the safe one [m] of two that come towards each other in one lane; infinite while they do not."""
    ahead, speed, other = np.sign(seen.forward), seen.speed, seen.other_speed
    v_1, v_2 = ahead * speed, -ahead * other
    safe = opposite(v_1, v_2, rho=rules.response_time, a=rules.acceleration, b_correct=rules.gentle_braking, b_min=rules.least_braking)
    meets = (seen.alike < 0.0) & (seen.aside < 0.0) & (v_1 > 0.0) & (v_2 > 0.0)
    return np.where(meets, seen.gap - safe, inf)


def beside_margin(seen: Outlines, rules: Rules) -> np.ndarray:
    """Distance minus the safe one [m] of two side by side; infinite while they are not."""
    first_is_left = seen.left < 0.0
    v_1 = np.where(first_is_left, -seen.drift, -seen.other_drift)
    v_2 = np.where(first_is_left, -seen.other_drift, -seen.drift)
    safe = lateral(v_1, v_2, rho=rules.response_time, a=rules.lateral_acceleration, b=rules.lateral_braking, margin=rules.swaying)
    beside = (seen.alike != 0.0) & (seen.gap < 0.0)
    return np.where(beside, seen.aside - safe, inf)
