"""Double lane change (after ISO 3888-1): out and back, two half waves that are aligned separately (Lat-II).

Each half wave turns the wheel to one side, then to the other. It is aligned where the angle reaches half of its first extremum. Of yaw
rate and lateral acceleration the two extrema of each half count, their times after that reference, and the lag: how much later the
signal reaches half of its own first extremum.
"""

import numpy as np

from studio.log.quantity import QUANTITIES
from studio.log.recording import Recording
from studio.log.smooth import crossing, rise, smooth
from studio.validation.marks import Lobe, Marks, Part, lacking, lobes, steering

TITLE = "Double lane change"
STEP = "II Lat-II"
FED = ("road_wheel_angle|steering_wheel_angle", "speed")
JUDGED = ("yaw_rate", "lateral_acceleration")
HOLDS_SPEED = True
REPEATS = True
ZONES = JUDGED
UNJUDGED = ("the way to the side", "course of the speed, which is held as it was recorded")
LEAD, SETTLE, LONGEST, QUIET = 1.0, 0.8, 15.0, 0.8  # [s] before the first half, after the second, all of it, between two maneuvers
HALVES = ("first half wave", "second half wave")
ORDER = ("first", "second", "third", "fourth")


def find(recording: Recording) -> list[tuple[float, float]]:
    """Groups of lobes whose sides follow each other as out and back do."""
    time, found, group = recording.time, [], []
    for lobe in [*lobes(recording), None]:
        if group and (lobe is None or time[lobe.first] - time[group[-1].last - 1] > 2.0 * QUIET):
            if sides(group) is not None:
                begin, end = time[group[0].first] - LEAD, time[group[-1].last - 1] + SETTLE
                found += [(float(max(begin, 0.0)), float(min(end, time[-1])))] if end - begin < LONGEST else []
            group = []
        if lobe is not None:
            group.append(lobe)
    return found


def sides(group: list[Lobe]) -> tuple[list[Lobe], list[Lobe]] | None:
    """The lobes of the two halves: one side, the other, the other again or still, the one; None for anything else."""
    turned = [lobe.side for lobe in group]
    if len(group) == 4 and turned in ([1, -1, -1, 1], [-1, 1, 1, -1]):
        return group[:2], group[2:]
    return (group[:2], group[1:]) if len(group) == 3 and turned in ([1, -1, 1], [-1, 1, -1]) else None


def marks(recording: Recording) -> Marks:
    """Halves as parts, each with its reference as `since`; the middle of what lies between them divides them."""
    angle, time, halves = steering(recording), recording.time, sides(lobes(recording))
    if halves is None:
        what = f"turns the wheel {' '.join('left' if each.side > 0 else 'right' for each in lobes(recording)) or 'nowhere'}"
        raise lacking(recording, what, "a double lane change turns left right right left, or the other way round: correct the cut")
    middle = 0.5 * (time[halves[0][1].last - 1] + time[halves[1][0].first])
    parts = []
    for name, (one, other), (begin, end) in zip(HALVES, halves, ((0.0, middle), (middle, time[-1])), strict=True):
        inside = (time >= begin) & (time <= max(time[one.peak], begin))
        half = crossing(time[inside], one.side * angle[inside], 0.5 * abs(angle[one.peak]))
        parts.append(Part(name, half, min(end, time[other.last - 1] + SETTLE), one.side))
    halves = ((parts[0].since, middle), (parts[1].since, np.inf))
    return Marks(parts[0].since, parts[0].since, parts[1].until, tuple(parts), halves)


def measures(recording: Recording, at: Marks) -> dict:
    """Extrema with their times, and lags."""
    found = {}
    for name in JUDGED:
        values = smooth(recording.time, recording[name])
        for h, half in enumerate(at.parts):
            gains, times, lag = extrema(recording.time, values, half)
            found |= {f"{name}, {ORDER[2 * h + i]} extremum": (gains[i], "gain", QUANTITIES[name].unit) for i in (0, 1)}
            found |= {f"{name}, time of the {ORDER[2 * h + i]} extremum": (times[i], "time", "s") for i in (0, 1)}
            found[f"{name}, lag of the {half.name}"] = (lag, "lag", "s")
    return found


def extrema(time: np.ndarray, values: np.ndarray, half: Part) -> tuple[list[float], list[float], float]:
    """The extremum to the side of the half, then that to the other; their times after the reference, and the lag [s]."""
    window = (time >= half.since - 0.1) & (time <= half.until)
    t, y = time[window], half.number * np.nan_to_num(values[window])
    first = int(np.argmax(y[: max(int(np.argmin(y)), 1)])) if np.argmin(y) > 0 else int(np.argmax(y))
    second = first + int(np.argmin(y[first:]))
    places = [peak(t, y, first), peak(t, -y, second)]
    gains = [half.number * places[0][1], -half.number * places[1][1]]
    reached = rise if window[0] else crossing  # what came before the window is known, what came before the log is not
    lag = reached(t[: first + 1], y[: first + 1], 0.5 * places[0][1]) - half.since if places[0][1] > 0 else float("nan")
    return gains, [places[0][0] - half.since, places[1][0] - half.since], lag


def peak(time: np.ndarray, values: np.ndarray, i: int) -> tuple[float, float]:
    """Time and height of an extremum between samples, by the parabola through three of them."""
    if not 0 < i < time.size - 1:
        return float(time[i]), float(values[i])
    a, b, c = values[i - 1 : i + 2]
    bend = a - 2.0 * b + c
    shift = 0.5 * (a - c) / bend if bend < 0.0 else 0.0
    return float(time[i] + shift * (time[i + 1] - time[i])), float(b - 0.25 * (a - c) * shift)
