"""Validation: every run of the validation set replayed, every maneuver judged by its criteria, the span that was covered.

result = validate(load(path))
result.verdicts, result.span, result.comparisons
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import isfinite
from types import ModuleType
from typing import Any

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.log.quantity import QUANTITIES
from studio.log.recording import Recording
from studio.log.smooth import smooth
from studio.scenario.vehicle import Span
from studio.validation import known, outlier, replay, span
from studio.validation.criterion import FAIL, PASS, Measure, Verdict, overridden, verdicts
from studio.validation.marks import Marks
from studio.validation.project import Loaded
from studio.validation.zone import WORDS, Confidence, Zone, zone

UNKNOWN = "two runs at least must have recorded the judged part of this signal: see which one breaks off, and cut or replace it"


@dataclass(frozen=True)
class Comparison:
    """A maneuver: its recorded runs, their simulations, and the simulation of the averaged input, with the marks of each."""

    name: str
    kind: str
    theirs: list[Recording]
    ours: list[Recording]
    averaged: Recording
    marks: list[Marks]

    @property
    def module(self) -> ModuleType:
        """The maneuver's file."""
        return known.find(self.kind)

    def aligned(self, runs: Sequence[Recording], signal: str) -> tuple[np.ndarray, np.ndarray]:
        """Times after the reference [s] that all runs have, and the smoothed signal of each on them [run, time]."""
        return aligned(runs, self.marks, signal)

    def of_average(self, signal: str) -> tuple[np.ndarray, np.ndarray]:
        """Times after the reference [s] and the smoothed signal of the simulation of the averaged input."""
        run = self.averaged
        return run.time - average_marks(self).reference, smooth(run.time, run[signal])

    def zone(self, signal: str, confidence: Confidence) -> tuple[np.ndarray, Zone, np.ndarray]:
        """Times after the reference [s], the experimental data zone, and the mean of the simulations."""
        time, values = self.aligned(self.theirs, signal)
        return time, zone(values, confidence), zone(self.aligned(self.ours, signal)[1]).mean


@dataclass(frozen=True)
class Result:
    """What a validation found; `hints` tell what a person should look at, though no verdict changes by it."""

    verdicts: list[Verdict]
    span: Span | None
    spans: dict[str, Span]
    comparisons: list[Comparison]
    confidence: Confidence
    hints: list[str] = field(default_factory=list)

    @property
    def unjudged(self) -> dict[str, list[str]]:
        """What nobody judged, maneuver by maneuver."""
        return {each.name: known.unjudged(each.module, each.theirs) for each in self.comparisons}

    @property
    def doubtful(self) -> int:
        """How many criteria are met by nothing but an interval that is wider than their limit."""
        return sum(each.is_doubtful for each in self.verdicts)

    @property
    def is_valid(self) -> bool:
        """Whether no criterion failed, but for those that a person has overridden."""
        return bool(self.verdicts) and all(each.verdict != FAIL for each in self.verdicts)

    def as_json(self) -> dict[str, Any]:
        """Plain data: verdicts, span, interval."""
        spans = {name: each.model_dump() for name, each in self.spans.items()}
        whole = {"whole": self.span.model_dump() if self.span else None, "maneuvers": spans}
        return {
            "verdicts": [each.as_json() for each in self.verdicts],
            "span": whole,
            "interval": WORDS[self.confidence],
            "valid": self.is_valid,
            "doubtful": self.doubtful,
            "hints": self.hints,
            "unjudged": self.unjudged,
        }


