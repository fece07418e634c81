"""The folder of maps beside the scenarios: what is in it, what is told of it, and what may be done with it.

A map is found by its name in the folder's listing and in no other way, so no name leads out of the folder.
"""

import json
import re
import shutil
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from studio.errors import MapError, Problem, ScenarioError, StudioError, UnknownError, nearest
from studio.road import load
from studio.road.formats import osm
from studio.road.library import folder
from studio.road.library.place import attribution, licence, name_of
from studio.road.library.reader import ENDINGS, ending_of
from studio.road.network import Lane, Network
from studio.road.ways.relief import Relief, relief_of
from studio.road.ways.trip import Trip, trip
from studio.scenario import file as scenario_file
from studio.scenario.schema import VERSION
from studio.scenario.text.splice import written
from studio.scene.city.stretch import land_of, runs
from studio.server.maps import answer
from studio.world.setting import USUAL_RADIUS

CALLED = "maps"  # the folder's name, as scenarios write it
LONGEST_NAME = 80  # characters
MOST_BYTES = 180  # of a name on disk; most file systems take 255, and endings are put behind it
RED_LIGHT = 20.0  # [s] that a stop line costs on average
OURS = (folder.REPORT, folder.NETWORK, folder.CORRECTIONS, *folder.MAPS)


@dataclass(frozen=True)
class Maps:
    """The maps of a folder of scenarios."""

    scenarios: Path

    @property
    def folder(self) -> Path:
        """Where the maps are."""
        return self.scenarios / CALLED

    def entries(self) -> dict[str, Path]:
        """Imports and map files by name."""
        found = sorted(self.folder.iterdir()) if self.folder.is_dir() else []
        return {path.name: path for path in found if not path.name.startswith(".") and (is_import(path) or is_map_file(path))}

    def find(self, name: str) -> Path:
        """A map; raises UnknownError."""
        entries = self.entries()
        if name not in entries:
            raise UnknownError(f"There is no map {name!r}.", [Problem("map", "does not exist", name, remedy=nearest(name, entries))])
        return entries[name]

    def find_import(self, name: str) -> Path:
        """The folder of an import; raises UnknownError, or MapError for a plain map file."""
        path = self.find(name)
        if not path.is_dir():
            problem = Problem("map", "is a map file, not an import", name, remedy="import it first: upload it, or `studio import`")
            raise MapError(f"{name!r} is no import.", [problem])
        return path

    # -- what is told ------------------------------------------------------------------------------

    def rows(self) -> list[answer.MapRow]:
        """All maps, for the list; one that cannot be read says why."""
        return [row(path) for path in self.entries().values()]

    def detail(self, name: str) -> answer.MapDetail:
        """One map with its report; a plain file is imported for it once. Raises UnknownError or MapError."""
        path = self.find(name)
        text = report_of(path) if path.is_dir() else folder.report_json(load(path), path, None)
        corrections = folder.corrections(path) if path.is_dir() else ()
        origin = (text["origin"]["latitude"], text["origin"]["longitude"])
        shown = row(path).model_dump() | {"drive_side": text["drive_side"], "lane_km": text["lane_km"]}
        return answer.MapDetail(
            **shown,
            bbox=text["bbox"],
            origin=origin,
            bounds_m=text["bounds_m"],
            digest=text["digest"],
            report=numbered(text, origin),
            corrections=[each.as_json() for each in corrections],
        )

    def plan(self, name: str) -> answer.MapPlan:
        """One map from above. Raises UnknownError or MapError."""
        path = self.find(name)
        network = load(path)
        return plan_of(network, numbered(folder.report_json(network, path, None), network.origin))

    # -- what is done ------------------------------------------------------------------------------

    def drive(self, name: str) -> str:
        """Writes a scenario with one car on this map; returns its id. Raises UnknownError or MapError."""
        path = self.find(name)
        found = trip(load(path) if path.is_dir() else load(path, radius=USUAL_RADIUS))
        base = f"{plain_name(title_of(path))}_drive"
        return write_new(self.scenarios, base, scenario_text(name, found, attribution(path), licence(path)))

    def users(self, path: Path) -> list[str]:
        """The scenarios of the folder that name a map."""
        wanted = path.resolve()
        return [each.stem for each in sorted(self.scenarios.glob("*.yaml")) if map_of(each) == wanted]

    def delete(self, name: str) -> None:
        """Removes an import. Raises UnknownError, or MapError when a scenario names it or it holds other things."""
        path = self.find_import(name)
        if users := self.users(path):
            problems = [
                Problem(f"scenario {each}", "names this map", remedy="remove the scenario, or let it name another map") for each in users
            ]
            raise MapError(f"The map {name!r} is in use.", problems)
        if others := sorted(each.name for each in path.iterdir() if each.name not in OURS):
            problem = Problem("map", "holds other things", ", ".join(others)[:200], remedy="move them elsewhere")
            raise MapError(f"The folder of {name!r} is not only an import.", [problem])
        aside = path.with_name(f".gone-{path.name}")
        shutil.rmtree(aside, ignore_errors=True)
        path.rename(aside)  # at once: nobody finds half of it
        shutil.rmtree(aside, ignore_errors=True)


