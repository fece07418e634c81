"""The door: lets the page out at once, while what computes is still being imported.

Numerics, map tools and the scene take two seconds to import. The page needs none of them; its first requests wait here.
"""

import asyncio
import logging
from collections.abc import Callable
from contextlib import AsyncExitStack
from typing import Any

from fastapi import FastAPI
from starlette.types import ASGIApp, Receive, Scope, Send

from studio.server.origin import INNER

LOG = logging.getLogger(__name__)


def told(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """One line for what the system refuses, such as another connection; the loop's own words for everything else."""
    error = context.get("exception")
    if isinstance(error, OSError):
        LOG.warning("%s: %s", context["message"], error)
    else:
        loop.default_exception_handler(context)


class Door:
    """ASGI: `page` answers by itself; addresses under INNER wait for the application that `make` makes."""

    def __init__(self, page: ASGIApp, make: Callable[[], FastAPI]) -> None:
        self.page, self.make = page, make
        self.inside: asyncio.Task[FastAPI] | None = None
        self.stack = AsyncExitStack()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            await self.live(receive, send)
        elif scope["path"].startswith(INNER):
            assert self.inside, "the server's life begins before its first request"
            app = await asyncio.shield(self.inside)
            await app(scope, receive, send)
        else:
            await self.page(scope, receive, send)

    async def live(self, receive: Receive, send: Send) -> None:
        """Opens when the server starts, closes when it ends."""
        await receive()
        asyncio.get_running_loop().set_exception_handler(told)
        self.inside = asyncio.create_task(self.open())
        await send({"type": "lifespan.startup.complete"})
        await receive()
        await asyncio.wait([self.inside])
        await self.stack.aclose()
        await send({"type": "lifespan.shutdown.complete"})

    async def open(self) -> FastAPI:
        """Makes the application and starts its life."""
        app = await asyncio.to_thread(self.make)
        await self.stack.enter_async_context(app.router.lifespan_context(app))
        return app
