"""Commands about the server: serve it, describe it."""

from pathlib import Path
from typing import Annotated

import typer

from studio.cli.option import DEFAULT_DB, Db, Kinds, load_kinds
from studio.cli.output import print_json

commands = typer.Typer()


@commands.command()
def serve(
    host: Annotated[str, typer.Option(help="Address to serve on; on a network only who has the printed token gets in.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port to serve on.", min=0, max=65535)] = 8000,
    db: Db = DEFAULT_DB,
    scenarios: Annotated[Path | None, typer.Option(help="Folder of scenario files; default: ./scenarios, else the samples.")] = None,
    kinds: Kinds = None,
    at_once: Annotated[int, typer.Option(help="Runs that go on at a time; others wait for their turn.", min=1, max=256)] = 8,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in a browser.")] = True,
) -> None:  # fmt: skip
    """Serves the page, the scene and the REST API."""
    from studio.server.serve import serve as start

    load_kinds(kinds)
    start(host=host, port=port, db=db, scenarios=scenarios, kinds=kinds, browser=browser, at_once=at_once)


@commands.command()
def openapi() -> None:
    """Prints the description of the REST API."""
    from studio.server.app import description

    print_json(description())
