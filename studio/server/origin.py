"""Only pages of this server may talk to it: requests from a foreign origin or under a foreign name get 403.

Three attacks are meant. A page from elsewhere, open in the same browser, calls http://127.0.0.1: its Origin
is another than the Host that it calls. Where a browser sends no Origin, with a picture or a script, it says in Sec-Fetch-Site
who asks; a link from elsewhere to our page is followed. A page from elsewhere lets its own name point to 127.0.0.1 (DNS
rebinding): Origin and Host agree, but the name is not one of ours.

What is answered says what a browser may do with it: nothing from elsewhere is loaded, and nobody else may frame or embed it.
"""

import ipaddress
import json
from collections.abc import Iterable
from urllib.parse import urlsplit

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from studio.errors import Problem

LOOPBACK = frozenset({"127.0.0.1", "localhost", "::1"})
EVERY_ADDRESS = frozenset({"0.0.0.0", "::", ""})
DEFAULT_PORTS = {"http": 80, "https": 443, "ws": 80, "wss": 443}


class SameOrigin:
    """ASGI middleware; `host` is the address that the server is bound to, `names` are further names for it.

    A server bound to every address may also be called by its numeric addresses: those cannot be rebound.
    """

    def __init__(self, app: ASGIApp, *, host: str = "127.0.0.1", names: Iterable[str] = ()) -> None:
        self.app = app
        self.names = LOOPBACK | {host.strip("[]").lower()} | {name.lower() for name in names}
        self.any_address = host in EVERY_ADDRESS

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            return await self.app(scope, receive, send)
        problem = self.problem(scope)
        if problem is None:
            return await self.app(scope, receive, with_headers(send))
        return await _refuse(scope, problem, send)

    def problem(self, scope: Scope) -> Problem | None:
        """What is wrong with the origin of a request; None if it is ours, or a program's."""
        host = _header(scope, b"host")
        secure = scope.get("scheme") in ("https", "wss")
        called = _place(f"{'https' if secure else 'http'}://{host}")
        if called is None or not self.knows(called[0]):
            return Problem(
                "Host",
                "this server is not known by that name",
                host,
                ", ".join(sorted(self.names - {""})),
                REMEDY,
            )
        origin = _header(scope, b"origin")
        if origin and _place(origin) != called:
            return Problem("Origin", "a page of another origin may not talk to this server", origin, host, REMEDY)
        asker = _header(scope, b"sec-fetch-site")
        if asker not in OURS and not is_link_to_the_page(scope):
            return Problem("Sec-Fetch-Site", "a page of another origin may not talk to this server", asker, "same-origin", REMEDY)
        return None

    def knows(self, name: str) -> bool:
        """Whether this server may be called by that name."""
        return name in self.names or (self.any_address and _is_address(name))


REMEDY = "open the studio at the address that it printed when it started"
OURS = ("", "same-origin", "none")  # programs, our page, and a person who types the address
INNER = ("/api", "/scene", "/openapi.json")  # what is no page for people
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; "
    "connect-src 'self'; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = (
    (b"content-security-policy", POLICY.encode()),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"referrer-policy", b"same-origin"),
    (b"x-content-type-options", b"nosniff"),
)


def is_link_to_the_page(scope: Scope) -> bool:
    """Whether somebody follows a link from elsewhere to a page for people."""
    follows = _header(scope, b"sec-fetch-mode"), _header(scope, b"sec-fetch-dest")
    return scope.get("method") == "GET" and follows == ("navigate", "document") and not scope["path"].startswith(INNER)


def with_headers(send: Send) -> Send:
    """Adds what a browser may do with an answer, where it does not say so itself."""

    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            present = {name.lower() for name, _ in message.get("headers", ())}
            message["headers"] = [*message.get("headers", ()), *(each for each in HEADERS if each[0] not in present)]
        await send(message)

    return sending


def _header(scope: Scope, name: bytes) -> str:
    values = [value for key, value in scope["headers"] if key == name]
    # two Host or Origin headers are a trick, and belong to no origin
    return values[0].decode("latin-1") if len(values) == 1 else "," * len(values)


def _place(url: str) -> tuple[str, int] | None:
    """Name and port of an origin; None if it is not one ("null", or no URL)."""
    try:
        parts = urlsplit(url)
        port = parts.port or DEFAULT_PORTS[parts.scheme]
    except (ValueError, KeyError):
        return None
    return (parts.hostname, port) if parts.hostname else None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


async def _refuse(scope: Scope, problem: Problem, send: Send) -> None:
    if scope["type"] == "websocket":
        # closed before it was accepted: the server answers 403
        await send({"type": "websocket.close", "code": 1008, "reason": "foreign origin"})
        return
    body = json.dumps({"message": f"403: {problem.what}", "problems": [vars(problem)]}).encode()
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode()), *HEADERS]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": body})
