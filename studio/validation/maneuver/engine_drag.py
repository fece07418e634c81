"""Slowing down by the engine's drag through the gears, pedal lifted: the mean acceleration in each gear (Long-Ic).

The gear is fed, and the torque that is asked of the engine where it is recorded. Runs are split at clutch open and close, and aligned
where the clutch closes first.
"""

import numpy as np

from studio.log.recording import Recording
from studio.validation import rolling
from studio.validation.marks import Marks, Part, gears, lacking, mean

TITLE = "Engine drag through the gears"
STEP = "III Long-Ic"
FED = ("speed", "gear")
JUDGED = ("acceleration",)
HOLDS_SPEED = False
REPEATS = True
ZONES = ()
UNJUDGED = ("the changes of gear, and the quarter of each gear after its clutch has closed", "course of the speed")
LEAST_GEARS = 2
IDLE_PEDAL = 0.02  # [1]


def find(recording: Recording) -> list[tuple[float, float]]:
    """Where it slows down in gear, with neither pedal, and shifts down."""
    return [span for span in rolling.find(recording, is_dragging) if shifts(recording.between(*span)) < 0]


def is_dragging(recording: Recording) -> np.ndarray:
    """In gear, pedal lifted, no brake."""
    lifted = np.nan_to_num(recording.signals.get("throttle", np.zeros(recording.time.size))) < IDLE_PEDAL
    asked = np.nan_to_num(recording.signals.get("engine_torque_request", np.zeros(recording.time.size))) <= 0.0
    return (recording["gear"] >= 1) & lifted & asked & ~rolling.is_braked(recording)


def shifts(recording: Recording) -> int:
    """Gears at the end minus gears at the beginning."""
    return int(recording["gear"][-1] - recording["gear"][0])


def marks(recording: Recording) -> Marks:
    """Parts are the gears."""
    parts = gears(recording)
    if len(parts) < LEAST_GEARS:
        raise lacking(recording, f"has {len(parts)} gears that are held", "cut it so that two gears at least are driven half a second")
    return Marks(parts[0].since, parts[0].since, parts[-1].until, parts)


def measures(recording: Recording, at: Marks) -> dict:
    """Mean acceleration in each gear, the quarter after its clutch has closed left out."""
    return {f"acceleration, {part.name}": (mean(recording, "acceleration", after(part), part.until), "gain", "m/s²") for part in at.parts}


def after(part: Part) -> float:
    """When a quarter of a gear is over [s]."""
    return part.since + 0.25 * (part.until - part.since)
