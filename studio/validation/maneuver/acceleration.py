"""Accelerating through the gears with a constant pedal: the regression line of the acceleration in each gear (Long-III).

A car's acceleration falls in each gear while the speed rises, nearly along a line: its slope and its value at the middle are judged.
"""

import numpy as np

from studio.log.recording import Recording
from studio.log.smooth import smooth, stretches
from studio.validation.marks import Marks, during, gears, lacking

TITLE = "Acceleration through the gears"
STEP = "III Long-III"
FED = ("speed", "gear", "throttle|engine_torque_request")
JUDGED = ("acceleration",)
HOLDS_SPEED = False
REPEATS = True
ZONES = ()
UNJUDGED = ("the changes of gear, and the quarter of each gear after its clutch has closed", "course of the speed")
PEDAL, CHANGE = 0.05, 0.1  # [1] that is pressed, and by which it may vary
LEAST, LEAST_RISE = 2.0, 3.0  # [s], [m/s]


def find(recording: Recording) -> list[tuple[float, float]]:
    """Where the pedal is held and the speed rises."""
    time, speed = recording.time, smooth(recording.time, recording["speed"])
    pedal = np.nan_to_num(recording.signals.get("throttle", np.zeros(time.size)))
    spans = [(a, b - 1) for a, b in stretches((pedal > PEDAL) & (recording["gear"] >= 1))]
    long = [(a, b) for a, b in spans if time[b] - time[a] >= LEAST and speed[b] - speed[a] >= LEAST_RISE]
    return [(float(time[a]), float(time[b])) for a, b in long if np.ptp(pedal[a : b + 1][len(pedal[a:b]) // 10 :]) <= CHANGE]


def marks(recording: Recording) -> Marks:
    """Parts are the gears."""
    parts = gears(recording)
    if not parts:
        raise lacking(recording, "has no gear that is held for half a second", "cut it so that a gear is driven out")
    return Marks(parts[0].since, parts[0].since, parts[-1].until, parts)


def measures(recording: Recording, at: Marks) -> dict:
    """Slope [m/s³] and middle [m/s²] of the line, the quarter after the clutch has closed left out."""
    found = {}
    for part in at.parts:
        values = during(recording, "acceleration", part.since + 0.25 * (part.until - part.since), part.until)
        found |= line(part.name, values, float(recording.time[1]))
    return found


def line(name: str, values: np.ndarray, period: float) -> dict:
    """The regression line through values that follow each other by a period [s]."""
    known = np.flatnonzero(np.isfinite(values))
    if known.size < 3:
        return {f"{name}, slope": (float("nan"), "gain", "m/s³"), f"{name}, midpoint": (float("nan"), "gain", "m/s²")}
    slope, first = np.polyfit(known * period, values[known], 1)
    middle = first + slope * period * 0.5 * (values.size - 1)
    return {f"{name}, slope": (float(slope), "gain", "m/s³"), f"{name}, midpoint": (float(middle), "gain", "m/s²")}
