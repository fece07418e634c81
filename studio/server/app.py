"""The application: wiring only."""

import asyncio
import json
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from importlib.metadata import version
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import Response

from studio.errors import (
    ConflictError,
    Problem,
    SealedError,
    ServerError,
    SizeError,
    StaleError,
    StoreError,
    StudioError,
    UnknownError,
    short,
)
from studio.scenario.finding import MOST_TOLD, allowed
from studio.server import relay, routes
from studio.server.answer import FIRST_STAGE
from studio.server.desk import Desk
from studio.server.editing import routes as editing_routes
from studio.server.maps import routes as map_routes
from studio.server.scenarios import routes as scenario_routes
from studio.server.validation import routes as validation_routes

TITLE = "Cooperative ADAS Studio"
METHODS = ["GET", "POST", "PUT", "PATCH", "DELETE"]
SEE = "see /openapi.json"


def create_app(desk: Desk) -> FastAPI:
    """REST and scene of one desk."""
    app = FastAPI(
        title=TITLE, version=version("cooperative-adas-studio"), lifespan=lifespan, docs_url=None, redoc_url=None, redirect_slashes=False
    )
    app.state.desk = desk
    app.exception_handler(StudioError)(refused)
    app.exception_handler(RequestValidationError)(misread)
    app.exception_handler(HTTPException)(unanswered)
    app.exception_handler(ClientDisconnect)(left)
    app.exception_handler(Exception)(mistaken)
    app.include_router(routes.router)
    app.include_router(map_routes.router)
    app.include_router(scenario_routes.router)
    app.include_router(validation_routes.router)
    app.include_router(editing_routes.router)
    app.include_router(relay.router(lambda stage: desk.stages[stage].scene.door, desk.stages.joined))
    app.add_route(
        "/api/{path:path}", no_such_route, methods=["GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "TRACE"], include_in_schema=False
    )
    return app


@asynccontextmanager
async def lifespan(app: FastAPI) -> AsyncGenerator[None]:
    """Processes compile and get ready for the first run while the page is already served; at the end all processes end."""
    desk: Desk = app.state.desk
    await asyncio.to_thread(desk.warmup.start)  # before anybody asks how far it is
    ready = asyncio.create_task(asyncio.to_thread(make_ready, desk))
    yield
    await ready
    await asyncio.to_thread(desk.warmup.close)
    await asyncio.to_thread(desk.lives.close)
    await asyncio.to_thread(desk.editions.close)
    await asyncio.to_thread(desk.map_jobs.close)
    await asyncio.to_thread(desk.project_jobs.close)
    await asyncio.to_thread(desk.stages.close)


def make_ready(desk: Desk) -> None:
    """Worker first: it gets ready while the scene is made."""
    desk.lives.make_ready()
    desk.stages[FIRST_STAGE]  # made by being looked at


STATUS = {UnknownError: 404, StaleError: 412, ConflictError: 409, SealedError: 403, StoreError: 503, SizeError: 413}


def status_of(error: StudioError) -> int:
    """HTTP status of an error."""
    if isinstance(error, ServerError) and "is over" in error.message:
        return 409
    return next((status for kind, status in STATUS.items() if isinstance(error, kind)), 422)


def refusal(error: StudioError, status: int) -> Response:
    """An error as JSON in plain ASCII: what was sent may hold half characters that no encoding takes."""
    return Response(json.dumps(error.as_json()), status_code=status, media_type="application/json")


async def refused(request: Request, error: StudioError) -> Response:
    """Our errors as JSON."""
    return refusal(error, status_of(error))


async def no_such_route(request: Request) -> Response:
    """An address under /api that does not exist."""
    path = short(request.url.path)
    return refusal(UnknownError(f"There is no {path}.", [Problem("address", "does not exist", path, remedy=SEE)]), 404)


async def misread(request: Request, error: RequestValidationError) -> Response:
    """FastAPI's findings about a request, in the same form."""
    found = list(error.errors())[:MOST_TOLD]
    problems = [Problem(".".join(map(str, each["loc"])), each["msg"], short(each.get("input", "")), allowed(each), SEE) for each in found]
    return refusal(StudioError("The request cannot be read.", problems), 422)


async def unanswered(request: Request, error: HTTPException) -> Response:
    """What the framework refuses: a method that an address does not have, a body that is no JSON."""
    where = "body" if error.status_code == 400 else f"{request.method} {short(request.url.path)}"
    problem = Problem(where, error.detail, allowed=(error.headers or {}).get("Allow", ""), remedy=SEE)
    return refusal(StudioError("The request cannot be answered.", [problem]), error.status_code)


async def left(request: Request, error: ClientDisconnect) -> Response:
    """Who asked has gone before the end of the question: nobody hears the answer, and nothing is wrong here."""
    return refusal(SizeError("The body is not complete.", [Problem("body", "broke off", remedy="send it again")]), 400)


async def mistaken(request: Request, error: Exception) -> Response:
    """A mistake of ours; the server's log has the traceback."""
    problem = Problem(f"{request.method} {short(request.url.path)}", f"{type(error).__name__}", remedy="tell us, with the server's log")
    return refusal(StudioError("The studio has made a mistake.", [problem]), 500)


def description() -> dict[str, Any]:
    """The OpenAPI description; its version is left out, so that it changes with the routes only."""
    app = create_app(Desk(db=Path("runs.db"), scenarios=Path("scenarios"), kinds=()))
    app.version = "1"
    return app.openapi()
