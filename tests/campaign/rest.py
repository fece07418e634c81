"""REST: requests of our own generator and of schemathesis to a server in a process of its own; every answer is looked at."""

import http.client
import random
import re
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any
from urllib.parse import unquote

import schemathesis
from hypothesis import HealthCheck, Phase, given, seed, settings
from schemathesis import checks
from schemathesis.generation import GenerationMode
from schemathesis.specs.openapi.checks import content_type_conformance, response_schema_conformance, status_code_conformance

from studio.server.answer import Refusal
from tests.campaign.request import KINDS, Maker, Request
from tests.campaign.station import Station
from tests.campaign.table import Row

PATIENCE = 30.0  # [s] for an answer
LONGEST_REFUSAL = 100_000  # [B]
TIDY_EVERY = 100  # requests, after which live runs and imports that were begun are ended
SECRET = b"root:x:0"  # of what lies outside the folders
ELSEWHERE = {"400", "403", "404", "405", "426"}  # statuses of an address that is in no description
CHECKS = (checks.not_a_server_error, status_code_conformance, content_type_conformance, response_schema_conformance)


class Enough(Exception):
    """The time is over."""


class Line:
    """One connection; sends addresses and methods as they are, opens another when the server has closed it."""

    def __init__(self, host: str, port: int) -> None:
        self.host, self.port = host, port
        self.connection: http.client.HTTPConnection | None = None

    def ask(self, request: Request) -> tuple[int, bytes]:
        """Status and body of the answer; 0 when the server has closed the line without one."""
        for is_last in (False, True):
            try:
                return self.once(request)
            except (http.client.HTTPException, ConnectionError):
                self.close()
                if is_last:
                    return 0, b""
        raise AssertionError("never comes here")

    def once(self, request: Request) -> tuple[int, bytes]:
        """One try."""
        if self.connection is None:
            self.connection = http.client.HTTPConnection(self.host, self.port, timeout=PATIENCE)
        told = {name.lower() for name in request.headers}
        address = "".join(each if "!" <= each <= "~" else "%20" for each in request.address)
        self.connection.putrequest(request.method, address, skip_host="host" in told, skip_accept_encoding=True)
        for name, value in request.headers.items():
            self.connection.putheader(name, value.encode("utf-8"))
        if request.body is not None and not told & {"content-length", "transfer-encoding"}:
            self.connection.putheader("Content-Length", str(len(request.body)))
        self.connection.endheaders(request.body)
        answer = self.connection.getresponse()
        body = answer.read()
        if answer.will_close or told & {"content-length", "transfer-encoding", "upgrade", "connection", "expect"}:
            self.close()  # what was said of the length may have been a lie
        return answer.status, body

    def close(self) -> None:
        """Hangs up."""
        if self.connection is not None:
            self.connection.close()
            self.connection = None


class Judge:
    """Looks at answers: described, no mistake of the studio, no traceback; refusals in their form; nothing of other folders."""

    def __init__(self, paths: dict[str, Any]) -> None:
        self.paths = paths
        self.patterns = {route: re.compile(re.sub(r"\\\{\w+\\\}", "[^/]+", re.escape(route))) for route in paths}

    def described(self, request: Request) -> set[str]:
        """The statuses that the description has for a request, by where it really goes."""
        place = unquote(request.address.partition("?")[0].partition("#")[0], errors="replace")
        found = [route for route, pattern in self.patterns.items() if pattern.fullmatch(place)]
        known = [self.paths[route].get(request.method.lower()) for route in found]
        return ELSEWHERE.union(*(each["responses"] for each in known if each))

    def wrong(self, request: Request, status: int, body: bytes) -> str:
        """What is wrong with an answer; "" when nothing is."""
        if status == 0:
            return "no answer"
        if status == 500 or (b"Traceback (most recent" in body and b"/api/kinds" not in request.address.encode()):
            return f"a mistake of the studio: {body[:300]!r}"
        if SECRET in body:
            return "reads outside its folders"
        if not request.address.startswith("/api/"):
            return ""
        if str(status) not in self.described(request):
            return f"status {status} is not described: {body[:200]!r}"
        return misformed(status, body) if status >= 400 and request.method != "HEAD" else ""


def misformed(status: int, body: bytes) -> str:
    """What is wrong with the form of a refusal; what the HTTP library itself cannot read it answers in its own words."""
    if status == 400 and body == b"Invalid HTTP request received.":
        return ""
    try:
        told = Refusal.model_validate_json(body, strict=True)
    except ValueError:
        return f"a refusal without its form: {status} {body[:200]!r}"
    if not (told.message and told.problems and all(each.what for each in told.problems)):
        return f"a refusal that says nothing: {body[:200]!r}"
    return "a refusal of great length" if len(body) > LONGEST_REFUSAL else ""


