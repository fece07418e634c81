"""What REST takes and gives, as pydantic models: OpenAPI and the page's types are made from them."""

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from studio.execution.happening import Happening
from studio.kind import registry
from studio.kind.given import given
from studio.kind.preset import presets
from studio.scenario.text.patch import Operation, is_text
from studio.store.runs import LARGEST_RUN

Pace = float | Literal["fast"]
Better = Literal["a", "b", "same"] | None
Goal = Literal["higher", "lower"] | None
Over = Literal["done", "stopped", "failed", "cancelled"]
LiveStatus = Literal["waiting", "starting", "running", "paused", Over]
RunStatus = Literal["waiting", "running", "done", "failed", "stopped", "killed", "cancelled"]
VerdictWord = Literal["open", "candidate", "discarded"]
ImportStatus = Literal["running", "done", "failed", "cancelled"]


ChangesByPath = Annotated[dict[str, Any], AfterValidator(is_text)]


class Compiling(BaseModel):
    """How far the first compilation on this machine is."""

    done: int = Field(description="functions that are compiled")
    of: int = Field(description="functions in all")
    seconds: float = Field(description="since it began [s]")
    latest: str = Field(description="the function that was compiled last")
    since: float = Field(description="[s] since that was done, or since it began")


class Info(BaseModel):
    """About this server."""

    version: str
    code_version: str
    db: str
    scenarios_folder: str
    compiling: Compiling | None = Field(description="what is compiled before the first run; null when that is done")


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


FIRST_STAGE, MOST_STAGES = 1, 8  # pages that show scenes of their own
MOST_SAID = 10_000  # runs of which something is said at once
REFUSALS: dict[int | str, dict[str, Any]] = {
    400: {"model": Refusal, "description": "The body is no JSON."},
    401: {
        "model": Refusal,
        "description": "The server is open to a network, and the header `Authorization: Bearer TOKEN` is not its token.",
    },
    403: {"model": Refusal, "description": "Another origin or name, or something that may be read only."},
    404: {"model": Refusal, "description": "There is no such thing."},
    405: {"model": Refusal, "description": "The address has no such method."},
    409: {"model": Refusal, "description": "It is over, or not as the request expects it."},
    412: {"model": Refusal, "description": "It has changed meanwhile."},
    413: {"model": Refusal, "description": "It is too much."},
    422: {"model": Refusal, "description": "Something in it is wrong."},
    500: {"model": Refusal, "description": "A mistake of the studio."},
    503: {"model": Refusal, "description": "The database cannot be used now, or is damaged."},
}


class ScenarioRow(BaseModel):
    """A scenario in the list; `problem` says why it cannot be run."""

    id: str
    file: str = Field(description="name of its file in the folder of scenarios")
    map: str = Field(description="the map file that it names; empty when it cannot be read")
    changed: str = Field(description="when the file was changed last (ISO 8601, UTC)")
    digest: str = Field(description="of its text, as in its ETag; empty when it cannot be read")
    sealed: bool = Field(description="whether it may be read only")
    runs: int | None = Field(description="how many runs of it are in the database; null when that cannot be read")
    title: str
    description: str
    vehicles: int
    duration_s: float
    attribution: str
    problem: str | None


class ScenarioDetail(BaseModel):
    """A scenario with its full document, what of it stands in the file, and the schema of its file."""

    model_config = ConfigDict(serialize_by_alias=True)

    id: str
    title: str
    description: str
    attribution: str
    scenario_hash: str
    digest: str = Field(description="of the file's text, as in its ETag")
    document: dict[str, Any] = Field(description="with all defaults")
    given: dict[str, Any] = Field(description="as it stands in the file, in the present version of the format: without defaults")
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


class Patched(BaseModel):
    """A scenario after a patch: the patch that takes it back, the digest of its text (its ETag), and the document as it stands in it."""

    inverse: list[Operation]
    digest: str
    document: dict[str, Any]


class KeptScenario(BaseModel):
    """A scenario that was written, and the digest of its text (its ETag)."""

    scenario: str
    digest: str


class Given(BaseModel):
    """A number that a kind gives; `size` of them under one name."""

    name: str
    unit: str
    size: int
    meaning: str


class Preset(BaseModel):
    """Settings of a kind that belong together, by the name that a scenario gives as `preset`."""

    name: str
    title: str
    source: str
    values: dict[str, Any]


