"""The relay between a browser and a real viser server, over real sockets."""

import asyncio
import socket

import httpx
import msgspec
import pytest
import viser
import websockets

from studio.scene.projection import Scene
from tests.patience import PATIENCE, until
from tests.server.stage import served

PROTOCOL = f"viser-v{viser.__version__}"


@pytest.fixture(scope="module")
def scene():
    shown = Scene()
    yield shown
    shown.stop()


@pytest.fixture(scope="module")
def port(scene):
    with served(lambda: scene.door) as own:
        yield own


def connect(port: int, *, protocol: str = PROTOCOL, **options):
    path = options.pop("path", "/scene")
    url = f"ws://127.0.0.1:{port}{path}"
    patience = {"open_timeout": PATIENCE, "ping_timeout": PATIENCE}
    return websockets.connect(url, subprotocols=[protocol], max_size=None, proxy=None, **patience, **options)


@pytest.mark.parametrize("path", ["/scene", "/scene/"])
def test_the_whole_scene_arrives_in_binary_under_visers_protocol(port, path):
    async def first() -> tuple[str, bytes]:
        async with connect(port, path=path) as client:
            return client.subprotocol, await asyncio.wait_for(client.recv(), PATIENCE)

    protocol, message = asyncio.run(first())
    assert protocol == PROTOCOL
    # wire format of viser 1.1.1: two sizes, then the packed messages, then the arrays
    assert isinstance(message, bytes) and len(message) > 10_000


def test_what_the_browser_says_reaches_viser(scene, port):
    camera = {
        "type": "ViewerCameraMessage",
        "wxyz": [1.0, 0.0, 0.0, 0.0],
        "position": [1.0, 2.0, 3.0],
        "fov": 0.7,
        "near": 0.1,
        "far": 100.0,
        "image_height": 90,
        "image_width": 160,
        "look_at": [0.0, 0.0, 0.0],
        "up_direction": [0.0, 0.0, 1.0],
    }

    async def look() -> list[tuple[float, ...]]:
        async with connect(port) as client:
            await client.recv()
            await client.send(msgspec.msgpack.encode(camera))
            clients = await asyncio.to_thread(until, scene._server.get_clients, "the client's camera")
            return [tuple(one.camera.position) for one in clients.values()]

    assert asyncio.run(look()) == [(1.0, 2.0, 3.0)]


def test_nobody_can_ask_for_a_public_tunnel(scene, port):
    heard = []
    from viser import _messages

    scene._server._websock_server.register_handler(_messages.ShareUrlRequest, lambda *args: heard.append("share"))
    scene._server._websock_server.register_handler(_messages.ShareUrlDisconnect, lambda *args: heard.append("end"))

    async def ask() -> None:
        async with connect(port) as client:
            await client.recv()
            await client.send(msgspec.msgpack.encode({"type": "ShareUrlRequest"}))
            await client.send(msgspec.msgpack.encode({"type": "ShareUrlDisconnect"}))
            await asyncio.to_thread(until, lambda: heard, "the end of a tunnel")

    asyncio.run(ask())
    assert heard == ["end"]


def test_when_the_browser_goes_viser_forgets_it(scene, port):
    connected = scene._server._websock_server._client_state_from_id

    async def count_is(expected: int) -> None:
        await asyncio.to_thread(until, lambda: len(connected) == expected, f"{expected} browsers")

    async def visit() -> None:
        await count_is(0)
        async with connect(port) as client:
            await client.recv()
            await count_is(1)
        await count_is(0)

    asyncio.run(visit())


def test_another_version_of_the_client_is_told_so(port):
    async def visit() -> int:
        async with connect(port, protocol="viser-v0.0.1") as client:
            with pytest.raises(websockets.ConnectionClosed):
                await asyncio.wait_for(client.recv(), PATIENCE)
            return client.close_code

    # 1002: viser's word for another version
    assert asyncio.run(visit()) == 1002


def test_when_viser_stops_the_browser_is_told():
    scene = Scene()
    with served(lambda: scene.door) as port:

        async def visit() -> int:
            async with connect(port) as client:
                await client.recv()
                await asyncio.to_thread(scene.stop)
                with pytest.raises(websockets.ConnectionClosed):  # noqa: PT012 - whatever still comes before
                    while True:
                        await asyncio.wait_for(client.recv(), PATIENCE)
                return client.close_code

        assert asyncio.run(visit()) in (1000, 1001, 1006, 1011, 1012)


def test_without_viser_the_socket_is_refused():
    with socket.create_server(("127.0.0.1", 0)) as closed:
        nobody = closed.getsockname()[1]

    async def visit(port: int) -> int:
        with pytest.raises(websockets.InvalidStatus) as refused:
            async with connect(port):
                pass
        return refused.value.response.status_code

    with served(lambda: (nobody, {})) as port:
        assert asyncio.run(visit(port)) == 403


def test_a_foreign_page_gets_neither_page_nor_socket(port):
    async def visit() -> int:
        with pytest.raises(websockets.InvalidStatus) as refused:
            async with connect(port, origin="http://evil.example"):
                pass
        return refused.value.response.status_code

    assert asyncio.run(visit()) == 403
    assert httpx.get(f"http://127.0.0.1:{port}/scene/", headers={"origin": "http://evil.example"}).status_code == 403


def test_the_page_is_visers_client_with_our_bridge(port):
    answer = httpx.get(f"http://127.0.0.1:{port}/scene", follow_redirects=True)
    assert answer.status_code == 200 and answer.url.path == "/scene/"
    assert "text/html" in answer.headers["content-type"]
    assert "frame-ancestors 'self'" in answer.headers["content-security-policy"]
    assert "__studioBridge" in answer.text and '<div id="root">' in answer.text


def test_visers_own_port_lets_nobody_in(scene):
    """Whatever their origin: no page, no socket, and no key but its own."""
    own, headers = scene.door

    async def visit(**options) -> int:
        with pytest.raises(websockets.InvalidStatus) as refused:
            async with websockets.connect(f"ws://127.0.0.1:{own}", subprotocols=[PROTOCOL], proxy=None, open_timeout=PATIENCE, **options):
                pass
        return refused.value.response.status_code

    (name,) = headers
    assert asyncio.run(visit(origin="http://evil.example")) == 403
    assert asyncio.run(visit()) == 403
    assert asyncio.run(visit(additional_headers={name: "guessed"})) == 403
    assert asyncio.run(visit(additional_headers=[*headers.items(), (name, "guessed")])) == 403
    assert httpx.get(f"http://127.0.0.1:{own}/").status_code == 403
