"""Reads an OpenStreetMap file: checks it, chooses the part to keep, cuts the car ways there.

The file is hostile until proven otherwise: it may be truncated, a bomb, or hold entities. Ways reach kilometres out of
the box that was asked for, so everything is cut at the box around the mapped core plus `REACH`.
"""

import gzip
import math
import tempfile
import threading
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import osmium
import pyproj

from studio.errors import MapError
from studio.road.formats import access, identity, overpass, shore
from studio.road.formats.correction import Corrections, Corrector, element_of
from studio.road.formats.identity import named
from studio.road.formats.kind import OPENINGS, area_kind, hidden, line_kind, point_kind
from studio.road.formats.turn_rule import is_rule, kind_of
from studio.road.formats.way import Way
from studio.road.network.report import Notes, Spot

GENERATOR = "Cooperative ADAS Studio"  # of maps that the studio has drawn itself
FORMATS = {".osm": "osm", ".osm.gz": "osm", ".osm.pbf": "pbf", ".json": "osm"}
LARGEST_FILE = 100 * 2**20  # [B] on disk
LARGEST = 512 * 2**20  # [B] unpacked, more than any city district; a bomb ends here
WIDEST = 25_000.0  # [m] side of the part that is kept: a large city
EARTH_RADIUS = 6_371_000.0  # [m]
REACH = 600.0  # [m] how far arms are kept beyond the mapped core
MOST_LANES = 16  # of one way; more is a slip of the mapper
CAR_WAYS = {
    *(
        "motorway",
        "motorway_link",
        "trunk",
        "trunk_link",
        "primary",
        "primary_link",
        "secondary",
        "secondary_link",
    ),
    *("tertiary", "tertiary_link", "unclassified", "residential", "living_street"),
}
SMALL_WAYS = {"service", "track", "road", "busway"}  # cars can drive there, but they are not built
ON_FOOT = {  # highway=… that is no way for cars
    *("footway", "path", "cycleway", "pedestrian", "steps", "bridleway", "elevator", "platform", "corridor", "via_ferrata", "ladder"),
    *("crossing", "sidewalk", "bus_stop", "street_lamp", "no", "razed", "abandoned", "disused", "traffic_island"),
}
OTHER_WAYS = {  # highway=… that cars use, and why it is not built
    "raceway": "race tracks are no public roads",
    "construction": "is not there yet",
    "proposed": "is not there yet",
    "planned": "is not there yet",
    "bus_guideway": "only guided buses can use it",
    "escape": "ramps for runaway trucks are not built",
    "emergency_bay": "emergency bays are not built",
    "emergency_access_point": "is no road",
    "services": "is an area",
    "rest_area": "is an area",
}
NO_PROGRAMME = {"blinker", "blink_mode", "blinking", "emergency", "level_crossing", "rail_crossing", "tram_priority", "no"}
ALONG = ("forward", "backward", "conditional")


@lru_cache(maxsize=64)
def projector(projection: str, thread: int) -> pyproj.Proj:
    """The projection, made once for each thread: making one takes longer than using it, and it must not be shared."""
    return pyproj.Proj(projection)


