"""A recorded drive on one clock: our signals, sampled together. Where one has a gap, it is not a number there.

    recording = load(Path("drive.csv"), known)        # read, mapped, resampled

Between two samples values are linear, a gear holds; beyond a signal's own samples nothing is made up. The clock begins with the first
signal and ends with the last one; `start` keeps the recorded time of its zero.
"""

import hashlib
from collections.abc import Mapping as Table
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from studio.errors import Problem, ScenarioError, UnknownError, nearest
from studio.kind.log import GAP, Log, Signal
from studio.log import lever, mapping, reading
from studio.log.mapping import Known, Mapping
from studio.log.quantity import QUANTITIES
from studio.rig import table

PERIOD = 0.01  # [s] of the common clock
LONGEST = 24 * 3600.0  # [s]
HOLDS = ("gear",)


@dataclass(frozen=True)
class Recording:
    """Our signals over one clock that begins with 0 s, [s]; `start` [s] is what the log called that moment."""

    name: str
    time: np.ndarray
    signals: Table[str, np.ndarray]
    start: float = 0.0

    def __getitem__(self, name: str) -> np.ndarray:
        """One signal; raises UnknownError that names the nearest."""
        if name not in self.signals:
            raise UnknownError(f"{self.name} has no {name}; {nearest(name, self.signals)}")
        return self.signals[name]

    def facts(self) -> list[dict[str, Any]]:
        """Unit, rate, gaps and range of every signal, as plain data."""
        return [
            Signal(name, QUANTITIES[name].unit, self.time, values).facts() | {"gaps": self.gaps(name)}
            for name, values in self.signals.items()
        ]

    def gaps(self, name: str) -> list[tuple[float, float]]:
        """From when to when [s] nothing is known of a signal."""
        known = np.concatenate([[True], np.isfinite(self[name]), [True]])
        edges = np.flatnonzero(np.diff(known.astype(np.int8)))
        return [(float(self.time[a]), float(self.time[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True)]

    def between(self, since: float, until: float) -> "Recording":
        """A part, its clock beginning with 0 s again; raises ScenarioError when there is hardly any."""
        inside = (self.time >= since - 1e-9) & (self.time <= until + 1e-9)
        if inside.sum() < 2:
            problem = Problem(self.name, "has nothing there", f"{since:g} to {until:g} s", f"0 to {self.time[-1]:g} s")
            raise ScenarioError(f"{self.name} does not go so far.", [problem])
        cut = {name: values[inside] for name, values in self.signals.items()}
        time = self.time[inside]
        return Recording(self.name, time - time[0], cut, self.start + float(time[0]))

    @cached_property
    def digest(self) -> str:
        """Of what was recorded, whatever its file is called: to 9 digits, so that a copy in another format is the same."""
        found = hashlib.sha256()
        for name in sorted(self.signals):
            found.update(name.encode() + np.array([f"{value:.9g}" for value in self.signals[name]], dtype="S20").tobytes())
        return found.hexdigest()


def load(path: Path, known: Known | None = None, *, period: float = PERIOD) -> Recording:
    """A log on one clock by a mapping, or by its names where they are ours; raises ScenarioError."""
    return of_log(reading.read(path, known.dbc if known else None), known.mapping if known else None, period)


def of_log(log: Log, known: Mapping | None = None, period: float = PERIOD) -> Recording:
    """The same of a log that was read: mapped, on one clock, at the centre of gravity; raises ScenarioError."""
    used = known or mapping.as_named(log)
    made = resampled(log.name, mapping.apply(used, log), period)
    return replace(made, signals=lever.centred(log.name, made.time, made.signals, used.places))


def resampled(name: str, signals: Table[str, Signal], period: float = PERIOD) -> Recording:
    """Signals of several clocks on one; raises ScenarioError when they do not overlap, or go on for days."""
    since, until = max(each.time[0] for each in signals.values()), min(each.time[-1] for each in signals.values())
    if until <= since:
        spans = ", ".join(f"{each.name} {each.time[0]:g} to {each.time[-1]:g} s" for each in signals.values())
        problem = Problem(name, "has signals that were not recorded at the same time", spans, remedy="leave one out, or say its `delay`")
        raise ScenarioError(f"The signals of {name} do not overlap.", [problem])
    if until - since > LONGEST:
        problem = Problem(
            name, "is too long", f"{until - since:g} s", f"≤ {LONGEST:g} s", "is its clock in ms? Say `time [ms]` in the head"
        )
        raise ScenarioError(f"{name} is no drive.", [problem])
    time = np.arange(int((until - since) / period + 1e-6) + 1) * period
    return Recording(name, time, {key: on(each, since + time) for key, each in signals.items()}, float(since))


def on(found: Signal, time: np.ndarray) -> np.ndarray:
    """A signal at other times: not a number in its gaps."""
    known = found.is_number
    own, values = found.time[known], found.values[known]
    after = np.clip(np.searchsorted(own, time - 1e-9), 0, own.size - 1)
    before = np.clip(np.searchsorted(own, time + 1e-9, side="right") - 1, 0, own.size - 1)
    made = values[before] if found.name in HOLDS else np.interp(time, own, values)
    wide = own[after] - own[before] > GAP * found.period
    outside = (time < own[0] - 1e-9) | (time > own[-1] + 1e-9)
    return np.where(wide | outside, np.nan, made)


def write(recording: Recording, out: Path) -> int:
    """Writes a recording as CSV, with our names and units in its head; a gap is an empty cell. Returns the number of rows."""
    head = ["time [s]", *(f"{name} [{QUANTITIES[name].unit}]" for name in recording.signals)]
    rows = [
        [f"{value:.9g}" if np.isfinite(value) else "" for value in row]
        for row in zip(recording.time, *recording.signals.values(), strict=True)
    ]
    table.write(out, [head, *rows])
    return len(rows)