class Siege:
    """A server under requests."""

    def __init__(self, station: Station) -> None:
        self.station = station
        self.description = station.client.get("/openapi.json").json()
        self.make, self.judge = Maker(self.description["paths"]), Judge(self.description["paths"])
        self.line = Line(station.client.base_url.host, station.client.base_url.port or 80)
        self.asked = 0

    def requests(self, kind: str, *, seed: int, count: int, seconds: float = 1e9, first: int = 0) -> Row:
        """Requests that are wrong in one way."""
        row, until = Row("rest", kind, seed), time.monotonic() + seconds
        for number in range(first, first + count):
            if time.monotonic() > until:
                break
            request = KINDS[kind](self.make, random.Random(f"{seed}/{kind}/{number}"))
            self.ask(row, request, f"number {number}")
        return row

    def ask(self, row: Row, request: Request, name: str) -> None:
        """One request and its answer."""
        self.tidy()
        began = time.perf_counter()
        try:
            status, body = self.line.ask(request)
            wrong = self.judge.wrong(request, status, body)
        except TimeoutError:
            self.line.close()
            status, wrong = 0, f"takes more than {PATIENCE:g} s"
        told = f"{name}: {request.method} {request.address[:80]}: {wrong}" if wrong else ""
        row.add(f"{status // 100}xx" if status else "nothing", time.perf_counter() - began, told)

    def tidy(self) -> None:
        """Ends, now and then, what requests have begun."""
        self.asked += 1
        if self.asked % TIDY_EVERY == 0:
            for live in self.station.client.get("/api/live").json():
                if live["status"] in ("running", "paused", "starting"):
                    self.station.client.post(f"/api/live/{live['run']}/stop")
            for job in self.station.client.get("/api/map-jobs").json():
                if job["status"] == "running":
                    self.station.client.delete(f"/api/map-jobs/{job['id']}")

    # -- schemathesis --------------------------------------------------------------------------------

    def described(self, mode: GenerationMode, *, number: int, count: int, seconds: float = 1e9) -> Row:
        """So many cases of schemathesis for each operation: good ones, or wrong ones."""
        row, until = Row("rest", f"schemathesis, {mode.value}", number), time.monotonic() + seconds
        schema = schemathesis.openapi.from_dict(self.description)
        operations = [found for each in schema.get_all_operations() if not (found := each.ok()).path.endswith("/socket")]
        for place, operation in enumerate(operations):
            end = time.monotonic() + (until - time.monotonic()) / (len(operations) - place)
            self.operation(row, operation, mode, number, count, end)
        return row

    def operation(self, row: Row, operation: Any, mode: GenerationMode, number: int, count: int, until: float) -> None:
        """Cases for one operation."""

        @seed(number)
        @settings(
            max_examples=count,
            database=None,
            deadline=None,
            report_multiple_bugs=False,
            phases=[Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        @given(case=operation.as_strategy(generation_mode=mode))
        def tried(case: Any) -> None:
            if time.monotonic() > until:
                raise Enough  # the library itself knows a number of cases only
            self.tidy()
            row.add(*self.case(case))

        try:
            tried()
        except Enough:
            return
        except Exception as error:
            if "Unsatisfiable" not in type(error).__name__ and "cannot" not in str(error).lower():
                row.blame(f"{operation.label}: {type(error).__name__}: {str(error)[:300]}")

    def case(self, case: Any) -> tuple[str, float, str]:
        """What came of one case, the time it took, and what is wrong."""
        began = time.perf_counter()
        answer = case.call(base_url=str(self.station.client.base_url).rstrip("/"), timeout=PATIENCE)
        took = time.perf_counter() - began
        wrong = misformed(answer.status_code, answer.content) if answer.status_code >= 400 and case.method != "HEAD" else ""
        try:
            case.validate_response(answer, checks=CHECKS)
        except Exception as error:
            wrong = str(error)[:500]
        return f"{answer.status_code // 100}xx", took, f"{case.method} {case.formatted_path[:80]}: {wrong}" if wrong else ""

    def afterwards(self, seed: int) -> Row:
        """The server after all that: it has told no traceback where it was started."""
        row, log = Row("rest", "the server afterwards", seed), self.station.log()
        with row.trying(f"holds {self.station.held().memory:.0f} MB"):
            assert "Traceback" not in log, log[log.index("Traceback") :][-1500:]
        return row

    # -- below HTTP ----------------------------------------------------------------------------------

    def lines(self, kind: str, *, seed: int, count: int, seconds: float = 1e9) -> Row:
        """Bytes that are no request, or half of one; afterwards the server answers as before."""
        row, until = Row("rest", kind, seed), time.monotonic() + seconds
        for number in range(count):
            if time.monotonic() > until:
                break
            with row.trying("answered or closed"):
                LINES[kind](self.line.host, self.line.port, random.Random(f"{seed}/{kind}/{number}"))
        with row.trying("answers afterwards"):
            assert self.station.client.get("/api/info").status_code == 200
        return row


def spoken(host: str, port: int, said: bytes, *, hears: bool = True) -> bytes:
    """Says something over a connection of its own; what was said back."""
    with socket.create_connection((host, port), timeout=PATIENCE) as line, suppress(ConnectionError):
        line.sendall(said)
        if hears:
            line.shutdown(socket.SHUT_WR)
            return b"".join(iter(lambda: line.recv(65536), b""))
    return b""


def noise(host: str, port: int, chance: random.Random) -> None:
    """Bytes that are no request."""
    start = chance.choice(
        (b"", b"GET ", b"POST /api/runs HTTP/1.1\r\n", b"GET /api/info HTTP/9.9\r\n", b"\x16\x03\x01", b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n")
    )
    answer = spoken(host, port, start + chance.randbytes(chance.choice((1, 100, 10_000))) + b"\r\n\r\n")
    assert b" 500 " not in answer[:30], answer[:200]


def half(host: str, port: int, chance: random.Random) -> None:
    """A body that breaks off."""
    route = chance.choice(("/api/runs", "/api/maps?name=x.osm", "/api/scene", "/api/scenarios/patched/check"))
    length = chance.choice((100, 10**6, 10**12))
    head = f"POST {route} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: {length}\r\n\r\n"
    spoken(host, port, head.encode() + b'{"scenario": '[: chance.randrange(13)], hears=chance.random() < 0.5)


def chunks(host: str, port: int, chance: random.Random) -> None:
    """Chunks of lengths that are none."""
    length = chance.choice((b"-1", b"FFFFFFFFFFFFFFFFFF", b"x", b"0", b"5;a=b", b"1e5", b"00000000000000000000005"))
    head = b"POST /api/runs HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\nContent-Type: application/json\r\n\r\n"
    answer = spoken(host, port, head + length + b"\r\n{}\r\n0\r\n\r\n")
    assert b" 500 " not in answer[:30], answer[:200]


def sockets(host: str, port: int, chance: random.Random) -> None:
    """WebSockets that are opened wrongly, or that say what nobody asked for."""
    route = chance.choice(
        ("/api/live/1/socket", "/api/live/999999999999999999999999/socket", "/api/live/x/socket", "/scene/", "/scene", "/api/none")
    )
    head = f"GET {route} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: "
    key = chance.choice(("dGhlIHNhbXBsZSBub25jZQ==", "", "x", "=" * 1000))
    spoken(
        host,
        port,
        f"{head}{key}\r\nSec-WebSocket-Version: {chance.choice((13, 13, 13, 7))}\r\n\r\n".encode()
        + chance.randbytes(chance.choice((0, 10, 1000))),
    )


LINES: dict[str, Callable[[str, int, random.Random], None]] = {
    "bytes that are no request": noise,
    "bodies that break off": half,
    "chunks of no length": chunks,
    "sockets that are opened wrongly": sockets,
}


MODES = {f"schemathesis, {each.value}": each for each in (GenerationMode.POSITIVE, GenerationMode.NEGATIVE)}
MOST_CASES = 2000  # of schemathesis for each operation


def rows(siege: Siege, *, seed: int, count: int, seconds: float, only: str = "") -> Iterator[Row]:
    """All kinds of requests, so many of each, or as many as there is time for."""
    each = seconds / (len(KINDS) + len(LINES) + 3 * len(MODES))
    for kind in [kind for kind in KINDS if only in kind]:
        yield siege.requests(kind, seed=seed, count=count, seconds=each)
    for kind in [kind for kind in LINES if only in kind]:
        yield siege.lines(kind, seed=seed, count=count, seconds=each)
    for kind in [kind for kind in MODES if only in kind]:
        yield siege.described(MODES[kind], number=seed, count=min(count, MOST_CASES), seconds=3 * each)
    yield siege.afterwards(seed)
