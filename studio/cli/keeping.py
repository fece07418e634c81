"""Commands that keep things in order: backup, restore, doctor."""

import sys
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

    Results that wait beside it are in the copy; of a run that goes on, only that it has begun. The history of edits of scenarios is
    copied beside it.
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


@commands.command()
def doctor(
    db: Db = DEFAULT_DB,
    host: Annotated[str, typer.Option(help="Address that the server is to serve on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port that the server is to serve on.", min=1, max=65535)] = 8000,
    yes: Annotated[bool, typer.Option("--yes", help="Mend without asking.")] = False,
    as_json: AsJson = False,
) -> None:
    """Looks whether installation, run database, caches, disk and port are well, and mends what it can after asking; a server may go on.

    Nothing that has finished is lost by it. Ends with 1 when something is wrong and has not been mended.
    """
    with progress("looking") as report:
        from studio.doctor.finding import Patient
        from studio.doctor.visit import examined

        found = list(examined(Patient(db, db != DEFAULT_DB, host, port), report))
    for each in [] if as_json else found:
        print(line(each))
    outcome = [(each, *treated(each, yes, as_json)) for each in found]
    if as_json:
        print_json([each.as_json(said if is_mended else "") for each, is_mended, said in outcome])
    if any(not each.is_good and not is_mended for each, is_mended, _ in outcome):
        raise typer.Exit(1)


def line(finding) -> str:
    """A finding in one line."""
    remedy = f"; {finding.remedy}" if finding.remedy and not finding.is_good else ""
    return f"{'good' if finding.is_good else 'bad '}  {finding.name:12}  {finding.what}{remedy}"


def treated(finding, yes: bool, as_json: bool) -> tuple[bool, str]:
    """Mends a finding when that can be done and somebody wants it: whether it is mended, and what was said of it."""
    from studio.doctor.visit import mended

    if finding.mend is None or not (yes or (not as_json and wanted(finding))):
        return False, ""
    is_mended, said = mended(finding)
    print(f"{finding.name}: {said if is_mended else f'could not be mended: {said}'}", file=sys.stderr if as_json else sys.stdout)
    return is_mended, said


def wanted(finding) -> bool:
    """Asks, where somebody is there to answer."""
    return sys.stdin.isatty() and typer.confirm(f"{finding.name}: {finding.what}. The doctor {finding.remedy}. Shall he?")


def tell(copied, what: str, as_json: bool) -> None:
    """What has been copied."""
    if as_json:
        print_json(asdict(copied) | {"file": str(copied.file), "before": copied.before and str(copied.before)})
        return
    print(f"{what}: {copied.runs} runs, the newest {copied.newest}, {copied.size / MEGA:.1f} MB, whole")
    if copied.going:
        print(f"without a result, because they went on: {', '.join(map(str, copied.going))}")
