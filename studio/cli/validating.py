"""Commands about recorded drives: import a log, find its maneuvers, calibrate and validate a vehicle against them."""

from pathlib import Path
from typing import Annotated, Any

import typer

from studio.cli.option import DEFAULT_DB, AsJson, Db, Kinds, load_kinds
from studio.cli.output import print_json, print_table, text
from studio.cli.progress import compile_first, progress, told
from studio.errors import Problem, ScenarioError

commands = typer.Typer()
logs = typer.Typer(help="Recorded drives.", no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False)
commands.add_typer(logs, name="logs")
LogFile = Annotated[
    Path,
    typer.Argument(
        metavar="FILE", help="CSV, .npz, MDF (.mf4), a CAN trace (.blf, .asc), or a folder of arrays; .gz too; or of a format of your own."
    ),
]
MappingFile = Annotated[Path | None, typer.Option("--mapping", help="Which recorded signal is which of ours (YAML).")]
DbcFile = Annotated[Path | None, typer.Option("--dbc", help="What the frames of a CAN trace mean.")]
ProjectFile = Annotated[Path, typer.Argument(metavar="PROJECT", help="A validation project (YAML).")]
VehicleOut = Annotated[Path | None, typer.Option("--out", help="A vehicle file (YAML) to write: the values with their provenance.")]
HEAD = ["signal", "unit", "samples", "rate [1/s]", "from [s]", "to [s]", "lowest", "highest", "gaps"]


@logs.command("import")
def import_(
    file: LogFile, mapping: MappingFile = None, dbc: DbcFile = None,
    out: Annotated[Path | None, typer.Option("--out", help="CSV for our signals on one clock; .gz packs it.")] = None,
    kinds: Kinds = None, as_json: AsJson = False,
) -> None:  # fmt: skip
    """Reads a log: what was recorded, and by a mapping what of it is ours, in SI on one clock.

    A gap stays a gap. What cannot be right (a yaw rate of 500 rad/s) is refused, with the unit that was taken for it.
    """
    from studio.log import recording
    from studio.log.hint import contradictions, hints

    load_kinds(kinds)
    log, made, used = taken(file, mapping, dbc)
    if out is not None and made is None:
        problem = Problem("--out", "is of our signals, and nobody says which they are", remedy="give --mapping")
        raise ScenarioError("There is nothing to write.", [problem])
    recorded = [each.facts() for each in log.signals.values()]
    ours = made.facts() if made else []
    doubts = [*(contradictions(used, log) if used else []), *(hints(made) if made else [])]
    if as_json:
        print_json({"log": log.name, "signals": recorded, "ours": ours, "period": recording.PERIOD if made else None, "hints": doubts})
    else:
        print_table(HEAD, [facts(each) for each in recorded])
        print_table(HEAD, [facts(each) for each in ours]) if ours else told("Which signal is which of ours says a mapping: --mapping FILE.")
    for each in doubts:
        told(f"warning: {each}")
    if out is not None and made is not None:
        told(f"{out}: {recording.write(made, out)} rows")


def taken(file: Path, mapping: Path | None, dbc: Path | None):
    """The log, our signals where a mapping says which they are, or their names do, and the mapping."""
    from studio.log import mapping as maps
    from studio.log import reading, recording

    known = maps.read(mapping) if mapping else None
    log = reading.read(file, dbc or (known.dbc if known else None))
    if known is None and not maps.has_named(log):
        return log, None, None
    return log, recording.of_log(log, known.mapping if known else None), known.mapping if known else None


def facts(each: dict[str, Any]) -> list[str]:
    """A signal as a row."""
    numbers = [text(each[name]) for name in ("rate", "from", "to", "low", "high")]
    return [each["name"], each["unit"] or "–", str(each["count"]), *numbers, str(len(each["gaps"]) or "–")]


@logs.command()
def cut(file: LogFile, mapping: MappingFile = None, dbc: DbcFile = None, kinds: Kinds = None, as_json: AsJson = False) -> None:
    """Finds the maneuvers in a long log, as the runs of a project take them: correct the times there where a cut is wrong."""
    from studio.validation import known

    load_kinds(kinds)
    _, made, _ = taken(file, mapping, dbc)
    if made is None:
        raise ScenarioError(
            "Nobody says what was recorded.", [Problem("--mapping", "is missing", remedy="say which signal is which of ours")]
        )
    found = known.cuts(made)
    if as_json:
        print_json([{"kind": kind, "begin": begin, "end": end} for kind, begin, end in found])
    elif found:
        print_table(["maneuver", "run of a project"], [[kind, run_text(file, begin, end)] for kind, begin, end in found])
    else:
        print("No maneuver was found; a run of kind `steered` takes any drive with steering and speed.")


def run_text(file: Path, begin: float, end: float) -> str:
    """A run as a project has it."""
    return f"- {{log: {file.name}, begin: {begin:.2f}, end: {end:.2f}}}"


