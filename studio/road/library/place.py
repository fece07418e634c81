"""From a map file to a Network, kept on disk: the second time it is only read back."""

import os
import time
from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from studio.road import kept
from studio.road.assembly.plan import Wish
from studio.road.formats.correction import Corrections
from studio.road.formats.country import BORDERS
from studio.road.library import folder
from studio.road.library.reader import ending_of, reader_of
from studio.road.network import Connection, Net, Network
from studio.road.network.signals import Signals, signals


def load(
    path: str | os.PathLike,
    *,
    radius: float | None = None,
    bbox: str | None = None,
    parking_aisles: bool = False,
    corrections: Corrections = (),
    progress: Callable[[str], None] = lambda text: None,
) -> Network:
    """The roads and the scenery of a map: OpenStreetMap (.osm, .osm.gz, .osm.pbf, .json from Overpass) or OpenDRIVE (.xodr).

    Args:
        path: the map file, or the folder that `studio import` made of one.
        bbox: the part to keep, "west,south,east,north" [deg]; OpenDRIVE is taken whole.
        radius: how far the map reaches to each side of its centre [m]; left out, the mapped place and its arms. OpenDRIVE is
            taken whole.
        parking_aisles: whether the aisles of parking places are built too, with the driveways that lead to them.
        corrections: what is known better than a map file says; an import's folder has its own.
        progress: is told what is being done.

    Raises:
        MapError: the file is missing, damaged, of an unknown kind, or holds no roads.
    """
    path = Path(path)
    if path.is_dir():
        found = folder.opened(path)
        network = load(
            found.map, radius=radius, bbox=bbox or (None if radius else found.bbox), corrections=found.corrections,
            parking_aisles=parking_aisles or found.parking_aisles, progress=progress,
        )  # fmt: skip
        return replace(network, name=path.name)
    reader = reader_of(path)
    part = reader.part(path, Wish(radius, bbox, parking_aisles, corrections))
    data = reader.read(path)
    digest = digest_of(data, part)
    network = recall(digest)
    if network is None:
        network = imported(path, reader, data, part, digest, progress)
        kept.keep("maps", digest, network)
    return replace(network, name=name_of(path))


def attribution(path: str | os.PathLike) -> str:
    """Who made a map, or the map of an import's folder, without building it; "" where it does not say.

    Raises:
        MapError: the file is of an unknown kind, or the folder is no import.
    """
    source = source_of(Path(path))
    return reader_of(source).attribution(source)


def licence(path: str | os.PathLike) -> str:
    """What others may do with a map; "" where it does not say. Raises MapError as `attribution` does."""
    source = source_of(Path(path))
    return reader_of(source).licence(source)


def source_of(path: Path) -> Path:
    """The map file itself, also of an import's folder."""
    return folder.opened(path).map if path.is_dir() else path


def recall(digest: str) -> Network | None:
    """The network of this digest, when it has been kept."""
    network = kept.recall("maps", digest)
    return network if isinstance(network, Network) and network.digest == digest else None


def name_of(path: Path) -> str:
    """The map's name: its file without the ending."""
    return path.name[: -len(ending_of(path))]


def digest_of(data: bytes, part: object) -> str:
    """Digest of the map's content, the part that is kept and everything that turns them into a Network."""
    return kept.digest_of(part, version("eclipse-sumo"), version("osmium"), data, BORDERS.read_bytes(), maker=__file__)


def imported(path: Path, reader: Any, data: bytes, part: object, digest: str, progress: Callable[[str], None]) -> Network:
    """The network, made anew."""
    from studio.road.assembly.priority import ruled

    began = time.perf_counter()
    progress(f"reading {path.name}")
    plan = reader.plan(path, data, part, progress)
    progress("placing signals and scenery")
    net = plan.net
    lights = signals(net.lanes, net.roads, net.connections, plan.signalled)
    network = Network(
        name=name_of(path),
        attribution=plan.attribution,
        licence=plan.licence,
        origin=plan.origin,
        bounds=plan.bounds,
        digest=digest,
        lanes=net.lanes,
        roads=net.roads,
        connections=ruled(net, plan.law, linked(net, lights), lights),
        junctions=net.junctions,
        signals=lights,
        scenery=plan.scenery,
        datum=plan.datum,
        bans=plan.bans,
    )
    return replace(network, report=replace(plan.report(network), seconds=time.perf_counter() - began))


def linked(net: Net, lights: Signals) -> tuple[Connection, ...]:
    """The connections with the signal that each starts at, and with their sharpest bends."""
    from studio.road.assembly.alignment import sharpest

    link = {lane: number for number, lane in enumerate(lights.link_lane.tolist())}
    return tuple(
        replace(each, link=link.get(each.from_lane, -1), sharpest=each.sharpest or sharpest(net, each)) for each in net.connections
    )
