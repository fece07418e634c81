"""REST under /api. Every route calls the function that the command line calls too."""

from collections.abc import Iterator
from dataclasses import asdict
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Body, Depends, Header, Query, Request, WebSocket
from starlette.responses import HTMLResponse, Response, StreamingResponse
from starlette.websockets import WebSocketDisconnect

from studio import job
from studio.assess.aggregate import MEANINGS, Aggregate
from studio.assess.beyond import stretches
from studio.assess.compare import ALIKE
from studio.errors import Problem, ScenarioError, StudioError, UnknownError, short
from studio.kind import registry
from studio.kind.registry import Kind
from studio.parcel import notebook, paper
from studio.parcel.report import report
from studio.scenario.schema import Scenario, json_schema
from studio.scenario.text.document import digest
from studio.scenario.text.patch import Operation, operations
from studio.scenario.text.source import Source
from studio.server import answer
from studio.server.desk import Desk, check_pace
from studio.server.listing import listing
from studio.server.live import Listener, plain
from studio.server.manuscript import manuscript
from studio.server.news import EndNews, News, RefusedNews
from studio.server.worker import pace_factor
from studio.source import code_version
from studio.store import column as of_channel
from studio.store import trace
from studio.store.aggregate import aggregated
from studio.store.comparison import beside, numbers
from studio.store.comparison import compare as compare_runs
from studio.store.explanation import explanation
from studio.store.export import MEDIA, Format, export
from studio.store.ledger import MEDIA as LEDGER_MEDIA
from studio.store.ledger import Form, ledger
from studio.store.many import Given, Retag, judge_all, retag
from studio.store.mcap import MEDIA as MCAP_MEDIA
from studio.store.mcap import mcap
from studio.store.queue import queue
from studio.store.runs import LARGEST_RUN, Runs
from studio.store.stretch import stretch
from studio.store.verdict import judge, remark, verdicts
from studio.workshop import vocabulary
from studio.workshop.proof import proof
from studio.workshop.start import starts
from studio.world import channel

PAPER: dict[int | str, dict[str, Any]] = {
    200: {"description": "PDF", "content": {paper.MEDIA: {"schema": {"type": "string", "format": "binary"}}}}
}
NOTEBOOK: dict[int | str, dict[str, Any]] = {
    200: {"description": "a notebook", "content": {notebook.MEDIA: {"schema": {"type": "object"}}}}
}
PAGE: dict[int | str, dict[str, Any]] = {200: {"description": "HTML", "content": {"text/html": {"schema": {"type": "string"}}}}}
TRAJECTORIES: dict[int | str, dict[str, Any]] = {
    200: {"description": "piece by piece", "content": {each: {"schema": {"type": "string"}} for each in MEDIA.values()}}
}
LEDGER: dict[int | str, dict[str, Any]] = {
    200: {"description": "a file", "content": {each: {"schema": {"type": "string", "format": "binary"}} for each in LEDGER_MEDIA.values()}}
}
RECORDING: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "a file",
        "content": {each: {"schema": {"type": "string"}} for each in (LEDGER_MEDIA["parquet"], LEDGER_MEDIA["csv"], MCAP_MEDIA)},
    }
}
MOST_CHOSEN, LONGEST_NUMBER = 10_000, 19  # runs that are named, and digits of each
MOST_COLUMNS = 50  # channels in one number that one table has
SOCKET: dict[int | str, dict[str, Any]] = {
    "1XX": {"model": News, "description": "101: a WebSocket from here on; each message is one of the news"}
}
router = APIRouter(prefix="/api", responses=answer.REFUSALS)


def desk_of(request: Request) -> Desk:
    """The desk of this server."""
    return request.app.state.desk


AtDesk = Annotated[Desk, Depends(desk_of)]


def own_desk(desk: AtDesk) -> Desk:
    """The desk, where something may be written."""
    desk.settle()
    return desk


AtOwnDesk = Annotated[Desk, Depends(own_desk)]
IfMatch = Annotated[str | None, Header(description="ETag of the text that is expected; without it, any")]


