"""REST of scenario files: new, copied, taken in, as text, saved, renamed, deleted, brought back.

Whoever changes a file sends the ETag that he has seen along, as If-Match: when somebody else has changed it since, that is told, and
nothing is written. The names of other folders, links and taken names are refused.
"""

import re
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Annotated, Any
from urllib.parse import quote

from fastapi import APIRouter, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from studio.errors import ScenarioError
from studio.scenario import file
from studio.scenario.text.source import decoded
from studio.server.answer import REFUSALS, Changes, KeptScenario, Patched
from studio.server.desk import Desk
from studio.server.documents import check_text, digest_of, names_in, too_large
from studio.server.routes import AtDesk, AtOwnDesk, IfMatch, etag, expected, patched
from studio.server.scenarios import answer, template
from studio.server.scenarios.name import ENDING
from studio.server.scenarios.trash import Deleted

TEXT = {"application/yaml": {"schema": {"type": "string"}}}
YAML: dict[int | str, dict[str, Any]] = {200: {"description": "YAML (RFC 9512)", "content": TEXT}}
BODY = {"requestBody": {"required": True, "content": TEXT}}
Name = Annotated[str, Query(description="name of the file, with or without .yaml", max_length=300)]
PLACE = re.compile(r", line (\d+), column (\d+)")
router = APIRouter(prefix="/api", responses=REFUSALS)


@router.get("/templates")
def templates() -> list[answer.Template]:
    """Scenarios to begin with, the emptiest first."""
    return [answer.Template(name=each.name, title=each.title, description=each.description) for each in template.templates()]


@router.post("/scenarios", status_code=201)
def new_scenario(new: answer.NewScenario, desk: AtOwnDesk) -> KeptScenario:
    """Writes a scenario from a template, on a way through a map that is drawn by lot."""
    desk.scenario_files.free(new.name)  # before the map is read, which takes its time
    text = template.text(new.template, desk.maps, new.map, new.title or "")
    return fresh(desk, desk.scenario_files.add(new.name, text))


@router.post("/scenarios/import", status_code=201, openapi_extra=BODY)
async def import_scenario(request: Request, desk: AtOwnDesk, name: Name) -> KeptScenario:
    """Takes the scenario file that is the body, if it is one whose map is here."""
    data = await received(request.stream())
    return await run_in_threadpool(lambda: fresh(desk, desk.scenario_files.add(name, decoded(data, name))))


@router.post("/scenarios/{scenario}/copy", status_code=201)
def copy_scenario(scenario: str, new: answer.NewCopy, desk: AtOwnDesk) -> KeptScenario:
    """Writes a scenario like this one under another name, with changes by path."""
    return fresh(desk, desk.scenario_files.copy(desk.file(scenario), new.name, new.title, new.set))


@router.post("/scenarios/{scenario}/save", response_model_exclude_unset=True)
def save_scenario(scenario: str, changes: Changes, desk: AtOwnDesk, response: Response, if_match: IfMatch = None) -> Patched:
    """Writes changes by path into the file: all of them if the result is valid, else nothing. Undo: patch with the inverse."""
    found, inverse = desk.scenario_files.save(desk.file(scenario), changes.set, expected(if_match))
    return patched(found, inverse, response)


@router.post("/scenarios/{scenario}/rename")
def rename_scenario(scenario: str, new: answer.NewName, desk: AtOwnDesk, if_match: IfMatch = None) -> KeptScenario:
    """Gives the file another name, another title, or both; its runs go with it. Refused while runs of it go on."""
    return kept(desk.rename(scenario, new.name, new.title, expected(if_match)))


@router.delete("/scenarios/{scenario}")
def delete_scenario(scenario: str, desk: AtOwnDesk, if_match: IfMatch = None) -> answer.DeletedScenario:
    """Moves the file to the trash, from where it can be brought back; its runs stay."""
    found = desk.scenario_files.delete(desk.file(scenario), expected(if_match))
    desk.editing.follow(scenario, found.id)
    return deleted(found)


