"""A validation project: one YAML file that says which car, which recorded runs, which criteria. Paths in it start from its folder.

title: BMW 320i against its multi-body model
vehicle: bmw_320i                     # of the catalogue, or a vehicle file
mapping: mapping.yaml
confidence: two-sided                 # or one-sided, as the paper has it
maneuvers:
  j_turn_20:
    kind: j_turn
    calibration: [{log: logs/j_turn_01.csv}]
    validation: [{log: logs/j_turn_02.csv}, {log: logs/day_2.csv, begin: 61.5, end: 68}]
calibration:
  parameters: {tyres.front_cornering: {low: 0.5, high: 1.5}, body.yaw_inertia: {low: 1200, high: 2400, prior: 1790, spread: 150}}
overrides:
  - {maneuver: j_turn_20, criterion: "steady yaw_rate, averaged simulation", reason: "the sensor was mounted askew that day"}
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import Field, model_validator

from studio.errors import Problem, ScenarioError, nearest
from studio.kind.settings import Name, number
from studio.kind.settings import Part as Settings
from studio.log import mapping, recording
from studio.log.mapping import Known
from studio.log.recording import Recording
from studio.scenario import catalogue, edit, file
from studio.scenario.catalogue import VehicleModel
from studio.scenario.text.source import Source
from studio.validation import known
from studio.validation.criterion import Limits, Override
from studio.validation.twin import are_twins
from studio.validation.zone import Confidence

SETS = ("calibration", "validation")
SIZE_LIMIT = 1_000_000  # [B] of a project file


class Run(Settings):
    """A run: its log, and from when to when in it [s after its first sample]."""

    log: str = Field(..., min_length=1, title="Log", description="relative to the project")
    begin: float = number(0.0, unit="s", title="Begin", ge=0)
    end: float | None = Field(None, title="End", description="left out: to the end of the log", gt=0, json_schema_extra={"unit": "s"})
    mapping: str | None = Field(None, title="Mapping of this log", description="left out: that of the project")

    @model_validator(mode="after")
    def takes_time(self):
        if self.end is not None and self.end <= self.begin:
            raise ValueError(f"end {self.end:g} s must be later than begin {self.begin:g} s")
        return self

    def beyond(self, length: float) -> tuple[str, float] | None:
        """What of it lies beyond a log of so many seconds: which time, and its value [s].

        Two samples must be left, and a period of the clock more is nothing.
        """
        last = length + recording.PERIOD + 1e-9
        times = {"begin": self.begin + 2 * recording.PERIOD, "end": self.end or 0.0}
        return next(((name, getattr(self, name)) for name, value in times.items() if value > last), None)


class Trial(Settings):
    """A maneuver of the project: what kind it is, and its runs, apart for calibration and validation."""

    kind: str = Field(..., title="Kind of maneuver")
    calibration: list[Run] = Field([], title="Runs to calibrate with")
    validation: list[Run] = Field([], title="Runs to validate with")

    @model_validator(mode="after")
    def has_runs(self):
        if not self.calibration and not self.validation:
            raise ValueError("has no runs: name them under `validation` or `calibration`")
        return self


class Wanted(Settings):
    """A parameter that calibration looks for: between which bounds, and what is known of it beforehand."""

    low: float = Field(..., title="Lowest")
    high: float = Field(..., title="Highest")
    prior: float | None = Field(None, title="Known beforehand", description="with `spread`; left out: nothing is")
    spread: float | None = Field(None, title="Standard deviation of what is known", gt=0)

    @model_validator(mode="after")
    def is_a_range(self):
        if self.low >= self.high:
            raise ValueError(f"low {self.low:g} must be less than high {self.high:g}")
        if (self.prior is None) != (self.spread is None):
            raise ValueError("prior and spread belong together: give both, or none")
        return self


class Calibration(Settings):
    """A step of calibration: what is looked for, with which maneuvers of the project."""

    parameters: dict[str, Wanted] = Field(..., min_length=1, max_length=12, title="Parameters by path")
    maneuvers: list[str] = Field([], title="Maneuvers", description="none named: all that have runs for calibration")


class Project(Settings):
    """All that a project says."""

    title: str = Field(..., min_length=1, max_length=120, title="Title")
    vehicle: str = Field(..., title="Vehicle")
    changes: dict[str, Any] = Field({}, title="Changes of the vehicle by path")
    road: dict[str, float] = Field({}, title="Road: road.friction, road.slope")
    mapping: str | None = Field(None, title="Mapping", description="left out: logs have our names")
    confidence: Confidence = Field("two-sided", title="Confidence")
    criteria: Limits = Field(default_factory=Limits, title="Limits of the criteria")
    maneuvers: dict[Name, Trial] = Field({}, title="Maneuvers", description="none: there is nothing to validate with yet")
    calibration: dict[Name, Calibration] = Field({}, title="Steps of calibration, in their order")
    overrides: list[Override] = Field([], title="What a person judged otherwise")

    @property
    def cuts(self) -> list[tuple[str, Run, str | None]]:
        """The runs that are parts of their logs: where each stands, and by which mapping it is read."""
        sets = [(f"maneuvers.{name}.{kind}", getattr(each, kind)) for name, each in self.maneuvers.items() for kind in SETS]
        runs = [(f"{where}.{i}", run) for where, found in sets for i, run in enumerate(found)]
        return [(where, run, run.mapping or self.mapping) for where, run in runs if run.begin or run.end is not None]


@dataclass(frozen=True)
class Loaded:
    """A project with its vehicle and its runs: by maneuver, to calibrate and to validate with."""

    project: Project
    path: Path
    model: VehicleModel
    calibration: dict[str, list[Recording]] = field(default_factory=dict)
    validation: dict[str, list[Recording]] = field(default_factory=dict)

    @property
    def document(self) -> dict[str, Any]:
        """The project as plain data."""
        return self.project.model_dump(mode="json")


def read(path: Path) -> Project:
    """What a project file says; raises ScenarioError with everything that is wrong, line by line."""
    return of_text(file.mapping(file.content(path, "project", SIZE_LIMIT), path.name, "project"))


def of_text(found: Source) -> Project:
    """The project that stands in a text; raises ScenarioError."""
    made = file.model(found, Project, "project")
    with file.placed(found, found.where):
        names(made, found.where)
    return made


def names(made: Project, where: str) -> None:
    """Every name in a project must exist; raises ScenarioError."""
    kinds = known.maneuvers()
    found = [
        Problem(f"{where}: maneuvers.{name}.kind", "is no maneuver", each.kind, ", ".join(kinds), nearest(each.kind, kinds))
        for name, each in made.maneuvers.items()
        if each.kind not in kinds
    ]
    asked = [
        (f"{where}: calibration.{step}.maneuvers.{i}", name)
        for step, each in made.calibration.items()
        for i, name in enumerate(each.maneuvers)
    ]
    asked += [(f"{where}: overrides.{i}.maneuver", each.maneuver) for i, each in enumerate(made.overrides)]
    found += [
        Problem(place, "is no maneuver of this project", name, remedy=nearest(name, made.maneuvers))
        for place, name in asked
        if name not in made.maneuvers
    ]
    if found:
        raise refused(where, found)


def load(path: Path) -> Loaded:
    """A project with its logs read, mapped, cut, and looked at: nothing of it is used when one run is no good. Raises StudioError."""
    made = read(path)
    model = catalogue.find_vehicle(made.vehicle, made.changes, folder=path.parent)
    check_parameters(made.calibration, model, path.name)
    logs = Logs(path.parent, made.mapping)
    calibration = {name: logs.runs(each.calibration, each.kind) for name, each in made.maneuvers.items() if each.calibration}
    validation = {name: logs.runs(each.validation, each.kind) for name, each in made.maneuvers.items() if each.validation}
    apart(calibration, validation)
    return Loaded(made, path, model, calibration, validation)


def check_parameters(steps: Mapping[str, Calibration], model: VehicleModel, where: str) -> None:
    """What is calibrated must be single numbers of the vehicle; raises ScenarioError."""
    full, allowed = model.values.model_dump(), numbers(model)
    found = [
        Problem(f"calibration.{step}.parameters.{name}", "is no single number of the vehicle", remedy=edit.nearest_path(full, name))
        for step, each in steps.items()
        for name in each.parameters
        if name not in allowed
    ]
    if found:
        raise refused(where, found)


def numbers(model: VehicleModel) -> dict[str, float]:
    """The single numbers of a vehicle by path, in the schema's units: what may be calibrated."""
    return {path: value for path, value in edit.flatten(model.values.model_dump()).items() if isinstance(value, float)}