def opened_runs(desk: AtDesk) -> Iterator[Runs]:
    """The run database, for one request: closed when that is over, not when somebody clears up."""
    kept = desk.runs()
    try:
        yield kept
    finally:
        kept.close()


KeptRuns = Annotated[Runs, Depends(opened_runs)]


@router.get("/info")
def info(desk: AtDesk) -> answer.Info:
    """About this server."""
    code = code_version()
    return answer.Info(
        version=code.partition("+")[0],
        code_version=code,
        db=str(desk.db),
        scenarios_folder=str(desk.scenarios),
        compiling=desk.compiling(),
    )


@router.get("/scenarios")
def scenarios(desk: AtDesk) -> list[answer.ScenarioRow]:
    """The scenario files of the folder."""
    runs = desk.runs_by_scenario()
    return [answer.ScenarioRow(**desk.row(each, runs)) for each in desk.files()]


@router.get("/scenarios/{scenario}")
def scenario(scenario: str, desk: AtDesk) -> answer.ScenarioDetail:
    """A scenario with all defaults filled in, and the schema of its form."""
    loaded = desk.load(scenario)
    prepared = job.prepare(loaded)
    return answer.ScenarioDetail(
        id=scenario,
        title=loaded.scenario.title,
        description=loaded.scenario.description.strip(),
        attribution=prepared.network.attribution,
        scenario_hash=job.scenario_hash(loaded, prepared),
        digest=digest(loaded.source.text),
        document=loaded.document,
        given=loaded.given,
        schema=json_schema(Scenario),
    )


@router.post("/scenarios/{scenario}/check")
def check(scenario: str, changes: answer.Changes, desk: AtDesk) -> answer.Check:
    """Whether changes make a valid scenario."""
    try:
        loaded = desk.load(scenario, changes.set)
        job.check(loaded)
        return answer.Check(ok=True, problems=[], document=loaded.document)
    except ScenarioError as error:
        document = desk.load(scenario).document
        return answer.Check(ok=False, problems=error.as_json()["problems"], document=document)


@router.patch("/scenarios/{scenario}", response_model_exclude_unset=True)
def patch_scenario(
    scenario: str,
    patch: Annotated[list[Operation], Body(media_type="application/json-patch+json")],
    desk: AtDesk,
    response: Response,
    if_match: IfMatch = None,
) -> answer.Patched:
    """Changes a scenario file by a JSON patch (RFC 6902): all of it if the result is valid, else nothing. Undo: send the inverse."""
    found, inverse = desk.documents.patch(desk.file(scenario), operations(patch), expected(if_match))
    return patched(found, inverse, response)


def patched(found: Source, inverse: list[Operation], response: Response) -> answer.Patched:
    """A scenario that was changed."""
    response.headers["ETag"] = etag(found.text)
    return answer.Patched(inverse=inverse, digest=digest(found.text), document=found.value)


def etag(text: str) -> str:
    """The digest of a text as HTTP has it."""
    return f'"{digest(text)}"'


def expected(if_match: str | None) -> str | None:
    """The digest that a request expects; None for any."""
    return None if if_match in (None, "*") else if_match.strip().removeprefix("W/").strip('"')


@router.get("/kinds")
def kinds(desk: AtDesk) -> answer.Kinds:
    """All kinds with the schemas of their settings, sort by sort, and the files that are broken."""
    desk.editions.notice()
    return answer.Kinds(kinds=list(map(answer.kind, registry.every())), broken=list(map(answer.broken_kind, registry.broken())))


@router.get("/kinds/{sort}/{name}/source")
def kind_source(sort: str, name: str, desk: AtDesk) -> answer.Manuscript:
    """The file of a kind as it stands now, with what Python cannot read in it; an application that has changed is taken in if it loads."""
    desk.editions.notice()
    kind = registry.find(sort, name)
    found = manuscript(kind, desk.editions.refused(kind.file))
    return answer.Manuscript(**asdict(found))


@router.post("/application-proof")
def application_proof(draft: answer.Draft) -> answer.Proof:
    """What is wrong in the text of an application, as far as reading tells. The text is parsed and never run."""
    return answer.Proof(slips=[answer.Proved(**each._asdict()) for each in proof(draft.text)])