def validate(loaded: Loaded, progress: Callable[[float], None] = lambda share: None) -> Result:
    """Replays and judges everything; raises ScenarioError when there is nothing to validate with, or a run cannot be replayed."""
    if not loaded.validation:
        problem = Problem("maneuvers", "have no runs for validation", remedy="name runs under `validation` that calibration does not use")
        raise ScenarioError(f"{loaded.path.name} has nothing to validate with.", [problem])
    compared = comparisons(loaded, loaded.validation, progress)
    asked = {each.name: quantities(each) for each in compared}
    found = [verdict for each in compared for verdict in judged(each, asked[each.name], loaded)]
    found = overridden(found, loaded.project.overrides)
    limits = loaded.project.criteria
    hints = [hint for each in compared if each.module.REPEATS for hint in outlier.hints(each.name, each.theirs, asked[each.name], limits)]
    met = [each for each in compared if all(verdict.verdict != FAIL for verdict in found if verdict.maneuver == each.name)]
    spans = {each.name: found_span for each in met if (found_span := span.span(each.theirs))}
    hints += [f"{each.maneuver}, {each.criterion}: {each.reason}" for each in found if each.is_coarse]
    return Result(found, span.span(run for each in met for run in each.theirs), spans, compared, loaded.project.confidence, hints)


def comparisons(
    loaded: Loaded, runs: dict[str, list[Recording]], progress: Callable[[float], None] = lambda share: None
) -> list[Comparison]:
    """All maneuvers with their replays; everything that drives does so side by side."""
    kinds = {name: known.find(loaded.project.maneuvers[name].kind) for name in runs}
    marks = {name: [kinds[name].marks(run) for run in each] for name, each in runs.items()}
    asked = [(name, run) for name, each in runs.items() for run in [*each, average(kinds[name], each, marks[name])]]
    orders = [replay.order(loaded.model, run, kinds[name], loaded.project.road) for name, run in asked]
    made = [replay.simulated(run, outcome) for (_, run), outcome in zip(asked, replay.driven(orders, progress), strict=True)]
    found, at = [], 0
    for name, each in runs.items():
        ours, at = made[at : at + len(each) + 1], at + len(each) + 1
        found.append(Comparison(name, loaded.project.maneuvers[name].kind, each, ours[:-1], ours[-1], marks[name]))
    return found


# -- one maneuver ----------------------------------------------------------------------------------------


def quantities(compared: Comparison) -> list[Measure]:
    """All quantities of a maneuver: of every run alone, and of runs that are looked at together."""
    module = compared.module
    together = module.compare(compared.theirs, compared.ours, compared.averaged) if hasattr(module, "compare") else ()
    return [*measured(compared), *together]


def judged(compared: Comparison, asked: Sequence[Measure], loaded: Loaded) -> list[Verdict]:
    """All criteria of a maneuver."""
    limits, confidence = loaded.project.criteria, loaded.project.confidence
    found = [verdict for each in asked for verdict in verdicts(compared.name, each, limits, confidence)]
    return [*found, *zones(compared, limits.zone, confidence)]


def measured(compared: Comparison) -> list[Measure]:
    """What is measured of every run alone; raises ScenarioError where runs do not have the same parts."""
    module, last = compared.module, average_marks(compared)
    theirs = [module.measures(run, at) for run, at in zip(compared.theirs, compared.marks, strict=True)]
    ours = [module.measures(run, at) for run, at in zip(compared.ours, compared.marks, strict=True)]
    averaged = module.measures(compared.averaged, last)
    runs = tuple(outlier.called(run) for run in compared.theirs)
    shared = [name for name in theirs[0] if all(name in each for each in (*theirs, averaged))]
    if theirs[0] and not shared:
        problem = Problem(
            f"maneuvers.{compared.name}", "has runs that have nothing in common", remedy="cut them so that they hold the same gears"
        )
        raise ScenarioError(f"The runs of {compared.name} cannot be compared.", [problem])
    return [
        Measure(name, rule, values(theirs, name), values(ours, name), float(averaged[name][0]), unit, runs)
        for name, (_, rule, unit) in theirs[0].items()
        if name in shared
    ]


def values(runs: Sequence[dict], name: str) -> np.ndarray:
    """One quantity of all runs."""
    return np.array([each[name][0] for each in runs])