@dataclass
class Logs:
    """The logs of a project, each read once."""

    folder: Path
    mapping: str | None
    read: dict[tuple[str, str | None], Recording] = field(default_factory=dict)

    def runs(self, asked: list[Run], kind: str) -> list[Recording]:
        """The runs, cut; raises ScenarioError."""
        found = [self.run(each) for each in asked]
        for each in found:
            known.check(each, known.find(kind))
        return found

    def run(self, asked: Run) -> Recording:
        """One run."""
        by = asked.mapping or self.mapping
        if (asked.log, by) not in self.read:
            self.read[asked.log, by] = recording.load(self.folder / asked.log, self.known(by))
        whole = self.read[asked.log, by]
        check_cuts([(asked.log, asked, float(whole.time[-1]))])
        if asked.begin == 0.0 and asked.end is None:
            return whole
        return whole.between(asked.begin, asked.end if asked.end is not None else float(whole.time[-1]))

    def known(self, name: str | None) -> Known | None:
        """A mapping by its name."""
        return mapping.read(self.folder / name) if name else None


def check_cuts(asked: Iterable[tuple[str, Run, float]]) -> None:
    """Refuses runs that begin or end beyond their log: where each stands, and how long its log is [s]; raises ScenarioError."""
    remedy = "begin and end count from the first sample; leave the end out for all that was recorded"
    found = [
        Problem(f"{where}.{late[0]}", f"is beyond {run.log}", f"{late[1]:g} s", f"0 to {length:.2f} s", remedy)
        for where, run, length in asked
        if (late := run.beyond(length))
    ]
    if found:
        raise ScenarioError("A run is cut from more than was recorded.", found)