@router.get("/application-vocabulary")
def application_vocabulary() -> answer.Vocabulary:
    """Everything that an application may name, with units and meanings: ports and what stands below them, functions, names."""
    return answer.Vocabulary(
        ports=[answer.PortWords(**each._asdict() | {"words": list(map(word, each.words))}) for each in vocabulary.ports()],
        functions=[answer.FunctionWords(**each._asdict() | {"arguments": list(each.arguments)}) for each in vocabulary.functions()],
        names=vocabulary.names(),
    )


def word(found: vocabulary.Word) -> answer.Word:
    """A field with what stands below it."""
    return answer.Word(**found._asdict() | {"words": list(map(word, found.words))})


@router.get("/application-starts")
def application_starts() -> list[answer.Start]:
    """Texts to begin an application with: what `studio new application` writes, and the applications that come with the studio."""
    return [answer.Start(**each._asdict()) for each in starts()]


@router.get("/glossary")
def glossary() -> answer.Glossary:
    """What channels and metrics are called, their units, and what they mean."""
    channels = [
        answer.Quantity(name=each.name, unit=each.unit, label=each.label, meaning=each.meaning) for each in channel.catalogue().values()
    ]
    return answer.Glossary(channels=channels, metrics=[measure_of(each) for each in registry.known("metric").values()], alike=ALIKE)


def measure_of(kind: Kind) -> answer.Measure:
    """A metric as it is told."""
    return answer.Measure(name=kind.name, title=kind.title, unit=kind.module.UNIT, goal=kind.module.BETTER, explanation=kind.explanation)


@router.get("/runs", response_model=list[answer.ListedRun])
def runs(
    kept: KeptRuns,
    scenario: str | None = None,
    limit: Annotated[int, Query(ge=1, le=10_000)] = 1000,
    before: Annotated[int | None, Query(ge=1, le=LARGEST_RUN, description="only runs with a smaller number")] = None,
) -> Response:
    """Runs, newest first, with what they were set to."""
    wanted = {"scenario = ?": scenario, "run < ?": before}
    conditions = {text: value for text, value in wanted.items() if value is not None}
    where = " and ".join(conditions) or "1"
    return Response(listing(kept, where=where, values=list(conditions.values()), limit=limit), media_type="application/json")


@router.get("/table", response_class=Response, responses=LEDGER)
def table_of_runs(
    kept: KeptRuns,
    form: Annotated[Form, Query(alias="format")] = "csv",
    scenario: Annotated[str | None, Query(description="only runs of this scenario")] = None,
    runs: Annotated[str, Query(description="only these numbers, separated by commas")] = "",
    columns: Annotated[
        tuple[str, ...], Query(description="channels in one number, such as leader.speed.max", max_length=MOST_COLUMNS)
    ] = (),
) -> Response:
    """The table of runs as a file: parameters, metrics with units, verdicts, and channels in one number."""
    where, values = chosen_runs(scenario, runs)
    named = {"Content-Disposition": f'attachment; filename="runs.{form}"'}
    return Response(ledger(kept, form, where=where, values=values, channels=columns), media_type=LEDGER_MEDIA[form], headers=named)


def chosen_runs(scenario: str | None, runs: str) -> tuple[str, list[Any]]:
    """A condition of SQL with its values; raises ScenarioError for what is no number of a run."""
    wanted = [each.strip() for each in runs.split(",")] if runs else []
    wrong = [each for each in wanted if not (each.isascii() and each.isdigit() and len(each) < LONGEST_NUMBER)]
    if wrong or len(wanted) > MOST_CHOSEN:
        problem = Problem("runs", "are no numbers of runs", short(", ".join(wrong or wanted)), f"at most {MOST_CHOSEN}, such as 1,2,5")
        raise ScenarioError("Which runs?", [problem])
    conditions = [f"run in ({', '.join('?' * len(wanted))})"] if wanted else []
    conditions += ["scenario = ?"] if scenario else []
    return " and ".join(conditions) or "1", [*map(int, wanted), *([scenario] if scenario else [])]


