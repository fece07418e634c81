"""REST of validation: projects with their logs, what is done with them in processes of their own, and what came out.

What takes time is answered at once with a job; whoever asked looks at it until it is over, or cancels it.
"""

import os
import secrets
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter, Body, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import HTMLResponse, Response

from studio.errors import ConflictError, Problem, ScenarioError, ServerError, SizeError, UnknownError, short
from studio.scenario import file
from studio.scenario.text import source
from studio.scenario.text.patch import Operation, operations
from studio.server import answer as answers
from studio.server.routes import PAGE, PAPER, AtDesk, AtOwnDesk, IfMatch, KeptRuns, expected, on_paper
from studio.server.scenarios import name as names
from studio.server.scenarios.routes import BODY as YAML_BODY
from studio.server.scenarios.routes import YAML, received
from studio.server.validation import (
    LARGEST,
    answer,
    check_inside,
    checked,
    courses_of,
    endings,
    is_document,
    kind_of,
    kinds,
    report_of,
    vehicle_of,
)
from studio.store import iteration

BYTES = {"requestBody": {"required": True, "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}}
router = APIRouter(prefix="/api", responses=answers.REFUSALS)


@router.get("/validation-kinds")
def validation_kinds() -> answer.ValidationKinds:
    """Maneuvers, signals and vehicles that a project may name."""
    return kinds()


@router.get("/validations")
def validations(desk: AtDesk, kept: KeptRuns) -> list[answer.ProjectRow]:
    """The validation projects beside the scenarios."""
    return desk.projects.rows(kept)


@router.post("/validations", status_code=201)
def new_validation(new: answer.NewProject, desk: AtOwnDesk, kept: KeptRuns) -> answer.ProjectDetail:
    """Begins a project without runs."""
    return desk.projects.detail(desk.projects.add(new), kept)


@router.post("/validations/sample", status_code=202)
def sample(new: answer.NewProject, desk: AtOwnDesk) -> answer.ProjectJob:
    """Makes a project to learn with: ten drives of a car whose truth is known."""
    name = names.checked(new.name)
    folder = desk.projects.make(name)
    try:
        return desk.project_jobs.begin(name, folder, answer.NewJob(task="sample")).row()
    except ServerError:
        folder.rmdir()
        raise


@router.get("/validations/{project}")
def validation(project: str, desk: AtDesk, kept: KeptRuns) -> answer.ProjectDetail:
    """A project: its text, its files, its iterations."""
    return desk.projects.detail(project, kept)


@router.put("/validations/{project}/text", openapi_extra=YAML_BODY)
async def put_project(project: str, request: Request, desk: AtOwnDesk, if_match: IfMatch = None) -> answers.KeptScenario:
    """Puts the body in the place of the project's text, if it is a project."""
    data = await received(request.stream())

    def write() -> answers.KeptScenario:
        now = desk.projects.put(project, source.decoded(data, "project.yaml"), expected(if_match))
        return answers.KeptScenario(scenario=project, digest=now)

    return await run_in_threadpool(write)


@router.patch("/validations/{project}", response_model_exclude_unset=True)
def patch_project(
    project: str,
    patch: Annotated[list[Operation], Body(media_type="application/json-patch+json")],
    desk: AtOwnDesk,
    if_match: IfMatch = None,
) -> answer.PatchedProject:
    """Changes a project by a JSON patch (RFC 6902), its comments kept: all of it if the result is a project, else nothing."""
    now, inverse = desk.projects.patch(project, operations(patch), expected(if_match))
    return answer.PatchedProject(digest=now, inverse=inverse)


@router.put("/validations/{project}/files/{name}", status_code=201, openapi_extra=BYTES)
async def put_file(
    project: str, name: str, request: Request, desk: AtOwnDesk, replace: Annotated[bool, Query(description="one of that name")] = False
) -> answer.ProjectFile:
    """Takes a log, a mapping, a DBC, a vehicle or a tyre into the folder of the project, whole or not at all."""
    path = await run_in_threadpool(lambda: place_for(desk.projects.find(project), name, replace))
    beside = path.with_name(f".{path.name}-{secrets.token_hex(4)}")
    try:
        await stored(request.stream(), beside)
        return await run_in_threadpool(lambda: taken(beside, path))
    finally:
        beside.unlink(missing_ok=True)


@router.delete("/validations/{project}/files/{name}", status_code=204)
def delete_file(project: str, name: str, desk: AtOwnDesk) -> None:
    """Removes a file that the project does not name."""
    desk.projects.delete_file(project, name)


# -- what is done ------------------------------------------------------------------------------------


@router.post("/validations/{project}/jobs", status_code=202)
def begin_job(project: str, new: answer.NewJob, desk: AtOwnDesk) -> answer.ProjectJob:
    """Looks at a log, calibrates, or validates, in a process of its own."""
    folder = desk.projects.find(project)
    if new.task == "sample":
        raise ScenarioError(
            "A sample is a project of its own.", [Problem("task", "is not done here", "sample", "look, calibrate, validate")]
        )
    for wanted in [each for each in (new.log, new.mapping) if each is not None]:
        desk.projects.file(project, wanted)
    check_inside({"mapping": new.mapping})
    if new.task == "look" and new.log is None:
        raise ScenarioError("Nobody says which log.", [Problem("log", "is missing", remedy="name a file of the project")])
    return desk.project_jobs.begin(project, folder, new).row()


@router.get("/validation-jobs")
def jobs(desk: AtDesk) -> list[answer.ProjectJob]:
    """What is being done with projects, newest first; what a log held is told by its own job."""
    return [each.row().model_copy(update={"looked": None}) for each in desk.project_jobs.rows()]


@router.get("/validation-jobs/{job}")
def job(job: int, desk: AtDesk) -> answer.ProjectJob:
    """A job now, and what came out once it is over."""
    return desk.project_jobs.find(job).row()


@router.delete("/validation-jobs/{job}")
def cancel(job: int, desk: AtDesk) -> answer.ProjectJob:
    """Cancels a job: its process ends, and of the step that went on nothing is kept; those before stay. One that is over stays as it is."""
    return desk.project_jobs.cancel(job).row()


# -- what came out -----------------------------------------------------------------------------------


@router.get("/iterations/{iteration}")
def one_iteration(iteration: int, kept: KeptRuns) -> answer.IterationDetail:
    """An iteration of a project: verdicts, or what was calibrated."""
    return found_iteration(kept, iteration)


def found_iteration(kept: Any, number: int) -> answer.IterationDetail:
    """An iteration as it is told; raises UnknownError."""
    return answer.IterationDetail(**iteration.find(kept, number).as_json())


@router.get("/validations/{project}/iterations/{iteration}/report", response_class=Response, responses=PAGE)
def iteration_report(project: str, iteration: int, desk: AtDesk) -> Response:
    """The report of a validation: one page, to be kept, read and printed."""
    return HTMLResponse(result(report_of(desk.projects.find(project), iteration), iteration))


@router.get("/validations/{project}/iterations/{iteration}/report.pdf", response_class=Response, responses=PAPER)
def iteration_report_on_paper(project: str, iteration: int, desk: AtDesk) -> Response:
    """The same report as PDF."""
    return on_paper(result(report_of(desk.projects.find(project), iteration), iteration), f"validation_{iteration}.pdf")


@router.get("/validations/{project}/iterations/{iteration}/courses")
def iteration_courses(project: str, iteration: int, desk: AtDesk) -> answer.Courses:
    """Zones of the recorded runs with the simulations, signal by signal."""
    return answer.Courses.model_validate_json(result(courses_of(desk.projects.find(project), iteration), iteration))


@router.get("/validations/{project}/iterations/{iteration}/vehicle", response_class=Response, responses=YAML)
def iteration_vehicle(project: str, iteration: int, desk: AtDesk) -> Response:
    """The vehicle file of a validation: what was calibrated with its provenance, and the validated span."""
    text = result(vehicle_of(desk.projects.find(project), iteration), iteration)
    named = {"Content-Disposition": f'attachment; filename="vehicle_{iteration}.yaml"'}
    return Response(text, media_type="application/yaml", headers=named)


def result(path: Path, number: int) -> str:
    """What was kept beside the project; raises UnknownError."""
    if not path.is_file():
        remedy = "only a validation begun in the page has one; studio validate --report writes it elsewhere"
        raise UnknownError(f"Iteration {number} has no results here.", [Problem("iteration", "has no results", str(number), remedy=remedy)])
    return path.read_text(encoding="utf-8")


# -- files that are sent -----------------------------------------------------------------------------


def place_for(folder: Path, name: str, replace: bool) -> Path:
    """Where a file is to be put; raises ScenarioError for a name that no file may have, ConflictError for one that is taken."""
    last, known = name.strip(), endings()
    what = names.wrong(last) or ("" if last.lower().endswith(tuple(known)) else "has an ending that is not known")
    if what or last == "project.yaml":
        problem = Problem("name", what or "is the project itself", short(name), ", ".join(known), "rename the file, then send it again")
        raise ScenarioError("This file is not taken.", [problem])
    if (folder / last).exists() and not replace:
        raise ConflictError(f"There is a file {last} already.", [Problem("name", "is taken", last, remedy="rename it, or replace it")])
    return folder / last


async def stored(body: AsyncIterator[bytes], beside: Path) -> None:
    """Writes a body to a file as it comes. Raises SizeError as soon as it is too much, ScenarioError when the disk does not take it."""
    size = 0
    try:
        with beside.open("xb") as out:
            async for part in body:
                size += len(part)
                if size > LARGEST:
                    limit = f"at most {LARGEST // 2**20} MiB"
                    raise SizeError("The file is too large.", [Problem("body", "is too large", "", limit, "cut the log")])
                await run_in_threadpool(out.write, part)
    except OSError as error:
        raise file.unwritten(beside, error) from None


def taken(beside: Path, path: Path) -> answer.ProjectFile:
    """Gives a file its name, if it is what it says; raises ScenarioError."""
    if is_document(path.name):
        check_inside(checked(source.decoded(file.content(beside, "file", file.SIZE_LIMIT), path.name), path.name).value)
    try:
        os.replace(beside, path)
    except OSError as error:
        raise file.unwritten(path, error) from None
    return answer.ProjectFile(name=path.name, bytes=path.stat().st_size, kind=kind_of(path))
