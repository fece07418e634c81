"""Starting the server: port, database, folder of scenarios, token, browser."""

import gc
import ipaddress
import os
import socket
import sys
import threading
import webbrowser
from pathlib import Path

import psutil
import uvicorn

from studio import sample
from studio.errors import Problem, ServerError
from studio.server import gate, page
from studio.server.door import Door
from studio.server.gate import Gate
from studio.server.origin import SameOrigin
from studio.store.runs import open_runs

FRAME_LIMIT = 64 * 1024 * 1024  # [B] of one WebSocket message: a city is sent in one piece
COLLECTED_AFTER = 2000  # new objects: a request leaves some fifty that refer to each other, with 30 kB behind them
PONG_PATIENCE = 120.0  # [s] a busy browser answers late, and is not gone for that


def serve(*, host: str, port: int, db: Path, scenarios: Path | None, kinds: list[Path] | None, browser: bool, at_once: int) -> None:
    """Serves until it is interrupted. Raises StoreError or ServerError before it starts."""
    listening = listen(host, port)
    try:
        open_runs(db).close()
        folder = scenario_folder(scenarios)
        token = gate.token() if is_open(listening) else ""
        app = application(db, folder, kinds, host, token, listening.getsockname()[1], at_once)
    except BaseException:
        listening.close()
        raise
    found = addresses(host, listening)
    print(announced(found, token), flush=True)
    if browser and has_display():
        # without the token, which other users of this machine would see among the arguments of the browser
        threading.Timer(0.5, webbrowser.open, [found[0]]).start()
    config = uvicorn.Config(
        app,
        log_level="warning",
        ws_max_size=FRAME_LIMIT,
        ws_per_message_deflate=False,
        ws_ping_timeout=PONG_PATIENCE,
        timeout_graceful_shutdown=2,
    )
    uvicorn.Server(config).run(sockets=[listening])


def application(db: Path, folder: Path, kinds: list[Path] | None, host: str, token: str, port: int, at_once: int):
    """The ASGI application, behind a gate where there is a token. Live runs load the folders of kinds again, each in its process."""
    door = Door(page.app, lambda: inner(db, folder, kinds, at_once))
    return SameOrigin(Gate(door, token=token, port=port) if token else door, host=host)


def inner(db: Path, folder: Path, kinds: list[Path] | None, at_once: int):
    """REST and scene; imported here, behind the door."""
    from studio.server.app import create_app
    from studio.server.desk import Desk

    own = tuple(each.resolve() for each in kinds or ())
    app = create_app(Desk(db=db.resolve(), scenarios=folder.resolve(), kinds=own, at_once=at_once))
    gc.freeze()  # what is there now stays, and is not looked through any more
    gc.set_threshold(COLLECTED_AFTER)
    return app


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


def is_open(listening: socket.socket) -> bool:
    """Whether others than this machine can reach the server."""
    return not bound(listening).is_loopback


def bound(listening: socket.socket) -> ipaddress.IPv4Address | ipaddress.IPv6Address:
    """The numeric address of a socket."""
    return ipaddress.ip_address(listening.getsockname()[0].partition("%")[0])


def addresses(host: str, listening: socket.socket) -> list[str]:
    """Where the server can be opened, first by this machine: a server on every address is not called by that."""
    hosts = reachable(listening.family) if bound(listening).is_unspecified else [host]
    return [f"http://{shown(each)}:{listening.getsockname()[1]}" for each in hosts]


def reachable(family: int) -> list[str]:
    """The addresses of this machine, its own first, without those that need to be told through which port of it."""
    found = [each.address for every in psutil.net_if_addrs().values() for each in every if each.family == family]
    others = [each for each in found if "%" not in each and not ipaddress.ip_address(each).is_loopback]
    return ["::1" if family == socket.AF_INET6 else "127.0.0.1", *others]


def announced(found: list[str], token: str) -> str:
    """The line that tells where the studio is, and those for other machines."""
    key = f"/?token={token}" if token else ""
    others = [f"from other machines:     {each}{key}" for each in found[1:]]
    return "\n".join([f"Cooperative ADAS Studio: {found[0]}{key}", *others])


def shown(host: str) -> str:
    """A host as it stands in an address."""
    return f"[{host}]" if ":" in host else host


def has_display() -> bool:
    """Whether a browser can be opened here."""
    return sys.platform in ("darwin", "win32") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