@router.post("/runs", status_code=202)
def start_run(new: answer.NewRun, desk: AtDesk) -> answer.Started:
    """Starts a run as fast as possible, watched by nobody, or lets it wait for its turn; its row tells when it is done."""
    live = desk.start(new.scenario, changes=new.set, seed=new.seed, parent=new.parent, pace="fast", paused=False)
    return answer.Started(run=live.run, position=live.position)


@router.get("/queue")
def runs_in_queue(desk: AtDesk) -> list[answer.Queued]:
    """Runs that go on, then those that wait for their turn, in their order; those of other servers and of the command line too."""
    return [answer.Queued(**vars(each)) for each in queue(desk.runs())]


@router.post("/runs/{run}/cancel")
def cancel(run: int, desk: AtDesk) -> answer.Run:
    """Takes a run out of the queue, or ends it; what was recorded is kept. Its row tells when it is over."""
    return answer.Run(**desk.cancel(run).as_json())


@router.get("/runs/{run}")
def run(run: int, kept: KeptRuns) -> answer.RunDetail:
    """One run with its scenario, channels and events."""
    row = kept.find(run)
    events = [answer.event(each) for each in kept.events(run)]
    given = [answer.Verdict(**each.as_json()) for each in verdicts(kept, run)]
    return answer.RunDetail(**row.as_json(), document=kept.document(row), channels=kept.channels(run), events=events, verdicts=given)


@router.post("/runs/{run}/verdicts", status_code=201)
def judge_run(run: int, new: answer.NewVerdict, kept: KeptRuns) -> answer.Verdict:
    """Decides about a run that is over: a verdict stands behind those before it, and counts from now on."""
    return answer.Verdict(**judge(kept, run, new.verdict, new.reason, new.who).as_json())


@router.post("/verdicts", status_code=201)
def judge_runs(new: answer.ManyVerdicts, kept: KeptRuns) -> list[answer.Verdict]:
    """Decides about many runs: about all of them or, when about one of them it cannot be decided, about none."""
    given = [Given(each.run, each.verdict, each.reason) for each in new.verdicts]
    return [answer.Verdict(**each.as_json()) for each in judge_all(kept, given, new.who)]


@router.post("/tags")
def tag_runs(new: answer.ManyTags, kept: KeptRuns) -> answer.ManyTags:
    """Puts tags on runs and takes them off; what was changed by that, whose opposite takes it back. All of it is done, or nothing."""
    wanted = [Retag(each.run, tuple(each.add), tuple(each.remove)) for each in new.tags]
    return answer.ManyTags(tags=[answer.Retag(**each.as_json()) for each in retag(kept, wanted)])


@router.put("/runs/{run}/remark")
def remark_on_run(run: int, new: answer.Remark, kept: KeptRuns) -> answer.Remark:
    """Sets name, tags and note of a run."""
    said = remark(kept, run, name=new.name, tags=new.tags, note=new.note)
    return answer.Remark(name=said.name, tags=list(said.tags), note=said.note)


@router.get("/runs/{run}/trace")
def run_trace(
    run: int,
    kept: KeptRuns,
    channels: Annotated[str, Query(description="names, separated by commas")],
    points: Annotated[int, Query(ge=2, le=1_000_000, description="about as many rows are returned; extremes are kept")] = 2000,
    begin: Annotated[float | None, Query(description="[s] only what came from then on, and one sample before", allow_inf_nan=False)] = None,
    end: Annotated[float | None, Query(description="[s] only what came until then, and one sample after", allow_inf_nan=False)] = None,
) -> answer.Trace:
    """Selected channels of a run, of all of it or between two times: a shorter stretch comes with finer samples."""
    names = [name.strip() for name in channels.split(",") if name.strip()]
    units = {each["name"]: each["unit"] for each in kept.channels(run)}
    columns = trace.decimate(trace.between(kept.trace(run, names), begin, end), points)
    values = {name: answer.TraceColumn(unit=units[name], values=plain(columns[name])) for name in names}
    return answer.Trace(time=columns["time"].tolist(), channels=values)


