"""Reads an OpenDRIVE document (ASAM OpenDRIVE 1.4 to 1.8): what of it makes a network, checked element by element.

The file is hostile until proven otherwise. What cannot be used is refused, with the element and the reason, where the network
would be wrong without it; else it becomes a remark.

    s       station along a road's reference line [m]
    lanes   are numbered from the middle: 1, 2, … to the left of the reference line, -1, -2, … to its right
"""

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.etree.ElementTree import Element

import numpy as np

from studio.errors import MapError
from studio.road.formats.limit import FASTEST, MILE, NO_LIMIT
from studio.road.formats.plain_xml import parse
from studio.road.formats.reference_line import NOTHING, Bend, Cubic, Profile, ReferenceLine

DRIVABLE = {
    *("driving", "entry", "exit", "onRamp", "offRamp", "connectingRamp", "slipLane", "bidirectional"),
    *("mwyEntry", "mwyExit"),  # as they were called before 1.4
}
KEPT_FOR_OTHERS = {"bus", "taxi", "HOV"}
UNITS = {"m/s": 1.0, "km/h": 1.0 / 3.6, "mph": MILE / 3.6}  # [m/s]
CAR_LIGHTS = {"1000001", "1000008", "1000009", "1000010", "1000011", "1000012"}  # three lamps, two, arrows
OTHER_LIGHTS = {"1000002", "1000003", "1000007", "1000013", "1000014", "1000015"}  # for people on foot and on bicycles, trams
LONGEST_ROAD = 100_000.0  # [m]
LONGEST_GAP = 1.0  # [m] between the elements of a reference line
LARGEST = 1e9  # of any number
WIDEST_LANE = 100.0  # [m] above this a width is a slip
MOST_LANES = 64  # of one section


@dataclass(frozen=True)
class Remark:
    """Something that is not used, where on which road, and why."""

    kind: str
    what: str
    road: str
    s: float  # [m]
    reason: str


@dataclass(frozen=True)
class Strip:
    """A lane of a section: `width` [m] in the distance from the section's start; links name lanes before and after it."""

    id: int
    type: str
    width: Profile
    before: tuple[int, ...]
    after: tuple[int, ...]
    speeds: tuple[tuple[float, float], ...]  # distance [m] from the section's start, limit [m/s]; not a number: none
    open: bool = True  # to cars


@dataclass(frozen=True)
class Section:
    """Lanes from station s [m] on; `strips` by their number."""

    s: float
    strips: dict[int, Strip]


@dataclass(frozen=True)
class Link:
    """What a road is joined to at one of its ends: a road, there "start" or "end", or a junction."""

    kind: str
    id: str
    contact: str = ""


@dataclass(frozen=True)
class Light:
    """A traffic light at station s [m] for the lanes of one direction: "+" along the reference line, "-" against it, "none" both."""

    id: str
    s: float
    orientation: str
    lanes: tuple[tuple[int, int], ...]  # from, to; none: all


@dataclass(frozen=True)
class XRoad:
    """A road of the document. `kinds` are (s [m], type, country, limit [m/s] or not a number)."""

    id: str
    name: str
    junction: str
    left_hand: bool
    line: ReferenceLine
    length: float
    before: Link | None
    after: Link | None
    kinds: tuple[tuple[float, str, str, float], ...]
    elevation: Profile
    offset: Profile
    sections: tuple[Section, ...]
    lights: tuple[Light, ...]


@dataclass(frozen=True)
class Join:
    """One `<connection>` of a junction: lanes of an incoming road go on over a connecting road from its `contact`."""

    incoming: str
    connecting: str
    contact: str
    lanes: tuple[tuple[int, int], ...]  # none: as the connecting road's own links say


@dataclass(frozen=True)
class Header:
    """Who made the document, under which licence, and how its plane lies on the earth ("" where it does not say)."""

    name: str
    vendor: str
    licence: str
    projection: str
    shift: tuple[float, float] = (0.0, 0.0)  # [m] that are to be added before the projection holds


@dataclass
class Document:
    """What of the file is used."""

    header: Header
    roads: dict[str, XRoad] = field(default_factory=dict)
    junctions: dict[str, tuple[Join, ...]] = field(default_factory=dict)
    remarks: list[Remark] = field(default_factory=list)
    light_ids: frozenset[str] = frozenset()  # of the signals that are traffic lights for cars

    def remark(self, kind: str, what: str, road: str, s: float, reason: str) -> None:
        """Notes what is not used."""
        self.remarks.append(Remark(kind, what, road, s, reason))


