"""On a network, only who has the token gets in: asked for once, kept in a cookie, accepted in a header; nothing else opens anything."""

import asyncio
import re
import subprocess
import sys

import httpx
import pytest
import websockets
from fastapi import FastAPI, Request, WebSocket
from fastapi.testclient import TestClient
from starlette.testclient import WebSocketDenialResponse
from starlette.websockets import WebSocketDisconnect

from studio.errors import ServerError
from studio.server import gate
from studio.server.gate import Gate
from studio.server.origin import SameOrigin
from studio.server.serve import announced, is_open, listen
from tests.patience import PATIENCE
from tests.server.server import served

TOKEN = "a-token.of_16~or-more"
PAGE = {"accept": "text/html,*/*;q=0.8"}
BEARER = {"authorization": f"Bearer {TOKEN}"}


def client(**options) -> TestClient:
    """Of an application behind the gate, which tells what it was asked for."""
    app = FastAPI()

    @app.get("/{path:path}")
    def asked(request: Request) -> str:
        return f"in: {request.url.path}"

    @app.websocket("/{path:path}")
    async def socket(connection: WebSocket) -> None:
        await connection.accept()
        await connection.send_text("in")
        await connection.close()

    guarded = SameOrigin(Gate(app, token=TOKEN, port=8000))
    return TestClient(guarded, base_url="http://127.0.0.1:8000", follow_redirects=False, **options)


def socket_status(here: TestClient, path: str, headers: dict[str, str]) -> int:
    """200 when a WebSocket opens, else what it is refused with."""
    try:
        with here.websocket_connect(path, headers={"host": "127.0.0.1:8000"} | headers) as socket:
            return 200 if socket.receive_text() == "in" else 500
    except WebSocketDenialResponse as denied:
        return denied.status_code
    except WebSocketDisconnect:
        return 403


WRONG = [
    {},
    {"authorization": "Bearer wrong"},
    {"authorization": f"Bearer {TOKEN}x"},
    {"authorization": f"Bearer {TOKEN[:-1]}"},
    {"authorization": f"Basic {TOKEN}"},
    {"authorization": "Bearer"},
    {"authorization": b"Bearer \xff\xfe"},
    {"cookie": "studio_8000=wrong"},
    {"cookie": f"studio_8000={TOKEN}"},  # the token itself is not what the cookie holds
    {"cookie": f"token={TOKEN}"},
]


@pytest.mark.parametrize("headers", WRONG, ids=str)
@pytest.mark.parametrize("path", ["/api/runs", "/scene/", "/openapi.json", "/", "/assets/index.js", "/docs/", "/favicon.svg"])
def test_without_the_token_nothing_is_answered(path, headers):
    """Programs get a refusal in the usual form; neither it nor anything else tells the token."""
    with client() as here:
        answer = here.get(path, headers=headers)
    assert answer.status_code == 401 and answer.headers["www-authenticate"] == "Bearer"
    (problem,) = answer.json()["problems"]
    assert problem.keys() == {"where", "what", "value", "allowed", "remedy"} and problem["allowed"] == "Bearer TOKEN"
    assert TOKEN not in answer.text


@pytest.mark.parametrize("headers", WRONG, ids=str)
def test_without_the_token_no_socket_opens(headers):
    with client() as here:
        assert [socket_status(here, path, headers) for path in ("/scene", "/scene/", "/api/live/1/socket")] == [401, 401, 401]


@pytest.mark.parametrize("scheme", ["Bearer", "bearer"])
def test_programs_bring_it_in_a_header(scheme):
    headers = {"authorization": f"{scheme} {TOKEN}"}
    with client() as here:
        assert here.get("/api/runs", headers=headers).json() == "in: /api/runs"
        assert socket_status(here, "/scene", headers) == 200


