"""Rolling to a stop, with and without the brake: what the two maneuvers of it share.

Runs are aligned at standstill, for they begin at somewhat different speeds. Deceleration is judged above and below the middle speed:
drag counts above, rolling resistance everywhere, so that two errors cannot hide behind each other.
"""

from collections.abc import Callable

import numpy as np

from studio.log.recording import Recording
from studio.log.smooth import smooth, stretches
from studio.validation.marks import Marks, lacking, mean

STILL = 0.3  # [m/s] below which a car stands, or nearly so
LEAST_FALL = 3.0  # [m/s] that it slows down
LEAST = 2.0  # [s]


def find(recording: Recording, rolls: Callable[[Recording], np.ndarray]) -> list[tuple[float, float]]:
    """Where a car rolls, and slows down by some m/s."""
    speed, time = smooth(recording.time, recording["speed"]), recording.time
    spans = [(a, b - 1) for a, b in stretches(rolls(recording) & (speed > STILL))]
    return [(float(time[a]), float(time[b])) for a, b in spans if time[b] - time[a] >= LEAST and speed[a] - speed[b] >= LEAST_FALL]


def is_neutral(recording: Recording) -> np.ndarray:
    """Where no gear is in, or the clutch is open."""
    neutral = np.zeros(recording.time.size, dtype=bool)
    if "gear" in recording.signals:
        neutral |= recording["gear"] == 0
    if "clutch" in recording.signals:
        neutral |= recording["clutch"] < 0.05
    return neutral


def is_braked(recording: Recording) -> np.ndarray:
    """Where the brake is applied."""
    for name, least in (("brake_torque", 1.0), ("brake", 0.01)):
        if name in recording.signals:
            return np.nan_to_num(recording[name]) > least
    return np.zeros(recording.time.size, dtype=bool)


def marks(recording: Recording) -> Marks:
    """Aligned at standstill, or at the end where it does not come to that; parts above and below the middle speed."""
    speed, time = smooth(recording.time, recording["speed"]), recording.time
    still = np.flatnonzero(speed <= STILL)
    end = float(time[still[0]]) if still.size else float(time[-1])
    begin = 0.1 * end
    if speed[0] - np.interp(end, time, speed) < LEAST_FALL:
        raise lacking(recording, "does not slow down", "cut it from where it rolls to where it stands")
    return Marks(end, begin, end - 0.05 * (end - begin))


def measures(recording: Recording, at: Marks) -> dict:
    """Mean acceleration over the first and the second half of the time."""
    middle = 0.5 * (at.since + at.until)
    return {
        "acceleration, faster half": (mean(recording, "acceleration", at.since, middle), "gain", "m/s²"),
        "acceleration, slower half": (mean(recording, "acceleration", middle, at.until), "gain", "m/s²"),
    }
