"""A server with nothing but the scene, on a real port, for tests that need real sockets."""

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import uvicorn
from fastapi import FastAPI

from studio.server import relay
from studio.server.origin import SameOrigin


@contextmanager
def served(port: Callable[[], int]) -> Iterator[int]:
    """Serves the scene whose viser server listens on port(); gives our own port."""
    app = FastAPI()
    app.include_router(relay.router(port))
    app.add_middleware(SameOrigin)
    listener = socket.create_server(("127.0.0.1", 0))
    config = uvicorn.Config(app, log_level="error", ws_per_message_deflate=False, ws_max_size=2**28)
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
    thread.start()
    _wait(lambda: server.started)
    try:
        yield listener.getsockname()[1]
    finally:
        server.should_exit = True
        thread.join(timeout=10.0)


def _wait(done: Callable[[], bool], *, limit: float = 10.0) -> None:
    end = time.monotonic() + limit
    while not done():
        if time.monotonic() > end:
            raise TimeoutError("the server did not start")
        time.sleep(0.01)