@router.get("/runs/{run}/stretch")
def run_stretch(
    run: int,
    kept: KeptRuns,
    begin: Annotated[float, Query(description="[s] from then on", allow_inf_nan=False)],
    end: Annotated[float, Query(description="[s] until then", allow_inf_nan=False)],
) -> answer.Stretch:
    """The measures of a stretch of a run, where they can be made from what was recorded: each without the others' time."""
    first, last, metrics = stretch(kept, run, begin, end)
    return answer.Stretch(begin=first, end=last, metrics={name: answer.Metric(**vars(each)) for name, each in metrics.items()})


@router.get("/runs/{run}/recording", response_class=StreamingResponse, responses=RECORDING)
def run_recording(
    run: int,
    kept: KeptRuns,
    form: Annotated[
        Literal["parquet", "csv", "mcap"],
        Query(alias="format", description="parquet: as it is kept, with units; csv: a table; mcap: for Foxglove, with events and messages"),
    ] = "parquet",
    channels: Annotated[str, Query(description="of csv: names, separated by commas; all without it")] = "",
) -> Response:
    """All recorded channels of a run as a file."""
    parquet = kept.parquet(run)
    named = {"Content-Disposition": f'attachment; filename="run_{run}.{form}"'}
    if form == "parquet":
        return Response(parquet, media_type=LEDGER_MEDIA["parquet"], headers=named)
    if form == "mcap":
        return StreamingResponse(mcap(kept, run), media_type=MCAP_MEDIA, headers=named)
    names = [name.strip() for name in channels.split(",") if name.strip()]
    return StreamingResponse(trace.lines(parquet, names), media_type="text/csv", headers=named)


@router.get("/runs/{run}/trajectories", response_class=StreamingResponse, responses=TRAJECTORIES)
def run_trajectories(
    run: int,
    kept: KeptRuns,
    form: Annotated[Format, Query(alias="format", description="fcd: SUMO's floating car data (XML); csv: a table")] = "fcd",
    degrees: Annotated[bool, Query(description="longitude and latitude instead of metres of the map")] = False,
) -> StreamingResponse:
    """The trajectories of the recorded vehicles for other programs."""
    return StreamingResponse(export(kept, run, form, as_degrees=degrees), media_type=MEDIA[form])


@router.get("/runs/{run}/report", response_class=Response, responses=PAGE)
def run_report(run: int, kept: KeptRuns) -> Response:
    """One page about a run, to be kept, read and printed."""
    return HTMLResponse(report(kept, run), headers={"Content-Disposition": f'attachment; filename="run_{run}.html"'})


@router.get("/runs/{run}/report.pdf", response_class=Response, responses=PAPER)
def run_report_on_paper(run: int, kept: KeptRuns) -> Response:
    """The same page about a run as PDF."""
    return on_paper(report(kept, run), f"run_{run}.pdf")


@router.get("/runs/{run}/notebook", response_class=Response, responses=NOTEBOOK)
def run_notebook(run: int, kept: KeptRuns, request: Request) -> Response:
    """A notebook (Jupyter) that reads the run from this studio, to be gone on with."""
    channels = [each["name"] for each in kept.channels(run)]
    made = notebook.notebook(kept.find(run), channels, str(request.base_url).rstrip("/"))
    return Response(made, media_type=notebook.MEDIA, headers={"Content-Disposition": f'attachment; filename="run_{run}.ipynb"'})


def on_paper(page: str, name: str) -> Response:
    """A report as PDF, to be downloaded."""
    named = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(paper.pdf(page), media_type=paper.MEDIA, headers=named)


@router.get("/runs/{run}/explanation")
def run_explanation(
    run: int, kept: KeptRuns, event: Annotated[str, Query(description="number in this list, or kind; all without it")] = ""
) -> list[answer.Explanation]:
    """Why collisions, near misses and hard brakes happened in a run."""
    return [answer.Explanation(**each.as_json(), lines=each.lines) for each in explanation(kept, run, event)]


@router.get("/runs/{run}/beyond")
def run_beyond(run: int, kept: KeptRuns) -> list[answer.Spanned]:
    """Every vehicle of a run that has a validated span, and where it was outside of it; of a run that goes on, as far as it is."""
    units = {each.name: each.unit for each in channel.CHANNELS}
    return [
        answer.Spanned(
            vehicle=each.vehicle,
            stretches=[answer.Beyond(unit=units[one.quantity], **one._asdict()) for one in each.stretches],
            not_recorded=list(each.not_recorded),
        )
        for each in stretches(kept.record(run))
    ]