# -- names -------------------------------------------------------------------------------------------


def is_import(path: Path) -> bool:
    """Whether this is the folder of an import."""
    return (path / folder.REPORT).is_file()


def is_map_file(path: Path) -> bool:
    """Whether this is a map file, by its ending."""
    return path.is_file() and path.name.lower().endswith(ENDINGS)


def plain_name(text: str) -> str:
    """A name for a folder or file, from what somebody calls it: letters and digits of any script, and no more signs than - and _.

    >>> plain_name("../../Straße des 17. Juni (東京).osm"), plain_name("...")
    ('Straße_des_17_Juni_東京_osm', '')
    """
    text = unicodedata.normalize("NFC", re.split(r"[/\\]", text)[-1])
    kept = "".join(each if unicodedata.category(each)[0] in "LMN" or each in "-_" else "_" for each in text)
    kept = re.sub(r"_+", "_", kept).strip("_-")[:LONGEST_NAME]
    while len(kept.encode()) > MOST_BYTES:
        kept = kept[:-1]
    return kept.strip("_-")


def file_name(text: str) -> tuple[str, str]:
    """Name and ending for a map file that somebody sends. Raises MapError when it is no kind of map or has no name."""
    last = re.split(r"[/\\]", text)[-1]
    shown = ascii(last[:80])
    try:
        ending = ending_of(Path(last))
    except MapError:
        allowed = ", ".join(ENDINGS)
        raise MapError(
            "This kind of file cannot be imported.", [Problem("name", "has an ending that is not known", shown, allowed)]
        ) from None
    name = plain_name(last[: -len(ending)])
    if not name:
        raise MapError("The file has no name.", [Problem("name", "holds no letter or digit", shown, "such as my_place.osm.gz")])
    return name, ending


def free_name(base: str, taken: Iterable[str]) -> str:
    """The name, or with a number behind it when it is taken.

    >>> free_name("berlin", ["berlin", "berlin_2"])
    'berlin_3'
    """
    taken, name, number = set(taken), base, 1
    while name in taken:
        number += 1
        name = f"{base}_{number}"
    return name


# -- reports -----------------------------------------------------------------------------------------


def row(path: Path) -> answer.MapRow:
    """A map for the list."""
    known: dict[str, Any] = {"source": path.name, "attribution": "", "licence": "", "problem": None, "drive_side": None, "lane_km": None}
    try:
        if path.is_dir():
            text = report_of(path)
            known |= {key: text[key] for key in ("source", "attribution", "licence", "drive_side", "lane_km")}
        else:
            known |= {"attribution": attribution(path), "licence": licence(path)}
        known["bytes"] = size_of(path)
    except MapError as error:
        known |= {"problem": str(error), "bytes": 0}
    return answer.MapRow(id=path.name, title=title_of(path), kind="import" if path.is_dir() else "file", **known)


def title_of(path: Path) -> str:
    """What a map is called: an import's folder, or a file without its ending."""
    return path.name if path.is_dir() else name_of(path)


def report_of(path: Path) -> dict[str, Any]:
    """The report of an import's folder; raises MapError."""
    try:
        text = json.loads((path / folder.REPORT).read_text(encoding="utf-8"))
        answer.ReportPlaces.model_validate(text)
        answer.ReportFile(**numbered(text, (text["origin"]["latitude"], text["origin"]["longitude"])))
        return text
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise MapError(f"{path.name}: its {folder.REPORT} cannot be read; import the map again") from None


def size_of(path: Path) -> int:
    """Size on disk [B]."""
    try:
        return sum(each.stat().st_size for each in (path.iterdir() if path.is_dir() else [path]) if each.is_file())
    except OSError as error:
        raise MapError(f"{path.name}: it cannot be read ({error.strerror or error})") from None


def numbered(text: dict[str, Any], origin: tuple[float, float]) -> dict[str, Any]:
    """A report whose guesses, gaps and corrections have numbers and local positions."""
    number, made = 1, dict(text)
    for kind in ("guesses", "skipped", "corrected"):
        things = text.get(kind, ())
        places = local([(each["latitude"], each["longitude"]) for each in things], origin)
        made[kind] = [
            {"element": "", "key": ""} | each | {"number": number + i, "x": x, "y": y}
            for i, (each, (x, y)) in enumerate(zip(things, places, strict=True))
        ]
        number += len(things)
    return made


