"""An imported place as a folder: the map it was made of, the network as plain JSON, and the report.

map.osm, map.osm.gz, map.osm.pbf, map.json, map.xodr   the map as it came; `load` of the folder starts from it
network.json.gz     lanes, roads, connections and signals in local metres, for other programs
report.json         what was found, guessed and skipped, the part that was kept, the attribution
corrections.json    what a user knows better than the map; outlives every import into this folder
"""

import gzip
import json
import os
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from studio.errors import MapError, StudioError
from studio.road.formats.correction import Corrections
from studio.road.library.reader import ENDINGS, ending_of
from studio.road.network import Network

REPORT, NETWORK, CORRECTIONS = "report.json", "network.json.gz", "corrections.json"
MAPS = tuple(f"map{ending}" for ending in ENDINGS)


@dataclass(frozen=True)
class Opened:
    """An import's folder: its map, the part that was kept, its corrections; the map's name and file as they came."""

    map: Path
    bbox: str | None
    parking_aisles: bool
    corrections: Corrections
    name: str
    source: str


def write(
    network: Network, source: Path, out: Path, *, bbox: str | None, parking_aisles: bool = False, corrections: Corrections = (),
    made_of: Opened | None = None,
) -> None:  # fmt: skip
    """Writes the folder beside its place and renames it, so that there is never half of one.

    `made_of` is the folder as it was when its own map is imported again.

    Raises:
        MapError: something that is no import stands there, or the disk does not take it.
    """
    refuse_foreign(out)
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f".{out.name}-", dir=out.parent) as beside:
            made = Path(beside, "made")
            made.mkdir()
            shutil.copyfile(source, made / f"map{ending_of(source)}")
            (made / NETWORK).write_bytes(gzip.compress(as_text(network_json(network)), mtime=0))
            text = report_json(network, source, bbox, parking_aisles=parking_aisles)
            if made_of is not None:
                text |= {"name": made_of.name, "source": made_of.source}
            (made / REPORT).write_bytes(as_text(text))
            if corrections:
                (made / CORRECTIONS).write_bytes(as_text([each.as_json() for each in corrections]))
            exchange(made, out, Path(beside, "old"))
    except OSError as error:
        raise MapError(f"{out}: the folder cannot be written ({error.strerror or error})") from None


def exchange(made: Path, out: Path, old: Path) -> None:
    """Puts what was made in its place; what stood there is put aside, and back when that fails."""
    is_there = out.exists()
    if is_there:
        os.rename(out, old)
    try:
        os.rename(made, out)
    except OSError:
        if is_there:
            os.rename(old, out)
        raise


def refuse_foreign(out: Path) -> None:
    """Refuses to write over what is no import."""
    if out.exists() and not out.is_dir():
        raise MapError(f"{out}: a file of this name is in the way; name another folder")
    if out.is_dir() and any(out.iterdir()) and not (out / REPORT).is_file():
        raise MapError(f"{out}: the folder holds other things; name a new or an empty one")


def as_text(value: Any) -> bytes:
    """JSON as it stands in a file."""
    return json.dumps(value, ensure_ascii=False, indent=1).encode()


def report_json(network: Network, source: Path, bbox: str | None, *, parking_aisles: bool = False) -> dict[str, Any]:
    """The report with what it is of."""
    latitude, longitude = network.origin
    return {
        "name": network.name,
        "attribution": network.attribution,
        "licence": network.licence,
        "source": source.name,
        "bbox": bbox,
        "parking_aisles": parking_aisles,
        "origin": {"latitude": latitude, "longitude": longitude},
        "bounds_m": list(network.bounds),
        "digest": network.digest,
        **network.report.as_json(),
    }


def network_json(network: Network) -> dict[str, Any]:
    """The roads and signals as plain values; lengths in metres, speeds in metres a second."""
    signals = network.signals
    return {
        "attribution": network.attribution,
        "drive_side": network.drive_side,
        "origin": list(network.origin),
        "datum": list(network.datum),
        "lanes": [
            {"id": each.id, "road": each.road, "index": each.index, "width": each.width, "speed": each.speed,
             "internal": each.internal, "centre": points(each.centre), "height": np.round(each.height, 3).tolist()}
            for each in network.lanes
        ],
        "roads": [
            {"id": each.id, "name": each.name, "lanes": list(each.lanes), "internal": each.internal, "ways": list(each.ways)}
            for each in network.roads.values()
        ],
        "connections": [
            {"from_lane": each.from_lane, "to_lane": each.to_lane, "via": list(each.via), "signal": each.link, "direction": each.direction,
             "right_of_way": each.right_of_way, "yields": list(each.yields)}
            for each in network.connections
        ],
        "junctions": [points(each) for each in network.junctions],
        "signals": [
            {"lane": int(signals.link_lane[i]), "programme": int(signals.programme[i]), "cycle_s": float(signals.cycle[i]),
             "offset_s": float(signals.offset[i])} for i in range(len(signals))
        ],
    }  # fmt: skip


def points(line: np.ndarray) -> list[list[float]]:
    """A line as pairs of x and y, to the millimetre."""
    return np.round(line.T, 3).tolist()


def opened(folder: Path) -> Opened:
    """What an import's folder holds.

    Raises:
        MapError: the folder is no import, or its corrections cannot be read.
    """
    try:
        text = json.loads((folder / REPORT).read_text(encoding="utf-8"))
        (source,) = [each for each in folder.iterdir() if each.name in MAPS]
        bbox, name, made_of = text["bbox"], text["name"], text["source"]
        parking_aisles = bool(text.get("parking_aisles", False))
    except (OSError, ValueError, KeyError, TypeError):
        raise MapError(f"{folder}: the map file cannot be read: this folder is no import; make one with `studio import`") from None
    return Opened(source, bbox, parking_aisles, corrections(folder), name, made_of)


def corrections(folder: Path) -> Corrections:
    """The corrections of a folder; none when it has none, or does not exist.

    Raises:
        MapError: the file is not as it should be: it may hold a day's work, so it is not passed over.
    """
    path = folder / CORRECTIONS
    if not path.exists():
        return ()
    from studio.road.library import tag

    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        return tuple(sorted((tag.from_json(each) for each in found), key=lambda each: each.element))
    except (OSError, ValueError, TypeError, RecursionError) as error:
        raise MapError(f"{path}: the corrections cannot be read ({error}); mend the file, or move it away") from None
    except StudioError as error:
        raise MapError(f"{path}: {error.message}", error.problems) from None