@commands.command()
def calibrate(
    project: ProjectFile,
    step: Annotated[str | None, typer.Argument(metavar="STEP", help="A step of calibration; none: all of them, in their order.")] = None,
    afresh: Annotated[bool, typer.Option("--afresh", help="Leave aside what was calibrated before.")] = False,
    out: VehicleOut = None,
    kinds: Kinds = None,
    db: Db = DEFAULT_DB,
    as_json: AsJson = False,
) -> None:
    """Finds the parameters of a vehicle with which it follows recorded runs best, and how well they are known.

    Every step is an iteration in the run database, and goes on from the one before. Interrupt it: nothing of the step is kept.
    """
    from studio.store.runs import open_runs
    from studio.validation import iterate
    from studio.validation.project import load

    load_kinds(kinds)
    loaded = load(project)
    steps = [step] if step else list(loaded.project.calibration)
    if not steps:
        what = Problem("calibration", "is missing", remedy="say what to look for: a step with its parameters and their ranges")
        raise ScenarioError(f"{project.name} does not say what to calibrate.", [what])
    compile_first()
    found, runs = [], open_runs(db)
    for i, name in enumerate(steps):
        begun = iterate.begin(loaded, runs, afresh=afresh and i == 0)
        with progress(f"calibrating: {name}") as report:
            number, each = iterate.calibrate(begun, name, runs, report)
        found.append({"iteration": number, "step": name} | each.as_json())
        if not as_json:
            print_calibrated(number, name, each)
    if as_json:
        print_json(found)
    if out is not None:
        written(iterate.begin(loaded, runs), runs, out, found[-1]["iteration"], None)


def print_calibrated(number: int, name: str, found) -> None:
    """What a step found."""
    print(f"iteration {number}: {name}")
    rows = [
        [each.path, text(each.start), f"{each.value:.6g}", f"{2 * each.spread:.2g}", each.unit, f"{each.low:g} to {each.high:g}"]
        for each in found.estimates
    ]
    print_table(["parameter", "before", "found", "± (two standard deviations)", "unit", "allowed"], rows)
    misfit = [[name, f"{100 * before:.3g} %", f"{100 * after:.3g} %"] for name, (before, after) in found.misfit.items()]
    print_table(["RMS difference over the range of", "before", "after"], misfit)
    for each in found.warnings:
        told(f"warning: {each}")


def written(step, runs, out: Path, number: int, span) -> None:
    """Writes the vehicle of an iteration."""
    from studio.validation import iterate, sheet

    sheet.write(step.loaded.model, out, title=step.loaded.project.title, estimates=iterate.estimates(runs, number), span=span)
    told(f"{out}: the vehicle of iteration {number}")


@commands.command()
def validate(
    project: ProjectFile,
    afresh: Annotated[bool, typer.Option("--afresh", help="The vehicle as the project names it, without what was calibrated.")] = False,
    report: Annotated[Path | None, typer.Option("--report", help="A report to write, .html or .pdf, with tables and figures.")] = None,
    out: VehicleOut = None,
    kinds: Kinds = None,
    db: Db = DEFAULT_DB,
    as_json: AsJson = False,
) -> None:
    """Judges a vehicle against recorded runs by the criteria of its maneuvers; it is that of the last calibration of the project.

    With --out the vehicle is written with its validated span, which later runs hold it to. Ends with code 1 when a criterion fails.
    """
    from studio.parcel import paper
    from studio.store.runs import open_runs
    from studio.validation import iterate
    from studio.validation.project import load

    load_kinds(kinds)
    if report is not None:
        paper.check(report)
    loaded = load(project)
    runs = open_runs(db)
    step = iterate.begin(loaded, runs, afresh=afresh)
    compile_first()
    with progress("validating") as share:
        number, found = iterate.validate(step, runs, share)
    if as_json:
        print_json(found.as_json() | {"iteration": number})
    else:
        print_validated(number, step, found)
    if report is not None:
        print_report(report, step, found, runs, number)
    if out is not None:
        written(step, runs, out, number, found.span)
    if not found.is_valid:
        raise typer.Exit(1)


def print_validated(number: int, step, found) -> None:
    """Verdicts, and the span in words."""
    from studio.validation import report, span, table
    from studio.validation.zone import WORDS

    before = f"with the values of iteration {step.before.iteration}" if step.before else "as the project names it"
    print(f"iteration {number}: {step.loaded.model.name}, {before}; {WORDS[found.confidence]}")
    print_table(["maneuver", *table.HEAD], [[each.maneuver, *table.cells(each)] for each in found.verdicts])
    for name, left in found.unjudged.items():
        print(f"Not judged in {name}:", "; ".join(left))
    print("Validated span:", "; ".join(span.told(found.span)))
    for each in found.hints:
        told(f"hint: {each}")
    if found.doubtful:
        told(f"hint: {report.doubtful(found.doubtful)}")


def print_report(out: Path, step, found, runs, number: int) -> None:
    """Writes the report."""
    from studio.parcel import paper
    from studio.validation import iterate
    from studio.validation.report import report

    paper.write(report(step.loaded, found, iterate.estimates(runs, number), number), out)
    told(f"{out}: the report of iteration {number}")
