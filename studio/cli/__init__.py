"""The command line: the same functions as the page and REST, as commands.

Results go to standard output, progress and errors to standard error. Wrong input ends with code 2, a run that failed
with code 1. A command imports what it needs when it is called: a list of runs need not wait for the compiler.
"""

import gc
import os
import sys

import typer

from studio.cache import cache_root
from studio.cli import deciding, keeping, kind, machine, mapping, running, serving, validating, vehicle
from studio.errors import Problem, RunError, StoreError, StudioError

app = typer.Typer(
    help="Cooperative ADAS Studio. Without a command it serves the page, and takes the options of `studio serve`: "
    "--host, --port, --scenarios and what else `studio serve --help` tells.",
    no_args_is_help=False,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
for group in (serving, running, deciding, keeping, kind, vehicle, mapping, validating, machine):
    app.add_typer(group.commands)


COLLECTED_AFTER = 50_000  # new objects; what is imported is no garbage, and looking through it took a sixth of a start


def main(arguments: list[str] | None = None) -> None:
    """Entry point: `studio` alone, or with options only, serves."""
    gc.set_threshold(COLLECTED_AFTER)
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    if not arguments or (arguments[0].startswith("-") and arguments[0] not in ("--help", "--version")):
        arguments = ["serve", *arguments]
    if arguments == ["--version"]:
        from studio.source import code_version

        print(code_version())
        return
    try:
        if arguments[0] != "doctor":  # who tells about it himself
            check_cache()
        app(arguments, standalone_mode=True)
    except StudioError as error:
        print(error, file=sys.stderr)
        sys.exit(1 if isinstance(error, RunError) else 2)


def check_cache() -> None:
    """What is compiled must be kept somewhere; raises StoreError when the folder for it cannot be made, or not be written."""
    folder = cache_root()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        what = "" if os.access(folder, os.W_OK | os.X_OK) else "may not be written"
    except OSError as error:
        what = f"cannot be made: {error.strerror or error}"
    if what:
        problem = Problem("STUDIO_CACHE", what, str(folder), "a folder of your own", "name another folder with STUDIO_CACHE")
        raise StoreError("There is no folder for what can be made again.", [problem])
