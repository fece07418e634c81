"""Commands that say something of runs, and hand them on: verdict, remark, report, notebook, pack, repeat."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from studio.cli.option import DEFAULT_DB, AsJson, Db, Kinds, load_kinds
from studio.cli.output import print_json, print_table
from studio.cli.progress import compile_first, progress
from studio.cli.running import existing
from studio.errors import Problem, ScenarioError

commands = typer.Typer()


@commands.command()
def verdict(
    run: Annotated[int, typer.Argument(help="Number of the run.")],
    word: Annotated[str, typer.Argument(metavar="[open|candidate|discarded]", help="Without it, all verdicts so far are told.")] = "",
    reason: Annotated[str, typer.Option(help="Why, in one line, for who reads it later.")] = "",
    who: Annotated[str, typer.Option(help="Whose verdict it is; default: the user of this machine.")] = "",
    db: Db = DEFAULT_DB,
    as_json: AsJson = False,
) -> None:
    """Decides about a run, with a reason; a verdict stands behind those before it, and counts from now on."""
    from studio.store.verdict import judge, verdicts

    runs = existing(db)
    if word:
        judge(runs, run, word, reason, who)
    given = verdicts(runs, run)
    if as_json:
        print_json([each.as_json() for each in given])
    elif given:
        print_table(["verdict", "when (UTC)", "who", "reason"], [[each.verdict, each.when[:19], each.who, each.reason] for each in given])
    else:
        print(f"Run {run} is open: nobody has decided about it. Try: studio verdict {run} candidate --reason '...'")


@commands.command()
def remark(
    run: Annotated[int, typer.Argument(help="Number of the run.")],
    name: Annotated[str | None, typer.Option(help="What it is called; '' takes the name away.")] = None,
    tag: Annotated[list[str] | None, typer.Option(help="A word to find it by; may stand several times, and replaces those before.")] = None,
    note: Annotated[str | None, typer.Option(help="A text about it.")] = None,
    db: Db = DEFAULT_DB,
    as_json: AsJson = False,
) -> None:
    """Gives a run a name, tags and a note; what is not said stays as it was. Alone it tells them."""
    from dataclasses import asdict

    from studio.store.verdict import remark as say
    from studio.store.verdict import remark_of

    runs = existing(db)
    said = remark_of(runs, run)
    if not (name is None and tag is None and note is None):
        tags = said.tags if tag is None else [each for each in tag if each]
        said = say(runs, run, name=said.name if name is None else name, tags=tags, note=said.note if note is None else note)
    if as_json:
        print_json(asdict(said))
        return
    for what, text in (("name", said.name), ("tags", ", ".join(said.tags)), ("note", said.note)):
        print(f"{what}  {text or '-'}")


@commands.command()
def report(
    run: Annotated[int, typer.Argument(help="Number of the run.")],
    out: Annotated[Path | None, typer.Option(help="The file, .html or .pdf; default: run_N.html here.")] = None,
    db: Db = DEFAULT_DB,
) -> None:
    """Writes one page about a run, to be read and printed: verdict, metrics against its parent, charts, events, environment."""
    from studio.parcel import paper
    from studio.parcel.report import report as page

    target = out or Path(f"run_{run}.html")
    paper.check(target)
    paper.write(page(existing(db), run), target)
    print(target)


@commands.command()
def notebook(
    run: Annotated[int, typer.Argument(help="Number of the run.")],
    out: Annotated[Path | None, typer.Option(help="The file; default: run_N.ipynb here.")] = None,
    url: Annotated[str, typer.Option(help="Where the studio serves that has the run.")] = "http://127.0.0.1:8000",
    db: Db = DEFAULT_DB,
) -> None:
    """Writes a notebook (Jupyter) that reads a run from a studio that serves it: its parameters, metrics and traces."""
    from studio.parcel.notebook import notebook as made

    runs, target = existing(db), out or Path(f"run_{run}.ipynb")
    text = made(runs.find(run), [each["name"] for each in runs.channels(run)], url)
    try:
        target.write_text(text, encoding="utf-8")
    except OSError as error:
        raise ScenarioError(
            f"{target} cannot be written.", [Problem(str(target), f"cannot be written: {error.strerror or error}")]
        ) from None
    print(target)


@commands.command()
def pack(
    run: Annotated[int, typer.Argument(help="Number of the run.")],
    folder: Annotated[Path | None, typer.Argument(help="A new folder; default: run_N here.")] = None,
    scenarios: Annotated[Path, typer.Option(help="Folder with the scenario that it stems from, for its map.")] = Path("scenarios"),
    db: Db = DEFAULT_DB,
    kinds: Kinds = None,
    as_json: AsJson = False,
) -> None:
    """Packs a run with all that it takes to repeat it elsewhere: scenario, map, kinds, row, traces, and a page about it."""
    from studio.parcel.pack import pack as packed

    load_kinds(kinds)
    with progress("packing"):
        parcel = packed(existing(db), run, folder or Path(f"run_{run}"), scenarios)
    for note in parcel.notes:
        print(note, file=sys.stderr)
    print_json({"folder": str(parcel.folder), "files": parcel.files, "notes": parcel.notes}) if as_json else print("\n".join(parcel.files))


@commands.command()
def repeat(
    folder: Annotated[Path, typer.Argument(help="What `studio pack` has made. Its kinds are loaded, and so is their code.")],
    as_json: AsJson = False,
) -> None:
    """Runs a packed run again and tells whether the bits are the same; ends with 1 when they are not, and says what differs."""
    from studio.parcel.repeat import repeat as repeated

    compile_first()
    with progress("running") as share:
        found = repeated(folder, share)
    if as_json:
        print_json(found.as_json())
    else:
        print(f"The state at the end has the same bits, {found.found[:16]}." if found.is_same else
              f"The state at the end is another: {found.found[:16]} and not {found.expected[:16]}.")  # fmt: skip
        differing = {**found.environment, **found.metrics}
        print_table(
            ["what differs", "then", "now"], [[name, str(then), str(now)] for name, (then, now) in differing.items()]
        ) if differing else None
    if not found.is_same:
        raise typer.Exit(1)