class Kind(BaseModel):
    """A kind that can be named in a scenario, and what may be set of it."""

    sort: str
    name: str
    title: str
    source: str = Field(description="where it comes from: built in, a package, or its file")
    description: str = Field(description="what its file says about it")
    settings: dict[str, Any] | None = Field(
        description="JSON schema of its settings, or of an application's parameters; null when it has none"
    )
    gives: list[Given]
    presets: list[Preset]


class Slip(BaseModel):
    """What Python cannot read in a file."""

    line: int = Field(description="from 1 on")
    column: int = Field(description="from 1 on")
    what: str


class Manuscript(BaseModel):
    """The file of a kind, as it stands on the disk now. It is only read: what a browser sends is never run."""

    file: str = Field(description="where it lies on the server's machine; empty of a kind in no file")
    text: str
    loaded: bool = Field(description="whether that is the text that the studio has loaded")
    missing: str = Field(description="why the file cannot be read, and the text is what was loaded; empty when it can")
    slips: list[Slip]
    own: bool = Field(description="whether it is a user's own file, and not one of the studio's")
    refused: str = Field(description="of an application: why what stands there is not used, and the version before is; empty when it is")


class Draft(BaseModel):
    """The text of an application, as somebody is writing it. It is parsed, and never run."""

    text: str = Field(max_length=400_000)


class Proved(BaseModel):
    """Something wrong in a text, found by reading alone."""

    line: int = Field(description="from 1 on")
    column: int = Field(description="from 1 on")
    what: str
    remedy: str


class Proof(BaseModel):
    """Everything that is found wrong in a text, in the order of its lines."""

    slips: list[Proved]


class Word(BaseModel):
    """What an application may name: a field, and what stands below it."""

    name: str
    unit: str
    meaning: str
    is_row: bool = Field(description="whether it is a row: `target[0]`")
    words: list["Word"]


class PortWords(BaseModel):
    """A port that `Sees` or `Does` may have, with the kind that it is about."""

    type: str
    kind: str = Field(description="the sensor or message; empty for a port that is about none")
    seen: bool = Field(description="whether it stands in Sees, and not in Does")
    meaning: str
    words: list[Word]


class FunctionWords(BaseModel):
    """A function that the contract gives."""

    name: str
    arguments: list[str]
    meaning: str


class Vocabulary(BaseModel):
    """Everything that an application may name, taken from the contract and the kinds that are there."""

    ports: list[PortWords]
    functions: list[FunctionWords]
    names: list[str] = Field(description="all names of the contract")


class Start(BaseModel):
    """A text to begin an application with."""

    name: str
    title: str
    explanation: str
    text: str


class BrokenKind(BaseModel):
    """A file that gave no kind, and why."""

    name: str
    file: str
    what: str = Field(description="in one line")
    traceback: str


class Kinds(BaseModel):
    """All kinds, sort by sort, and the files that are broken."""

    kinds: list[Kind]
    broken: list[BrokenKind]


def kind(known: registry.Kind) -> Kind:
    """What the page needs to know about one."""
    return Kind(
        sort=known.sort,
        name=known.name,
        title=known.title,
        source=known.source,
        description=known.explanation,
        settings=known.settings.model_json_schema() if known.settings else None,
        gives=[Given(name=each.name, unit=each.unit, size=each.size, meaning=each.meaning) for each in given(known)],
        presets=[Preset(name=name, **each._asdict()) for name, each in presets(known.module).items()],
    )


def broken_kind(broken: registry.Broken) -> BrokenKind:
    """Why a file gave none."""
    return BrokenKind(name=broken.name, file=broken.file, what=broken.what, traceback=str(broken.error))


class Quantity(BaseModel):
    """What can be recorded of a vehicle."""

    name: str
    unit: str
    label: str
    meaning: str


class Measure(BaseModel):
    """What a run is measured by; `goal` says which direction is better."""

    name: str
    title: str
    unit: str
    goal: Goal
    explanation: str


class Glossary(BaseModel):
    """The words of the results: what channels and metrics are called, their units, and what they mean."""

    channels: list[Quantity]
    metrics: list[Measure]
    alike: float = Field(description="[1] of the greater value: metrics of two runs that differ by less are the same")


class Metric(BaseModel):
    """A measure of a run; `goal` says which direction is better."""

    value: float | None
    unit: str
    goal: Goal
    subject: list[str] = Field(description="the vehicles that it is about; empty when it is about all of them")
    time: float | None = Field(description="[s] when it was so; null when it is about the whole run")
    kind: str = Field(description="the metric; empty in runs that were saved before measures had names of their own")
    about: str = Field(description="subject and time in words")