@dataclass(frozen=True)
class Box:
    """A box in degrees, with the projection to local metres whose origin is its centre."""

    south: float
    west: float
    north: float
    east: float

    @property
    def centre(self) -> tuple[float, float]:
        """Latitude and longitude of the middle [deg]."""
        return (self.south + self.north) / 2, (self.west + self.east) / 2

    @property
    def projection(self) -> str:
        """Transverse Mercator at the centre, scale 1: metres on the ground are metres here, up is north."""
        latitude, longitude = self.centre
        return f"+proj=tmerc +lat_0={latitude:.9f} +lon_0={longitude:.9f} +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m"

    def local(self, latitude, longitude) -> np.ndarray:
        """Positions in local metres, float64[2, n]."""
        return np.array(projector(self.projection, threading.get_ident())(longitude, latitude), dtype=float)

    def degrees(self, points: np.ndarray) -> list[tuple[float, float]]:
        """Longitude and latitude of local points [deg]."""
        longitude, latitude = projector(self.projection, threading.get_ident())(*points, inverse=True)
        return list(zip(np.atleast_1d(longitude).tolist(), np.atleast_1d(latitude).tolist(), strict=True))

    def bounds(self) -> tuple[float, float, float, float]:
        """The box in local metres: x0, y0, x1, y1."""
        (x0, x1), (y0, y1) = self.local([self.south, self.north], [self.west, self.east]).tolist()
        return x0, y0, x1, y1

    def grown(self, metres: float) -> "Box":
        """The box with a margin on every side [m]."""
        north = math.degrees(metres / EARTH_RADIUS)
        east = north / math.cos(math.radians(self.centre[0]))
        return Box(self.south - north, self.west - east, self.north + north, self.east + east)

    def around(self, metres: float) -> "Box":
        """The box about the same centre that reaches `metres` to every side."""
        latitude, longitude = self.centre
        return Box(latitude, longitude, latitude, longitude).grown(metres)


@dataclass(frozen=True)
class Shape:
    """An area or building as mapped: rings of (longitude, latitude) [deg], the outer one first, its tags, its name there."""

    rings: list[list[tuple[float, float]]]
    tags: dict[str, str]
    element: str = ""


@dataclass(frozen=True)
class Thing:
    """A line or a point as mapped: its positions (longitude, latitude) [deg], its kind here, and its tags."""

    points: list[tuple[float, float]]
    kind: str
    tags: dict[str, str]
    name: str  # such as "node 12"

    @property
    def spot(self) -> Spot:
        """Where to point at it."""
        return Spot(self.name, *self.points[0][::-1])


@dataclass
class Survey:
    """Everything of a file that the studio uses."""

    ways: list[Way] = field(default_factory=list)
    nodes: dict[int, dict[str, str]] = field(default_factory=dict)
    restrictions: list[tuple[int, list[tuple[str, int, str]], dict[str, str]]] = field(default_factory=list)
    shapes: list[Shape] = field(default_factory=list)
    outlines: dict[int, str] = field(default_factory=dict)  # relations that shall be an area, and its kind
    drawn: set[int] = field(default_factory=set)  # those of them that are one
    shores: dict[int, tuple[dict[str, str], list[int]]] = field(default_factory=dict)  # of water: its tags, and the ways of its outline
    service: list[Way] = field(default_factory=list)
    lines: list[Thing] = field(default_factory=list)
    points: list[Thing] = field(default_factory=list)
    places: list[tuple[float, float]] = field(default_factory=list)
    parking: list[tuple[str, tuple[float, float]]] = field(default_factory=list)
    small: Counter = field(default_factory=Counter)
    other: Counter = field(default_factory=Counter)  # ways of kinds that are not built at all
    barriers: Counter = field(default_factory=Counter)  # that are not drawn
    notes: Notes = field(default_factory=Notes)
    mapped: Box | None = None
    drawn_here: bool = False  # by the studio, so that nobody else has a right in it


# -- the file --------------------------------------------------------------------------------------


def file_format(path: Path) -> str:
    """The format that osmium is to read, from the file's ending."""
    for ending, name in FORMATS.items():
        if path.name.lower().endswith(ending):
            return name
    raise MapError(f"{path}: not a kind of map that can be read; allowed: {', '.join(FORMATS)}")


def read(path: Path) -> bytes:
    """The map as OSM XML or PBF, unpacked and checked.

    Raises:
        MapError: the file is missing, empty, truncated, too large, not XML, or holds entities.
    """
    form = file_format(path)
    try:
        data = unpack(path)
    except FileNotFoundError:
        raise MapError(f"{path}: there is no such map file") from None
    except (gzip.BadGzipFile, EOFError, zlib.error) as error:
        raise MapError(f"{path}: the compressed file is damaged ({error}); fetch it again") from None
    except OSError as error:
        raise MapError(f"{path}: the map file cannot be read ({error.strerror or error})") from None
    if path.name.lower().endswith(".json"):
        return overpass.as_xml(path, data)
    if form == "osm":
        check_xml(path, data)
        return uploaded(path, data)
    if not data:
        raise MapError(f"{path}: the map file is empty")
    return data