# -- XML -------------------------------------------------------------------------------------------


def read_header(data: bytes) -> Header:
    """The header alone, quickly: what comes after it is not looked at; empty where there is none."""
    end = data.find(b"</header>")
    head = data[: end + 9] if end >= 0 else data[: data.find(b"/>", data.find(b"<header")) + 2]
    try:
        return header_of(parse(head + b"</OpenDRIVE>", "map file"))
    except (MapError, ValueError):
        return Header("", "", "", "")


def document(data: bytes) -> Document:
    """The document of an OpenDRIVE file.

    Raises:
        MapError: this is no OpenDRIVE, it has no roads, or an element of it is not as it should be.
    """
    root = parse(data, "map file")
    if root.tag != "OpenDRIVE":
        raise MapError(f"this is not OpenDRIVE: its root element is <{root.tag}>, not <OpenDRIVE>")
    head = root.find("header")
    version = "1" if head is None else head.get("revMajor", "1")
    if version != "1":
        raise MapError(f"<header>: revMajor {version!r} cannot be read; allowed: 1")
    lights = frozenset(each.get("id") or "" for each in root.iter("signal") if is_car_light(each))
    found = Document(header_of(root), light_ids=lights)
    for element in root.iter("road"):
        road = read_road(element, found)
        if road.id in found.roads:
            raise MapError(f"road {road.id}: <road> stands twice with this id")
        found.roads[road.id] = road
    if not found.roads:
        raise MapError("there are no roads in this map; <OpenDRIVE> has no <road>")
    for element in root.iter("junction"):
        read_junction(element, found)
    return found


def header_of(root: Element) -> Header:
    """Who made the map, and its place on the earth."""
    head = root.find("header")
    if head is None:
        return Header("", "", "", "")
    licence, offset = head.find("license"), head.find("offset")
    named = "" if licence is None else licence.get("name") or licence.get("spdxid") or licence.get("resource") or ""
    shift = (0.0, 0.0) if offset is None else (number(offset, "x", "<header>", 0.0), number(offset, "y", "<header>", 0.0))
    text = head.findtext("geoReference") or ""
    return Header(head.get("name", "").strip(), head.get("vendor", "").strip(), named.strip(), text.strip(), shift)


