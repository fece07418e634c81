"""Options that several commands share, and what becomes of them."""

from pathlib import Path
from typing import Annotated, Any

import typer

from studio.cli.progress import told

Db = Annotated[Path, typer.Option("--db", help="The run database; made when there is none.")]
Kinds = Annotated[
    list[Path] | None,
    typer.Option("--kinds", "--applications", metavar="FOLDER", help="A folder of Python files, each a kind of your own; can be repeated."),
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object instead of a table.")]
Sets = Annotated[list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Change a field; can be repeated.")]
ScenarioFile = Annotated[Path, typer.Argument(metavar="SCENARIO", help="A scenario file (YAML).")]
DEFAULT_DB = Path("runs.db")


# -- input -------------------------------------------------------------------------------------------


def changes(assignments: list[str] | None) -> dict[str, Any]:
    """The --set options as {path: value}."""
    from studio.scenario.edit import parse_assignment

    return dict(parse_assignment(each) for each in assignments or [])


def load_kinds(folders: list[Path] | None) -> None:
    """Registers the user's own kinds; files that are broken are told on standard error, and hurt nobody who does not need them."""
    if folders:
        from studio.kind import registry

        for folder in folders:
            registry.load_folder(folder)
        for each in registry.broken():
            if Path(each.file).parent in [folder.resolve() for folder in folders]:
                told(f"{each.error}\n")