class Stretch(BaseModel):
    """The measures of a stretch of a run, by name."""

    begin: float = Field(description="[s] the first sample in it")
    end: float = Field(description="[s] the last sample in it")
    metrics: dict[str, Metric]


class Aggregate(BaseModel):
    """One number about the samples of a channel."""

    kind: Literal["min", "max", "mean", "p5", "p95", "at_event"]
    value: float | None = Field(description="in the unit of the channel; null where no sample is a number, or without an event")
    time: float | None = Field(description="[s] when it was, of what was at a time")
    meaning: str = Field(description="how it is made, in words")


class Aggregated(BaseModel):
    """A channel of a run in a few numbers."""

    run: int
    unit: str
    begin: float = Field(description="[s] the first sample in it")
    end: float = Field(description="[s] the last sample in it")
    samples: int = Field(description="how many of them are numbers")
    moment: float | None = Field(description="[s] when the event was")
    aggregates: list[Aggregate]


class Cell(BaseModel):
    """A channel of one run in one number."""

    run: int
    value: float | None = Field(description="in the unit of the channel; null where there is none")
    unit: str
    time: float | None = Field(description="[s] when it was, of what was at a time")
    why: str = Field(description="why there is none; empty where there is one")


class ChannelColumn(BaseModel):
    """A channel in one number, run by run, as far as that has been worked out."""

    name: str = Field(description="what it is called in exports and by the command")
    channel: str
    kind: Literal["min", "max", "mean", "p5", "p95", "at_event"]
    begin: float | None = Field(description="[s] from then on; null from the beginning")
    end: float | None = Field(description="[s] until then; null to the end")
    event: str = Field(description="the kind of events at whose first it is; empty for other numbers")
    meaning: str = Field(description="how the number is made, in words")
    cells: list[Cell] = Field(description="newest run first")
    lacking: int = Field(description="runs that are over and have not been worked out")


class Run(BaseModel):
    """A run in the database; `parameters` are those that were set, by path."""

    run: int
    scenario: str
    scenario_hash: str
    parent: int | None
    seed: int
    status: RunStatus
    error: str | None
    state_hash: str | None
    code_version: str
    created: str
    sim_time_s: float | None
    wall_time_s: float | None = Field(description="[s] of real time that it took, without its pauses")
    parameters: dict[str, Any]
    unmet: list[str]
    metrics: dict[str, Metric]
    verdict: VerdictWord = Field(description="the last that was given")
    reason: str = Field(description="of that verdict; empty when none was given")
    name: str = Field(description="that somebody gave it; empty when it has none")
    tags: list[str]
    note: str = Field(description="what somebody has written about it: text with a little of Markdown, and times such as @12.3 s")


class NewVerdict(BaseModel):
    """What somebody decides about a run that is over."""

    model_config = ConfigDict(extra="forbid")

    verdict: VerdictWord
    reason: str = Field(description="why, in one line")
    who: str = Field("", description="empty for the user of the machine that the server runs on")


class Verdict(BaseModel):
    """What was decided about a run, why, by whom and when."""

    verdict: VerdictWord
    reason: str
    who: str
    when: str = Field(description="UTC (ISO 8601)")


class GivenVerdict(BaseModel):
    """A verdict on one of many runs."""

    model_config = ConfigDict(extra="forbid")

    run: int = Field(ge=1, le=LARGEST_RUN)
    verdict: VerdictWord
    reason: str = Field(description="why, in one line")


class ManyVerdicts(BaseModel):
    """What somebody decides about many runs at once."""

    model_config = ConfigDict(extra="forbid")

    verdicts: list[GivenVerdict] = Field(min_length=1, max_length=MOST_SAID)
    who: str = Field("", description="empty for the user of the machine that the server runs on")


class Retag(BaseModel):
    """Tags that are put on a run, and such that are taken off it."""

    model_config = ConfigDict(extra="forbid")

    run: int = Field(ge=1, le=LARGEST_RUN)
    add: list[str] = []
    remove: list[str] = []


class ManyTags(BaseModel):
    """Changes of the tags of many runs."""

    model_config = ConfigDict(extra="forbid")

    tags: list[Retag] = Field(max_length=MOST_SAID)