@router.get("/compare")
def compare(a: int, b: int, kept: KeptRuns) -> answer.Comparison:
    """Two runs side by side."""
    return answer.Comparison(**compare_runs(kept, a, b))


@router.get("/beside")
def side_by_side(
    runs: Annotated[str, Query(description="numbers of up to eight runs, with commas; the first is what the others are compared with")],
    kept: KeptRuns,
    everything: Annotated[bool, Query(description="also the parameters and the environment that do not differ")] = False,
) -> answer.SideBySide:
    """Several runs side by side."""
    return answer.SideBySide(**beside(kept, numbers(runs), everything=everything))


@router.get("/aggregates")
def aggregates(
    runs: Annotated[str, Query(description="numbers of up to eight runs, with commas")],
    kept: KeptRuns,
    channel: Annotated[str, Query(description="vehicle.quantity, recorded in all of them")],
    begin: Annotated[float | None, Query(description="[s] from then on; from the beginning without it", allow_inf_nan=False)] = None,
    end: Annotated[float | None, Query(description="[s] until then; to the end without it", allow_inf_nan=False)] = None,
    event: Annotated[str, Query(description="a kind of events: the value at the first of them")] = "",
) -> list[answer.Aggregated]:
    """A channel of runs in a few numbers: least, greatest and mean value, percentiles, the value at an event."""
    found = aggregated(kept, numbers(runs), channel, begin=begin, end=end, event=event)
    return [answer.Aggregated(**each._asdict() | {"aggregates": [aggregate_of(one) for one in each.aggregates]}) for each in found]


def aggregate_of(found: Aggregate) -> answer.Aggregate:
    """A number with how it is made."""
    return answer.Aggregate(**found._asdict(), meaning=MEANINGS[found.kind])


ColumnName = Annotated[
    str,
    Query(
        description="vehicle.quantity.kind, @5..20 between times [s]: leader.speed.max, leader.speed.mean@5..20, leader.speed.at_collision"
    ),
]


@router.get("/column")
def channel_column(kept: KeptRuns, name: ColumnName) -> answer.ChannelColumn:
    """A channel in one number, of every run of which that has been worked out already."""
    wanted = of_channel.wanted(name)
    return column_of(kept, wanted, of_channel.kept(kept, wanted))


@router.post("/column")
def fill_channel_column(
    kept: KeptRuns,
    name: ColumnName,
    most: Annotated[int, Query(ge=1, le=of_channel.BATCH, description="so many runs at most")] = of_channel.BATCH,
) -> answer.ChannelColumn:
    """Works a channel in one number out of runs of which that has not been done, newest first, and keeps it; only these are returned."""
    wanted = of_channel.wanted(name)
    return column_of(kept, wanted, of_channel.fill(kept, wanted, of_channel.lacking(kept, wanted)[:most]))


def column_of(kept: Runs, wanted: of_channel.Wanted, cells: list[of_channel.Cell]) -> answer.ChannelColumn:
    """A column as it is told."""
    return answer.ChannelColumn(
        **wanted._asdict(),
        name=wanted.name,
        meaning=MEANINGS[wanted.kind],
        cells=[answer.Cell(**each._asdict()) for each in cells],
        lacking=len(of_channel.lacking(kept, wanted)),
    )


@router.get("/live")
def live_runs(desk: AtDesk) -> list[answer.Live]:
    """Live runs of this server, newest first."""
    return [live.row() for live in desk.lives.all()]


@router.post("/live", status_code=201)
def start_live(new: answer.NewLiveRun, desk: AtDesk) -> answer.Live:
    """Starts a live run in a process of its own, or lets it wait for its turn."""
    live = desk.start(new.scenario, changes=new.set, seed=new.seed, parent=new.parent, pace=new.pace, paused=new.paused)
    return live.row()


@router.get("/live/{run}")
def live_run(run: int, desk: AtDesk) -> answer.Live:
    """A live run now."""
    return desk.lives.find(run).row()