def head(path: Path) -> bytes:
    """The beginning of the file, unpacked."""
    opener = gzip.open if path.name.lower().endswith(".gz") else open
    with opener(path, "rb") as file:
        return file.read(512)


def unpack(path: Path) -> bytes:
    """The content of the file, no more of it than `LARGEST`."""
    if path.stat().st_size > LARGEST_FILE:
        raise MapError(f"{path}: the file is larger than {LARGEST_FILE // 2**20} MiB; cut out a smaller place")
    opener = gzip.open if path.name.lower().endswith(".gz") else open
    with opener(path, "rb") as file:
        data = file.read(LARGEST + 1)
    if len(data) > LARGEST:
        raise MapError(f"{path}: the map is larger than {LARGEST // 2**20} MiB; cut out a smaller place")
    return data


def check_xml(path: Path, data: bytes) -> None:
    """Refuses what is empty, no XML, or tries more than plain elements."""
    if not data.strip():
        raise MapError(f"{path}: the map file is empty")
    if not data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        raise MapError(f"{path}: this is not an OpenStreetMap XML file")
    if b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        raise MapError(f"{path}: XML with a document type or entities is refused; export the map again without them")


def uploaded(path: Path, data: bytes) -> bytes:
    """The same as if it had been uploaded; raises MapError that names the file."""
    try:
        return identity.uploaded(data)
    except MapError as error:
        raise MapError(f"{path}: the map cannot be read: {error.message}") from None


# -- the survey ------------------------------------------------------------------------------------


def survey(path: Path, data: bytes, *, parking_aisles: bool = False, corrections: Corrections = ()) -> Survey:
    """Goes once through the map and notes what is used of it, as corrected; parking aisles become ways for cars if asked for."""
    try:
        found = in_order(data, file_format(path), corrections)
        if found is None or not found.ways:
            found = surveyed(sorted_xml(data, file_format(path)), "osm", corrections)
    except (RuntimeError, ValueError, osmium.InvalidLocationError) as error:
        raise MapError(f"{path}: the map cannot be read: {error}") from None
    if parking_aisles:
        built = [way for each in aisles(found.service) if (way := access.directed(each, found.notes)) is not None]
        found.ways += built
        found.small["service"] -= len(built)
    if not found.ways:
        raise MapError(f"{path}: there are no roads for cars in this map{there(found)}")
    note_counts(found)
    return found


def aisles(service: list[Way]) -> list[Way]:
    """The parking aisles among service ways, and the driveways by which one comes to them, in the file's order."""
    chosen = {way.id for way in service if way.tags.get("service") == "parking_aisle"}
    driveways = [way for way in service if way.tags.get("service", "driveway") == "driveway"]
    reached = {node for way in service if way.id in chosen for node in way.nodes}
    while more := [way for way in driveways if way.id not in chosen and not reached.isdisjoint(way.nodes)]:
        chosen |= {way.id for way in more}
        reached |= {node for way in more for node in way.nodes}
    return [way for way in service if way.id in chosen]


def there(found: Survey) -> str:
    """What a map has instead of roads for cars, and what to do."""
    reasons = Counter(each.kind for each in found.notes.skipped)
    closed = ", ".join(dict.fromkeys(each.reason for each in found.notes.skipped if each.kind == "closed way"))
    has = [f"{count} ways with highway={kind}" for kind, count in sorted((found.small + found.other).items())]
    has += [f"{reasons['closed way']} closed to cars ({closed})"] if reasons["closed way"] else []
    has += [f"{reasons['missing nodes']} whose nodes are not in the file"] if reasons["missing nodes"] else []
    aisles_too = "; --parking-aisles builds the aisles of parking places with their driveways" if found.small["service"] else ""
    remedy = "; public roads are built, from motorway to living_street: correct highway or access of a way that is one"
    return f"; it has {', '.join(has)}{remedy}{aisles_too}" if has else ""


