"""From a map file to a Network, kept on disk: the second time it is only read back."""

import hashlib
import itertools
import os
import pickle
import tempfile
from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

from studio.compiled import cache_root
from studio.errors import MapError
from studio.road import bend, netconvert, osm
from studio.road.network import ATTRIBUTION, Connection, Network
from studio.road.scenery import scenery
from studio.road.signals import Signals, signals

IMPORTER = (
    "bend.py",
    "curve.py",
    "netconvert.py",
    "network.py",
    "osm.py",
    "place.py",
    "scenery.py",
    "signals.py",
)
SHORTEST_RADIUS = 50.0  # [m]


def load(
    path: str | os.PathLike,
    *,
    radius: float | None = None,
    progress: Callable[[str], None] = lambda text: None,
) -> Network:
    """The roads and the scenery of a map file (.osm, .osm.gz, .osm.pbf).

    Args:
        path: the map file.
        radius: how far the map reaches to each side of its centre [m]; left out, the mapped place and its arms.
        progress: is told what is being done.

    Raises:
        MapError: the file is missing, damaged, of an unknown kind, or holds no roads.
    """
    path = Path(path)
    if radius is not None and not radius >= SHORTEST_RADIUS:
        raise MapError(f"{path}: radius must be at least {SHORTEST_RADIUS:g} m (got {radius!r})")
    data = osm.read(path)
    digest = digest_of(data, radius)
    kept = recall(digest)
    if kept is None:
        kept = imported(path, data, digest, radius=radius, progress=progress)
        keep(kept)
    return replace(kept, name=name_of(path))


def name_of(path: Path) -> str:
    """The map's name: its file without endings."""
    return path.name.split(".osm")[0]


def digest_of(data: bytes, radius: float | None) -> str:
    """Digest of the map's content, the options and everything that turns them into a Network."""
    digest = hashlib.sha256(f"{radius!r} {version('eclipse-sumo')} {version('osmium')}".encode())
    for name in IMPORTER:
        digest.update(Path(__file__).with_name(name).read_bytes())
    digest.update(data)
    return digest.hexdigest()


def imported(path: Path, data: bytes, digest: str, *, radius: float | None, progress) -> Network:
    """The network, made anew."""
    progress(f"reading {path.name}")
    found = osm.survey(path, data)
    box = osm.clip_box(found, radius=radius)
    ids = itertools.count(10**15)  # above every OpenStreetMap id
    ways = [piece for way in found.ways for piece in osm.cut(way, box, ids)]
    if not ways:
        raise MapError(
            f"{path}: there are no roads for cars within the part that is kept; try a larger radius"
        )
    progress("building lanes and junctions")
    net = netconvert.convert(osm.clean_xml(found, bend.rounded(ways, box, ids)), box.projection, source=path)
    progress("placing signals and scenery")
    lights = signals(net.lanes, net.roads, net.connections, net.signalled)
    return Network(
        name=name_of(path),
        attribution=ATTRIBUTION,
        origin=box.centre,
        bounds=box.bounds(),
        digest=digest,
        lanes=net.lanes,
        roads=net.roads,
        connections=linked(net.connections, lights),
        junctions=net.junctions,
        signals=lights,
        scenery=scenery(found, box),
    )


def linked(connections: tuple[Connection, ...], lights: Signals) -> tuple[Connection, ...]:
    """The connections with the signal that each starts at."""
    link = {lane: number for number, lane in enumerate(lights.link_lane.tolist())}
    return tuple(replace(connection, link=link.get(connection.from_lane, -1)) for connection in connections)


# -- kept on disk ----------------------------------------------------------------------------------


def kept_at(digest: str) -> Path:
    """The file that keeps the network of this digest."""
    return cache_root() / "maps" / f"{digest}.pickle"


def recall(digest: str) -> Network | None:
    """What was kept for this digest; anything unreadable counts as nothing and is made again."""
    try:
        with kept_at(digest).open("rb") as file:
            checksum, body = file.read(32), file.read()
        network = pickle.loads(body) if hashlib.sha256(body).digest() == checksum else None
    except Exception:  # a damaged pickle can raise anything
        return None
    return network if isinstance(network, Network) and network.digest == digest else None


def keep(network: Network) -> None:
    """Writes beside and renames, so that nobody reads a half-written file; a full disk only costs the next import."""
    body = pickle.dumps(network, protocol=pickle.HIGHEST_PROTOCOL)
    target = kept_at(network.digest)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, beside = tempfile.mkstemp(dir=target.parent)
    except OSError:
        return
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(hashlib.sha256(body).digest() + body)
        os.replace(beside, target)
    except OSError:
        Path(beside).unlink(missing_ok=True)