@router.post("/live/{run}/pause")
def pause(run: int, desk: AtDesk) -> answer.Live:
    """Stands still after the present tick."""
    return ordered(desk, run, "pause")


@router.post("/live/{run}/resume")
def resume(run: int, desk: AtDesk) -> answer.Live:
    """Goes on."""
    return ordered(desk, run, "resume")


@router.post("/live/{run}/step")
def step(run: int, desk: AtDesk) -> answer.Live:
    """Goes on by one tick and stands still."""
    return ordered(desk, run, "step")


@router.post("/live/{run}/stop")
def stop(run: int, desk: AtDesk) -> answer.Live:
    """Ends the run; what was recorded is kept. One that waits for its turn is cancelled."""
    return desk.lives.stop(run).row()


@router.post("/live/{run}/pace")
def pace(run: int, new: answer.NewPace, desk: AtDesk) -> answer.Live:
    """Changes how fast it goes."""
    check_pace(new.pace)
    return ordered(desk, run, "pace", pace_factor(new.pace))


def ordered(desk: Desk, run: int, *words: Any) -> answer.Live:
    """Gives an order to a live run."""
    live = desk.lives.find(run)
    live.order(*words)
    return live.row()


@router.get("/live/{run}/socket", status_code=426, response_description="Upgrade Required", response_model=answer.Refusal, responses=SOCKET)
def socket_only(run: int) -> Response:
    """A WebSocket (RFC 6455): news of a live run, everything so far, then as it comes. Asked for anything else, it refuses."""
    return upgrade_required()


def upgrade_required() -> Response:
    """The refusal of whatever is no WebSocket."""
    refusal = answer.Refusal(
        message="This address speaks WebSocket only.",
        problems=[answer.Problem(where="socket", what="was asked for without an upgrade", value="", allowed="a WebSocket", remedy="")],
    )
    return Response(refusal.model_dump_json(), 426, {"Upgrade": "websocket", "Connection": "Upgrade"}, "application/json")


@router.websocket("/live/{run}/socket")
async def socket(browser: WebSocket, run: int) -> None:
    """News of a live run: everything so far, then as it comes."""
    try:
        live = browser.app.state.desk.lives.find(run)
    except UnknownError as error:
        await browser.accept()
        await browser.send_text(RefusedNews(**error.as_json()).model_dump_json())
        await browser.close()
        return
    await browser.accept()
    listener = Listener()
    live.join(listener)
    try:
        while True:
            message = await listener.queue.get()
            if message is not None:
                await browser.send_text(message.model_dump_json())
            if message is None or isinstance(message, EndNews):
                await browser.close()
                return
    except (WebSocketDisconnect, RuntimeError):
        return  # the page has gone
    finally:
        live.leave(listener)


@router.post("/stages", status_code=201)
def stage(new: answer.WantedStage, desk: AtDesk) -> answer.AllottedStage:
    """Gives a page a stage to itself, whose scene is at `/scene/{stage}/`; the wanted one if nobody has it."""
    return answer.AllottedStage(stage=desk.stages.allot(new.wanted))


@router.post("/scene")
def scene(wanted: answer.OnStage, desk: AtDesk, runs: KeptRuns) -> answer.SceneCast:
    """Chooses what a scene shows."""
    stage = desk.stages[wanted.stage]
    if wanted.run is not None:
        live = desk.lives.going(wanted.run)
        if live is None:
            return answer.SceneCast(**desk.play(runs, wanted.stage, wanted.run, tuple(wanted.ghosts), wanted.align))
        return answer.SceneCast(**stage.show(live.loaded, live))
    if wanted.scenario is None:
        raise StudioError("Nothing to show.", [Problem("scene", "names nothing", "", "a scenario or a run")])
    return answer.SceneCast(**stage.show(desk.load(wanted.scenario, wanted.set)))


@router.put("/scene/time")
def scene_time(moment: answer.Moment, desk: AtDesk) -> answer.Shown:
    """Another time of the run that a scene plays back."""
    stage = desk.stages[moment.stage]
    played = stage.seek(moment.run, moment.time)
    return answer.Shown(shown=played is not None, layers=stage.layers(played, moment.time) if played and moment.layers else None)