def note_counts(found: Survey) -> None:
    """Notes what is left out by kind, not one by one."""
    spot = Spot("the whole map", *found.places[0][::-1])
    for kind, count in sorted((+found.small).items()):
        found.notes.skip("small way", f"{count} ways with highway={kind}", spot, "only public roads are built")
    broken = Counter(kind for name, kind in found.outlines.items() if name not in found.drawn)
    for kind, count in sorted(broken.items()):
        found.notes.skip("outline", f"{count} {kind} relations", spot, "their outlines are not closed, or not whole in the file")
    for kind, count in sorted(found.barriers.items()):
        reason = "an opening" if kind in OPENINGS else "not drawn, or below the ground"
        found.notes.skip("barrier", f"{count} with barrier={kind}", spot, reason)


def in_order(data: bytes, form: str, corrections: Corrections) -> Survey | None:
    """The survey of a map whose elements are in order; None when they are not."""
    try:
        return surveyed(data, form, corrections)
    except RuntimeError as error:
        if "out of order" in str(error):
            return None
        raise


def surveyed(data: bytes, form: str, corrections: Corrections) -> Survey:
    """What is used of a map whose nodes come before its ways."""
    found = Survey()
    corrector = Corrector(corrections, found.notes)
    file = osmium.FileProcessor(osmium.io.FileBuffer(data, form))
    found.mapped = mapped_box(file.header.box())
    found.drawn_here = file.header.get("generator", "") == GENERATOR
    tagged = osmium.filter.EmptyTagFilter()
    for thing in file.with_locations().with_areas().with_filter(tagged):
        note(found, corrector.seen(thing))
    found.nodes |= corrector.bare_nodes(found.ways)
    close_shores(found, data, form)
    corrector.finish(found.places[0] if found.places else (0.0, 0.0))
    return found


def sorted_xml(data: bytes, form: str) -> bytes:
    """The map with nodes before ways before relations; some tools write ways first."""
    reader = osmium.MergeInputReader()
    reader.add_buffer(data, form)
    with tempfile.TemporaryDirectory(prefix="studio-map-") as folder:
        target = Path(folder, "sorted.osm")
        with osmium.SimpleWriter(str(target)) as writer:
            reader.apply(writer)
        return target.read_bytes()


def mapped_box(box) -> Box | None:
    """The box that the file's `<bounds>` names, if it has one."""
    if not box.valid():
        return None
    return Box(box.bottom_left.lat, box.bottom_left.lon, box.top_right.lat, box.top_right.lon)


def note(found: Survey, thing) -> None:
    """Notes what is used of a node, way, area or relation."""
    if thing.is_node():
        note_node(found, thing)
    elif thing.is_way():
        note_way(found, thing)
    elif thing.is_area():
        note_area(found, thing)
    elif thing.is_relation() and is_rule(thing.tags):
        members = [(member.type, member.ref, member.role) for member in thing.members]
        found.restrictions.append((thing.id, members, dict(thing.tags)))
    elif thing.is_relation() and thing.tags.get("type") == "multipolygon" and (kind := area_kind(thing.tags)):
        found.outlines[thing.id] = kind
        if kind == "water":
            found.shores[thing.id] = dict(thing.tags), [member.ref for member in thing.members if member.type == "w"]