def number(element: Element, name: str, where: str, default: float | None = None) -> float:
    """A finite number in an attribute."""
    text = element.get(name)
    if text is None and default is not None:
        return default
    try:
        value = math.nan if text is None else float(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= LARGEST:
        what = "is missing" if text is None else f"is no number that a road has (got {text[:40]!r})"
        raise MapError(f"{where}: {name} of <{element.tag}> {what}")
    return value


def whole(element: Element, name: str, where: str) -> int:
    """A whole number in an attribute."""
    value = number(element, name, where)
    if value != int(value):
        raise MapError(f"{where}: {name} of <{element.tag}> is not a whole number (got {element.get(name)!r})")
    return int(value)


# -- roads -----------------------------------------------------------------------------------------


def read_road(element: Element, found: Document) -> XRoad:
    """One `<road>`."""
    name = element.get("id")
    if not name:
        raise MapError("<road>: it has no id")
    where = f"road {name}"
    rule = element.get("rule") or "RHT"
    if rule not in ("RHT", "LHT"):
        raise MapError(f"{where}: rule of <road> is unknown (got {rule!r}); allowed: RHT, LHT")
    line = read_line(element, where)
    length = number(element, "length", where)
    if not 0.0 < length <= LONGEST_ROAD:
        raise MapError(f"{where}: length of <road> is {length:g} m; allowed: above 0, up to {LONGEST_ROAD:g} m")
    note_gaps(line, length, name, found)
    length = min(length, line.length)
    note_unused(element, name, found)
    sections = tuple(read_sections(element, length, name, found))
    if not sections:
        raise MapError(f"{where}: its first <laneSection> begins behind its end")
    return XRoad(
        id=name,
        name=element.get("name") or "",
        junction=element.get("junction") or "-1",
        left_hand=rule == "LHT",
        line=line,
        length=length,
        before=read_link(element.find("link/predecessor"), where),
        after=read_link(element.find("link/successor"), where),
        kinds=tuple(read_kind(each, name, found) for each in element.findall("type")),
        elevation=profile(element.findall("elevationProfile/elevation"), where),
        offset=profile(element.findall("lanes/laneOffset"), where),
        sections=sections,
        lights=tuple(read_lights(element, length, name, found)),
    )


def read_line(element: Element, where: str) -> ReferenceLine:
    """The plan view of a road."""
    elements = [read_geometry(each, where) for each in element.findall("planView/geometry")]
    if not elements:
        raise MapError(f"{where}: <planView> has no <geometry>")
    return ReferenceLine(tuple(sorted(elements, key=lambda each: each.s)))


def read_geometry(element: Element, where: str) -> Bend | Cubic:
    """One element of a plan view."""
    s, x, y, heading, length = (number(element, name, where) for name in ("s", "x", "y", "hdg", "length"))
    at = (s, x, y, heading, length)
    where = f"{where}, <geometry> at s = {s:g}"
    if not 0.0 < length <= LONGEST_ROAD:
        raise MapError(f"{where}: length is {length:g} m; allowed: above 0, up to {LONGEST_ROAD:g} m")
    shapes = [each for each in element if each.tag != "userData"]
    shape = shapes[0] if shapes else Element("none")
    if shape.tag == "line":
        return Bend(*at, 0.0, 0.0)
    if shape.tag == "arc":
        bent = turning(number(shape, "curvature", where), length, where)
        return Bend(*at, bent, bent)
    if shape.tag == "spiral":
        start, end = (turning(number(shape, name, where), length, where) for name in ("curvStart", "curvEnd"))
        return Bend(*at, start, end)
    if shape.tag == "poly3":
        return Cubic(*at, (0.0, 1.0, 0.0, 0.0), coefficients(shape, "abcd", where), by_arc=True)
    if shape.tag == "paramPoly3":
        u, v = (coefficients(shape, [f"{letter}{axis}" for letter in "abcd"], where) for axis in "UV")
        if not any(u[1:]) and not any(v[1:]):
            raise MapError(f"{where}: <paramPoly3> is a point")
        return Cubic(*at, u, v, rate=1.0 if shape.get("pRange") == "arcLength" else 1.0 / length)
    raise MapError(f"{where}: <{shape.tag}> is no known geometry; allowed: line, arc, spiral, poly3, paramPoly3")


def turning(curvature: float, length: float, where: str) -> float:
    """A curvature [1/m] that does not turn round and round."""
    if abs(curvature) > 10.0 or abs(curvature) * length > 100.0:
        raise MapError(f"{where}: curvature is {curvature:g} 1/m over {length:g} m, which no road has")
    return curvature


def coefficients(element: Element, names, where: str) -> tuple[float, float, float, float]:
    """Four coefficients of a cubic."""
    a, b, c, d = (number(element, name, where) for name in names)
    return a, b, c, d


def note_gaps(line: ReferenceLine, length: float, road: str, found: Document) -> None:
    """Refuses a reference line in pieces, and notes one that does not join well."""
    for s, gap, turn in line.gaps():
        if gap > LONGEST_GAP:
            raise MapError(f"road {road}: <geometry> at s = {s:g} begins {gap:.3g} m beside the end of the one before it")
        if gap > 0.05 or turn > math.radians(2.0):
            what = f"{gap:.2f} m and {math.degrees(turn):.1f}° between two elements"
            found.remark("reference line", what, road, s, "is built as it is")
    if abs(line.length - length) > 0.1:
        what = f"its length is {length:g} m, its geometry {line.length:g} m long"
        found.remark("length", what, road, 0.0, "the shorter one counts")


def profile(elements: list[Element], where: str, *, at: str = "s") -> Profile:
    """A piecewise cubic."""
    rows = sorted((number(each, at, where), *coefficients(each, "abcd", where)) for each in elements)
    if not rows:
        return NOTHING
    table = np.array(rows).T
    return Profile(table[0].copy(), table[1:].copy())


def read_link(element: Element | None, where: str) -> Link | None:
    """What a road is joined to."""
    if element is None:
        return None
    kind, contact = element.get("elementType") or "road", element.get("contactPoint") or ""
    if kind not in ("road", "junction") or (kind == "road" and contact not in ("start", "end")):
        raise MapError(f"{where}: <{element.tag}> names no road with contactPoint start or end, and no junction")
    return Link(kind, element.get("elementId") or "", contact)


def read_kind(element: Element, road: str, found: Document) -> tuple[float, str, str, float]:
    """A `<type>`: from where, what kind of road, in which country, which limit [m/s]."""
    where, speed = f"road {road}", element.find("speed")
    limit = math.nan if speed is None else read_speed(speed, where)
    return number(element, "s", where), element.get("type") or "unknown", element.get("country") or "", limit


def read_speed(element: Element, where: str) -> float:
    """A limit [m/s]; not a number where none is named."""
    text, unit = element.get("max") or "undefined", element.get("unit") or "m/s"
    if text == "no limit":
        return NO_LIMIT / 3.6
    if text == "undefined":
        return math.nan
    if unit not in UNITS:
        raise MapError(f"{where}: unit of <speed> is unknown (got {unit!r}); allowed: {', '.join(UNITS)}")
    value = number(element, "max", where) * UNITS[unit]
    if not 0.0 <= value <= FASTEST / 3.6:
        raise MapError(f"{where}: max of <speed> is {text} {unit}; allowed: 0 to {FASTEST:g} km/h")
    return value or math.nan


def note_unused(element: Element, road: str, found: Document) -> None:
    """Notes objects, cross slopes and surfaces, which are not built."""
    where = f"road {road}"
    for each in element.findall("objects/object"):
        what = " ".join(filter(None, ["object", each.get("id"), each.get("type") or each.get("name")]))
        found.remark("object", what, road, number(each, "s", where, 0.0), "objects beside the road are not built")
    for name in ("tunnel", "bridge", "objectReference"):
        for each in element.findall(f"objects/{name}"):
            found.remark(name, f"{name} {each.get('id')}", road, number(each, "s", where, 0.0), "objects are not built")
    for name in ("superelevation", "crossfall", "shape"):
        steep = [each for each in element.findall(f"lateralProfile/{name}") if any(number(each, k, where, 0.0) for k in "abcd")]
        if steep:
            found.remark(name, f"{len(steep)} entries", road, number(steep[0], "s", where), "roads have no slope across")
    for each in element.findall("surface/CRG"):
        found.remark("surface", f"CRG {each.get('file')}", road, number(each, "sStart", where, 0.0), "roads are even")
    for each in element.findall("railroad/switch"):
        found.remark("railway", f"switch {each.get('id')}", road, 0.0, "rails are not built")


# -- lanes -----------------------------------------------------------------------------------------


def read_sections(element: Element, length: float, road: str, found: Document) -> Iterator[Section]:
    """The lane sections of a road, in order."""
    sections = element.findall("lanes/laneSection")
    if not sections:
        raise MapError(f"road {road}: <lanes> has no <laneSection>")
    last = -1.0
    for each in sections:
        s = number(each, "s", f"road {road}")
        where = f"road {road}, <laneSection> at s = {s:g}"
        if s <= last or not s >= 0.0:
            raise MapError(f"{where}: lane sections must begin one behind another, from s = 0 on")
        last = s
        if s < length - 1e-6:
            yield read_section(each, s, where, road, found)


def read_section(element: Element, s: float, where: str, road: str, found: Document) -> Section:
    """One lane section, with the lanes that cars cannot use noted."""
    strips, unused = {}, defaultdict(int)
    for side, sign in (("left", 1), ("right", -1)):
        lanes = sorted(element.findall(f"{side}/lane"), key=lambda lane: abs(whole(lane, "id", where)))
        edge = NOTHING
        if len(lanes) > MOST_LANES:
            raise MapError(f"{where}: <{side}> has {len(lanes)} lanes; allowed: up to {MOST_LANES}")
        for count, lane in enumerate(lanes, start=1):
            strip, edge = read_strip(lane, sign, edge, where)
            if strip.id != sign * count:
                raise MapError(f"{where}: <lane> {strip.id} on the {side} should be {sign * count}; lanes count from the middle")
            strips[strip.id] = strip
            if strip.type not in DRIVABLE | KEPT_FOR_OTHERS:
                unused[strip.type] += 1
    for kind, count in unused.items():
        found.remark("lane", f"{count} of type {kind}", road, s, "cars cannot use lanes of this type")
    return Section(s, strips)


def read_strip(element: Element, sign: int, edge: Profile, where: str) -> tuple[Strip, Profile]:
    """One lane, and the border it ends at; its width is given, or is what lies between two borders."""
    number_ = whole(element, "id", where)
    where = f"{where}, <lane> {number_}"
    width, border = (element.findall(name) for name in ("width", "border"))
    if width or not border:
        shape, outer = profile(width, where, at="sOffset"), NOTHING
    else:
        outer = profile(border, where, at="sOffset")
        shape = difference(outer, edge, sign)
    if shape.starts.size and np.abs(shape.k[0]).max() > WIDEST_LANE:
        raise MapError(f"{where}: it is {np.abs(shape.k[0]).max():g} m wide; allowed: up to {WIDEST_LANE:g} m")
    speeds = [(number(each, "sOffset", where, 0.0), read_speed(each, where)) for each in element.findall("speed")]
    kind = element.get("type") or "none"
    strip = Strip(
        id=number_,
        type=kind,
        width=shape,
        before=tuple(whole(each, "id", where) for each in element.findall("link/predecessor")),
        after=tuple(whole(each, "id", where) for each in element.findall("link/successor")),
        speeds=tuple(sorted(speeds)),
        open=kind not in KEPT_FOR_OTHERS and admits_cars(element),
    )
    return strip, outer


def difference(outer: Profile, inner: Profile, sign: int) -> Profile:
    """How far one border lies beyond another."""
    starts = np.union1d(outer.starts, inner.starts)
    columns = [[sign * (a - b) for a, b in zip(moved(outer, s), moved(inner, s), strict=True)] for s in starts]
    return Profile(starts, np.array(columns).T)


def moved(of: Profile, s: float) -> np.ndarray:
    """The coefficients that hold from s on, for the distance from there (Taylor's expansion)."""
    i = int(np.searchsorted(of.starts, s, side="right")) - 1
    if i < 0:
        return np.zeros(4)
    a, b, c, d = of.k[:, i]
    h = s - of.starts[i]
    return np.array([a + h * (b + h * (c + h * d)), b + h * (2 * c + h * 3 * d), c + 3 * d * h, d])


def admits_cars(element: Element) -> bool:
    """Whether cars may use a lane; `<access>` names who may (rule allow) or may not (deny)."""
    rules = defaultdict(set)
    for each in element.findall("access"):
        rules[each.get("rule") or "deny"] |= {each.get("restriction") or ""} | {r.get("type") or "" for r in each.findall("restriction")}
    cars = {"passengerCar", "motorVehicle"}
    return not cars & rules["deny"] and (not rules["allow"] or bool(cars & rules["allow"]))


# -- lights and junctions --------------------------------------------------------------------------


def read_lights(element: Element, length: float, road: str, found: Document) -> Iterator[Light]:
    """The traffic lights of a road; other signals are noted."""
    where = f"road {road}"
    for each in element.findall("signals/signal"):
        s, kind = min(max(0.0, number(each, "s", where)), length), each.get("type") or "-1"
        name = f"signal {each.get('id')} of type {kind}"
        country = each.get("country")
        name += f" in {country}" if country and country != "OpenDRIVE" else ""
        if is_car_light(each):
            yield light(each, each.get("id") or "", s)
        elif kind in OTHER_LIGHTS:
            found.remark("light", name, road, s, "is not for cars")
        elif each.get("dynamic") == "yes":
            found.remark("light", name, road, s, "is no traffic light that is known")
        else:
            found.remark("sign", name, road, s, "signs are not read; limits come from <speed>")
    for each in element.findall("signals/signalReference"):
        if each.get("id") in found.light_ids:
            yield light(each, each.get("id") or "", min(max(0.0, number(each, "s", where)), length))


def is_car_light(signal: Element) -> bool:
    """Whether a signal is a traffic light for cars."""
    return signal.get("dynamic") == "yes" and signal.get("type") in CAR_LIGHTS


def light(element: Element, name: str, s: float) -> Light:
    """A light, for the lanes that it is valid for."""
    spans = [(whole(each, "fromLane", "<validity>"), whole(each, "toLane", "<validity>")) for each in element.findall("validity")]
    return Light(name, s, element.get("orientation") or "none", tuple((min(span), max(span)) for span in spans))


def read_junction(element: Element, found: Document) -> None:
    """One `<junction>`."""
    name = element.get("id") or ""
    if element.get("type") == "virtual":
        found.remark("junction", f"virtual junction {name}", element.get("mainRoad") or "", 0.0, "virtual junctions are not built")
        return
    joins = []
    for each in element.findall("connection"):
        where = f"junction {name}, <connection> {each.get('id')}"
        connecting = each.get("connectingRoad") or each.get("linkedRoad") or ""
        for attribute, road in (("incomingRoad", each.get("incomingRoad") or ""), ("connectingRoad", connecting)):
            if road not in found.roads:
                raise MapError(f"{where}: {attribute} names no road of this map (got {road!r})")
        if each.get("contactPoint") not in ("start", "end"):
            raise MapError(f"{where}: contactPoint is {each.get('contactPoint')!r}; allowed: start, end")
        links = tuple((whole(link, "from", where), whole(link, "to", where)) for link in each.findall("laneLink"))
        joins.append(Join(each.get("incomingRoad") or "", connecting, each.get("contactPoint") or "", links))
    found.junctions[name] = tuple(joins)
