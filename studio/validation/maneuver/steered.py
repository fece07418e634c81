"""Any drive that is steered: a slalom, a lap, a ride to work. No maneuver of the method; it says how well one whole run is followed.

Judged is the RMS difference between recorded and simulated signal over the range of the recorded one. One run is enough for it, and
it gives no interval: a model that follows one drive has not shown that it would follow the next.
"""

from collections.abc import Sequence

import numpy as np

from studio.log.recording import Recording
from studio.validation.criterion import Measure
from studio.validation.marks import Marks

TITLE = "Any steered drive"
STEP = "besides"
FED = ("road_wheel_angle|steering_wheel_angle", "speed")
JUDGED = ("yaw_rate", "lateral_acceleration")
HOLDS_SPEED = True
REPEATS = False
ZONES = ()
UNJUDGED = ("lags by themselves", "whether another drive would be followed as well")


def find(recording: Recording) -> list[tuple[float, float]]:
    """None: everything is one."""
    return []


def marks(recording: Recording) -> Marks:
    """From the first sample to the last."""
    return Marks(0.0, 0.0, float(recording.time[-1]))


def measures(recording: Recording, at: Marks) -> dict:
    """Nothing of a run alone: it is compared instant by instant."""
    return {}


def compare(theirs: Sequence[Recording], ours: Sequence[Recording], averaged: Recording) -> list[Measure]:
    """RMS difference over the range, of every run; the averaged input is no use where every drive is another."""
    found = []
    for name in JUDGED:
        errors = np.array([misfit(real[name], mine[name]) for real, mine in zip(theirs, ours, strict=True)])
        found.append(Measure(f"{name}, RMS difference over range", "fit", np.zeros(errors.size), errors, 0.0))
    return found


def misfit(theirs: np.ndarray, ours: np.ndarray) -> float:
    """RMS difference over the range of theirs [1]."""
    return float(np.sqrt(np.nanmean((ours - theirs) ** 2)) / np.ptp(theirs[np.isfinite(theirs)]))