def test_the_printed_address_opens_the_page_and_leaves_a_cookie():
    """The page that comes first leads on to the address without the token; then the cookie is enough, for the scene's socket too."""
    with client() as here:
        first = here.get(f"/runs/3?token={TOKEN}&tab=events", headers=PAGE)
        cookie = first.headers["set-cookie"].lower()
        assert first.status_code == 200 and "url=/runs/3?tab=events" in first.text and TOKEN not in first.text
        assert "httponly" in cookie and "samesite=strict" in cookie and "path=/" in cookie and TOKEN not in cookie
        assert here.get("/runs/3", headers=PAGE).json() == "in: /runs/3"
        assert here.get("/api/runs").json() == "in: /api/runs"
        assert socket_status(here, "/scene", {"cookie": "; ".join(f"{name}={value}" for name, value in here.cookies.items())}) == 200
        assert here.get("/api/runs", headers={"authorization": "Bearer wrong"}).status_code == 401  # who brings a wrong one is told so


def test_a_page_asks_for_it_once():
    with client() as here:
        asked = here.get("/runs/3?tab=events", headers=PAGE)
        assert (
            asked.status_code == 401
            and '<form method="post">' in asked.text
            and "form-action 'self'" in asked.headers["content-security-policy"]
        )
        assert asked.headers["cache-control"] == "no-store"
        wrong = here.post("/runs/3?tab=events", data={"token": "wrong"}, headers=PAGE)
        assert wrong.status_code == 401 and "not the token" in wrong.text and "set-cookie" not in wrong.headers
        right = here.post("/runs/3?tab=events", data={"token": f" {TOKEN}\n"}, headers=PAGE)
        assert right.status_code == 303 and right.headers["location"] == "/runs/3?tab=events"
        assert here.get(right.headers["location"], headers=PAGE).json() == "in: /runs/3"


@pytest.mark.parametrize(
    "body", [b"", b"token=", b"token", b"token=" + b"x" * 100_000, b"\xff\x00", b"x" * 5000 + f"&token={TOKEN}".encode()]
)
def test_a_form_that_is_none_opens_nothing(body):
    with client() as here:
        assert here.post("/", content=body, headers=PAGE).status_code == 401


def test_a_form_and_a_link_with_a_wrong_token_open_nothing():
    with client() as here:
        answer = here.get("/?token=wrong", headers=PAGE)
        assert answer.status_code == 401 and "set-cookie" not in answer.headers and "<form" in answer.text
        # REST takes it in the header only: addresses are written down in many places
        assert here.get(f"/api/runs?token={TOKEN}").status_code == 401


@pytest.mark.parametrize("path", ["//evil.example/", "/%5Cevil.example", "///evil.example", "/%0d%0aset-cookie:x=y", '/"><script>'])
def test_it_leads_on_to_this_server_only(path):
    path = f"http://127.0.0.1:8000{path}"
    with client() as here:
        location = here.post(path, data={"token": TOKEN}).headers["location"]
        assert re.match(r"/[^/\\]", location) and "\n" not in location
        shown = here.get(f"{path}?token={TOKEN}", headers=PAGE).text
        assert "<script>" not in shown and re.search(r'url=/(?![/\\])[^"]*">', shown)


def test_a_foreign_page_is_refused_even_with_the_cookie():
    with client() as here:
        here.get(f"/?token={TOKEN}", headers=PAGE)
        assert here.get("/api/runs", headers={"origin": "http://evil.example"}).status_code == 403


# -- the token and the address ----------------------------------------------------------------------


def test_a_token_is_new_each_time_unless_the_environment_has_one(monkeypatch):
    monkeypatch.delenv(gate.VARIABLE, raising=False)
    assert len({gate.token() for _ in range(10)}) == 10 and len(gate.token()) >= 32
    monkeypatch.setenv(gate.VARIABLE, TOKEN)
    assert gate.token() == TOKEN
    assert gate.VARIABLE not in gate.os.environ  # what is started from here does not see it


@pytest.mark.parametrize("value", ["", "short", "x" * 15, "with a blank in it", "größer als sechzehn", "a/slash/in/the/token"])
def test_a_token_that_keeps_nobody_out_is_refused(value, monkeypatch):
    monkeypatch.setenv(gate.VARIABLE, value)
    with pytest.raises(ServerError) as told:
        gate.token()
    assert "at least 16 characters" in str(told.value) and (not value or value not in str(told.value))


