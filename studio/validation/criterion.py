"""Criteria and verdicts: what is asked of the mean of the simulations and of the simulation of the averaged input (section 5.4, 5.5).

    gain   the mean of the simulations lies inside the interval; the averaged simulation is within 5 %
    time   the same interval; the mean within 0.05 s, the averaged simulation within 0.1 s
    lag    mean and averaged simulation within 0.05 s; the interval does not count; unjudged where a recorded run begins beyond its half

Bounds and limits are included, and numbers are compared as decimals: 14.32 - 14.22 is 0.1, and neither more nor less by how a computer
writes it. The relative error of the averaged simulation is meant over the mean of the experiments.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from math import isfinite
from typing import Any, Literal

import numpy as np
from pydantic import Field

from studio.kind.settings import Part, number
from studio.validation.zone import Confidence, zone

DIGITS = 9  # after the point, to which numbers are compared
Rule = Literal["gain", "time", "lag", "fit", "final"]
PASS, FAIL, OVERRIDDEN, UNJUDGED = "pass", "fail", "overridden", "unjudged"
WIDE = "says little, for the interval is wider than the limit: record more runs, and see whether one of these differs"
LENIENT = f"met by nothing but the width of its interval, and {WIDE}"
LATE = "beyond half of its value from the first sample on, so that nobody knows since when; cut the log so that it begins before the step"
COARSE, SHARE = (
    "within its limit, and yet {0:.0f} % of the lag itself: the limit is coarse for so short a lag; ask for less with limits: lag",
    0.25,
)
ALONE = "one run only: there is no interval; record the maneuver again"


class Limits(Part):
    """What the criteria allow; first values are those of the paper, but for `zone` and `fit`, which it judges by eye."""

    gain: float = number(0.05, unit="1", title="Error of the averaged simulation over the mean of the experiments", gt=0, le=1)
    lag: float = number(0.05, unit="s", title="Error of a time lag", gt=0, le=1)
    time: float = number(0.05, unit="s", title="Error of the time of an extremum, mean of the simulations", gt=0, le=1)
    averaged_time: float = number(0.1, unit="s", title="The same, averaged simulation", gt=0, le=1)
    final: float = number(0.05, unit="1", title="Final deviation of the position over the final travelled distance", gt=0, le=1)
    zone: float = number(
        0.9, unit="1", title="Share of the time inside the data zone",
        description="a car that is ours itself is inside for 95 % of the time in the mean, and for less by chance", gt=0, le=1,
    )  # fmt: skip
    fit: float = number(0.05, unit="1", title="RMS difference over the range of the signal, any steered drive", gt=0, le=1)


class Override(Part):
    """A person's judgement beside a criterion that failed."""

    maneuver: str = Field(..., title="Maneuver")
    criterion: str = Field(..., title="Criterion, as the verdicts name it")
    reason: str = Field(..., min_length=10, max_length=2000, title="Why it counts as valid all the same")


@dataclass(frozen=True)
class Verdict:
    """One criterion: our value, theirs, its interval, the error and its limit, the verdict, and the reason where one is needed.

    `unit` is that of values and interval, `error_unit` that of error and limit: "1" where the error is meant over something.
    """

    maneuver: str
    criterion: str
    ours: float
    theirs: float
    low: float | None
    high: float | None
    error: float
    limit: float | None
    verdict: str
    reason: str = ""
    unit: str = "1"
    error_unit: str = "1"

    @property
    def is_coarse(self) -> bool:
        """Whether it is a lag that is met by a limit which is large beside it."""
        return self.verdict == PASS and self.reason.startswith(COARSE.partition("{")[0])

    @property
    def is_doubtful(self) -> bool:
        """Whether it is met by nothing but the width of an interval that is wider than its limit."""
        return self.verdict == PASS and self.reason == LENIENT

    def as_json(self) -> dict[str, Any]:
        """Plain data, in which what is not a number is none."""
        return {key: None if isinstance(value, float) and not isfinite(value) else value for key, value in asdict(self).items()}


@dataclass(frozen=True)
class Measure:
    """One quantity of a maneuver: of the recorded runs, of their simulations, and of that of the averaged input."""

    name: str
    rule: Rule
    theirs: np.ndarray
    ours: np.ndarray
    averaged: float
    unit: str = "1"
    runs: tuple[str, ...] = ()

    @property
    def unknown(self) -> list[str]:
        """The recorded runs that it cannot be read off."""
        return [name for name, value in zip(self.runs, self.theirs, strict=False) if not isfinite(value)]


