"""Lanes and junctions from car ways: netconvert (Eclipse SUMO) as a separate program, and its answer as our arrays.

netconvert is good at lanes and junction areas and weak at signals: it is told where they stand, and `signals` makes the
programmes.
"""

import subprocess
import tempfile
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree
from xml.sax.saxutils import unescape

import numpy as np
import sumo

from studio.errors import MapError
from studio.road.network import Connection, Lane, Net, Pair, Road, curve

NETCONVERT = Path(sumo.SUMO_HOME) / "bin" / "netconvert"
PATIENCE = 120.0  # [s] after which an import is given up
DEFAULT_LANE_WIDTH = 3.2  # [m] netconvert's own
# netconvert's own kinds of ways, and service ways for cars too; which of them are built is decided before
KINDS = Path(sumo.SUMO_HOME) / "data" / "typemap" / "osmNetconvert.typ.xml"
SERVICE = '<types><type id="highway.service" numLanes="1" speed="2.78" priority="1" oneway="false" allow="passenger delivery"/></types>'
OPTIONS = (
    *("--geometry.remove", "true", "--roundabouts.guess", "true", "--ramps.guess", "true"),
    *("--junctions.join", "true", "--junctions.corner-detail", "5", "--junctions.internal-link-detail", "12"),
    # the speed through a junction follows from the path's curvature, not from netconvert's guess
    *("--junctions.limit-turn-speed", "-1", "--no-turnarounds.except-deadend", "true"),
    *("--osm.turn-lanes", "true", "--osm.lane-access", "true", "--keep-edges.by-vclass", "passenger"),
    *("--output.street-names", "true", "--output.original-names", "true", "--tls.default-type", "static"),
    *("--offset.disable-normalization", "true", "--xml-validation", "never", "--precision", "3"),
)
DIRECTIONS = {
    "s": "straight",
    "l": "left",
    "r": "right",
    "L": "slight_left",
    "R": "slight_right",
    "t": "turn",
    "T": "turn",
}


def convert(xml: str, projection: str, *, source: Path, left_hand: bool = False) -> Net:
    """Runs netconvert on clean OSM XML and reads its network; `source` is the map that messages name.

    Raises:
        MapError: netconvert refuses the map, or finds no roads in it.
    """
    with tempfile.TemporaryDirectory(prefix="studio-map-") as folder:
        clean, target = Path(folder, "map.osm.xml"), Path(folder, "map.net.xml")
        clean.write_text(xml, encoding="utf-8")
        try:
            run(clean, target, projection, left_hand=left_hand)
        except MapError as error:
            raise MapError(f"{source}: {error.message}") from None
        return parse(ElementTree.parse(target).getroot())


