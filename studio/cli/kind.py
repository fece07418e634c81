"""Commands about kinds: list them, write a new one, see whether one keeps its contract."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from studio.cli.option import AsJson, Kinds, load_kinds
from studio.cli.output import print_json, print_table
from studio.errors import KindError, Problem, UnknownError, nearest

commands = typer.Typer()


@commands.command()
def kinds(folder: Kinds = None, as_json: AsJson = False) -> None:
    """Lists all kinds with where they come from, and the files that are broken; their tracebacks go to standard error."""
    from studio.kind import registry

    for each in folder or []:
        registry.load_folder(each)
    found, broken = list(registry.every()), registry.broken()
    for each in broken:
        print(f"{each.error}\n", file=sys.stderr)
    if as_json:
        print_json([kind.as_json() for kind in found])
        return
    print_table(["kind", "name", "title", "source"], [[kind.sort, kind.name, kind.title, kind.source] for kind in found])
    if broken:
        print_table(["broken file", "what is wrong"], [[each.file, each.what] for each in broken])


@commands.command()
def new(
    sort: Annotated[
        str,
        typer.Argument(metavar="SORT", help="sensor, radio, message, driver, condition, action, metric, channel, logformat, application."),
    ],
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the kind, and of its file.")],
    folder: Annotated[Path, typer.Option("--folder", help="Where it is written.")] = Path(),
) -> None:
    """Begins a kind of your own: a small working file, a test for it, and a scenario, or a log, that uses it."""
    from studio.workshop.draft import draft, use

    for path in draft(sort, name, folder):
        print(path)
    print(f"Try: studio conform {folder / name}.py; studio {use(sort, name, folder)} --kinds {folder}")


@commands.command()
def conform(
    kind: Annotated[str, typer.Argument(metavar="KIND", help="A file, or the name of a kind: min_ttc, or metric.min_ttc.")],
    kinds: Kinds = None,
) -> None:
    """Tries whether a kind keeps what its sort demands, one check per line; ends with code 1 when it does not."""
    load_kinds(kinds)
    from studio.workshop.check import Check
    from studio.workshop.conform import conform as checks

    try:
        found = {each: checks(each) for each in named(kind)}
    except KindError as error:
        print(Check("loads, and keeps the contract of its sort", str(error)))
        raise typer.Exit(1) from None
    for each, made in found.items():
        print(f"{each.sort} {each.name} ({each.source})", *made, sep="\n")
    if any(check.wrong for made in found.values() for check in made):
        raise typer.Exit(1)


def named(name: str) -> list:
    """The kinds that are meant: the one in a file, or those of a name; raises KindError or UnknownError."""
    from studio.kind import registry

    if name.endswith(".py"):
        if not Path(name).is_file():
            raise UnknownError(
                f"There is no file {name}.", [Problem("KIND", "does not exist", name, "a Python file, or the name of a kind")]
            )
        registry.load_folder(Path(name).resolve().parent)  # it may need others of its folder
        return [registry.load_file(Path(name))]
    found = [kind for kind in registry.every() if name in (kind.name, f"{kind.sort}.{kind.name}")]
    if not found:
        raise UnknownError(f"There is no kind {name!r}; {nearest(name, [kind.name for kind in registry.every()])}")
    return found