def verdicts(maneuver: str, found: Measure, limits: Limits, confidence: Confidence) -> list[Verdict]:
    """All criteria of a quantity."""
    theirs, mean = zone(found.theirs, confidence), float(np.mean(found.ours))
    experiments = (float(theirs.mean), float(theirs.low), float(theirs.high))
    made = list(judged(maneuver, found.name, found.rule, experiments, mean, found.averaged, limits, found.unit))
    return [unjudged(each, found.unknown) for each in made] if found.rule == "lag" and found.unknown else made


def judged(
    maneuver: str, name: str, rule: Rule, experiments: Sequence[float], mean: float, averaged: float, limits: Limits, unit: str = "1"
) -> Iterator[Verdict]:
    """The criteria of a rule; `experiments` are mean, low and high, `unit` that of all of them."""
    theirs, low, high = experiments
    asked = Verdict(maneuver, f"{name}, mean in the interval", mean, theirs, low, high, mean - theirs, None, PASS, "", unit, unit)
    interval = inside(asked)
    if rule == "gain":
        yield doubted(interval, limits.gain * abs(theirs))
        yield within(maneuver, f"{name}, averaged simulation", averaged, theirs, limits.gain, unit, abs(theirs))
    elif rule == "time":
        yield doubted(interval, limits.time)
        yield within(maneuver, f"{name}, mean", mean, theirs, limits.time, unit)
        yield within(maneuver, f"{name}, averaged simulation", averaged, theirs, limits.averaged_time, unit)
    elif rule == "lag":
        yield coarse(within(maneuver, f"{name}, mean", mean, theirs, limits.lag, unit))
        yield coarse(within(maneuver, f"{name}, averaged simulation", averaged, theirs, limits.lag, unit))
    elif rule == "final":
        yield interval
        yield within(maneuver, f"{name}, averaged simulation", averaged, theirs, limits.final, unit)
    else:
        yield within(maneuver, name, mean, 0.0, limits.fit, unit)


def inside(asked: Verdict) -> Verdict:
    """Whether ours lies in the interval; without one that cannot be said."""
    low, high = asked.low, asked.high
    if low is None or high is None or not (isfinite(low) and isfinite(high)):
        return replace(asked, low=None, high=None, verdict=FAIL, reason=ALONE)
    fits = round(min(low, high) - asked.ours, DIGITS) <= 0.0 and round(asked.ours - max(low, high), DIGITS) <= 0.0
    return replace(asked, verdict=PASS if fits else FAIL)


def doubted(found: Verdict, limit: float) -> Verdict:
    """A verdict by an interval that is so wide on each side that nearly anything passes says so, and whether it passes by that alone."""
    is_wide = found.low is not None and found.high is not None and abs(found.high - found.low) > 2.0 * limit
    is_lenient = found.verdict == PASS and round(abs(found.error) - limit, DIGITS) > 0.0
    return replace(found, reason=LENIENT if is_lenient else WIDE) if is_wide else found


def within(maneuver: str, name: str, ours: float, theirs: float, limit: float, unit: str, over: float | None = None) -> Verdict:
    """Whether the error keeps to its limit: as it is, or as a share of a reference."""
    error = ours - theirs if over is None else (ours - theirs) / over if over else float("nan")
    fits = isfinite(error) and round(abs(error) - limit, DIGITS) <= 0.0
    error_unit = unit if over is None else "1"
    return Verdict(maneuver, name, ours, theirs, None, None, error, limit, PASS if fits else FAIL, "", unit, error_unit)


def coarse(found: Verdict) -> Verdict:
    """A verdict about a lag that keeps to its limit because that is large beside the lag says so."""
    share = abs(found.error / found.theirs) if found.theirs else 0.0
    return replace(found, reason=COARSE.format(100.0 * share)) if found.verdict == PASS and share > SHARE else found


def unjudged(found: Verdict, runs: Sequence[str]) -> Verdict:
    """A verdict about a lag that nobody can read off some of the recorded runs: neither met nor failed."""
    what = f"{', '.join(runs[:3])}{' and others' if len(runs) > 3 else ''}"
    return replace(found, verdict=UNJUDGED, reason=f"{what}: {LATE}")


def overridden(found: Sequence[Verdict], overrides: Sequence[Override]) -> list[Verdict]:
    """The verdicts, those that failed and that a person has judged with his reason; what passed stays so."""
    reasons = {(each.maneuver, each.criterion): each.reason for each in overrides}
    return [
        replace(each, verdict=OVERRIDDEN, reason=reasons[each.maneuver, each.criterion])
        if each.verdict == FAIL and (each.maneuver, each.criterion) in reasons
        else each
        for each in found
    ]
