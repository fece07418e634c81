"""Imports as the server sees them: a process each, two at a time, the others wait; one at a time for the same map.

What an import needs for a while lies in a folder of its own beside the maps, and goes with it however it ends. The folder that
it makes appears at once and whole; from that moment on nobody cancels it.
"""

import itertools
import os
import shutil
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psutil
from starlette.concurrency import run_in_threadpool

from studio.errors import MapError, Problem, ServerError, SizeError, StudioError
from studio.process import Child, Gone
from studio.road.formats import osm
from studio.road.library import folder, intake, tag
from studio.server.answer import ImportStatus
from studio.server.docket import Docket, Errand
from studio.server.maps import Maps, answer, file_name, free_name, plain_name
from studio.server.maps import worker as map_worker
from studio.server.maps.worker import Order

AT_A_TIME = 2  # processes
MOST_WAITING = 16  # imports, each with its file
MOST_KEPT = 100  # imports that are over
END_PATIENCE = 10.0  # [s] for folders that are being written when the server ends
SCRATCH = ".job"  # how the folders of imports begin
COPIES = 3  # of an upload: as it came, in its folder, and the network that is made of it
WAITING = "waiting for other imports"


@dataclass(kw_only=True)
class MapJob(Errand):
    """One import."""

    map: str
    order: Order
    stage: str = WAITING
    committed: bool = False

    def row(self) -> answer.MapJob:
        """The import as it is told."""
        with self.lock:
            return answer.MapJob(**self.told(), map=self.map)

    def cancel(self) -> None:
        """Ends it with its process, as long as its folder is not being written."""
        with self.lock:
            if not self.is_over and not self.committed:
                super().cancel()

    def work(self) -> None:
        """Runs it in a process; when it is over, what it needed for a while is gone."""
        try:
            child = self.start(map_worker.main, self.order)
            outcome = self.listen(child) if child else ("cancelled", None)
        except OSError as error:
            outcome = "failed", ServerError(f"The process of the import did not start ({error.strerror or error}).")
        shutil.rmtree(self.order.scratch, ignore_errors=True)
        self.end(*outcome)

    def listen(self, child: Child) -> tuple[ImportStatus, StudioError | None]:
        """Hears the process out; the status that it ends with, and the problem."""
        outcome = None
        try:
            while outcome is None:
                outcome = self.hear(child, *child.hear())
        except Gone as end:
            outcome = "failed", gone(end.code)
        child.end(END_PATIENCE)
        return outcome

    def hear(self, child: Child, word: str, *values: Any) -> tuple[ImportStatus, StudioError | None] | None:
        """One piece of news; the last one is how it ended."""
        if word in ("done", "failed"):
            return word, values[0]
        if word == "stage":
            self.note(*values)
        elif word == "commit":
            with self.lock:
                if not self.is_over:
                    self.committed = True
                    child.tell("go")
        return None


def gone(code: int | None) -> StudioError:
    """The problem of a process that ended without a word."""
    why = "was ended by the system, perhaps for want of memory" if code == -9 else "crashed"
    return MapError("The map cannot be imported.", [Problem("importer", why, f"code {code}", remedy="cut out a smaller place")])


