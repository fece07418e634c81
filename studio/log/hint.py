"""What looks wrong in a recording though every signal by itself could be right: hints for who looks at it, no refusals.

On a level road a car without much side slip has

    a_y ≈ v r

and turns to the side to which its wheels are turned. A speed in km/h that is taken for m/s makes the one 3.6 times the other, a sensor
that is mounted the other way round turns a sign. A slide, a banked bend or a sensor far from the middle do not make it half or double.

A log that says its units is believed unless the mapping says others: then one of the two is wrong, though the values may be possible
in both. A lane change on a motorway takes 1.3 deg at the wheels; read as 1.3 rad it is still an angle that wheels can have.
"""

import numpy as np

from studio.kind.log import Log
from studio.log import unit
from studio.log.mapping import Mapping, names
from studio.log.quantity import QUANTITIES
from studio.log.recording import Recording

LEAST = 0.5  # [m/s²] that v r has at least in the mean square: less tells nothing
LOW, HIGH = 0.6, 1.6  # [1] of a_y over v r
STEERING = ("road_wheel_angle", "steering_wheel_angle")


def hints(recording: Recording) -> list[str]:
    """What to look at, in words."""
    found = [torn(recording), sideways(recording), *(turned(recording, name) for name in STEERING)]
    return [each for each in found if each]


def torn(recording: Recording) -> str:
    """Of the first gap of every signal that has any: no maneuver is found, or taken, across one."""
    found = [(name, gaps) for name in recording.signals if (gaps := recording.gaps(name))]
    more = [f" and {len(gaps) - 1} more" if gaps[1:] else "" for _, gaps in found]
    said = ", ".join(f"{name} from {gaps[0][0]:.2f} to {gaps[0][1]:.2f} s{rest}" for (name, gaps), rest in zip(found, more, strict=True))
    return f"nothing was recorded of {said}: a maneuver must lie before or after a gap" if found else ""


def contradictions(used: Mapping, log: Log) -> list[str]:
    """Units of a mapping that are not those of the log, in words; the mapping's are taken."""
    return [
        f"{each} is recorded in {log[each].unit}, and the mapping takes it in {source.unit}: if the log is right, leave the unit out"
        for name, source in used.signals.items()
        for each in names(source)
        if source.unit and differ(log[each].unit, source.unit, QUANTITIES[name].unit)
    ]


def differ(recorded: str, said: str, ours: str) -> bool:
    """Whether two units of a quantity are two; one that nobody reads, or that the log leaves open, is none."""
    known = unit.plain(ours)
    one, other = known.get(recorded.strip().lower()), known.get(said.strip().lower())
    return bool(recorded.strip()) and one is not None and one != other


def sideways(recording: Recording) -> str:
    """Of lateral acceleration against speed and yaw rate; nothing when they agree, or do not tell."""
    if not {"speed", "yaw_rate", "lateral_acceleration"} <= recording.signals.keys():
        return ""
    turning = recording["speed"] * recording["yaw_rate"]
    ratio = slope(turning, recording["lateral_acceleration"])
    if not np.isfinite(ratio) or LOW < ratio < HIGH:
        return ""
    remedy = "is one of them turned round? Give it sign: -1" if ratio < 0.0 else "has one of the three another unit, such as km/h or g?"
    return f"lateral_acceleration is {ratio:.2g} times speed × yaw_rate, and in a car they are nearly the same: {remedy}"


def turned(recording: Recording, name: str) -> str:
    """Of steering against yaw rate; nothing when they agree, or do not tell."""
    if not {name, "speed", "yaw_rate"} <= recording.signals.keys():
        return ""
    ratio = slope(recording["speed"] * recording["yaw_rate"], recording[name])
    return f"the car turns to the other side than {name}: is one of them turned round? Give it sign: -1" if ratio < 0.0 else ""


def slope(x: np.ndarray, y: np.ndarray) -> float:
    """Of the line through zero that fits y over x best; not a number where x hardly moves."""
    known = np.isfinite(x) & np.isfinite(y)
    square = float(np.square(x[known]).mean()) if known.any() else 0.0
    return float((x[known] * y[known]).mean() / square) if square > LEAST**2 else float("nan")