def run(source: Path, target: Path, projection: str, *, left_hand: bool) -> None:
    """Lets netconvert turn the file `source` into the network file `target`."""
    command = [str(NETCONVERT), "--osm-files", str(source), "-o", str(target), "--proj", projection, *OPTIONS]
    command += ["--lefthand", "true"] if left_hand else []
    service = source.with_name("service.typ.xml")
    service.write_text(SERVICE, encoding="utf-8")
    command += ["--type-files", f"{KINDS},{service}"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        raise MapError(f"the map took longer than {PATIENCE:.0f} s to import; cut out a smaller place") from None
    if done.returncode or not target.exists():
        reason = next((line for line in done.stderr.splitlines() if line.startswith("Error")), "no reason given")
        raise MapError(f"the roads of the map cannot be built: {reason}")


def parse(root: ElementTree.Element) -> Net:
    """The network of a .net.xml document."""
    lanes, roads = [], {}
    for edge in root.iter("edge"):
        read_edge(edge, lanes, roads)
    named = {(lane.road, lane.index): lane.id for lane in lanes}
    steps = [Step.read(element, named, roads) for element in root.iter("connection")]
    signalled = frozenset(step.start for step in steps if step.signalled)
    junctions = tuple(shape(element.attrib["shape"]) for element in root.iter("junction") if is_surface(element))
    made = connections(steps, lanes)
    equal = frozenset(junction.attrib["id"] for junction in root.iter("junction") if junction.get("type") == "right_before_left")
    rings = frozenset(road for ring in root.iter("roundabout") for road in ring.get("edges", "").split())
    return Net(tuple(lanes), roads, made, junctions, signalled, origins(root), yields(root, named, made, lanes), equal, rings)


def yields(root: ElementTree.Element, named: dict, made: tuple[Connection, ...], lanes: list[Lane]) -> dict[Pair, frozenset[Pair]]:
    """For the way from a road to another those that go first: netconvert numbers a junction's ways and tells of each to
    which others it responds, in a word of bits whose last one is for way 0."""
    over = {via: (lanes[c.from_lane].road, lanes[c.to_lane].road) for c in made for via in c.via}
    found = defaultdict(frozenset)
    for junction in root.iter("junction"):
        pairs = [over.get(named.get(tuple_of(lane), -1)) for lane in (junction.get("intLanes") or "").split()]
        for request in junction.iter("request"):
            own = pairs[int(request.attrib["index"])]
            first = {pair for pair, bit in zip(pairs, reversed(request.attrib["response"]), strict=False) if bit == "1" and pair}
            if own is not None:
                found[own] |= first - {own}
    return dict(found)


def origins(root: ElementTree.Element) -> dict[str, tuple[int, ...]]:
    """The ids of the ways that each road is made of, in their order along it."""
    found = {}
    for edge in root.iter("edge"):
        names = [param.get("value", "") for param in edge.iter("param") if param.get("key") == "origId"]
        found[edge.attrib["id"]] = tuple(dict.fromkeys(int(name) for text in names for name in text.split()))
    return found


def read_edge(edge: ElementTree.Element, lanes: list[Lane], roads: dict[str, Road]) -> None:
    """Adds a road and its lanes; crossings and footways are left out."""
    if edge.get("function") not in (None, "normal", "internal"):
        return
    internal = edge.get("function") == "internal"
    name, first = edge.attrib["id"], len(lanes)
    for element in edge.iter("lane"):
        lanes.append(read_lane(element, len(lanes), name, internal=internal))
    own = lanes[first:]
    roads[name] = Road(
        id=name,
        name=unescape(edge.get("name", ""), {"&quot;": '"', "&apos;": "'"}),  # netconvert escapes names twice
        lanes=tuple(lane.id for lane in own),
        from_junction=edge.get("from", ""),
        to_junction=edge.get("to", ""),
        speed=max(lane.speed for lane in own),
        length=sum(lane.length for lane in own) / len(own),
        internal=internal,
        kind=edge.get("type", "").split("|")[0].removeprefix("highway."),
    )


def read_lane(element: ElementTree.Element, number: int, road: str, *, internal: bool) -> Lane:
    """The lane of one `<lane>`."""
    centre = shape(element.attrib["shape"])
    return Lane(
        id=number,
        road=road,
        index=int(element.attrib["index"]),
        width=float(element.get("width", DEFAULT_LANE_WIDTH)),
        speed=float(element.attrib["speed"]),
        centre=centre,
        internal=internal,
        length=curve.length(centre),
        open=is_open(element),
    )


def is_open(lane: ElementTree.Element) -> bool:
    """Whether cars may use a lane; `allow` and `disallow` name classes of vehicles."""
    allowed = lane.get("allow")
    if allowed is not None:
        return bool({"passenger", "all"} & set(allowed.split()))
    return not {"passenger", "all"} & set(lane.get("disallow", "").split())


def shape(text: str) -> np.ndarray:
    """Points of a netconvert shape, float64[2, n], without doubled points; height is left out."""
    points = np.array([[float(number) for number in point.split(",")[:2]] for point in text.split()]).T
    keep = np.ones(points.shape[1], dtype=bool)
    keep[1:] = np.hypot(*np.diff(points)) > 1e-6
    return points[:, keep] if keep.sum() > 1 else points


def is_surface(junction: ElementTree.Element) -> bool:
    """Whether a junction covers ground."""
    return len((junction.get("shape") or "").split()) > 2


@dataclass(frozen=True)
class Step:
    """One line of netconvert's connection table: from a lane to a lane, first over the internal lane `via`."""

    start: int
    end: int
    via: int
    signalled: bool
    direction: str

    @classmethod
    def read(cls, element: ElementTree.Element, named: dict, roads: dict[str, Road]) -> "Step":
        """The step that one `<connection>` tells of."""
        via = element.get("via")
        return cls(
            start=named[element.attrib["from"], int(element.attrib["fromLane"])],
            end=named[element.attrib["to"], int(element.attrib["toLane"])],
            via=-1 if via is None else named[tuple_of(via)],
            signalled=element.get("tl") is not None,
            direction=DIRECTIONS.get(element.get("dir", ""), "straight"),
        )


def tuple_of(lane: str) -> tuple[str, int]:
    """Road and index from a lane's name."""
    road, _, index = lane.rpartition("_")
    return road, int(index)


def connections(steps: list[Step], lanes: list[Lane]) -> tuple[Connection, ...]:
    """One connection for every way from a road's lane to the next road's lane; `link` is filled in by the signals."""
    onward = {step.start: step for step in steps if lanes[step.start].internal}
    return tuple(
        Connection(step.start, step.end, chain(step, onward), -1, step.direction) for step in steps if not lanes[step.start].internal
    )


def chain(step: Step, onward: dict[int, Step]) -> tuple[int, ...]:
    """The internal lanes of a connection in order; netconvert cuts them where a waiting car stops."""
    via, here = [], step
    while here is not None and here.via >= 0:
        via.append(here.via)
        here = onward.get(here.via)
    return tuple(via)