def note_node(found: Survey, node) -> None:
    """Notes a tagged node: signals, trees, posts, crossings and parking."""
    if not node.location.valid():
        found.notes.skip(
            "node", named("node", node.id), Spot(named("node", node.id), 0.0, 0.0, named("node", node.id)), "lies outside the world"
        )
        return
    place = (node.lon, node.lat)
    found.places.append(place)
    note_parking(found, node.tags, place)
    found.nodes[node.id] = node_tags(found, node, place)
    if kind := point_kind(node.tags):
        found.points.append(Thing([place], kind, found.nodes[node.id], named("node", node.id)))
    elif barrier := node.tags.get("barrier"):
        note_barrier(found, barrier)


def node_tags(found: Survey, node, place: tuple[float, float]) -> dict[str, str]:
    """The tags of a node; lights that do not go through green, amber and red are none here, and told."""
    own = dict(node.tags)
    if own.get("highway") == "traffic_signals" and own.get("traffic_signals") in NO_PROGRAMME:
        name = named("node", node.id)
        what = f"traffic_signals={own['traffic_signals']}"
        found.notes.skip("signal", what, Spot(name, place[1], place[0], name), "has no programme of green, amber and red")
        del own["highway"]
    return own


def note_way(found: Survey, way) -> None:
    """Notes a way for cars; where the file lacks nodes it is interrupted."""
    nodes = list(way.nodes)
    known = [i for i, node in enumerate(nodes) if node.location.valid()]
    place = (nodes[known[0]].lon, nodes[known[0]].lat) if known else (0.0, 0.0)
    if known:
        found.places.append(place)
    if kind := line_kind(way.tags) if len(known) > 1 else "":
        line = [(nodes[i].lon, nodes[i].lat) for i in known]
        found.lines.append(Thing(line, kind, dict(way.tags), named("way", way.id)))
    elif barrier := way.tags.get("barrier"):
        note_barrier(found, barrier)
    highway, spot = way.tags.get("highway"), Spot(named("way", way.id), *place[::-1], named("way", way.id))
    if highway in SMALL_WAYS:
        found.small[highway] += 1
        if highway == "service" and len(known) > 1:
            found.service.append(way_of(way, nodes, known))
    elif highway not in CAR_WAYS:
        note_other(found, way.tags, spot)
    if highway in CAR_WAYS:
        note_car_way(found, way, nodes, known, spot)


def note_other(found: Survey, tags, spot: Spot) -> None:
    """Notes what cars use and is not built: ways of other kinds, ferries, and those whose kind nobody knows."""
    highway = tags.get("highway", "")
    if tags.get("route") in ("ferry", "shuttle_train") and not access.closed(tags):
        found.notes.skip("ferry", f"route={tags.get('route')}", spot, "ferries and car trains do not run")
    if not highway or highway in ON_FOOT:
        return
    found.other[highway if highway.isascii() else "other"] += 1
    found.notes.skip("other way", f"highway={highway[:40]}", spot, OTHER_WAYS.get(highway, "is no class of roads that is known"))


def note_car_way(found: Survey, way, nodes: list, known: list[int], spot: Spot) -> None:
    """Notes a way for cars, in the directions that are open to them."""
    if len(known) < len(nodes):
        lacking = f"{len(nodes) - len(known)} of {len(nodes)} nodes"
        found.notes.skip("missing nodes", lacking, spot, "they are not in the file, or lie outside the world")
    if len(known) > 1 and (driven := access.directed(way_of(way, nodes, known), found.notes)) is not None:
        found.ways.append(driven)


def way_of(way, nodes: list, known: list[int]) -> Way:
    """A way with those of its nodes that are known."""
    points = [(nodes[i].lon, nodes[i].lat) for i in known]
    gaps = frozenset(k for k, (i, j) in enumerate(pairwise(known)) if j > i + 1)
    return Way(way.id, [nodes[i].ref for i in known], points, dict(way.tags), gaps)


def note_barrier(found: Survey, barrier: str) -> None:
    """Counts a barrier that is not drawn."""
    found.barriers[barrier if barrier.isascii() else "other"] += 1


