"""Commands that say something of runs: verdict, remark."""

from typing import Annotated

import typer

from studio.cli.option import DEFAULT_DB, AsJson, Db
from studio.cli.output import print_json, print_table
from studio.cli.running import existing

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
