"""Options that several commands share, and what becomes of them."""

from pathlib import Path
from typing import Annotated, Any

import typer

Db = Annotated[Path, typer.Option("--db", help="The run database; made when there is none.")]
Applications = Annotated[Path | None, typer.Option("--applications", help="A folder of Python files, each an application of your own.")]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object instead of a table.")]
Sets = Annotated[list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Change a field; can be repeated.")]
ScenarioFile = Annotated[Path, typer.Argument(metavar="SCENARIO", help="A scenario file (YAML).")]
DEFAULT_DB = Path("runs.db")


# -- input -------------------------------------------------------------------------------------------


def changes(assignments: list[str] | None) -> dict[str, Any]:
    """The --set options as {path: value}."""
    from studio.scenario.edit import parse_assignment

    return dict(parse_assignment(each) for each in assignments or [])


def load_applications(folder: Path | None) -> None:
    """Registers the user's own applications."""
    if folder:
        from studio.kind.registry import load_folder

        load_folder(folder)