def apart(calibration: dict[str, list[Recording]], validation: dict[str, list[Recording]]) -> None:
    """Refuses runs in both sets, whatever they are called and were rounded to, and cuts of one log that overlap; raises ScenarioError."""
    used = [each for runs in calibration.values() for each in runs]
    digests = {each.digest: each for each in used}
    found = [
        Problem(
            f"maneuvers.{name}.validation[{i}]",
            "was used for calibration",
            each.name,
            remedy="validate with another run, or calibrate without it",
        )
        for name, runs in validation.items()
        for i, each in enumerate(runs)
        if each.digest in digests or any(overlaps(each, other) or are_twins(each, other) for other in used)
    ]
    if found:
        raise ScenarioError("A run that calibrates cannot validate: it would prove what it was fitted to.", found)


def overlaps(a: Recording, b: Recording) -> bool:
    """Whether two cuts of one log have a time in common."""
    return a.name == b.name and a.start < b.start + b.time[-1] and b.start < a.start + a.time[-1] and shares(a, b)


def shares(a: Recording, b: Recording) -> bool:
    """Whether they hold the same samples there: logs in different folders may have one name."""
    since = max(a.start, b.start)
    one, other = (each.between(since - each.start, min(a.start + a.time[-1], b.start + b.time[-1]) - each.start) for each in (a, b))
    return one.time.size == other.time.size and one.digest == other.digest


def refused(name: str, problems: list[Problem]) -> ScenarioError:
    """What is told of a project that is none."""
    return ScenarioError(f"{name} is not a valid project.", problems)