@pytest.mark.parametrize(("host", "expected"), [("127.0.0.1", False), ("localhost", False), ("127.0.0.2", False), ("0.0.0.0", True)])
def test_only_what_others_can_reach_is_behind_the_gate(host, expected):
    with listen(host, 0) as listening:
        assert is_open(listening) is expected


def test_the_token_stands_in_every_address_that_is_told():
    text = announced(["http://127.0.0.1:8000", "http://192.0.2.7:8000"], TOKEN)
    assert text.splitlines()[0] == f"Cooperative ADAS Studio: http://127.0.0.1:8000/?token={TOKEN}"
    assert f"http://192.0.2.7:8000/?token={TOKEN}" in text
    assert announced(["http://127.0.0.1:8000"], "") == "Cooperative ADAS Studio: http://127.0.0.1:8000"


# -- a real server ----------------------------------------------------------------------------------


def test_a_server_on_every_address_wants_its_token(tmp_path, sample):
    """REST, the socket of a live run and the scene's: with the token all of it works; the token is in no log and no database."""
    with served(tmp_path, "--host", "0.0.0.0", "--scenarios", sample.parent, STUDIO_TOKEN=TOKEN) as (here, _, _):
        refused = here.get("/api/info")
        assert refused.status_code == 401 and refused.json()["problems"][0]["remedy"]
        assert here.post("/api/live", json={}).status_code == 401 and here.get("/openapi.json").status_code == 401
        assert here.get("/api/info", headers=BEARER).status_code == 200
        assert "401" in here.get("/openapi.json", headers=BEARER).json()["paths"]["/api/info"]["get"]["responses"]
        new = {"scenario": sample.stem, "set": {"clock.duration": 0.1}, "pace": "fast"}
        run = here.post("/api/live", json=new, headers=BEARER).raise_for_status().json()["run"]
        for path in ("/scene", "/scene/", f"/api/live/{run}/socket"):
            assert asyncio.run(opened(here, path, {})) == 401
            assert asyncio.run(opened(here, path, BEARER)) == 101
        while here.get(f"/api/runs/{run}", headers=BEARER).json()["status"] == "running":
            pass
        kept = b"".join(each.read_bytes() for each in tmp_path.glob("runs.db*"))
        assert b"grosser" in kept.lower() and TOKEN.encode() not in kept
        assert TOKEN not in (tmp_path / "server.log").read_text()


async def opened(here: httpx.Client, path: str, headers: dict[str, str]) -> int:
    """Status of the answer to a WebSocket."""
    url = f"ws://{here.base_url.host}:{here.base_url.port}{path}"
    try:
        async with websockets.connect(url, additional_headers=headers, proxy=None, open_timeout=PATIENCE):
            return 101
    except websockets.InvalidStatus as refused:
        return refused.response.status_code


def test_it_prints_the_address_with_a_token_of_its_own(tmp_path):
    command = [sys.executable, "-m", "studio.cli", "--host", "0.0.0.0", "--port", "0", "--no-browser"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    try:
        line = process.stdout.readline()
        address, token = re.fullmatch(r"Cooperative ADAS Studio: (http://127\.0\.0\.1:\d+)/\?token=([\w-]{32,})\n", line).groups()
        with httpx.Client(base_url=address, timeout=PATIENCE) as here:
            assert here.get("/", headers=PAGE).status_code == 401
            assert here.get("/", params={"token": token}, headers=PAGE).status_code == 200
            assert "<div" in here.get("/", headers=PAGE).text  # the cookie is sent from now on
    finally:
        process.terminate()
        process.wait(PATIENCE)


def test_a_bad_token_of_the_environment_ends_the_start(tmp_path):
    command = [sys.executable, "-m", "studio.cli", "--host", "0.0.0.0", "--port", "0", "--no-browser"]
    done = subprocess.run(command, cwd=tmp_path, env=gate.os.environ | {"STUDIO_TOKEN": "hunter2"}, capture_output=True, text=True)
    assert done.returncode == 2 and "STUDIO_TOKEN" in done.stderr and "hunter2" not in done.stderr
