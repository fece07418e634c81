"""The gate: on a network, only who has the token gets in. He is asked for it once, and known again by a cookie.

    Authorization: Bearer TOKEN     programs, over REST and WebSockets
    http://.../?token=TOKEN         the address that the server prints
    a form                          everybody else who opens a page

The token is made anew at every start, unless STUDIO_TOKEN holds one that stays. The cookie holds a digest of it: who
reads the cookie does not know the token. No script can read it, and no page from elsewhere can have it sent. A link from elsewhere
comes without it too, for which the form has a way on.
"""

import hashlib
import hmac
import html
import json
import os
import re
import secrets
from urllib.parse import parse_qs, parse_qsl, quote, urlencode

from starlette.requests import HTTPConnection
from starlette.responses import HTMLResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send

from studio.errors import Problem, ServerError, StudioError
from studio.server.origin import INNER

VARIABLE = "STUDIO_TOKEN"
FIXED = re.compile(r"[A-Za-z0-9._~-]{16,}")  # what stands in an address as it is, and takes too long to guess
REMEMBERED = 30 * 86400  # [s]
LONGEST_FORM = 4096  # [B]
HEADERS = {"Cache-Control": "no-store"}
REMEDY = "open the address that the studio printed when it started, or send the header Authorization: Bearer TOKEN"
POLICY = "default-src 'none'; style-src 'unsafe-inline'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'"
PAGE = """<!doctype html><meta charset="utf-8"><title>Cooperative ADAS Studio</title>
<style>body {{ font: 1rem/1.5 system-ui, sans-serif; max-width: 30rem; margin: 4rem auto; padding: 0 1rem; color-scheme: light dark }}
input, button {{ font: inherit; padding: 0.3rem 0.6rem }}</style>
{body}
"""
FORM = """<h1>Cooperative ADAS Studio</h1>
<p>{said} It stands in the address that the studio printed when it started, behind <code>token=</code>.</p>
<form method="post"><label>Token <input name="token" type="password" autocomplete="current-password" required autofocus></label>
<button>Open</button></form>
<p>A link from elsewhere has led you here, and you have given it before? <a href="{address}">Go on</a>.</p>"""
ONWARD = '<meta http-equiv="refresh" content="0;url={address}"><p><a href="{address}">Go on</a></p>'


def token() -> str:
    """The one of the environment, which no process of a run gets to see, or a new one. Raises ServerError for one easily guessed."""
    fixed = os.environ.pop(VARIABLE, None)
    if fixed is None:
        return secrets.token_urlsafe(24)
    if FIXED.fullmatch(fixed):
        return fixed
    allowed = "at least 16 characters of A-Z a-z 0-9 . _ ~ -"
    problem = Problem(VARIABLE, "does not keep anybody out", f"{len(fixed)} characters", allowed, "leave it out, and a new one is made")
    raise ServerError("The token of the environment cannot be used.", [problem])


class Gate:
    """ASGI middleware before `app`; `port` tells the cookies of two studios on one machine apart."""

    def __init__(self, app: ASGIApp, *, token: str, port: int) -> None:
        self.app, self.token, self.cookie = app, token, f"studio_{port}"
        self.digest = hmac.digest(token.encode(), b"cookie", hashlib.sha256).hex()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            return await self.app(scope, receive, send)
        asked = HTTPConnection(scope)
        answer = await self.brought(asked, receive)
        if answer is None and self.knows(asked):
            return await self.app(scope, receive, send)
        answer = answer or refusal(asked)
        if scope["type"] == "http" or "websocket.http.response" in scope.get("extensions", {}):
            return await answer(scope, receive, send)
        return await send({"type": "websocket.close", "code": 1008, "reason": "no token"})

    def knows(self, asked: HTTPConnection) -> bool:
        """Whether a request has the token in its header, or else the cookie."""
        sort, _, given = asked.headers.get("authorization", "").partition(" ")
        if sort.lower() == "bearer":
            return same(given.strip(), self.token)
        return same(asked.cookies.get(self.cookie, ""), self.digest)

    async def brought(self, asked: HTTPConnection, receive: Receive) -> Response | None:
        """The answer to who brings the token to a page, in its address or by the form; None for everything else."""
        if asked.scope["type"] != "http" or asked.url.path.startswith(INNER):
            return None
        if asked.scope["method"] == "POST":
            right = same(await in_form(receive), self.token)
            return self.remembered(asked, Response(status_code=303, headers={"Location": onward(asked)})) if right else form(asked, WRONG)
        if "token" not in asked.query_params:
            return None
        right = same(asked.query_params["token"], self.token)
        # a redirect would be followed as coming from where the link stands, without the cookie; this page leads on by itself
        return self.remembered(asked, page(ONWARD, asked, status=200)) if right else form(asked, WRONG)

    def remembered(self, asked: HTTPConnection, answer: Response) -> Response:
        """An answer with the cookie."""
        secure = asked.url.scheme == "https"
        answer.set_cookie(self.cookie, self.digest, max_age=REMEMBERED, httponly=True, samesite="strict", secure=secure)
        return answer


def same(given: str, secret: str) -> bool:
    """Whether two texts are the same, in a time that tells nothing about where they differ."""
    return hmac.compare_digest(given.encode(errors="surrogateescape"), secret.encode())


async def in_form(receive: Receive) -> str:
    """The token of a form; what is longer than any is not read."""
    body, goes_on = b"", True
    while goes_on and len(body) <= LONGEST_FORM:
        message = await receive()
        body += message.get("body", b"")
        goes_on = message.get("more_body", False)
    return parse_qs(body[:LONGEST_FORM].decode("latin-1")).get("token", [""])[0].strip()


def onward(asked: HTTPConnection) -> str:
    """The address that was asked for, on this server and without a token."""
    rest = urlencode([(key, value) for key, value in parse_qsl(asked.url.query, keep_blank_values=True) if key != "token"])
    return "/" + quote(asked.url.path.lstrip("/\\")) + (f"?{rest}" if rest else "")


# -- what is answered --------------------------------------------------------------------------------

WANTED, WRONG = "This server wants to know its token from you.", "That is not the token of this server."


def refusal(asked: HTTPConnection) -> Response:
    """The form for people, words for programs."""
    if "text/html" in asked.headers.get("accept", "") and not asked.url.path.startswith(INNER):
        return form(asked, WANTED)
    is_wrong = "authorization" in asked.headers
    problem = Problem(
        "Authorization", "is not the token of this server" if is_wrong else "has no token", allowed="Bearer TOKEN", remedy=REMEDY
    )
    error = StudioError(WRONG if is_wrong else "This server answers only who has its token.", [problem])
    return Response(json.dumps(error.as_json()), 401, HEADERS | {"WWW-Authenticate": "Bearer"}, "application/json")


def form(asked: HTTPConnection, said: str) -> Response:
    """The page that asks."""
    return page(FORM.replace("{said}", said), asked, status=401)


def page(body: str, asked: HTTPConnection, *, status: int) -> Response:
    """A plain page that leads on to what was asked for."""
    return HTMLResponse(
        PAGE.format(body=body.format(address=html.escape(onward(asked)))), status, HEADERS | {"Content-Security-Policy": POLICY}
    )
