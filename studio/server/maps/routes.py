"""REST of the maps: import by upload or download, report, plan, corrections, and a first drive.

Imports are answered at once with a job; whoever asked looks at it until it is over.
"""

from typing import Annotated

from fastapi import APIRouter, Query, Request

from studio.server.answer import REFUSALS
from studio.server.maps import answer
from studio.server.routes import AtDesk, AtOwnDesk

BODY = {"requestBody": {"required": True, "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}}
Name = Annotated[str, Query(description="name of the file; its ending tells the kind: .osm, .osm.gz, .osm.pbf, .json", max_length=300)]
Box = Annotated[str | None, Query(description="the part to keep, west,south,east,north [deg]")]
Replace = Annotated[bool, Query(description="replace the import of that name; its corrections are kept")]
router = APIRouter(prefix="/api", responses=REFUSALS)


@router.get("/maps")
def maps(desk: AtDesk) -> list[answer.MapRow]:
    """The imports and map files of the folder of maps."""
    return desk.maps.rows()


@router.get("/maps/{map}")
def map_detail(map: str, desk: AtDesk) -> answer.MapDetail:
    """A map with the report of its import and its corrections."""
    return desk.maps.detail(map)


@router.get("/maps/{map}/plan")
def map_plan(map: str, desk: AtDesk) -> answer.MapPlan:
    """A map from above."""
    return desk.maps.plan(map)


@router.post("/maps", status_code=202, openapi_extra=BODY)
async def upload(request: Request, desk: AtOwnDesk, name: Name, bbox: Box = None, replace: Replace = False) -> answer.MapJob:
    """Imports the map file that is the body, at most 100 MiB of it."""
    said = request.headers.get("content-length", "")
    size = int(said) if said.isdigit() else 0
    return (await desk.map_jobs.upload(request.stream(), name=name, size=size, bbox=bbox, replace=replace)).row()


@router.post("/maps/download", status_code=202)
def download(new: answer.NewDownload, desk: AtOwnDesk) -> answer.MapJob:
    """Downloads a place from the Overpass server of this studio, and imports it."""
    return desk.map_jobs.download(new).row()


@router.get("/map-jobs")
def map_jobs(desk: AtDesk) -> list[answer.MapJob]:
    """The imports of this server, newest first."""
    return [each.row() for each in desk.map_jobs.rows()]


@router.get("/map-jobs/{job}")
def map_job(job: int, desk: AtDesk) -> answer.MapJob:
    """An import now."""
    return desk.map_jobs.find(job).row()


@router.delete("/map-jobs/{job}")
def cancel(job: int, desk: AtDesk) -> answer.MapJob:
    """Cancels an import: its process ends, and nothing of it stays. One that is over stays as it is."""
    return desk.map_jobs.cancel(job).row()


@router.put("/maps/{map}/corrections", status_code=202)
def correct(map: str, new: answer.NewCorrection, desk: AtDesk) -> answer.MapJob:
    """Corrects an element of the map and imports it again; if that fails, map and corrections stay as they were."""
    return desk.map_jobs.correct(map, new).row()


@router.delete("/maps/{map}/corrections/{element}", status_code=202)
def take_back(map: str, element: str, desk: AtDesk) -> answer.MapJob:
    """Takes the corrections of an element back and imports the map again."""
    return desk.map_jobs.take_back(map, element).row()


@router.post("/maps/{map}/drive", status_code=201)
def drive(map: str, desk: AtOwnDesk) -> answer.Driven:
    """Writes a scenario with one car on this map, to be opened at once."""
    return answer.Driven(scenario=desk.maps.drive(map))


@router.delete("/maps/{map}", status_code=204)
def delete(map: str, desk: AtDesk) -> None:
    """Removes an import that no scenario of the folder names."""
    desk.map_jobs.delete(map)