def local(places: list[tuple[float, float]], origin: tuple[float, float]) -> list[tuple[float, float]]:
    """Positions in local metres; what the projection cannot show lies at its centre."""
    if not places:
        return []
    latitude, longitude = origin
    points = osm.Box(latitude, longitude, latitude, longitude).local(*np.array(places).T).T.tolist()
    return [(round(x, 2), round(y, 2)) if isfinite(x) and isfinite(y) else (0.0, 0.0) for x, y in points]


# -- the plan ----------------------------------------------------------------------------------------


def plan_of(network: Network, report: dict[str, Any]) -> answer.MapPlan:
    """A network from above, with what its report points at."""
    signals, relief = network.signals, relief_of(network)
    return answer.MapPlan(
        bounds_m=network.bounds,
        drive_side=network.drive_side,
        attribution=network.attribution,
        lanes=[
            {"id": each.id, "road": each.road, "index": each.index, "width": each.width, "speed": each.speed,
             "internal": each.internal, "open": each.open, "centre": points(each.centre)} | (stretches(each, relief) if relief else {})
            for each in network.lanes
        ],
        roads=[
            {"id": each.id, "name": each.name, "lanes": list(each.lanes), "ways": list(each.ways)}
            for each in network.roads.values() if not each.internal
        ],
        junctions=[points(each) for each in network.junctions],
        buildings=[
            {"outline": points(each.outline), "holes": list(map(points, each.holes)), "height": each.height}
            for each in network.scenery.buildings
        ],
        areas=[
            {"kind": each.kind, "outline": points(each.outline), "holes": list(map(points, each.holes))}
            for each in network.scenery.areas
        ],
        signals=[
            {"x": float(signals.link_x[i]), "y": float(signals.link_y[i]), "heading": float(signals.link_heading[i]),
             "lane": int(signals.link_lane[i]), "programme": int(signals.programme[i])} for i in range(len(signals))
        ],
        **{kind: [{key: each.get(key, "corrected") for key in ("number", "kind", "x", "y")} for each in report[kind]]
           for kind in ("guesses", "skipped", "corrected")},
    )  # fmt: skip


def stretches(lane: Lane, relief: Relief) -> dict[str, Any]:
    """Which parts of a lane lie on the land, and which off it and how far."""
    _, place, lift = relief.of_lane(lane.id)
    if not lift.any():
        return {}
    off = [(float(lift[a + np.abs(lift[a : b + 1]).argmax()]), place[:, a : b + 1]) for a, b in runs(lift != 0.0)]
    return {
        "land": [points(centre) for _, _, centre in land_of(lane, relief)],
        "aloft": [{"lift": round(most, 2), "centre": points(line)} for most, line in off],
    }


def points(line: np.ndarray) -> list[tuple[float, float]]:
    """A line as pairs of x and y, to the centimetre."""
    return [(x, y) for x, y in np.round(line.T, 2).tolist()]


# -- scenarios ---------------------------------------------------------------------------------------


def map_of(scenario: Path) -> Path | None:
    """The map that a scenario file names; None when it cannot be read."""
    try:
        named = scenario_file.read(scenario)["map"]["file"]
        return (scenario.parent / named.strip()).resolve()
    except (StudioError, KeyError, TypeError, AttributeError, OSError, ValueError):
        return None


def scenario_text(name: str, found: Trip, maker: str, terms: str) -> str:
    """A scenario file: one car on a trip, at the limit."""
    return as_file(a_drive(name, found), maker, terms)


def a_drive(name: str, found: Trip) -> dict[str, Any]:
    """A scenario: one car on a trip, at the limit."""
    duration = min(600.0, 10.0 * np.ceil((1.2 * found.time + RED_LIGHT * len(found.path.stop_lines)) / 10.0) + 10.0)
    return {
        "version": VERSION,
        "title": f"A drive in {name}"[:120],
        "description": f"One car drives {found.length:.0f} m through the map {name}, a way drawn by lot, and stops at red.",
        "map": {"file": f"{CALLED}/{name}"},
        "clock": {"duration": float(duration)},
        "seed": 1,
        "routes": {"trip": {"roads": list(found.roads)}},
        "vehicles": {"ego": {"route": "trip", "position": {"along": found.start}, "speed": round(found.speed, 2)}},
    }


def as_file(document: dict[str, Any], maker: str, terms: str) -> str:
    """A scenario as its file, which names the source of the map."""
    named = " ".join(", ".join(filter(None, (maker, terms))).split())  # a header may hold line breaks
    head = f"# Map data {named}.\n" if named else ""
    return f"{head}{written(document, flow=None)}\n"


def write_new(place: Path, base: str, text: str) -> str:
    """Writes a scenario under a free name; returns its id. Raises ScenarioError when the disk does not take it."""
    while True:
        name = free_name(base, (each.stem for each in place.iterdir()))
        try:
            with (place / f"{name}.yaml").open("x", encoding="utf-8") as target:
                target.write(text)
            return name
        except FileExistsError:
            continue
        except OSError as error:
            raise ScenarioError(f"{place}: the scenario cannot be written ({error.strerror or error})") from None
