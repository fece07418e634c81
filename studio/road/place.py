"""From a map file to a Network, kept on disk: the second time it is only read back."""

import itertools
import os
import time
from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

from studio.errors import MapError
from studio.road import folder, kept, osm
from studio.road.correction import Corrections
from studio.road.network import ATTRIBUTION, Connection, Network, Road
from studio.road.signals import Signals, dead_ends, signals

IMPORTER = (
    *("audit.py", "bend.py", "correction.py", "country.py", "cross_section.py", "curve.py", "countries.json.gz", "limit.py", "netconvert.py"),
    *("network.py", "osm.py", "overpass.py", "place.py", "report.py", "scenery.py", "side.py", "signals.py", "surface.py", "turn.py"),
)
SHORTEST_RADIUS = 50.0  # [m]


def load(
    path: str | os.PathLike,
    *,
    radius: float | None = None,
    bbox: str | None = None,
    corrections: Corrections = (),
    progress: Callable[[str], None] = lambda text: None,
) -> Network:
    """The roads and the scenery of a map file (.osm, .osm.gz, .osm.pbf, or .json from an Overpass server).

    Args:
        path: the map file, or the folder that `studio import` made of one.
        bbox: the part to keep, "west,south,east,north" [deg].
        radius: how far the map reaches to each side of its centre [m]; left out, the mapped place and its arms.
        corrections: what is known better than a map file says; an import's folder has its own.
        progress: is told what is being done.

    Raises:
        MapError: the file is missing, damaged, of an unknown kind, or holds no roads.
    """
    path = Path(path)
    if path.is_dir():
        found = folder.opened(path)
        part = bbox or (None if radius else found.bbox)
        network = load(found.map, radius=radius, bbox=part, corrections=found.corrections, progress=progress)
        return replace(network, name=path.name)
    if radius is not None and not radius >= SHORTEST_RADIUS:
        raise MapError(f"{path}: radius must be at least {SHORTEST_RADIUS:g} m (got {radius!r})")
    box = None if bbox is None else osm.bounding_box(bbox)
    if box is not None and radius is not None:
        raise MapError(f"{path}: a radius and a bbox exclude each other; give one of them")
    data = osm.read(path)
    digest = digest_of(data, radius, box, corrections)
    network = recall(digest)
    if network is None:
        network = imported(path, data, digest, radius=radius, bbox=box, corrections=corrections, progress=progress)
        kept.keep("maps", digest, network)
    return replace(network, name=name_of(path))


def recall(digest: str) -> Network | None:
    """The network of this digest, when it has been kept."""
    network = kept.recall("maps", digest)
    return network if isinstance(network, Network) and network.digest == digest else None


def name_of(path: Path) -> str:
    """The map's name: its file without endings."""
    return path.name.split(".osm")[0].removesuffix(".json")


def digest_of(data: bytes, radius: float | None, bbox: osm.Box | None, corrections: Corrections) -> str:
    """Digest of the map's content, the options, the corrections and everything that turns them into a Network."""
    return kept.digest_of(radius, bbox, corrections, version("eclipse-sumo"), version("osmium"), data, sources=IMPORTER)


def imported(
    path: Path, data: bytes, digest: str, *, radius: float | None, bbox: osm.Box | None, corrections: Corrections, progress
) -> Network:
    """The network, made anew. What is needed only here is imported only here: a kept map opens at once."""
    from studio.road import audit, turn
    from studio.road.country import country_at
    from studio.road.scenery import scenery
    from studio.road.side import drive_side

    began = time.perf_counter()
    progress(f"reading {path.name}")
    found = osm.survey(path, data, corrections)
    box = clipped(path, found, radius, bbox)
    ids = itertools.count(10**15)  # above every OpenStreetMap id
    cut = cut_ways(path, found, box, ids)
    country = country_at(*box.centre)
    side = drive_side(cut, country)
    left_hand = side.side == "left"
    ways = tagged(cut, found, country.name, left_hand)
    progress("building lanes and junctions")
    net, forks = lanes_of(path, found, ways, box, ids, left_hand)
    progress("placing signals and scenery")
    lights = lights_of(found, ways, box, net)
    network = Network(
        name=name_of(path),
        attribution=ATTRIBUTION,
        origin=box.centre,
        bounds=box.bounds(),
        digest=digest,
        lanes=net.lanes,
        roads=of_ways(net.roads, net.origins, ways),
        connections=linked(net.connections, lights),
        junctions=net.junctions,
        signals=lights,
        scenery=scenery(found, box),
    )
    report = audit.report(network, found, ways, box, net.origins, turns=turn.count(net, forks), side=side, country=country.name)
    return replace(network, report=replace(report, seconds=time.perf_counter() - began))


def clipped(path: Path, found, radius: float | None, bbox: osm.Box | None):
    """The part of the map that is kept; raises MapError that names the file."""
    try:
        return osm.clip_box(found, radius=radius, bbox=bbox)
    except MapError as error:
        raise MapError(f"{path}: {error.message}") from None


def cut_ways(path: Path, found, box, ids) -> list:
    """The ways within that part; raises MapError when there is none."""
    ways = [piece for way in found.ways for piece in osm.cut(way, box, ids)]
    if not ways:
        raise MapError(
            f"{path}: there are no roads for cars within the part that is kept; try a larger radius or another bbox"
        )
    return ways


def tagged(ways: list, found, country: str, left_hand: bool) -> list:
    """The ways with limits, lane counts and widths that netconvert reads; what was guessed is noted in `found`."""
    from studio.road import cross_section, limit

    limited = [limit.limited(way, country, found.notes) for way in ways]
    return [cross_section.mended(way, found.notes, left_hand=left_hand) for way in limited]


def lanes_of(path: Path, found, ways: list, box, ids, left_hand: bool):
    """Lanes and junctions, their arrows mended, and the forks that have arrows."""
    from studio.road import bend, netconvert, turn

    clean = osm.clean_xml(found, bend.rounded(ways, box, ids))
    net = netconvert.convert(clean, box.projection, source=path, left_hand=left_hand)
    forks = turn.forks(net, ways, box, found.notes, left_hand=left_hand)
    return turn.mended(net, forks, left_hand=left_hand), forks


def lights_of(found, ways: list, box, net) -> Signals:
    """The signals of the network, those at the map's edge too."""
    mapped = list(osm.mapped_signals(found, ways, box).values())
    return signals(net.lanes, net.roads, net.connections, net.signalled | dead_ends(net.lanes, net.roads, net.connections, mapped))


def of_ways(roads: dict[str, Road], origins: dict[str, tuple[int, ...]], ways: list) -> dict[str, Road]:
    """The roads with the mapped ways that they are made of."""
    mapped = {way.id: way.mapped for way in ways}
    names = {road: dict.fromkeys(mapped[way] for way in origins.get(road, ()) if way in mapped) for road in roads}
    return {name: replace(road, ways=tuple(names[name])) for name, road in roads.items()}


def linked(connections: tuple[Connection, ...], lights: Signals) -> tuple[Connection, ...]:
    """The connections with the signal that each starts at."""
    link = {lane: number for number, lane in enumerate(lights.link_lane.tolist())}
    return tuple(replace(connection, link=link.get(connection.from_lane, -1)) for connection in connections)