class Remark(BaseModel):
    """What a run is called, what it is found by, and a text about it."""

    model_config = ConfigDict(extra="forbid")

    name: str = ""
    tags: list[str] = []
    note: str = ""


class ListedRun(Run):
    """A run among others, with what they can be told apart by."""

    settings: dict[str, Any] = Field(
        description="the value of every parameter that one of the listed runs has set, as this one had it; none that it has not"
    )


class Channel(BaseModel):
    """A recorded quantity of a vehicle."""

    name: str
    unit: str
    label: str


class Number(BaseModel):
    """A number with its unit."""

    value: float
    unit: str


class Event(BaseModel):
    """Something that happened in a run: of which kind, to which units, where, its numbers; and all of it in words."""

    time: float = Field(description="[s]")
    text: str
    vehicle: str = Field(description="the first of the units; empty when it is about none")
    kind: str = Field(description="empty in runs that were saved before events had kinds")
    units: list[str]
    x: float | None = Field(description="[m] to the east")
    y: float | None = Field(description="[m] to the north")
    numbers: dict[str, Number]
    words: dict[str, str] = Field(description="the entry of the script that begins, for instance")


def event(happened: Happening) -> Event:
    """One of a run."""
    return Event.model_validate(happened.as_json())


class Lost(BaseModel):
    """A message that did not come."""

    time: float = Field(description="[s] when it was sent")
    why: str


class Known(BaseModel):
    """What a unit knew about another, from which sensor or message."""

    unit: str
    about: str
    source: str = Field(description="name of the sensor, or kind of the message")
    age: float | None = Field(description="[s] when it began; null when nothing had come")
    time: float | None = Field(description="[s] when it was measured, or sent; null when nothing had come")
    what: dict[str, Number]
    lost: list[Lost] = Field(description="messages since the newest that had come")


class Overseer(BaseModel):
    """A unit without a vehicle that guided one of them: what it had told that one, and what it knew about the other."""

    told: Known
    knew: Known


class Wheel(BaseModel):
    """A tyre at its limit."""

    unit: str
    wheel: str
    use: float = Field(description="[1] greatest share of its adhesion in the second before")
    slides: bool = Field(description="whether it was past its peak of slip")


class Asked(BaseModel):
    """What who had the brake of a vehicle asked for."""

    unit: str
    by: str
    acceleration: float = Field(description="[m/s²]")
    greatest: float | None = Field(description="[m/s²] the greatest deceleration that he may ask for; null where that is not known")


class Harmed(BaseModel):
    """A sensor that the script harmed at that time."""

    unit: str
    sensor: str = Field(description='its name, "" for all of the unit')
    entry: str = Field(description="of the script")
    since: float = Field(description="[s]")
    fails: bool
    noise: float = Field(description="[1] factor on its noise")


class Explanation(BaseModel):
    """Why something happened: what was known about the other, who commanded, which tyre was at its limit; and all of it in sentences."""

    event: str = Field(description="kind of the event")
    time: float = Field(description="[s]")
    began: float = Field(description="[s] when it began, before which what was known counts: of a near miss earlier than its time")
    text: str
    units: list[str]
    known: list[Known]
    commanded_by: dict[str, dict[str, str]] = Field(description="who had wheel, brake, drive and gear, by vehicle")
    asked: list[Asked]
    tyre_at_limit: list[Wheel]
    faults: list[Harmed]
    not_recorded: list[str] = Field(description='channels that the run has not kept, and "sensors" when it lacks their readings')
    unknown: list[str] = Field(description="units of which nothing was recorded")
    overseers: list[Overseer] = Field(description="who beside the road knew for them")
    without_tyres: list[str] = Field(description="units that are light vehicles, of whose tyres nothing is known")
    lines: list[str]


class Beyond(BaseModel):
    """From when until when a vehicle was outside its validated span, what led it farthest, and how far."""

    begin: float = Field(description="[s]")
    end: float = Field(description="[s]")
    quantity: str = Field(description="the channel that led farthest outside, in the width of its own span")
    unit: str
    value: float = Field(description="its value where it was farthest outside")
    low: float = Field(description="what it was validated from")
    high: float = Field(description="what it was validated until")


class Spanned(BaseModel):
    """A vehicle with a validated span, and where it was outside of it."""

    vehicle: str
    stretches: list[Beyond]
    not_recorded: list[str] = Field(description="channels that the run has not kept: nothing is said of them")