# -- as text -----------------------------------------------------------------------------------------


@router.get("/scenarios/{scenario}/text", response_class=Response, responses=YAML)
def text(
    scenario: str, desk: AtDesk, download: Annotated[bool, Query(description="as a file to be kept by the browser")] = False
) -> Response:
    """A scenario file as it stands, be it valid or not; its ETag is the digest of the text."""
    found = desk.documents.text(desk.file(scenario))
    named = {"Content-Disposition": f"attachment; filename*=UTF-8''{quote(scenario + ENDING, safe='')}"} if download else {}
    return Response(found, media_type="application/yaml", headers={"ETag": etag(found)} | named)


@router.put("/scenarios/{scenario}/text", openapi_extra=BODY)
async def put_text(scenario: str, request: Request, desk: AtOwnDesk, if_match: IfMatch = None) -> KeptScenario:
    """Puts the body in the place of the file's text, if it is a scenario."""
    data = await received(request.stream())

    def write() -> KeptScenario:
        path = desk.file(scenario)
        desk.documents.put(path, decoded(data, path.name), expected(if_match))
        return KeptScenario(scenario=scenario, digest=digest_of(data))

    return await run_in_threadpool(write)


@router.post("/scenarios/{scenario}/text/check", openapi_extra=BODY)
async def check_scenario_text(scenario: str, request: Request, desk: AtDesk) -> answer.TextCheck:
    """Whether the body would be a scenario in the place of this file; nothing is written. Problems with their lines."""
    data = await received(request.stream())

    def check() -> answer.TextCheck:
        path = desk.file(scenario)
        try:
            check_text(decoded(data, path.name), path, own=names_in(path))
            return answer.TextCheck(ok=True, problems=[])
        except ScenarioError as error:
            return answer.TextCheck(ok=False, problems=[with_place(each) for each in error.as_json()["problems"]])

    return await run_in_threadpool(check)


def with_place(problem: dict[str, str]) -> answer.TextProblem:
    """A problem whose place in the text is told in numbers too."""
    found = PLACE.search(problem["where"])
    line, column = map(int, found.groups()) if found else (None, None)
    return answer.TextProblem(**problem, line=line, column=column)


async def received(body: AsyncIterator[bytes]) -> bytes:
    """A body as it comes; raises SizeError as soon as it is too much."""
    data = bytearray()
    async for part in body:
        data += part
        if len(data) > file.SIZE_LIMIT:
            raise too_large()
    return bytes(data)


# -- the trash ---------------------------------------------------------------------------------------


@router.get("/trash")
def trash(desk: AtDesk) -> list[answer.DeletedScenario]:
    """Scenario files that were deleted, the latest first."""
    return [deleted(each) for each in desk.scenario_files.trash.entries()]


@router.post("/trash/{entry}/restore")
def restore(entry: str, how: answer.Return, desk: AtOwnDesk) -> KeptScenario:
    """Brings a deleted scenario back with the history of its edits, under its name or another one."""
    path = desk.scenario_files.restore(entry, how.name)
    desk.editing.follow(entry, path.stem)
    return kept(path)


def fresh(desk: Desk, path: Path) -> KeptScenario:
    """A scenario file that was not there before: what was done to an older one of its name is not its history."""
    desk.editing.forget(path.stem)
    return kept(path)


def kept(path: Path) -> KeptScenario:
    """A scenario file that was written."""
    return KeptScenario(scenario=path.stem, digest=digest_of(file.content(path, "scenario", file.SIZE_LIMIT)))


def deleted(found: Deleted) -> answer.DeletedScenario:
    """A file in the trash."""
    when = found.when.isoformat(timespec="seconds")
    return answer.DeletedScenario(id=found.id, scenario=found.scenario, deleted=when, bytes=found.path.stat().st_size)
