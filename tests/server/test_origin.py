"""Pages from elsewhere get 403, over HTTP and over WebSockets; our page and programs without Origin pass."""

import asyncio
import socket

import pytest
from fastapi import FastAPI, Response, WebSocket
from fastapi.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from studio.server.door import told
from studio.server.origin import SameOrigin
from studio.server.serve import listen

OURS = "127.0.0.1:8000"


def client(**options) -> TestClient:
    app = FastAPI()

    @app.get("/")
    def root() -> str:
        return "here"

    @app.websocket("/socket")
    async def speak(connection: WebSocket) -> None:
        await connection.accept()
        await connection.send_text("here")
        await connection.close()

    return TestClient(SameOrigin(app, **options), base_url=f"http://{OURS}")


def answers(headers: dict[str, str], **options) -> tuple[int, int]:
    """Status over HTTP, and 200 or 403 over a WebSocket."""
    with client(**options) as here:
        status = here.get("/", headers=headers).status_code
        try:
            with here.websocket_connect("/socket", headers=headers) as socket:
                return status, 200 if socket.receive_text() == "here" else 500
        except WebSocketDisconnect:
            return status, 403


ALLOWED = [
    {"host": OURS},
    {"host": OURS, "origin": f"http://{OURS}"},
    {"host": "localhost:8000", "origin": "http://localhost:8000"},
    {"host": "LOCALHOST:8000", "origin": "http://localhost:8000"},
    {"host": "[::1]:8000", "origin": "http://[::1]:8000"},
    # a tunnel to another port of this machine
    {"host": "localhost:9000", "origin": "http://localhost:9000"},
    {"host": "localhost", "origin": "http://localhost:80"},
    {"host": OURS, "sec-fetch-site": "same-origin"},
    {"host": OURS, "sec-fetch-site": "none", "sec-fetch-mode": "navigate", "sec-fetch-dest": "document"},
]
FOREIGN = [
    {"host": OURS, "origin": "http://evil.example"},
    {"host": OURS, "origin": "http://localhost:8000"},
    {"host": OURS, "origin": "http://127.0.0.1:3000"},
    {"host": OURS, "origin": "http://127.0.0.1"},
    {"host": OURS, "origin": "http://127.0.0.1:8000.evil.example"},
    {"host": OURS, "origin": "http://127.0.0.1:8000@evil.example"},
    {"host": OURS, "origin": "https://127.0.0.1"},
    {"host": OURS, "origin": "file://"},
    # sandboxed frames and local files
    {"host": OURS, "origin": "null"},
    # DNS rebinding: origin and host agree, but the name is not ours
    {"host": "evil.example:8000", "origin": "http://evil.example:8000"},
    {"host": "evil.example:8000"},
    {"host": "192.168.1.5:8000", "origin": "http://192.168.1.5:8000"},
    {"host": ""},
    # pictures and scripts of pages from elsewhere, which send no Origin; another port of this machine is the same site
    {"host": OURS, "sec-fetch-site": "cross-site", "sec-fetch-mode": "no-cors", "sec-fetch-dest": "image"},
    {"host": OURS, "sec-fetch-site": "same-site", "sec-fetch-mode": "no-cors", "sec-fetch-dest": "script"},
    {"host": OURS, "sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate", "sec-fetch-dest": "iframe"},
    {"host": OURS, "sec-fetch-site": "a trick"},
]


@pytest.mark.parametrize("headers", ALLOWED, ids=str)
def test_our_own_page_and_programs_pass(headers):
    assert answers(headers) == (200, 200)


@pytest.mark.parametrize("headers", FOREIGN, ids=str)
def test_foreign_pages_are_refused(headers):
    assert answers(headers) == (403, 403)


def test_the_refusal_says_why_and_what_to_do():
    with client() as here:
        body = here.get("/", headers={"origin": "http://evil.example"}).json()
    (problem,) = body["problems"]
    assert problem["where"] == "Origin" and problem["value"] == "http://evil.example"
    assert problem["allowed"] == OURS and problem["remedy"]


def test_a_server_on_every_address_may_be_called_by_numbers_but_not_by_foreign_names():
    number = {"host": "192.168.1.5:8000", "origin": "http://192.168.1.5:8000"}
    name = {"host": "evil.example:8000", "origin": "http://evil.example:8000"}
    assert answers(number, host="0.0.0.0") == (200, 200)
    assert answers(name, host="0.0.0.0") == (403, 403)
    assert answers(name, host="0.0.0.0", names=["evil.example"]) == (200, 200)
    assert answers(number, host="192.168.1.5") == (200, 200)


def test_two_origins_are_none_of_ours():
    with client() as here:
        doubled = [("host", OURS), ("origin", f"http://{OURS}"), ("origin", f"http://{OURS}")]
        assert here.get("/", headers=doubled).status_code == 403


LINK = {"sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}


def test_a_link_from_elsewhere_leads_to_the_page_only():
    with client() as here:
        assert here.get("/", headers=LINK).status_code == 200
        for path in ("/api/runs", "/scene/", "/openapi.json"):
            assert here.get(path, headers=LINK).status_code == 403
        assert here.post("/", headers=LINK).status_code == 403


def test_every_answer_says_what_a_browser_may_do_with_it():
    """Refusals too; a policy of an answer's own stays."""
    app = FastAPI()
    app.get("/own")(lambda: Response(headers={"Content-Security-Policy": "default-src 'self'"}))
    with TestClient(SameOrigin(app), base_url=f"http://{OURS}") as here:
        for answer in (here.get("/nowhere"), here.get("/nowhere", headers={"origin": "http://evil.example"})):
            assert answer.headers["x-content-type-options"] == "nosniff"
            assert answer.headers["cross-origin-resource-policy"] == "same-origin"
            assert "frame-ancestors 'none'" in answer.headers["content-security-policy"]
        assert here.get("/own").headers.get_list("content-security-policy") == ["default-src 'self'"]


def test_small_answers_are_sent_at_once():
    """asyncio takes Nagle's delay only from a socket that names its protocol; with it, an answer on a line that is kept waits 40 ms."""
    listening = listen("127.0.0.1", 0)
    try:
        assert listening.proto == socket.IPPROTO_TCP
    finally:
        listening.close()


def test_what_the_system_refuses_is_told_in_one_line(caplog):
    """No descriptor for another connection: asyncio would say so with a traceback, again and again."""
    loop = asyncio.new_event_loop()
    told(loop, {"message": "no more connections", "exception": OSError(24, "Too many open files")})
    assert [(each.getMessage(), each.exc_info) for each in caplog.records] == [
        ("no more connections: [Errno 24] Too many open files", None)
    ]
    told(loop, {"message": "a mistake", "exception": ValueError()})
    loop.close()
    assert caplog.records[-1].exc_info
