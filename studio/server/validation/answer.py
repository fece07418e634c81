"""What REST of validations takes and gives."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from studio.scenario.text.patch import Operation
from studio.server.answer import ImportStatus, Problem, Refusal

Task = Literal["look", "calibrate", "validate", "sample"]
FileKind = Literal["log", "mapping", "dbc", "vehicle", "tyre", "project", "other"]


class ProjectRow(BaseModel):
    """A project for the list; one that cannot be read says why."""

    name: str
    title: str
    vehicle: str
    maneuvers: int
    runs: int = Field(description="for calibration and validation together")
    latest: int | None = Field(description="its last iteration")
    valid: bool | None = Field(description="what its last validation said; null without one")
    problem: str | None


class ProjectFile(BaseModel):
    """A file in the folder of a project."""

    name: str
    bytes: int
    kind: FileKind


class ProjectParameter(BaseModel):
    """A single number of the project's vehicle, which may be calibrated."""

    path: str
    title: str
    unit: str
    value: float = Field(description="as the project has it, before any calibration")
    low: float | None = Field(description="the least that the vehicle's file holds possible; null where it says nothing of it")
    high: float | None = Field(description="the greatest")


class ProjectIteration(BaseModel):
    """A step of a project in the run database, without its details."""

    iteration: int
    step: str = Field(description="that of calibration; validation")
    parent: int | None
    created: str
    valid: bool | None = Field(description="of a validation: whether no criterion failed")
    told: str = Field(description="what came out, in a line")
    has_report: bool


class ProjectDetail(BaseModel):
    """A project: its text, what it says, its files, its iterations."""

    name: str
    text: str
    digest: str
    document: dict[str, Any] | None = Field(description="all that it says with defaults; null while it is no project")
    problems: list[Problem]
    files: list[ProjectFile]
    iterations: list[ProjectIteration]
    parameters: list[ProjectParameter] = Field(description="of the vehicle; none while it cannot be read")


class PatchedProject(BaseModel):
    """A project that was changed: the digest of its text, and the patch that takes it back."""

    digest: str
    inverse: list[Operation]


class NewProject(BaseModel):
    """A project to begin."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(min_length=1, max_length=300, description="of its folder")
    title: str | None = Field(None, min_length=1, max_length=120, description="left out, its name")
    vehicle: str = Field("bmw_320i", min_length=1, max_length=300, description="of the catalogue")


class ManeuverKind(BaseModel):
    """A kind of maneuver: what it is fed with, what is judged."""

    name: str
    title: str
    fed: list[str]
    judged: list[str]


class SignalKind(BaseModel):
    """One of our signals."""

    name: str
    unit: str
    meaning: str
    units: list[str] = Field(description="in which it may be recorded")


class CarName(BaseModel):
    """A vehicle of the catalogue."""

    name: str
    title: str


class ValidationKinds(BaseModel):
    """What a project may name."""

    maneuvers: list[ManeuverKind]
    signals: list[SignalKind]
    vehicles: list[CarName]
    endings: list[str] = Field(description="of files that are taken")


class NewJob(BaseModel):
    """Something to do with a project, in a process of its own.

    look: read a log, and what a mapping makes of it; calibrate: one step, or all; validate; sample: drives whose truth is known.
    """

    model_config = ConfigDict(extra="forbid")

    task: Task
    log: str | None = Field(None, max_length=300, description="of look: which file")
    mapping: str | None = Field(None, max_length=300, description="of look: which mapping; left out, that of the project")
    step: str | None = Field(None, max_length=80, description="of calibrate: which step; left out, all in their order")
    afresh: bool = Field(False, description="leave aside what was calibrated before")


class Gap(BaseModel):
    """From when to when nothing was recorded [s]."""

    since: float
    until: float


class SignalFacts(BaseModel):
    """What is known of a recorded signal."""

    name: str
    unit: str
    count: int
    rate: float | None = Field(description="[1/s]")
    gaps: list[Gap]
    since: float | None = Field(description="first sample [s]")
    until: float | None = Field(description="last sample [s]")
    low: float | None
    high: float | None


class Drawn(BaseModel):
    """A signal to be drawn, thinned; extremes are kept."""

    name: str
    unit: str
    time: list[float]
    values: list[float | None]


class Cut(BaseModel):
    """A maneuver that was found in a log."""

    kind: str
    begin: float
    end: float


class Looked(BaseModel):
    """What is in a log."""

    log: str
    recorded: list[SignalFacts]
    mapping: dict[str, Any] | None = Field(description="that was used, as it stands in its file; null without one")
    ours: list[SignalFacts] = Field(description="by the mapping, in SI, on one clock; none without a mapping")
    drawn: list[Drawn]
    cuts: list[Cut]
    hints: list[str] = Field(description="what looks wrong though every signal by itself could be right")
    problem: Refusal | None = Field(description="why the mapping makes nothing of it")


class Kept(BaseModel):
    """The iterations that were kept."""

    iterations: list[int]


class ProjectJob(BaseModel):
    """Something that is being done, or is over, in a process of its own."""

    id: int
    project: str
    task: Task
    status: ImportStatus
    stage: str = Field(description="what is being done; may be waiting for others")
    share: float | None = Field(description="of the work that is done, 0 to 1; null where nobody knows")
    seconds: float = Field(description="since it was asked for, until its end [s]")
    problem: Refusal | None
    looked: Looked | None
    kept: Kept | None


class IterationDetail(BaseModel):
    """A step of a project with all that was kept of it."""

    iteration: int
    project: str
    step: str
    parent: int | None
    created: str
    code_version: str
    document: dict[str, Any]
    changes: dict[str, float] = Field(description="all values found so far, by path")
    result: dict[str, Any] = Field(description="a calibration: estimates, correlations, misfit, warnings; a validation: verdicts, span")


class Course(BaseModel):
    """A judged signal of a maneuver: the zone of the recorded runs, and the simulations."""

    maneuver: str
    runs: list[str]
    signal: str
    unit: str
    over: str
    over_unit: str
    at: list[float | None]
    theirs: list[float | None]
    low: list[float | None]
    high: list[float | None]
    ours: list[float | None]
    averaged: Annotated[list[float | None] | None, Field(description="simulation of the averaged input; null where there is none")]


class Courses(BaseModel):
    """The courses of a validation."""

    interval: str
    courses: list[Course]
