"""Commands that keep runs: backup, restore."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from studio.cli.option import DEFAULT_DB, AsJson, Db
from studio.cli.output import print_json
from studio.cli.progress import progress

commands = typer.Typer()
MEGA = 1e6


@commands.command()
def backup(
    file: Annotated[Path | None, typer.Argument(help="New file, or a folder for one; default: beside the database, with the time.")] = None,
    db: Db = DEFAULT_DB,
    as_json: AsJson = False,
) -> None:
    """Copies the run database to one file, also while it is in use: all runs with traces, events, messages, and texts of their kinds.

    Results that wait beside it are in the copy; of a run that goes on, only that it has begun.
    """
    with progress("copying") as report:
        from studio.store.backup import back_up, stamp

        named = f"{db.stem}-{stamp()}{db.suffix}"
        target = db.with_name(named) if file is None else file / named if file.is_dir() else file
        copied = back_up(db, target, report)
    tell(copied, f"{copied.file} is a backup of {db}", as_json)


@commands.command()
def restore(
    file: Annotated[Path, typer.Argument(help="The backup.")],
    db: Db = DEFAULT_DB,
    replace: Annotated[bool, typer.Option("--replace", help="When there is a database: it is kept beside under another name.")] = False,
    as_json: AsJson = False,
) -> None:
    """Puts a backup in the place of the run database, after a look whether it is whole. A server may go on meanwhile, runs may not."""
    with progress("copying") as report:
        from studio.store.backup import restore as restored

        copied = restored(file, db, replace=replace, report=report)
    tell(copied, f"{db} is what {file} was", as_json)
    if copied.before and not as_json:
        print(f"what was there before lies in {copied.before}")


def tell(copied, what: str, as_json: bool) -> None:
    """What has been copied."""
    if as_json:
        print_json(asdict(copied) | {"file": str(copied.file), "before": copied.before and str(copied.before)})
        return
    print(f"{what}: {copied.runs} runs, the newest {copied.newest}, {copied.size / MEGA:.1f} MB, whole")
    if copied.going:
        print(f"without a result, because they went on: {', '.join(map(str, copied.going))}")