class Revision(BaseModel):
    """What git has told of a folder of code: the commit, and the digest of the patch of what was not committed, "" when all was."""

    folder: str
    commit: str
    patch: str
    is_cut: bool = Field(description="whether the patch was too long to be kept as a whole")


class RunDetail(Run):
    """A run with its scenario, what can be plotted of it, what happened, and of what code it is made."""

    kinds: dict[str, str] = Field(description="digests of all kinds that it used, by sort.name")
    host: str | None = Field(description="name of the machine; null for a run of an older studio")
    versions: dict[str, str] = Field(description="of Python and of the packages that compute")
    revisions: list[Revision]
    document: dict[str, Any]
    channels: list[Channel]
    events: list[Event]
    verdicts: list[Verdict] = Field(description="all that were given, the first first")


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
    """The number of a run that has begun, or that waits for its turn."""

    run: int
    position: int = Field(description="place among those that wait, from 1 on; 0 when it has begun")


class Live(BaseModel):
    """A live run now."""

    run: int
    scenario: str
    status: LiveStatus
    time: float
    pace: Pace
    duration_s: float
    position: int = Field(0, description="place among those that wait for their turn, from 1 on; 0 when it does not")


class Queued(BaseModel):
    """A run that goes on or waits for its turn, whoever has begun it; `parameters` are those that were set, by path."""

    run: int
    scenario: str
    status: Literal["running", "waiting"]
    position: int = Field(description="place among those that wait for the same server, from 1 on; 0 when it goes on")
    created: str
    parameters: dict[str, Any]
    time: float = Field(description="[s] up to which it has been recorded")
    duration: float = Field(description="[s] that it will take at most")


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
    """A metric of two runs; `difference` is b - a. Nothing is `better` where the comparison is unranked, or the metric has no direction."""

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
    alike: float = Field(description="[1] of the greater value: metrics that differ by less are the same")
    unranked: str = Field(description="why no metric is better in one of the runs, because one ended early; empty when both are whole")
    parameters: list[ParameterDifference]
    metrics: list[MetricDifference]


class Beside(BaseModel):
    """What differs between several runs: a value of each, in their order, null where a run has none."""

    path: str
    values: list[Any]
    unit: str


class MetricBeside(BaseModel):
    """A metric of several runs, and how each stands against the first one; nothing where that is not to be ranked."""

    name: str
    unit: str
    goal: Goal
    values: list[float | None]
    relative: list[float | None] = Field(description="difference from the first one, over the size of that")
    stands: list[Literal["better", "worse", "same"] | None]


class EnvironmentBeside(BaseModel):
    """A version, machine or commit that differs."""

    name: str
    values: list[str | None]


class SourceBeside(BaseModel):
    """What a run has used in another form than the first one: a unified diff, or `only` the run that has used it at all."""

    kind: str
    file: str
    run: int
    only: int | None
    diff: str


class GoalsMet(BaseModel):
    """How many of the goals of its scenario a run met."""

    met: int
    of: int
    missed: list[str] = Field(description="what is told of those that it did not meet")


class SideBySide(BaseModel):
    """Up to eight runs, each compared with the first."""

    runs: list[Run]
    alike: float = Field(description="[1] of the greater value: metrics that differ by less are the same")
    unranked: list[str] = Field(description="of every run why its metrics are not ranked; empty when they are")
    goals: list[GoalsMet | None] = Field(description="of every run; null of one that was not measured to its end")
    parameters: list[Beside]
    metrics: list[MetricBeside]
    environment: list[EnvironmentBeside]
    sources: list[SourceBeside]


class WantedStage(BaseModel):
    """The stage that a page had before it was loaded again; null for one that has none yet."""

    model_config = ConfigDict(extra="forbid")

    wanted: int | None = Field(None, ge=FIRST_STAGE, le=MOST_STAGES)


class AllottedStage(BaseModel):
    """The stage that a page has to itself while its scene is connected."""

    stage: int


class OnStage(BaseModel):
    """What the scene is to show: a scenario as it would start, or a run: as it goes on, or as it was recorded."""

    model_config = ConfigDict(extra="forbid")

    scenario: str | None = None
    set: ChangesByPath = {}
    run: int | None = None
    ghosts: list[int] = Field([], max_length=7, description="other runs that are over, among the cars of the run that is played back")
    stage: int = Field(FIRST_STAGE, ge=FIRST_STAGE, le=MOST_STAGES, description="on which stage; see `/api/stages`")
    align: str = Field("", description="kind of event whose first is at the same time in all of them; empty: by their clocks")


