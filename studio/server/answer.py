"""What REST takes and gives, as pydantic models: OpenAPI and the page's types are made from them."""

import json
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

Pace = float | Literal["fast"]
Better = Literal["a", "b", "same"] | None
Goal = Literal["higher", "lower"] | None


def is_text(values: dict[str, Any]) -> dict[str, Any]:
    """Refuses half characters (lone surrogates): JSON can carry them, a scenario cannot."""
    try:
        json.dumps(values, ensure_ascii=False).encode()
    except UnicodeEncodeError as error:
        raise ValueError(f"holds text that is no Unicode: {error.reason}") from None
    return values


ChangesByPath = Annotated[dict[str, Any], AfterValidator(is_text)]


class Info(BaseModel):
    """About this server."""

    version: str
    code_version: str
    db: str
    scenarios_folder: str


class Problem(BaseModel):
    """One thing that is wrong with what was asked."""

    where: str
    what: str
    value: str
    allowed: str
    remedy: str


class Refusal(BaseModel):
    """The body of every answer with a status of 400 or more."""

    message: str
    problems: list[Problem]


class ScenarioRow(BaseModel):
    """A scenario in the list; `problem` says why it cannot be run."""

    id: str
    title: str
    description: str
    vehicles: int
    duration_s: float
    attribution: str
    problem: str | None


class ScenarioDetail(BaseModel):
    """A scenario with its full document and the schema of its file."""

    model_config = ConfigDict(serialize_by_alias=True)

    id: str
    title: str
    description: str
    attribution: str
    scenario_hash: str
    document: dict[str, Any]
    form: dict[str, Any] = Field(alias="schema")


class Changes(BaseModel):
    """Changes of a scenario by path."""

    model_config = ConfigDict(extra="forbid")

    set: ChangesByPath = {}


class Check(BaseModel):
    """Whether a changed scenario is valid, and how it reads then."""

    ok: bool
    problems: list[Problem]
    document: dict[str, Any]


class Application(BaseModel):
    """A registered application and the schema of its parameters."""

    name: str
    title: str
    description: str
    parameters: dict[str, Any]


class Metric(BaseModel):
    """A metric of a run; `goal` says which direction is better."""

    value: float | None
    unit: str
    goal: Goal


class Run(BaseModel):
    """A run in the database; `parameters` are those that were set, by path."""

    run: int
    scenario: str
    scenario_hash: str
    parent: int | None
    seed: int
    status: Literal["running", "done", "failed", "stopped", "killed"]
    error: str | None
    state_hash: str | None
    code_version: str
    created: str
    sim_time_s: float | None
    wall_time_s: float | None
    parameters: dict[str, Any]
    unmet: list[str]
    metrics: dict[str, Metric]


class Channel(BaseModel):
    """A recorded quantity of a vehicle."""

    name: str
    unit: str
    label: str


class Event(BaseModel):
    """Something that happened in a run."""

    time: float
    text: str
    vehicle: str


class RunDetail(Run):
    """A run with its scenario, what can be plotted of it, and what happened."""

    document: dict[str, Any]
    channels: list[Channel]
    events: list[Event]


class NewRun(BaseModel):
    """A run to start."""

    model_config = ConfigDict(extra="forbid")

    scenario: str
    set: ChangesByPath = {}
    seed: int | None = None
    parent: int | None = None


class NewLiveRun(NewRun):
    """A live run to start."""

    pace: Pace = 1.0
    paused: bool = False


class Started(BaseModel):
    """The number of a run that has begun."""

    run: int


class Live(BaseModel):
    """A live run now."""

    run: int
    scenario: str
    status: Literal["starting", "running", "paused", "done", "stopped", "failed"]
    time: float
    pace: Pace
    duration_s: float


class NewPace(BaseModel):
    """Simulated over real seconds, or "fast" for as fast as possible."""

    model_config = ConfigDict(extra="forbid")

    pace: Pace


class TraceColumn(BaseModel):
    """Values of one channel; null where there is none."""

    unit: str
    values: list[float | None]


class Trace(BaseModel):
    """Channels of a run over one time base."""

    time: list[float]
    channels: dict[str, TraceColumn]


class ParameterDifference(BaseModel):
    """A parameter that differs between two runs."""

    path: str
    a: Any
    b: Any
    unit: str


class MetricDifference(BaseModel):
    """A metric of two runs; `difference` is b - a."""

    name: str
    unit: str
    goal: Goal
    a: float | None
    b: float | None
    difference: float | None
    relative: float | None
    better: Better


class Comparison(BaseModel):
    """Two runs side by side."""

    a: Run
    b: Run
    parameters: list[ParameterDifference]
    metrics: list[MetricDifference]


class OnStage(BaseModel):
    """What the scene is to show: a scenario as it would start, or a live run."""

    model_config = ConfigDict(extra="forbid")

    scenario: str | None = None
    set: ChangesByPath = {}
    run: int | None = None


class SceneVehicle(BaseModel):
    """A vehicle in the scene."""

    name: str
    index: int
    color: str


class SceneCast(BaseModel):
    """Who is to be seen, and whose map it is."""

    vehicles: list[SceneVehicle]
    attribution: str