def zones(compared: Comparison, least: float, confidence: Confidence) -> list[Verdict]:
    """How much of the judged time, or distance, the mean of the simulations lies inside the data zone."""
    if len(compared.theirs) < 2 or not compared.module.REPEATS:
        return []
    shares = {f"{name} in the data zone": inside(compared, name, confidence) for name in compared.module.ZONES}
    if hasattr(compared.module, "share"):
        found = compared.module.share(compared.theirs, compared.ours, confidence)
        shares |= {f"{name} in the data zone": each for name, each in found.items()}
    return [zoned(compared.name, name, share, least) for name, share in shares.items()]


def zoned(maneuver: str, name: str, share: float, least: float) -> Verdict:
    """The verdict about a share [1] of the judged part; of a part that was not recorded there is none."""
    passed, reason = share >= least, "" if isfinite(share) else UNKNOWN
    return Verdict(maneuver, name, share, 1.0, None, None, share - 1.0, least - 1.0, PASS if passed else FAIL, reason)


def inside(compared: Comparison, name: str, confidence: Confidence) -> float:
    """Share of the judged time [1] in which the mean of the simulations lies inside the zone."""
    time, around, mean = compared.zone(name, confidence)
    since = np.mean([each.since - each.reference for each in compared.marks])
    until = np.mean([each.until - each.reference for each in compared.marks])
    judged = (time >= since) & (time <= until) & np.isfinite(around.low) & np.isfinite(mean)
    return float(around.holds(mean)[judged].mean()) if judged.any() else float("nan")


# -- aligning --------------------------------------------------------------------------------------------


def aligned(runs: Sequence[Recording], marks: Sequence[Marks], name: str, smoothed: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """A signal of runs whose references lie on each other, over the time that all of them have; raises ScenarioError without one.

    What is aligned by itself, as the second half wave of a double lane change, follows the first where it does so on average.
    """
    references = np.array([[reference for reference, _ in each.anchors] for each in marks])
    after = (references - references[:, :1]).mean(axis=0)
    ends = np.array([[end for _, end in each.anchors] for each in marks]) - references[:, :1]
    since = float(-references[:, 0].min())
    until = float(min(run.time[-1] - each for run, each in zip(runs, references[:, -1], strict=True)) + after[-1])
    if until - since < 0.1:
        what, remedy = "do not overlap when they are aligned", "cut them to the same part of the maneuver"
        raise ScenarioError("The runs do not overlap.", [Problem(", ".join(run.name for run in runs[:4]), what, remedy=remedy)])
    time = since + np.arange(int((until - since) / float(runs[0].time[1]) + 1e-6) + 1) * float(runs[0].time[1])
    part = np.searchsorted(ends.mean(axis=0)[:-1], time, side="right")
    return time, np.array([on(run, each[part] + time - after[part], name, smoothed) for run, each in zip(runs, references, strict=True)])


def on(run: Recording, time: np.ndarray, name: str, smoothed: bool) -> np.ndarray:
    """A signal of a run at other times; the gear of the moment before, and not something between two gears."""
    values = smooth(run.time, run[name]) if smoothed else run[name]
    if name == "gear":
        return values[np.clip(np.searchsorted(run.time, time + 1e-9, side="right") - 1, 0, run.time.size - 1)]
    return np.interp(time, run.time, values)


def average(module: ModuleType, runs: Sequence[Recording], marks: Sequence[Marks]) -> Recording:
    """The averaged run: every signal that all runs have, aligned and averaged; of a gear the one that most are in.

    Of a single run, and of runs that do not repeat each other, it is the first.
    """
    if len(runs) == 1 or not module.REPEATS:
        return runs[0]
    names = [name for name in QUANTITIES if all(name in run.signals for run in runs)]
    found = {name: aligned(runs, marks, name, smoothed=False) for name in names}
    signals = {name: np.median(values, axis=0).round() if name == "gear" else zone(values).mean for name, (_, values) in found.items()}
    time = next(iter(found.values()))[0]
    return Recording("the averaged input", time - time[0], signals)


def average_marks(compared: Comparison) -> Marks:
    """The marks of the averaged run: read off its own inputs, which are those of the simulation of it."""
    run = average(compared.module, compared.theirs, compared.marks)
    return compared.module.marks(run)
