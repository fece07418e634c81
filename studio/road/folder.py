"""An imported place as a folder: the map it was made of, the network as plain JSON, and the report.

    map.osm, map.osm.gz, map.osm.pbf, map.json, map.xodr   the map as it came; `load` of the folder starts from it
    network.json.gz     lanes, roads, connections and signals in local metres, for other programs
    report.json         what was found, guessed and skipped, the part that was kept, the attribution
"""

import gzip
import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from studio.errors import MapError
from studio.road.network import Network
from studio.road.reader import ENDINGS, ending_of

REPORT, NETWORK = "report.json", "network.json.gz"


def write(network: Network, source: Path, out: Path, *, bbox: str | None) -> None:
    """Writes the folder beside its place and renames it, so that there is never half of one.

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
            (made / REPORT).write_bytes(as_text(report_json(network, source, bbox)))
            if out.exists():
                os.rename(out, Path(beside, "old"))
            os.rename(made, out)
    except OSError as error:
        raise MapError(f"{out}: the folder cannot be written ({error.strerror or error})") from None


def refuse_foreign(out: Path) -> None:
    """Refuses to write over what is no import."""
    if out.exists() and not out.is_dir():
        raise MapError(f"{out}: a file of this name is in the way; name another folder")
    if out.is_dir() and any(out.iterdir()) and not (out / REPORT).is_file():
        raise MapError(f"{out}: the folder holds other things; name a new or an empty one")


def as_text(value: Any) -> bytes:
    """JSON as it stands in a file."""
    return json.dumps(value, ensure_ascii=False, indent=1).encode()


def report_json(network: Network, source: Path, bbox: str | None) -> dict[str, Any]:
    """The report with what it is of."""
    latitude, longitude = network.origin
    return {
        "name": network.name,
        "attribution": network.attribution,
        "licence": network.licence,
        "source": source.name,
        "bbox": bbox,
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
             "internal": each.internal, "centre": points(each.centre), "height": np.round(each.height, 3).tolist()} for each in network.lanes
        ],
        "roads": [
            {"id": each.id, "name": each.name, "lanes": list(each.lanes), "internal": each.internal} for each in network.roads.values()
        ],
        "connections": [
            {"from_lane": each.from_lane, "to_lane": each.to_lane, "via": list(each.via), "signal": each.link, "direction": each.direction}
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


def opened(folder: Path) -> tuple[Path, str | None]:
    """The map of an import's folder, and the part of it that was kept.

    Raises:
        MapError: the folder is no import.
    """
    try:
        text = json.loads((folder / REPORT).read_text(encoding="utf-8"))
        (source,) = [each for each in folder.iterdir() if each.name in {f"map{ending}" for ending in ENDINGS}]
        bbox = text["bbox"]
    except (OSError, ValueError, KeyError, TypeError):
        raise MapError(f"{folder}: the map file cannot be read: this folder is no import; make one with `studio import`") from None
    return source, bbox
