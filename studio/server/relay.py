"""The scene on our own origin: the client's page at /scene/, and its WebSocket relayed to the viser server.

The viser server listens on 127.0.0.1 only and lets in nobody who has not its key: browsers never talk to it directly.
"""

import asyncio
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Annotated

import websockets
from fastapi import APIRouter, Path, WebSocket
from fastapi.responses import HTMLResponse, RedirectResponse
from starlette.websockets import WebSocketDisconnect, WebSocketState
from websockets.asyncio.client import ClientConnection

from studio.scene import client
from studio.server.answer import FIRST_STAGE, MOST_STAGES

# opens a public tunnel to the viser server: nobody may ask for that
FORBIDDEN = b"ShareUrlRequest"
# viser's client is one file, with its scripts in it
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval' data: blob:; style-src 'unsafe-inline'; img-src 'self' data: blob:; "
    "font-src data:; connect-src 'self' data: blob:; worker-src blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
)
# close codes that mean "no close frame came" must not be sent themselves (RFC 6455, section 7.4.1)
UNSENDABLE = {1005, 1006, 1015}
GOING_AWAY, TRY_AGAIN_LATER = 1001, 1013


Number = Annotated[int, Path(ge=FIRST_STAGE, le=MOST_STAGES)]


def router(
    door: Callable[[int], tuple[int, dict[str, str]]], joined: Callable[[int], AbstractContextManager[None]] = lambda stage: nullcontext()
) -> APIRouter:
    """Routes of the scenes, the first without its number; `door` tells where the viser server of a stage listens on 127.0.0.1, and the
    headers that it wants; `joined` holds while a browser is connected."""
    routes = APIRouter(include_in_schema=False)

    @routes.get("/scene")
    def slash() -> RedirectResponse:
        return RedirectResponse("/scene/")

    @routes.get("/scene/")
    def first() -> HTMLResponse:
        return page(FIRST_STAGE)

    @routes.get("/scene/{stage}/")
    def page(stage: Number) -> HTMLResponse:
        return HTMLResponse(client.page(), headers={"Cache-Control": "no-cache", "Content-Security-Policy": POLICY})

    @routes.websocket("/scene")
    @routes.websocket("/scene/")
    async def first_socket(browser: WebSocket) -> None:
        await socket(browser, FIRST_STAGE)

    @routes.websocket("/scene/{stage}")
    @routes.websocket("/scene/{stage}/")
    async def socket(browser: WebSocket, stage: Number) -> None:
        with joined(stage):
            port, headers = await asyncio.to_thread(door, stage)
            await relay(browser, f"ws://127.0.0.1:{port}", headers)

    return routes


async def relay(browser: WebSocket, url: str, headers: dict[str, str]) -> None:
    """Join a browser's WebSocket with the one at `url`, asked for with headers, until either side goes."""
    try:
        upstream = await websockets.connect(
            url,
            additional_headers=headers,
            subprotocols=browser.scope["subprotocols"] or None,
            max_size=None,
            compression=None,
            proxy=None,
            # viser is a thread of this process: it cannot be gone without a word, and a busy machine lets it answer late
            open_timeout=None,
            ping_interval=None,
        )
    except (OSError, websockets.WebSocketException):
        await browser.close(TRY_AGAIN_LATER)
        return
    async with upstream:
        await browser.accept(subprotocol=upstream.subprotocol)
        await _until_one_ends(_down(upstream, browser), _up(browser, upstream))
    await _close(browser, upstream.close_code)


async def _until_one_ends(*ways) -> None:
    tasks = [asyncio.ensure_future(way) for way in ways]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _down(upstream: ClientConnection, browser: WebSocket) -> None:
    async for message in upstream:
        await (browser.send_bytes(message) if isinstance(message, bytes) else browser.send_text(message))


async def _up(browser: WebSocket, upstream: ClientConnection) -> None:
    while True:
        message = await browser.receive()
        if message["type"] == "websocket.disconnect":
            return
        data = message.get("bytes") or (message.get("text") or "").encode()
        if FORBIDDEN not in data:
            await upstream.send(data)


async def _close(browser: WebSocket, code: int | None) -> None:
    if browser.client_state is WebSocketState.DISCONNECTED:
        return
    try:
        await browser.close(GOING_AWAY if code is None or code in UNSENDABLE else code)
    except (RuntimeError, WebSocketDisconnect):
        # the browser went away in the same moment
        return
