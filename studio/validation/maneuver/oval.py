"""Oval laps in both directions: everything at once, judged by where the car comes to (step IV).

Position over travelled distance: the final deviation under 5 % of the final travelled distance and inside the interval, and the
deviation over distance inside the zone. The simulated car begins where the recorded one does, with its heading.
"""

from collections.abc import Sequence

import numpy as np

from studio.log.recording import Recording
from studio.validation import path
from studio.validation.criterion import Measure
from studio.validation.marks import Marks
from studio.validation.path import Path
from studio.validation.zone import Confidence, zone

TITLE = "Oval laps"
STEP = "IV"
FED = ("road_wheel_angle|steering_wheel_angle", "speed")
JUDGED = ("x", "y")
HOLDS_SPEED = True
REPEATS = True
ZONES = ()
UNJUDGED = ("when the car is where", "yaw rate and accelerations on the way")
HEADING = 2.0  # [m] from which the first heading is taken
ROUND = 1.7 * np.pi  # [rad] that a lap turns
CLOSE = 5.0  # [m] between beginning and end of a lap


def find(recording: Recording) -> list[tuple[float, float]]:
    """Where the car comes back to where it was, having turned around once."""
    x, y, time = recording["x"], recording["y"], recording.time
    turned = np.unwrap(np.arctan2(np.gradient(y), np.gradient(x)))
    found, i = [], 0
    while i < time.size - 1:
        back = np.flatnonzero((np.abs(turned[i:] - turned[i]) > ROUND) & (np.hypot(x[i:] - x[i], y[i:] - y[i]) < CLOSE))
        if not back.size:
            break
        found.append((float(time[i]), float(time[i + back[0]])))
        i += int(back[0]) + 1
    return found


def marks(recording: Recording) -> Marks:
    """From the first sample to the last."""
    return Marks(0.0, 0.0, float(recording.time[-1]))


def measures(recording: Recording, at: Marks) -> dict:
    """The final travelled distance [m]."""
    return {"final travelled distance": (line(recording).length, "gain", "m")}


def line(recording: Recording) -> Path:
    """The path of a run."""
    return path.path(recording["x"], recording["y"])


def placed(ours: Recording, theirs: Recording) -> Path:
    """A simulated path, turned and moved to where the recorded one begins."""
    own, other = line(ours), line(theirs)
    turn = heading(other) - heading(own)
    rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return Path((own.points - own.points[0]) @ rotation + other.points[0], own.distance)


def heading(of: Path) -> float:
    """The direction of the first metres [rad]."""
    along = of.at(np.array([HEADING]))[0] - of.points[0]
    return float(np.arctan2(along[1], along[0]))


def compare(theirs: Sequence[Recording], ours: Sequence[Recording], averaged: Recording) -> list[Measure]:
    """Final deviation over the final travelled distance, of every run."""
    base = path.averaged([line(each) for each in theirs])
    runs = np.array([path.offsets(base, line(each))[-1] for each in theirs])
    sims = np.array([path.deviations(base, placed(mine, real))[-1] for mine, real in zip(ours, theirs, strict=True)])
    own = float(path.deviations(base, placed(averaged, theirs[0]))[-1])
    return [
        Measure("final deviation of the position over the distance", "final", runs / base.length, sims / base.length, own / base.length)
    ]


def share(theirs: Sequence[Recording], ours: Sequence[Recording], confidence: Confidence) -> dict[str, float]:
    """How much of the distance the mean deviation of the simulations lies inside the zone of the runs [1]."""
    base = path.averaged([line(each) for each in theirs])
    around = zone([path.offsets(base, line(each)) for each in theirs], confidence)
    mean = np.mean([path.deviations(base, placed(mine, real)) for mine, real in zip(ours, theirs, strict=True)], axis=0)
    return {"position over distance": float(around.holds(mean).mean())}