class MapJobs(Docket[MapJob]):
    """All imports of this server."""

    def __init__(self, maps: Maps) -> None:
        super().__init__(at_a_time=AT_A_TIME, most_kept=MOST_KEPT, patience=END_PATIENCE, what="import")
        self.maps, self.numbers = maps, itertools.count()

    def of(self, name: str) -> list[MapJob]:
        """The imports of a map that are not over."""
        with self.lock:
            return [job for job in self.waiting if job.map == name]

    # -- what is done ------------------------------------------------------------------------------

    async def upload(self, body: AsyncIterator[bytes], *, name: str, size: int, bbox: str | None, replace: bool) -> MapJob:
        """Takes a map file and imports it; `size` is what its sender says of it [B]. Raises MapError, SizeError or ServerError."""
        base, ending = file_name(name)
        if bbox is not None:
            osm.bounding_box(bbox)
        if size > osm.LARGEST_FILE:
            raise too_large()
        check_disk(self.maps.folder.parent, size)
        scratch = await run_in_threadpool(self.scratch)
        try:
            source = scratch / f"{base}{ending}"
            await received(body, source)
            given = {"source": source, "bbox": bbox}
            return await run_in_threadpool(self.begin, "take", scratch, base, given, replace=replace)
        except BaseException:
            shutil.rmtree(scratch, ignore_errors=True)
            raise

    def download(self, new: answer.NewDownload) -> MapJob:
        """Downloads and imports a place. Raises MapError or ServerError."""
        from studio.road.library import download

        if (new.place is None) == (new.bbox is None):
            problem = Problem("place, bbox", "are none or both given", remedy="give one of them")
            raise MapError("What shall be downloaded?", [problem])
        by = download.servers()
        place = new.place or "" if new.bbox is None else osm.bounding_box(",".join(map(repr, new.bbox)))
        if isinstance(place, osm.Box):
            download.check_area(place)
        base = plain_name(new.name or name_for(place))
        if not base:
            raise MapError("The map has no name.", [Problem("name", "holds no letter or digit", ascii(new.name or new.place))])
        given = {"place": place, "overpass": by.overpass, "search": by.search}
        return self.begin("fetch", self.scratch(), base, given, replace=new.replace)

    def correct(self, name: str, new: answer.NewCorrection) -> MapJob:
        """Imports a map again with a correction. Raises UnknownError, MapError or ServerError."""
        path, wanted = self.maps.find_import(name), tag.correction(new.element, new.tags, new.remove)
        return self.begin("correct", self.scratch(), path.name, {"new": wanted}, replace=True)

    def take_back(self, name: str, element: str) -> MapJob:
        """Imports a map again without the corrections of an element. Raises UnknownError, MapError or ServerError."""
        path = self.maps.find_import(name)
        if not self.of(name):  # else one may be on its way
            intake.check_corrected(path, element, folder.corrections(path))
        return self.begin("undo", self.scratch(), path.name, {"element": element}, replace=True)

    def delete(self, name: str) -> None:
        """Removes an import that nobody works on. Raises UnknownError, MapError or ServerError."""
        with self.lock:
            if self.of(name):
                problem = Problem("map", "is being imported", name, remedy="wait, or cancel the import")
                raise MapError(f"The map {name!r} is in use.", [problem])
            self.maps.delete(name)

    # -- processes ---------------------------------------------------------------------------------

    def scratch(self) -> Path:
        """A new folder for what an import needs for a while; those of servers that are gone are removed. Raises ServerError."""
        try:
            self.maps.folder.mkdir(exist_ok=True)
            sweep(self.maps.folder)
            made = self.maps.folder / f"{SCRATCH}-{os.getpid()}-{next(self.numbers)}"
            made.mkdir()
            return made
        except OSError as error:
            raise ServerError(f"{self.maps.folder}: maps cannot be kept here ({error.strerror or error})") from None

    def begin(self, task: str, scratch: Path, base: str, given: dict[str, Any], *, replace: bool) -> MapJob:
        """An import of its own number, under a free name unless it replaces. Raises MapError or ServerError."""
        try:
            with self.lock:
                self.check_room()
                waiting = [job.map for job in self.waiting]
                name = base if replace else free_name(base, [*waiting, *(each.name for each in self.maps.folder.iterdir())])
                folder.refuse_foreign(self.maps.folder / name)
                order = Order(task, self.maps.folder / name, scratch, given)
                job = self.add(lambda number: MapJob(id=number, map=name, order=order))
        except BaseException:
            shutil.rmtree(scratch, ignore_errors=True)
            raise
        self.proceed()
        return job

    def check_room(self) -> None:
        """Raises ServerError when too many imports wait, or the server ends."""
        if self.closed:
            raise ServerError("The server is ending.")
        waiting = len(self.waiting)
        if waiting >= MOST_WAITING:
            problem = Problem("imports", "are as many as may wait", str(waiting), f"at most {MOST_WAITING}", "wait, or cancel one")
            raise ServerError("Too many imports are waiting.", [problem])

    def may_begin(self, job: MapJob) -> bool:
        """One at a time for the same map."""
        return job.map not in [self.jobs[each].map for each in self.working]

    def proceed(self) -> None:
        """Starts the imports that may start now; those cancelled while they waited go."""
        with self.lock:
            for number, job in self.jobs.items():
                if job.is_over and job.process is None and number not in self.working:
                    shutil.rmtree(job.order.scratch, ignore_errors=True)
            super().proceed()

    def close(self) -> None:
        """Cancels all imports; folders that are being written are finished."""
        super().close()
        for job in self.rows():
            shutil.rmtree(job.order.scratch, ignore_errors=True)


def sweep(maps: Path) -> None:
    """Removes what servers left behind that were ended by force."""
    for each in maps.glob(f"{SCRATCH}-*-*"):
        pid = each.name.split("-")[1]
        if pid.isdigit() and int(pid) != os.getpid() and not psutil.pid_exists(int(pid)):
            shutil.rmtree(each, ignore_errors=True)


def name_for(place: str | osm.Box) -> str:
    """What a place is called that nobody named: the first part of its name, or where it lies."""
    if isinstance(place, str):
        return place.split(",")[0]
    latitude, longitude = place.centre
    return f"place_{latitude:.4f}_{longitude:.4f}".replace(".", "_")


async def received(body: AsyncIterator[bytes], target: Path) -> None:
    """Writes a body to a file as it comes. Raises SizeError as soon as it is too much, ServerError when the disk does not take it."""
    size = 0
    try:
        with target.open("wb") as file:
            async for part in body:
                size += len(part)
                if size > osm.LARGEST_FILE:
                    raise too_large()
                await run_in_threadpool(file.write, part)
    except OSError as error:
        raise ServerError(f"The file cannot be kept ({error.strerror or error}).") from None


def check_disk(folder: Path, size: int) -> None:
    """Raises ServerError when a file of this size, and what is made of it, will not find room."""
    needed, free = COPIES * size, shutil.disk_usage(folder).free
    if needed > free:
        problem = Problem(
            "disk", "has no room for the map", f"{free / 1e6:.0f} MB free", f"{needed / 1e6:.0f} MB", f"make room in {folder}"
        )
        raise ServerError("There is no room for this map.", [problem])


def too_large() -> SizeError:
    """The refusal of a file that is too large."""
    limit = f"{osm.LARGEST_FILE // 2**20} MiB"
    return SizeError("The file is too large.", [Problem("body", "is too large", "", f"at most {limit}", "cut out a smaller place")])
