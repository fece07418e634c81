"""A server with nothing but the scene, on a real port, for tests that need real sockets."""

import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import uvicorn
from fastapi import FastAPI

from studio.server import relay
from studio.server.origin import SameOrigin
from tests.patience import PATIENCE, until


@contextmanager
def served(door: Callable[[], tuple[int, dict[str, str]]]) -> Iterator[int]:
    """Serves the scene whose viser server is behind door(); gives our own port."""
    app = FastAPI()
    app.include_router(relay.router(lambda stage: door()))
    app.add_middleware(SameOrigin)
    listener = socket.create_server(("127.0.0.1", 0))
    config = uvicorn.Config(app, log_level="error", ws_per_message_deflate=False, ws_max_size=2**28)
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
    thread.start()
    until(lambda: server.started, "the server")
    try:
        yield listener.getsockname()[1]
    finally:
        server.should_exit = True
        thread.join(timeout=PATIENCE)
