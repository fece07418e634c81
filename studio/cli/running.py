"""Commands about runs: make one, list, show and compare them, check what is to be run."""

import os
import sys
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any, BinaryIO, Literal

import typer

from studio.cli.option import DEFAULT_DB, AsJson, Db, Kinds, ScenarioFile, Sets, changes, load_kinds
from studio.cli.output import print_json, print_table, signed, text
from studio.cli.progress import compile_first, progress
from studio.errors import Problem, StoreError, UnknownError

commands = typer.Typer()


@commands.command()
def run(
    scenario: ScenarioFile,
    set_: Sets = None,
    seed: Annotated[int | None, typer.Option(help="Seed of every random number; default: the scenario's.")] = None,
    parent: Annotated[int | None, typer.Option(help="The run that this one refines.")] = None,
    db: Db = DEFAULT_DB,
    kinds: Kinds = None,
    as_json: AsJson = False,
) -> None:
    """Runs a scenario as fast as possible and saves the run."""
    from studio import job
    from studio.store.runs import open_runs

    load_kinds(kinds)
    loaded = job.load(scenario, changes(set_))
    tell_migrated(loaded)
    compile_first()
    kept = open_runs(db)
    try:
        with progress("starting") as report:
            result = job.run(loaded, seed=seed, runs=kept, parent=parent, progress=report)
    except KeyboardInterrupt:
        print(interrupted(kept, scenario, db), file=sys.stderr)
        raise typer.Exit(INTERRUPTED) from None
    if as_json:
        print_json(run_json(result.row) | events_json(result.record.happenings))
    else:
        print_run(result.row)
    if result.status == "failed":
        raise typer.Exit(1)


INTERRUPTED = 130  # as a shell tells of a command that Ctrl+C has ended: 128 and the number of the signal


def interrupted(kept, scenario: Path, db: Path) -> str:
    """What is there of the run of this process that was broken off, and how to go on."""
    from studio.store import owner

    mine = [os.getpid(), owner.mark(os.getpid())]
    (found,) = kept.rows("select max(run) as run from runs where process = ? and process_mark is ?", mine)
    again = f"studio run {scenario}"
    if found["run"] is None:
        return f"Interrupted before the run began: nothing was kept. Run it again: {again}"
    row, where = kept.find(found["run"]), "" if db == DEFAULT_DB else f" --db {db}"
    what = f"what was recorded until {row.sim_time_s:g} s is kept, and measured" if row.sim_time_s else "it had recorded nothing"
    return f"Interrupted: run {row.run} is {row.status}, {what}. Look at it: studio show {row.run}{where}; run it again: {again}"


