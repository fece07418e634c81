"""Starting the server: port, database, folder of scenarios, browser."""

import os
import socket
import sys
import threading
import webbrowser
from pathlib import Path

import uvicorn

from studio import sample
from studio.errors import Problem, ServerError
from studio.server import page
from studio.server.door import Door
from studio.server.origin import SameOrigin
from studio.store.runs import open_runs

FRAME_LIMIT = 64 * 1024 * 1024  # [B] of one WebSocket message: a city is sent in one piece
PONG_PATIENCE = 120.0  # [s] a busy browser answers late, and is not gone for that


def serve(*, host: str, port: int, db: Path, scenarios: Path | None, kinds: list[Path] | None, browser: bool) -> None:
    """Serves until it is interrupted. Raises StoreError or ServerError before it starts."""
    listening = listen(host, port)
    try:
        open_runs(db).close()
        folder = scenario_folder(scenarios)
        app = application(db, folder, kinds, host)
    except BaseException:
        listening.close()
        raise
    address = f"http://{shown(host)}:{listening.getsockname()[1]}"
    print(f"Cooperative ADAS Studio: {address}", flush=True)
    if browser and has_display():
        threading.Timer(0.5, webbrowser.open, [address]).start()
    config = uvicorn.Config(
        app,
        log_level="warning",
        ws_max_size=FRAME_LIMIT,
        ws_per_message_deflate=False,
        ws_ping_timeout=PONG_PATIENCE,
        timeout_graceful_shutdown=2,
    )
    uvicorn.Server(config).run(sockets=[listening])


def application(db: Path, folder: Path, kinds: list[Path] | None, host: str):
    """The ASGI application. Live runs load the folders of kinds again, each in its process."""
    return SameOrigin(Door(page.app, lambda: inner(db, folder, kinds)), host=host)


def inner(db: Path, folder: Path, kinds: list[Path] | None):
    """REST and scene; imported here, behind the door."""
    from studio.server.app import create_app
    from studio.server.desk import Desk

    return create_app(Desk(db=db.resolve(), scenarios=folder.resolve(), kinds=tuple(each.resolve() for each in kinds or ())))


def listen(host: str, port: int) -> socket.socket:
    """The socket to serve on; raises ServerError when the port is in use or the address is not ours."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)  # named, or asyncio holds small answers back for 40 ms
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
        listening.listen(128)
    except OSError as error:
        listening.close()
        raise ServerError(
            f"The studio cannot serve on {host} port {port}.",
            [Problem("--host, --port", error.strerror or str(error), f"{host}:{port}", remedy=f"try --port {port + 1}")],
        ) from None
    return listening


def scenario_folder(wanted: Path | None) -> Path:
    """The folder that was named, else ./scenarios, else the samples."""
    if wanted is not None and not wanted.is_dir():
        raise ServerError(
            f"There is no folder {wanted}.", [Problem("--scenarios", "is not a folder", str(wanted), "a folder of YAML files")]
        )
    here = Path("scenarios")
    return wanted or (here if here.is_dir() else sample.folder())


def shown(host: str) -> str:
    """A host as it stands in an address."""
    return f"[{host}]" if ":" in host else host


def has_display() -> bool:
    """Whether a browser can be opened here."""
    return sys.platform in ("darwin", "win32") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
