"""J-turn (ISO 7401, step steer): the wheel is turned quickly to an angle and held. Judged in its steady part (Lat-I).

The zone is that of the steady part alone. So that a clock that runs late does not pass by it, the lag of the yaw rate counts too, as in a
double lane change: from half of the steady angle to half of its own steady value. How the lateral acceleration builds up is judged in the
double lane change alone, as the method has it.
"""

import numpy as np

from studio.log.quantity import QUANTITIES
from studio.log.recording import Recording
from studio.log.smooth import crossing, rise, smooth
from studio.validation.marks import Lobe, Marks, lacking, lobes, mean, steering

TITLE = "J-turn"
STEP = "II Lat-I"
FED = ("road_wheel_angle|steering_wheel_angle", "speed")
JUDGED = ("yaw_rate", "lateral_acceleration")
HOLDS_SPEED = True
REPEATS = True
ZONES = JUDGED
UNJUDGED = ("lag of the lateral acceleration", "course of yaw rate and lateral acceleration before they are steady")
LATE = "yaw_rate"  # whose lag counts
LEAD, HELD, LONGEST = 1.0, 2.5, 8.0  # [s] straight before, held at least, looked at at most
SHARPNESS = 0.1  # [s] that smoothing reaches to both sides
STEADY = 0.1  # [1] of the angle, by which it may vary while it is held


def find(recording: Recording) -> list[tuple[float, float]]:
    """Where the wheel is held after it was straight."""
    angle, time = steering(recording), recording.time
    found = []
    for lobe in lobes(recording, 0.5):
        begin, end = max(time[lobe.first] - LEAD, 0.0), min(released(time, angle, lobe), time[lobe.first] + LONGEST)
        held = angle[(time > time[lobe.first] + 0.5) & (time < end - 0.3)]
        before = angle[(time >= begin) & (time < time[lobe.first] - 0.4 * LEAD)]
        is_held = end - time[lobe.first] >= HELD and held.size and np.ptp(held) < 2 * STEADY * abs(held.mean())
        if before.size and is_held and np.abs(before).max() < STEADY * abs(held.mean()):
            found.append((float(begin), float(end)))
    return found


def released(time: np.ndarray, angle: np.ndarray, lobe: Lobe) -> float:
    """Until when the wheel is held at its angle [s]: what follows is the way back."""
    held = np.abs(angle[lobe.first : lobe.last])
    return float(time[lobe.first + np.flatnonzero(held > (1.0 - STEADY) * np.median(held))[-1]]) - SHARPNESS


def marks(recording: Recording) -> Marks:
    """Aligned where the angle reaches half of its steady value; steady is the second half of what follows."""
    angle, time = steering(recording), recording.time
    steady = float(np.nanmedian(angle[time > 0.6 * time[-1]]))
    half = crossing(time, angle * np.sign(steady), 0.5 * abs(steady)) if steady else float("nan")
    if not half < time[-1] - 1.0:
        raise lacking(recording, "has no step of the steering that is held", "cut it so that it begins straight and ends while held")
    return Marks(half, half + 0.5 * (time[-1] - half), float(time[-1]))


def measures(recording: Recording, at: Marks) -> dict:
    """Steady-state gains of yaw rate and lateral acceleration, and the lag of the yaw rate."""
    steady = {name: mean(recording, name, at.since, at.until) for name in JUDGED}
    gains = {f"steady {name}": (value, "gain", QUANTITIES[name].unit) for name, value in steady.items()}
    return gains | {f"{LATE}, lag of the step": (lag(recording, LATE, at, steady[LATE]), "lag", "s")}


def lag(recording: Recording, name: str, at: Marks, steady: float) -> float:
    """How much later than the wheel a signal reaches half of its steady value [s]; not a number of one that begins beyond it."""
    if not steady:
        return float("nan")
    values = smooth(recording.time, recording[name]) * np.sign(steady)
    return rise(recording.time, values, 0.5 * abs(steady)) - at.reference