@commands.command()
def runs(
    db: Db = DEFAULT_DB,
    limit: Annotated[int, typer.Option(help="How many, newest first.", min=1, max=1_000_000)] = 50,
    out: Annotated[Path | None, typer.Option("--out", help="A file for the whole table: .csv, .parquet, .json.")] = None,
    column: Annotated[
        list[str] | None,
        typer.Option("--column", help="With --out: a channel in one number, such as leader.speed.max or leader.speed.mean@5..20."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Lists the runs of the database."""
    if out is not None:
        write_ledger(existing(db), out, column or [])
        return
    rows = existing(db).select(limit=limit)
    if as_json:
        print_json([run_json(row) for row in rows])
        return
    if not rows:
        print(f"No run in {db} yet. Try: studio run scenarios/grosser_stern_platoon.yaml")
        return
    print_table(
        ["run", "scenario", "status", "verdict", "parent", "seed", "set", "min TTC [s]", "worst hop gain [1]"],
        [[str(row.run), row.scenario, row.status, row.verdict, str(row.parent or ""), str(row.seed), settings(row.parameters),
          metric_text(row, "min_ttc"), metric_text(row, "worst_hop_gain")] for row in rows],
    )  # fmt: skip


def write_ledger(found, out: Path, channels: list[str]) -> None:
    """Writes the table of runs, in the form that the ending of the file says."""
    from studio.store.ledger import FORMS, ledger

    form = next((each for each in FORMS if each == out.suffix.removeprefix(".").lower()), None)
    if form is None:
        raise StoreError(
            f"{out} is of no form.", [Problem("--out", "has an unknown ending", out.suffix, ", ".join(f".{each}" for each in FORMS))]
        )
    data = ledger(found, form, channels=channels)
    put(out, lambda file: file.write(data))
    print(f"{out}: the table of runs, {len(data) / 1e6:.1f} MB")


def put(out: Path, write: Callable[[BinaryIO], Any]) -> None:
    """Writes a file; raises StoreError when the disk does not take it."""
    try:
        with out.open("wb") as file:
            write(file)
    except OSError as error:
        problem = Problem("--out", "cannot be written", str(out), remedy="name a file in a folder that exists, with room")
        raise StoreError(f"{out}: {error.strerror or error}", [problem]) from None


@commands.command()
def queue(db: Db = DEFAULT_DB, as_json: AsJson = False) -> None:
    """Lists the runs that go on and those that wait for their turn, in their order, whoever has begun them."""
    from studio.store.queue import queue as found

    places = found(existing(db))
    if as_json:
        print_json([asdict(each) for each in places])
    elif not places:
        print(f"No run of {db} goes on or waits.")
    else:
        print_table(
            ["run", "scenario", "status", "position", "recorded [s]", "of [s]", "set"],
            [[str(each.run), each.scenario, each.status, str(each.position or ""), text(round(each.time, 2)), text(each.duration),
              settings(each.parameters)] for each in places],
        )  # fmt: skip


@commands.command()
def cancel(
    run: Annotated[int, typer.Argument(help="Number of the run.")],
    db: Db = DEFAULT_DB,
    force: Annotated[bool, typer.Option("--force", help="End the process of a run that does not react.")] = False,
    kinds: Kinds = None,
) -> None:
    """Takes a run out of the queue, or ends one that goes on, whoever has begun it; what was recorded is kept."""
    from studio.store.queue import cancel as cancelled

    load_kinds(kinds)
    row = cancelled(existing(db), run, force)
    print(f"Run {run} is {row.status}. {row.error or ''}".rstrip())


@commands.command()
def show(
    run: Annotated[int, typer.Argument(help="Number of the run.")],
    db: Db = DEFAULT_DB,
    sources: Annotated[bool, typer.Option("--sources", help="The texts of the kinds that it used, and what was not committed.")] = False,
    as_json: AsJson = False,
) -> None:
    """Shows one run: what was set, every metric, and what happened; or the texts of its kinds."""
    runs = existing(db)
    row = runs.find(run)
    if sources:
        texts, patches = runs.sources(row), {each["folder"]: runs.text(each["patch"]) for each in row.revisions}
        print_json({"kinds": texts, "patches": patches}) if as_json else print_sources(row, texts, patches)
    elif as_json:
        print_json(run_json(row) | events_json(runs.events(run)))
    else:
        print_run(row)
        print_goals(row, runs.document(row))
        print_events(runs.events(run))


@commands.command()
def explain(
    run: Annotated[int, typer.Argument(help="Number of the run.")],
    event: Annotated[str, typer.Argument(help="Number of an event in this list, or a kind: collision, near_miss, hard_brake.")] = "",
    db: Db = DEFAULT_DB,
    as_json: AsJson = False,
) -> None:
    """Explains collisions, near misses and hard brakes: what was known, what was lost, who commanded, which tyre was at its limit."""
    from studio.store.explanation import explanation

    found = explanation(existing(db), run, event)
    if as_json:
        print_json([each.as_json() for each in found])
    elif not found:
        print(f"Run {run}: no {event.replace('_', ' ') or 'collision, near miss or hard brake'}.")
    for i, each in enumerate([] if as_json else found):
        number = event if event.isdecimal() else i + 1
        print(f"{number}. {each.event.time:.2f} s, {each.event.vehicle}: {each.event.text}")
        print("".join(f"   {line}\n" for line in each.lines))


@commands.command()
def aggregate(
    runs: Annotated[str, typer.Argument(help="Numbers of up to eight runs, with commas.")],
    channel: Annotated[str, typer.Argument(help="vehicle.quantity, such as leader.speed.")],
    begin: Annotated[float | None, typer.Option("--begin", help="[s] From then on; from the beginning without it.")] = None,
    end: Annotated[float | None, typer.Option("--end", help="[s] Until then; to the end without it.")] = None,
    event: Annotated[str, typer.Option("--event", help="A kind of events: also the value at the first of them.")] = "",
    db: Db = DEFAULT_DB,
    as_json: AsJson = False,
) -> None:
    """Tells a recorded channel in a few numbers: least, greatest and mean value, percentiles, the value at an event."""
    from studio.assess.aggregate import MEANINGS
    from studio.store.aggregate import aggregated
    from studio.store.comparison import numbers

    found = aggregated(existing(db), numbers(runs), channel, begin=begin, end=end, event=event)
    if as_json:
        print_json([each._asdict() | {"aggregates": [one._asdict() for one in each.aggregates]} for each in found])
        return
    print_table(
        [with_unit(channel, found[0].unit), *(f"run {each.run}" for each in found), "is"],
        [[kind, *(text(each.aggregates[i].value) for each in found), MEANINGS[kind]] for i, kind in enumerate(MEANINGS)],
    )
    print("".join(f"run {each.run}: {each.samples} samples from {each.begin:g} to {each.end:g} s\n" for each in found), end="")


@commands.command()
def compare(
    a: Annotated[int, typer.Argument(help="Number of a run.")],
    b: Annotated[int, typer.Argument(help="Number of another run.")],
    db: Db = DEFAULT_DB,
    as_json: AsJson = False,
) -> None:
    """Compares two runs: the parameters that differ, and every metric."""
    from studio.store.comparison import compare as compared

    runs = existing(db)
    result = compared(runs, a, b)
    if as_json:
        print_json(result)
        return
    print_table(
        ["parameter", f"run {a}", f"run {b}"],
        [[with_unit(each["path"], each["unit"]), text(each["a"]), text(each["b"])] for each in result["parameters"]],
    )
    print_table(
        ["metric", f"run {a}", f"run {b}", "difference", "wanted", "better"],
        [[with_unit(each["name"], each["unit"]), text(each["a"]), text(each["b"]), signed(each["difference"]), each["goal"] or "",
          {"a": f"run {a}", "b": f"run {b}"}.get(each["better"], each["better"] or "")] for each in result["metrics"]],
    )  # fmt: skip
    for each in (runs.find(a), runs.find(b)):
        print(f"run {each.run}: {goals_met(each, runs.document(each))}")
    print(result["unranked"] or f"same: differs by less than {100 * result['alike']:g} %")


Form = Literal["fcd", "csv", "parquet", "channels", "mcap"]


@commands.command()
def export(
    run: Annotated[int, typer.Argument(help="Number of the run.")],
    out: Annotated[Path, typer.Option("--out", help="The file to write; one that is there is replaced.")],
    format_: Annotated[
        Form | None,
        typer.Option(
            "--format",
            help="Trajectories: fcd (SUMO's floating car data, .xml) or csv. All recorded channels: parquet, or channels (a .csv table). "
            "mcap: channels, scene, events and messages for Foxglove. "
            "Left out: by the ending of the file, csv for .csv.",
        ),
    ] = None,
    as_degrees: Annotated[bool, typer.Option("--degrees", help="Longitude and latitude instead of metres of the map.")] = False,
    db: Db = DEFAULT_DB,
) -> None:
    """Writes a run for other programs: trajectories of the recorded vehicles, with recording.traffic of all, or all that was recorded."""
    from studio.store import trace
    from studio.store.export import export as exported
    from studio.store.mcap import mcap

    form = format_of(out, format_)
    runs = existing(db)
    if form == "parquet":
        parts = iter([runs.parquet(run)])
    elif form == "mcap":
        parts = mcap(runs, run)
    else:
        texts = trace.lines(runs.parquet(run)) if form == "channels" else exported(runs, run, form, as_degrees=as_degrees)
        parts = (each.encode() for each in texts)
    put(out, lambda file: file.writelines(parts))
    what = "trajectories" if form in ("fcd", "csv") else "recorded channels"
    print(f"{out}: the {what} of run {run}, {out.stat().st_size / 1e6:.1f} MB")


ENDINGS: dict[Form, str] = {"fcd": ".xml", "csv": ".csv", "parquet": ".parquet", "channels": ".csv", "mcap": ".mcap"}  # of an exported run


def format_of(out: Path, named: Form | None) -> Form:
    """The format that is named, or that of a file's ending; raises StoreError where there is none, or where the two contradict."""
    ending = out.suffix.lower()
    by_ending = [name for name, each in ENDINGS.items() if each == ending]
    if named and (named in by_ending or not by_ending):
        return named
    if by_ending and not named:
        return by_ending[0]
    allowed = ", ".join(f"{name}: {each}" for name, each in ENDINGS.items() if named in (None, name))
    what = f"does not end as {named} does" if named else "tells no format by its ending"
    raise StoreError("The run cannot be exported.", [Problem("--out", what, str(out), allowed, "another ending, or another --format")])


@commands.command()
def check(
    scenario: ScenarioFile,
    set_: Sets = None,
    kinds: Kinds = None,
    traffic: Annotated[bool, typer.Option("--traffic", help="List the cars of the traffic, and what their drivers are like.")] = False,
) -> None:
    """Checks a scenario file: fields, names, map, routes and starts, and what its applications decide on drawn inputs."""
    with progress("checking"):
        from studio import job
        from studio.execution.event import foreseen
        from studio.workshop import trial
        from studio.world.setting import refuse

        load_kinds(kinds)
        loaded = job.load(scenario, changes(set_))
        prepared = job.prepare(loaded)
        refuse(trial.problems(loaded.scenario, scenario.name), scenario.name)
    tell_migrated(loaded)
    print(f"{scenario} is valid: {len(prepared.cars)} vehicles on {prepared.network.name}. {prepared.network.attribution}".rstrip())
    print("".join(f"note: {event.text}\n" for event in foreseen(prepared)), end="")
    if traffic:
        print_traffic(prepared)


@commands.command()
def migrate(scenario: ScenarioFile, kinds: Kinds = None) -> None:
    """Rewrites an old scenario file in place as the present version of the format has it; what moves loses its comments."""
    load_kinds(kinds)
    from studio import job
    from studio.scenario import file
    from studio.scenario.schema import VERSION
    from studio.scenario.text.migration import migrated

    source = file.opened(scenario)
    now, changed = migrated(source)
    if now.text != source.text:
        job.loaded(file.checked(now, "scenario"), scenario)
        file.write(scenario, now.text)
    for each in changed:
        print(f"{scenario}: {each}")
    print(f"{scenario} is of version {VERSION}" + (" already" if now.text == source.text else " now"))


def tell_migrated(loaded) -> None:
    """What an old file says in another way now, on standard error."""
    for each in loaded.migrated:
        print(f"{loaded.path}: {each}", file=sys.stderr)
    if loaded.migrated:
        print(f"{loaded.path} is of an older version; `studio migrate {loaded.path}` rewrites it", file=sys.stderr)


@commands.command()
def schema(kinds: Kinds = None) -> None:
    """Prints the JSON schema of scenario files."""
    load_kinds(kinds)
    from studio.scenario.schema import Scenario, json_schema

    print_json(json_schema(Scenario))


# -- the runs, and how they are shown ----------------------------------------------------------------


def existing(db: Path):
    """The runs of a database that must exist; reading makes no file."""
    from studio.store.runs import read_runs

    if not db.exists():
        raise UnknownError(
            f"There is no run database {db}.",
            [Problem("--db", "does not exist", str(db), remedy="run a scenario first, or name another file")],
        )
    return read_runs(db)


def run_json(row) -> dict[str, Any]:
    """A run as the one object that scripts read."""
    plain = asdict(row)
    plain["metrics"] = {name: asdict(each) for name, each in row.metrics.items()}
    return plain


def events_json(events) -> dict[str, Any]:
    """What happened, as scripts read it."""
    return {"events": [each.as_json() for each in events]}


def print_events(events) -> None:
    """What happened, for people."""
    if events:
        print_table(["time [s]", "vehicle", "event"], [[text(each.time), each.vehicle, each.text] for each in events])


def print_traffic(prepared) -> None:
    """The cars of the traffic with what they and their drivers differ in, and what they have in common, for people."""
    cars = [car for car in prepared.cars if car.returns or car.is_outside]
    told = [(car, {"dynamics": "light" if car.is_light else "full"} | what_driver(car)) for car in cars]
    named = list(dict.fromkeys(name for _, driver in told for name in driver))
    settings = [name for name in named if len({driver.get(name, "") for _, driver in told}) > 1]
    streams = [prepared.sources[car.source].stream.rpartition("/")[0] if car.source is not None else "" for car in cars]
    rows = [
        [car.name, car.model.name, stream, *(driver.get(name, "") for name in settings)]
        for (car, driver), stream in zip(told, streams, strict=True)
    ]
    print_table(["vehicle", "model", "flow", *settings], rows)
    alike = ", ".join(f"{name} {told[0][1][name]}" for name in named if name not in settings)
    print(f"alike for all: {alike}" if alike else "")


def what_driver(car) -> dict[str, str]:
    """The settings of a car's driver, for people."""
    return {name: text(each) for name, each in car.driver.model_dump().items() if name != "preset"}


def print_run(row) -> None:
    """A run for people."""
    lines = {
        "run": f"{row.run} ({row.status})",
        "scenario": f"{row.scenario}  {row.scenario_hash[:12]}",
        "set": settings(row.parameters) or "nothing, as in the file",
        "parent": str(row.parent or "none"),
        "verdict": f"{row.verdict}: {row.reason}" if row.reason else row.verdict,
        "called": ", ".join(each for each in (row.name, *row.tags) if each) or "nothing",
        "seed": str(row.seed),
        "time": f"{text(row.sim_time_s)} s simulated in {text(row.wall_time_s)} s",
        "state": (row.state_hash or "none")[:16],
        "code": row.code_version,
        "kinds": ", ".join(name for name in row.kinds if not name.startswith(("metric.", "channel."))) or "none by name",
    }
    for name, value in lines.items():
        print(f"{name:9} {value}")
    if row.error:
        print(f"\n{row.error}")
    if row.metrics:
        print_table(
            ["metric", "value", "whom and when", "better"],
            [[with_unit(name, each.unit), text(each.value), each.about, each.goal or ""] for name, each in row.metrics.items()],
        )


def with_unit(name: str, unit: str) -> str:
    """A name with its unit; numbers without one have none."""
    return f"{name} [{unit}]" if unit and unit != "1" else name


def print_goals(row, document: dict[str, Any]) -> None:
    """What was wanted of a run, and whether it was met."""
    from studio.assess.goal import asked, failing, goals_of

    print(goals_met(row, document))
    rows = []
    for name, goal in goals_of(document).items():
        found, why = row.metrics.get(name), failing(name, goal, row.metrics.get(name))
        rows.append(
            [with_unit(name, found.unit if found else ""), asked(goal), text(found.value if found else None), "no" if why else "yes"]
        )
    if rows:
        print_table(["goal", "wanted", "value", "met"], rows)
    print("".join(f"goal not met: {each}\n" for each in row.unmet), end="")


def goals_met(row, document: dict[str, Any]) -> str:
    """How many of its goals a run meets, in words."""
    from studio.assess.goal import goals_of, unmet

    goals = goals_of(document)
    if not goals:
        return "no goals are set"
    if not row.metrics:
        return f"{len(goals)} goals, and nothing was measured"
    hits = row.metrics["collisions"].value if "collisions" in row.metrics and "collisions" not in goals else 0
    though = f", though there {'was a collision' if hits == 1 else f'were {hits:g} collisions'}" if hits else ""
    return f"{len(goals) - len(unmet(goals, row.metrics))} of {len(goals)} goals met{though}"


def print_sources(row, texts: dict[str, dict[str, str]], patches: dict[str, str]) -> None:
    """The texts of a run's kinds, then what was changed since the last commits."""
    for name, files in texts.items():
        for file, content in files.items():
            print(f"# ---- {name} {row.kinds[name]}: {file}\n{content}")
    for each in row.revisions:
        print(f"# ---- {each['folder']}: {each['commit']}{', cut' if each['is_cut'] else ''}\n{patches[each['folder']]}")


def settings(parameters: dict[str, Any]) -> str:
    """What was set, in one line."""
    return ", ".join(f"{path}={value}" for path, value in parameters.items())


def metric_text(row, name: str) -> str:
    """A metric of a row."""
    return text(row.metrics[name].value) if name in row.metrics else ""