def note_parking(found: Survey, tags, place: tuple[float, float]) -> None:
    """Notes a parking area or a single space."""
    if tags.get("amenity") in ("parking", "parking_space"):
        found.parking.append((tags["amenity"], place))


def note_area(found: Survey, area) -> None:
    """Notes a building, green, water or parking."""
    if "amenity" in area.tags:
        first = next((node for ring in area.outer_rings() for node in ring), None)
        if first is not None:
            note_parking(found, area.tags, (first.lon, first.lat))
        if area.tags["amenity"] in ("parking", "parking_space") and (reason := hidden(area.tags)):
            spot = Spot(named("parking", area.orig_id()), first.lat, first.lon) if first is not None else Spot("parking", 0.0, 0.0)
            found.notes.skip("parking", area.tags.get("name", "") or "parking", spot, reason)
    if area_kind(area.tags):
        if not area.from_way():
            found.drawn.add(area.orig_id())
        for ring in area.outer_rings():
            rings = [ring, *area.inner_rings(ring)]
            found.shapes.append(Shape([[(n.lon, n.lat) for n in ring] for ring in rings], dict(area.tags), element_of(area)))


# -- water at the edge of the file -----------------------------------------------------------------


def close_shores(found: Survey, data: bytes, form: str) -> None:
    """Closes water that the file has in parts along the box that it was cut by, and notes which."""
    broken = {name: shore for name, shore in found.shores.items() if name not in found.drawn}
    if not broken or found.mapped is None:
        return
    lines = outlines(data, form, {way for _, ways in broken.values() for way in ways})
    box, dry = found.mapped, dry_places(found)
    for name, (tags, ways) in broken.items():
        here = [lines[way] for way in ways if way in lines]
        faces = shore.wet(here, (box.west, box.south, box.east, box.north), dry) if here else []
        if faces:
            found.drawn.add(name)
            note_closed(found, named("relation", name), tags, faces)


def note_closed(found: Survey, element: str, tags: dict[str, str], faces: list) -> None:
    """Notes the faces of water that was closed, and that this is a guess."""
    for face in faces:
        rings = [face.exterior, *face.interiors]
        found.shapes.append(Shape([list(ring.coords) for ring in rings], tags, element))
    longitude, latitude = faces[0].representative_point().coords[0]
    spot = Spot(tags.get("name", "") or element, latitude, longitude, element)
    found.notes.guess(
        "water", "closed along the edge of the file", spot, source="the part of its outline that is in the file", sure="medium"
    )


def outlines(data: bytes, form: str, wanted: set[int]) -> dict[int, list[tuple[float, float]]]:
    """The places of some ways [deg], as far as the file has them whole; most of them have no tag, so that nothing was noted of them."""
    file = osmium.FileProcessor(osmium.io.FileBuffer(data, form), osmium.osm.NODE | osmium.osm.WAY).with_locations()
    ways = (way for way in file if isinstance(way, osmium.osm.Way) and way.id in wanted)
    return {way.id: [(node.lon, node.lat) for node in way.nodes] for way in ways if all(node.location.valid() for node in way.nodes)}


def dry_places(found: Survey) -> np.ndarray:
    """Places on land [deg], float64[2, n]: corners of houses, and of streets that are no bridges."""
    houses = [shape.rings[0][0] for shape in found.shapes if area_kind(shape.tags) in ("building", "part")]
    streets = [point for way in found.ways if not {"bridge", "tunnel", "layer"} & way.tags.keys() for point in way.points]
    return np.array([*houses, *streets], dtype=float).reshape(-1, 2).T


# -- the part to keep ------------------------------------------------------------------------------


def clip_box(found: Survey, *, radius: float | None, bbox: Box | None = None) -> Box:
    """The box to keep: `bbox`, else the mapped core and `REACH`, or `radius` [m] about its centre.

    Without `<bounds>` the core is where 96 % of everything that has a tag lies: a few long ways do not move it.

    Raises:
        MapError: the box is larger than can be built.
    """
    if bbox is not None:
        return bbox
    core = found.mapped or core_box(found.places)
    return checked(core.grown(REACH) if radius is None else core.around(radius), "the mapped place")


