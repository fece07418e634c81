"""The span of driving dynamics that recorded runs covered: what a vehicle was validated for, and what it was not.

A model is believed where it was compared: between the lowest and the highest speed, longitudinal and lateral acceleration and yaw rate
of the runs whose criteria were met. Outside, nothing is said of it.
"""

from collections.abc import Iterable

import numpy as np

from studio.log.recording import Recording
from studio.log.smooth import smooth
from studio.scenario.vehicle import Span

DIGITS = 4  # of a bound, after the point
UNITS = {"speed": "m/s", "acceleration": "m/s²", "lateral_acceleration": "m/s²", "yaw_rate": "rad/s"}
WORDS = {
    "speed": "speed",
    "acceleration": "longitudinal acceleration",
    "lateral_acceleration": "lateral acceleration",
    "yaw_rate": "yaw rate",
}


def span(runs: Iterable[Recording]) -> Span | None:
    """What the runs covered; None of no runs. What none of them recorded was not covered: its span is [0, 0]."""
    runs = list(runs)
    if not runs:
        return None
    return Span(**{name: covered(runs, name) for name in UNITS})


def covered(runs: list[Recording], name: str) -> list[float]:
    """Lowest and highest smoothed value of a signal in runs."""
    values = [smooth(each.time, each[name]) for each in runs if name in each.signals]
    known = np.concatenate(values) if values else np.zeros(1)
    return [round(float(np.nanmin(known)), DIGITS), round(float(np.nanmax(known)), DIGITS)]


def told(found: Span | None) -> list[str]:
    """A span in words."""
    if found is None:
        return ["Nothing was validated: no maneuver met all of its criteria."]
    lines = [f"{WORDS[name]} from {low:.3g} to {high:.3g} {UNITS[name]}" for name, (low, high) in found.model_dump().items() if low != high]
    missing = [WORDS[name] for name, (low, high) in found.model_dump().items() if low == high]
    return [*lines, *(f"{each}: not covered by any run, so nothing is said of it" for each in missing)]
