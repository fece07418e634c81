"""REST of the editor: a scenario with all that can be chosen in it, edits by name, undo and redo, ways by clicking, and news of changes."""

import asyncio

from fastapi import APIRouter, WebSocket
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response
from starlette.websockets import WebSocketDisconnect

from studio import job
from studio.errors import RouteError, StudioError
from studio.server import answer
from studio.server.desk import Desk
from studio.server.editing.answer import Editing, EditingNews, Gone, NewEdit, NewTurn, NewWay, Revised, Way
from studio.server.editing.figure import lock_of
from studio.server.editing.way import way
from studio.server.maps import plan_of
from studio.server.maps.answer import MapPlan
from studio.server.routes import AtDesk, AtOwnDesk, upgrade_required

LOOKS = 0.25  # [s] between looks at a file that somebody has open
NOTHING_FOUND = {"guesses": [], "skipped": [], "corrected": []}
router = APIRouter(prefix="/api", responses=answer.REFUSALS)


@router.get("/scenarios/{scenario}/editing")
def editing(scenario: str, desk: AtDesk) -> Editing:
    """A scenario as it is edited: its document, where everything lies, what happens when, and what can be undone."""
    return desk.editing.state(desk.file(scenario))


@router.post("/scenarios/{scenario}/editing")
def edit(scenario: str, new: NewEdit, desk: AtOwnDesk) -> Editing:
    """Does an edit and writes the file: all of it if the result can be run, else nothing. One to an older revision is done to the present
    one, unless somebody has changed the same."""
    return desk.editing.edit(desk.file(scenario), new)


@router.post("/scenarios/{scenario}/editing/undo")
def undo(scenario: str, asked: NewTurn, desk: AtOwnDesk) -> Editing:
    """Takes the last step back, whoever has done it; where there is none, nothing happens."""
    return desk.editing.undo(desk.file(scenario), asked)


@router.post("/scenarios/{scenario}/editing/redo")
def redo(scenario: str, asked: NewTurn, desk: AtOwnDesk) -> Editing:
    """Does the step again that was undone last; where there is none, nothing happens."""
    return desk.editing.redo(desk.file(scenario), asked)


@router.get("/scenarios/{scenario}/plan")
def scenario_plan(scenario: str, desk: AtDesk) -> MapPlan:
    """The map of a scenario from above, cut as the scenario cuts it."""
    return plan_of(job.prepare(desk.load(scenario)).network, NOTHING_FOUND)


@router.post("/scenarios/{scenario}/way")
def a_way(scenario: str, new: NewWay, desk: AtDesk) -> Way:
    """The way through points on the map of a scenario; nothing is written. Where no way leads, the answer says why."""
    setting = job.prepare(desk.load(scenario))
    try:
        return way(setting.network, new.points, onwards=new.onwards, before=new.roads, lock=lock_of(setting, new.vehicles))
    except RouteError as error:
        return Way(problem=answer.Refusal(**error.as_json()), roads=[], line=[], length=0.0, handles=[])


@router.get(
    "/scenarios/{scenario}/editing/socket",
    status_code=426,
    response_description="Upgrade Required",
    response_model=answer.Refusal,
    responses={"1XX": {"model": EditingNews, "description": "101: a WebSocket from here on; each message is one of the news"}},
)
def socket_only(scenario: str) -> Response:
    """A WebSocket (RFC 6455): news of every change of a scenario. Asked for anything else, it refuses."""
    return upgrade_required()


@router.websocket("/scenarios/{scenario}/editing/socket")
async def socket(browser: WebSocket, scenario: str) -> None:
    """Tells of every change of a scenario, whoever makes it: the present revision first. Ends when the scenario is gone."""
    await browser.accept()
    desk: Desk = browser.app.state.desk
    hearing = asyncio.create_task(browser.receive())
    told = None
    try:
        while not hearing.done():
            news = await run_in_threadpool(look, desk, scenario)
            if news != told:
                await browser.send_text(news.model_dump_json())
            if isinstance(news, Gone):
                break
            told = news
            await asyncio.wait([hearing], timeout=LOOKS)
        if not hearing.done():
            await browser.close()
    except (WebSocketDisconnect, RuntimeError):
        pass  # the page has gone
    finally:
        hearing.cancel()


def look(desk: Desk, scenario: str) -> Revised | Gone:
    """What is to be told of a scenario now."""
    try:
        last = desk.editing.latest(desk.file(scenario))
    except StudioError as error:
        return Gone(**error.as_json())
    return Revised(revision=last.revision, name=last.name, who=last.who) if last else Revised(revision=0, name="", who="")