def around_roads(found: Survey, radius: float) -> Box:
    """The box about the road point that lies nearest to the middle of all of them, `radius` [m] to every side."""
    points = np.array([point for way in found.ways for point in way.points])
    middle = np.median(points, axis=0)
    longitude, latitude = points[np.abs(points - middle).sum(axis=1).argmin()].tolist()
    return checked(Box(latitude, longitude, latitude, longitude).around(radius), "the middle of the roads")


def checked(box: Box, name: str) -> Box:
    """The box if it is not too large; `name` is what a message calls it.

    Raises:
        MapError: the box is larger than can be built.
    """
    height = math.radians(box.north - box.south) * EARTH_RADIUS
    width = math.radians(box.east - box.west) * EARTH_RADIUS * math.cos(math.radians(box.centre[0]))
    if max(width, height) > WIDEST:
        size = f"{width / 1000:.0f} km by {height / 1000:.0f} km"
        limit = f"{WIDEST / 1000:.0f} km a side"
        raise MapError(f"{name} is {size}, larger than the limit of {limit}; choose a smaller box")
    return box


def bounding_box(text: str) -> Box:
    """The box of "west,south,east,north" [deg].

    Raises:
        MapError: the text is no box, or one without area, outside the world or too large.
    """
    try:
        west, south, east, north = (float(part) for part in text.split(","))
    except ValueError:
        raise MapError(f"bbox {text!r}: must be west,south,east,north in degrees, such as 13.39,52.51,13.41,52.53") from None
    if not (-180.0 <= west <= 180.0 and -180.0 <= east <= 180.0 and -85.0 <= south <= 85.0 and -85.0 <= north <= 85.0):
        raise MapError(f"bbox {text!r}: outside the world; longitudes are -180 to 180, latitudes -85 to 85")
    if not (west < east and south < north):
        raise MapError(f"bbox {text!r}: has no area; west must be less than east, and south less than north")
    return checked(Box(south, west, north, east), f"bbox {text!r}")


def core_box(places: list[tuple[float, float]]) -> Box:
    """The box that holds nearly all places."""
    (west, south), (east, north) = np.percentile(np.array(places), [2, 98], axis=0)
    return Box(float(south), float(west), float(north), float(east))


def cut(way: Way, box: Box, new_id: Iterator[int]) -> list[Way]:
    """The pieces of a way inside the box; where it crosses the border, a new node ends it."""
    pieces, nodes, points = [], [], []
    for i in range(len(way.nodes) - 1):
        inside = None if i in way.gaps else visible(way.points[i], way.points[i + 1], box)
        if inside is None:
            if nodes:
                pieces.append((nodes, points))
                nodes, points = [], []
            continue
        first, last = inside
        if not nodes:
            nodes, points = [way.nodes[i] if first == 0.0 else next(new_id)], [between(way, i, first)]
        nodes.append(way.nodes[i + 1] if last == 1.0 else next(new_id))
        points.append(between(way, i, last))
        if last < 1.0:
            pieces.append((nodes, points))
            nodes, points = [], []
    if nodes:
        pieces.append((nodes, points))
    ids = [way.id, *(next(new_id) for _ in pieces[1:])]
    parts = [way.part_of, *(way.mapped for _ in pieces[1:])]
    return [Way(name, nodes, points, way.tags, part_of=part) for name, part, (nodes, points) in zip(ids, parts, pieces, strict=False)]


