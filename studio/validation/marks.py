"""Marks of a run, read off its inputs: the moment that runs are aligned by, the time that is judged, the parts that it falls into."""

from typing import NamedTuple

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.log.recording import Recording
from studio.log.smooth import smooth, stretches

WHEELS = ("road_wheel_angle", "steering_wheel_angle")
LEAST = {"road_wheel_angle": 0.002, "steering_wheel_angle": 0.03}  # [rad] below which nobody steers
STEERED = 0.3  # [1] of the greatest angle: what is more is a lobe


class Part(NamedTuple):
    """A part of a run: what it is, from when to when [s]; of a gear its number, of a lobe its sign."""

    name: str
    since: float
    until: float
    number: int = 0


class Marks(NamedTuple):
    """The reference [s], the time that is judged [s], and the parts; `halves` are aligned each by itself: reference and end [s]."""

    reference: float
    since: float
    until: float
    parts: tuple[Part, ...] = ()
    halves: tuple[tuple[float, float], ...] = ()

    @property
    def anchors(self) -> tuple[tuple[float, float], ...]:
        """What is aligned by itself: each with its reference and its end [s]."""
        return self.halves or ((self.reference, np.inf),)


class Lobe(NamedTuple):
    """The steering wheel held to one side: indices, side (1 left), and the index of its extremum."""

    first: int
    last: int
    side: int
    peak: int


def steering(recording: Recording) -> np.ndarray:
    """The angle that is fed, smoothed: of the road wheels where it is known, else of the steering wheel."""
    name = wheel(recording)
    return smooth(recording.time, recording[name])


def wheel(recording: Recording) -> str:
    """Which angle is fed."""
    return next((name for name in WHEELS if name in recording.signals), WHEELS[1])


def lobes(recording: Recording, share: float = STEERED) -> list[Lobe]:
    """Every time that the steering is held to a side, more than a share of the greatest angle."""
    angle = steering(recording)
    level = max(share * float(np.nanmax(np.abs(angle))), LEAST[wheel(recording)])
    found = [(a, b, side) for side in (1, -1) for a, b in stretches(side * angle > level)]
    return [Lobe(a, b, side, a + int(np.argmax(side * angle[a:b]))) for a, b, side in sorted(found)]


def lacking(recording: Recording, what: str, remedy: str) -> ScenarioError:
    """What is told of a run that is not the maneuver that it is said to be."""
    return ScenarioError(f"{recording.name} is not the maneuver that it is named.", [Problem(recording.name, what, remedy=remedy)])


def gears(recording: Recording, least: float = 0.5) -> tuple[Part, ...]:
    """The times in one gear with the clutch closed, longer than `least` [s]: split at clutch open and close where it is recorded."""
    gear = np.nan_to_num(recording["gear"])
    closed = recording.signals.get("clutch", np.ones(gear.size)) > 0.95
    time, parts = recording.time, []
    for number in sorted({int(each) for each in gear}, reverse=True):
        spans = [(time[a], time[b - 1]) for a, b in stretches((gear == number) & closed)]
        long = [span for span in spans if span[1] - span[0] >= least]
        parts += [Part(f"gear {number}" if number else "neutral", float(a), float(b), number) for a, b in long[:1]]
    return tuple(sorted(parts, key=lambda part: part.since))


def during(recording: Recording, name: str, since: float, until: float) -> np.ndarray:
    """Smoothed values of a signal in a time."""
    inside = (recording.time >= since - 1e-9) & (recording.time <= until + 1e-9)
    return smooth(recording.time, recording[name])[inside]


def mean(recording: Recording, name: str, since: float, until: float) -> float:
    """Mean of a signal over a time; not a number where it was not recorded."""
    values = during(recording, name, since, until)
    return float(np.nanmean(values)) if np.isfinite(values).any() else float("nan")