class SceneGhost(BaseModel):
    """Another run among the cars: its colour, and by how much its clock is ahead."""

    run: int
    color: str
    offset: float = Field(description="[s]")


class SceneVehicle(BaseModel):
    """A vehicle in the scene."""

    name: str
    index: int
    color: str
    length: float = Field(description="[m]")
    width: float = Field(description="[m]")
    height: float = Field(description="[m]")
    middle: float = Field(description="[m] from its origin, below the centre of gravity, to the middle of the body")


class SceneCast(BaseModel):
    """Who is to be seen, and whose map it is; of a run that is played back from when to when, and what cannot be shown."""

    vehicles: list[SceneVehicle]
    attribution: str
    map: str = Field("", description="digest of the map; the scene has a node /map/DIGEST as soon as it has the map")
    begin: float | None = Field(None, description="first time that was recorded [s]; null unless a run is played back")
    end: float | None = Field(None, description="last time that was recorded [s]")
    step: float | None = Field(None, description="from one sample to the next [s]")
    notes: list[str] = Field([], description="what is not as it was, or is missing")
    ghosts: list[SceneGhost] = []
    missing: dict[str, str] = Field({}, description="layers that cannot be drawn, and why")


Spot = Annotated[list[float], Field(min_length=2, max_length=2)]


class LayerCar(BaseModel):
    """What is known of a car that the picture does not show."""

    car: int = Field(description="its index in the scene")
    speed: float | None = Field(description="[m/s]")
    brakes: bool = Field(description="whether its brake lights are on")
    turns: int = Field(description="1: its way bends to the left soon, -1: to the right; cars of the simulation have no indicators")
    ahead: int | None = Field(description="index of the car ahead; null when there is none, or something else")
    gap: float | None = Field(description="[m] to what is ahead")
    notice: str = Field(description="what its driver is shown")


class LayerField(BaseModel):
    """The field of a sensor, and what it says that it sees: in the frame of its car, x ahead and y to the left of its centre of gravity."""

    car: int
    sensor: str
    x: float = Field(description="[m]")
    y: float = Field(description="[m]")
    yaw: float = Field(description="[rad]")
    range: float = Field(description="[m]")
    angle: float = Field(description="[rad] from edge to edge")
    seen: list[Spot] = Field(description="[m]")


class LayerEnd(BaseModel):
    """Who sends or hears: a car by its index, or a station at its place."""

    car: int | None = None
    x: float | None = Field(None, description="[m]")
    y: float | None = Field(None, description="[m]")


class LayerMessage(BaseModel):
    """The newest message from one to another, which was sent a moment ago."""

    sender: LayerEnd
    receiver: LayerEnd
    kind: str
    lost: bool


class LayerLine(BaseModel):
    """A line on the map that belongs to a car."""

    car: int
    points: list[Spot] = Field(description="[m]")
    lifts: list[float] = Field([], description="how high above the land each lies [m]; none where all lie on it")


class LayerLink(BaseModel):
    """A line from a car to the same one of another run, a ghost."""

    car: int
    run: int = Field(description="the other run")
    color: str = Field(description="of its ghosts, #rrggbb")
    x: float = Field(description="[m] of the ghost")
    y: float = Field(description="[m]")
    z: float = Field(description="[m] of the road as it is drawn")
    distance: float = Field(description="[m] from one to the other, seen from above")


class Layers(BaseModel):
    """What can be drawn over the scene at a time."""

    time: float = Field(description="[s]")
    cars: list[LayerCar]
    fields: list[LayerField]
    messages: list[LayerMessage]
    trails: list[LayerLine] = Field(description="where cars came from, the oldest point first")
    paths: list[LayerLine] = Field(description="where their ways lead")
    links: list[LayerLink] = Field([], description="to the ghosts of a run that is played back")


class Moment(BaseModel):
    """A time of a run that the scene plays back."""

    model_config = ConfigDict(extra="forbid")

    stage: int = Field(FIRST_STAGE, ge=FIRST_STAGE, le=MOST_STAGES, description="on which stage; see `/api/stages`")
    run: int
    time: float = Field(description="[s]; before the first and after the last sample that of this", allow_inf_nan=False)
    layers: bool = Field(False, description="whether what can be drawn over the scene is wanted")


class Shown(BaseModel):
    """Whether the scene shows that time now: not when it was set to something else meanwhile."""

    shown: bool
    layers: Layers | None = None
