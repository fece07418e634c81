"""Braking with the engine's drag in gear: the steady acceleration while braking (Long-II)."""

import numpy as np

from studio.log.recording import Recording
from studio.log.smooth import smooth
from studio.validation import rolling
from studio.validation.marks import Marks, lacking, mean

TITLE = "Braking"
STEP = "III Long-II"
FED = ("speed", "brake_torque|brake|drive_torque")
JUDGED = ("acceleration",)
HOLDS_SPEED = False
REPEATS = True
ZONES = JUDGED
UNJUDGED = ("how the deceleration builds up", "course of the speed", "way to standstill")
BUILT_UP = 0.5  # [s] until the deceleration is steady
SLOW = 1.0  # [m/s]


def find(recording: Recording) -> list[tuple[float, float]]:
    """Where it is braked in gear."""
    return rolling.find(recording, lambda each: ~rolling.is_neutral(each) & rolling.is_braked(each))


def marks(recording: Recording) -> Marks:
    """Aligned where half of the greatest deceleration is reached; steady from half a second later until it is slow, or let go."""
    slowing, time = -smooth(recording.time, recording["acceleration"]), recording.time
    hard = np.flatnonzero(slowing > 0.5 * np.nanmax(slowing))
    fast = np.flatnonzero(smooth(time, recording["speed"]) > SLOW)
    since = float(time[hard[0]]) if hard.size else float("nan")
    until = float(time[min(hard[-1], fast[-1])]) if hard.size and fast.size else float("nan")
    if not until - since > 2.0 * BUILT_UP:
        raise lacking(recording, "does not brake for a second", "cut it from before the brake to standstill")
    return Marks(since, since + BUILT_UP, until - 0.1)


def measures(recording: Recording, at: Marks) -> dict:
    """Steady acceleration."""
    return {"steady acceleration": (mean(recording, "acceleration", at.since, at.until), "gain", "m/s²")}