def visible(a: tuple[float, float], b: tuple[float, float], box: Box) -> tuple[float, float] | None:
    """The share of the segment a to b that lies in the box, as two fractions (Liang and Barsky 1984)."""
    first, last = 0.0, 1.0
    limits = ((box.west, box.east), (box.south, box.north))
    for start, end, (low, high) in zip(a, b, limits, strict=True):
        for distance, room in ((start - end, start - low), (end - start, high - start)):
            if distance == 0.0:
                if room < 0.0:
                    return None
            elif distance < 0.0:
                first = max(first, room / distance)
            else:
                last = min(last, room / distance)
    return (first, last) if first < last else None


def between(way: Way, i: int, fraction: float) -> tuple[float, float]:
    """The point a fraction along the segment that starts at node i."""
    if fraction in (0.0, 1.0):
        return way.points[i + int(fraction)]
    (lon_a, lat_a), (lon_b, lat_b) = way.points[i], way.points[i + 1]
    return lon_a + fraction * (lon_b - lon_a), lat_a + fraction * (lat_b - lat_a)


def mapped_signals(found: Survey, ways: list[Way], box: Box) -> dict[int, np.ndarray]:
    """Positions of the signals on car roads in the part that is kept [m]."""
    nodes = {node: point for way in ways for node, point in zip(way.nodes, way.points, strict=True)}
    signals = {n: p for n, p in nodes.items() if found.nodes.get(n, {}).get("highway") == "traffic_signals"}
    return {n: box.local(latitude, longitude) for n, (longitude, latitude) in signals.items()}


# -- the clean file for netconvert -----------------------------------------------------------------


def clean_xml(found: Survey, ways: list[Way]) -> str:
    """OSM XML with nothing but these car ways, their nodes and the turn restrictions among them."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<osm version="0.6">']
    places = {node: point for way in ways for node, point in zip(way.nodes, way.points, strict=True)}
    for node, (longitude, latitude) in places.items():
        lines += element("node", {"id": node, "lat": f"{latitude:.9f}", "lon": f"{longitude:.9f}", "version": 1},
                         tags(found.nodes.get(node, {})))  # fmt: skip
    for way in ways:
        content = [f'<nd ref="{node}"/>' for node in way.nodes] + tags(way_tags(way))
        lines += element("way", {"id": way.id, "version": 1}, content)
    kept = {"w": {way.id for way in ways}, "n": set(places), "r": set()}
    for name, members, text in found.restrictions:
        if (kind := kind_of(text)) and all(ref in kept[form] for form, ref, _ in members):
            rule = {"type": "restriction", "restriction": kind}
            lines += element("relation", {"id": name, "version": 1}, [*map(member, members), *tags(rule)])
    return "\n".join([*lines, "</osm>"])


def element(name: str, attributes: dict, content: list[str]) -> list[str]:
    """The lines of an XML element."""
    text = " ".join(f'{key}="{value}"' for key, value in attributes.items())
    return [f"<{name} {text}>", *content, f"</{name}>"]


def tags(of: dict[str, str]) -> list[str]:
    """`<tag>` elements."""
    return [f"<tag k={quoteattr(key)} v={quoteattr(value)}/>" for key, value in of.items()]


def member(of: tuple[str, int, str]) -> str:
    """A `<member>` element of a turn restriction."""
    kind, ref, role = of
    return f'<member type="{ {"n": "node", "w": "way"}[kind] }" ref="{ref}" role={quoteattr(role)}/>'


def way_tags(way: Way) -> dict[str, str]:
    """The tags of a way as netconvert shall read them: without absurd lanes, and without access, which is decided."""
    kept = {key: value for key, value in way.tags.items() if not is_decided(key)}
    return {key: value for key, value in kept.items() if not (key.startswith("lanes") and is_absurd(value))}


def is_decided(key: str) -> bool:
    """Whether a key says who may drive on a way, in which direction, or when; with ":lanes" it says on which lane."""
    mode, *rest = key.split(":")
    return mode in access.KEYS and all(part in ALONG for part in rest)


def is_absurd(lanes: str) -> bool:
    """Whether a number of lanes cannot be meant."""
    return lanes.isdigit() and not 0 < int(lanes) <= MOST_LANES
