"""Reads the roads of an OpenDRIVE document."""

import math
from collections.abc import Iterable, Iterator
from xml.etree.ElementTree import Element

import numpy as np

from studio.errors import MapError
from studio.road.opendrive.document import Deck, Document, Link, XRoad
from studio.road.opendrive.element import number, place, spared
from studio.road.opendrive.lane import read_sections
from studio.road.opendrive.reference_line import NOTHING, Bend, Cubic, Profile, ReferenceLine
from studio.road.opendrive.signal import read_signals
from studio.road.opendrive.speed import read_speed
from studio.road.opendrive.vocabulary import note_unread
from studio.road.opendrive.width import in_order

LONGEST_ROAD = 100_000.0  # [m]
LONGEST_GAP = 1.0  # [m] between the elements of a reference line


def read_roads(elements: Iterable[Element], found: Document) -> None:
    """All roads that can be used; the others are told."""
    for element in elements:
        name = element.get("id") or ""
        try:
            if name in found.roads:
                raise MapError(f"road {name}: <road> stands twice with this id; the first one counts")
            found.roads[name] = read_road(element, name, found)
        except MapError as error:
            found.remark("road", f"road {name}", name, 0.0, error.message, where_of(element))


def where_of(element: Element) -> tuple[float, float] | None:
    """Where a road that cannot be used begins [m], if that much can be read."""
    geometry = element.find("planView/geometry")
    return None if geometry is None else (place(geometry, "x"), place(geometry, "y"))


def read_road(element: Element, name: str, found: Document) -> XRoad:
    """One `<road>`; raises MapError."""
    if not name:
        raise MapError("<road>: it has no id")
    where = f"road {name}"
    line = read_line(element, name, found)
    length = read_length(element, line, name, found)
    note_gaps(line, length, name, found)
    length = min(length, line.length)
    note_unused(element, name, found)
    note_unread(element, name, found)
    sections = tuple(read_sections(element, length, name, found))
    if not sections:
        raise MapError(f"{where}: its first <laneSection> begins behind its end")
    ends = [spared(found, "link", name, s, lambda tag=tag: read_link(element.find(f"link/{tag}"), where))
            for tag, s in (("predecessor", 0.0), ("successor", length))]  # fmt: skip
    kinds = (
        spared(found, "type", name, place(each, "s"), lambda each=each: read_kind(each, name, found)) for each in element.findall("type")
    )
    return XRoad(
        id=name,
        name=element.get("name") or "",
        junction=element.get("junction") or "-1",
        left_hand=is_left_hand(element, name, found),
        line=line,
        length=length,
        before=ends[0],
        after=ends[1],
        kinds=tuple(sorted((kind for kind in kinds if kind is not None), key=lambda kind: kind[0])),
        elevation=profile(element.findall("elevationProfile/elevation"), name, found),
        offset=profile(element.findall("lanes/laneOffset"), name, found),
        sections=sections,
        signals=tuple(read_signals(element, length, name, found)),
        decks=tuple(read_decks(element, length, name, found)),
    )


def is_left_hand(element: Element, road: str, found: Document) -> bool:
    """Whether one drives on the left; by default on the right."""
    rule = element.get("rule") or "RHT"
    if rule not in ("RHT", "LHT"):
        found.remark("rule", f"rule={rule[:20]}", road, 0.0, "is unknown; allowed: RHT, LHT; RHT is taken")
    return rule == "LHT"


def read_length(element: Element, line: ReferenceLine, road: str, found: Document) -> float:
    """The length of a road [m]: as it says, else that of its geometry."""
    where = f"road {road}"
    length = spared(found, "length", road, 0.0, lambda: number(element, "length", where))
    if length is None or not 0.0 < length <= LONGEST_ROAD:
        said = "no length that can be read" if length is None else f"length {length:g} m; allowed: above 0, up to {LONGEST_ROAD:g} m"
        found.derive("length", f"{line.length:.2f} m", road, 0.0, f"its geometry: <road> has {said}")
        return line.length
    return length


def read_line(element: Element, road: str, found: Document) -> ReferenceLine:
    """The plan view of a road; raises MapError."""
    where, elements = f"road {road}", []
    for each in element.findall("planView/geometry"):
        if number(each, "length", where) == 0.0:
            found.remark("geometry", "an element without length", road, place(each, "s"), "is not needed")
        else:
            elements.append(read_geometry(each, where))
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


def profile(elements: list[Element], road: str, found: Document) -> Profile:
    """A piecewise cubic; records that cannot be read are told."""
    made = (
        spared(found, each.tag, road, place(each, "s"), lambda each=each: (number(each, "s", f"road {road}"),
                                                                        *coefficients(each, "abcd", f"road {road}")))
        for each in elements
    )  # fmt: skip
    rows = [row for row in made if row is not None]
    if not rows:
        return NOTHING
    table = np.array(in_order(rows, elements[0].tag, f"road {road}", road, found)).T
    return Profile(table[0].copy(), table[1:].copy())


def read_link(element: Element | None, where: str) -> Link | None:
    """What a road is joined to."""
    if element is None:
        return None
    kind, contact = element.get("elementType") or "", element.get("contactPoint") or ""
    if kind not in ("", "road", "junction") or contact not in ("", "start", "end") or not element.get("elementId"):
        raise MapError(f"{where}: <{element.tag}> names no road with contactPoint start or end, and no junction")
    return Link(kind or ("road" if contact else "junction"), element.get("elementId") or "", contact)


def read_kind(element: Element, road: str, found: Document) -> tuple[float, str, str, float]:
    """A `<type>`: from where, what kind of road, in which country, which limit [m/s]."""
    s, speed = number(element, "s", f"road {road}"), element.find("speed")
    limit = None if speed is None else spared(found, "speed", road, s, lambda: read_speed(speed, f"road {road}"))
    return s, element.get("type") or "unknown", element.get("country") or "", math.nan if limit is None else limit


def read_decks(element: Element, length: float, road: str, found: Document) -> Iterator[Deck]:
    """The bridges and tunnels of a road, each told with the level on which its lanes lie there."""
    for tag, level in (("bridge", 1), ("tunnel", -1)):
        for each in element.findall(f"objects/{tag}"):
            s = place(each, "s")
            deck = spared(found, tag, road, s, lambda each=each, tag=tag, level=level: read_deck(each, tag, level, length, f"road {road}"))
            if deck is not None:
                what = f"level {deck.level} for {deck.end - deck.start:.1f} m"
                found.derive("level", what, road, s, f"{tag} {each.get('id')}: on its whole width, whichever lanes it names")
                yield deck


def read_deck(element: Element, tag: str, level: int, length: float, where: str) -> Deck:
    """One bridge or tunnel, as far as its road goes; raises MapError where it is beside its road."""
    s, far = number(element, "s", where), number(element, "length", where)
    start, end = max(s, 0.0), min(s + far, length)
    if not start < end:
        raise MapError(f"{where}: <{tag}> is from s = {s:g} m on {far:g} m long; allowed: on its road, 0 to {length:g} m")
    return Deck(start, end, level)


def note_unused(element: Element, road: str, found: Document) -> None:
    """Notes objects, cross slopes and surfaces, which are not built."""
    for each in element.findall("objects/object"):
        what = " ".join(filter(None, ["object", each.get("id"), each.get("type") or each.get("name")]))
        found.remark("object", what, road, place(each, "s"), "objects beside the road are not built")
    for each in element.findall("objects/objectReference"):
        found.remark("objectReference", f"objectReference {each.get('id')}", road, place(each, "s"), "objects are not built")
    for name in ("superelevation", "crossfall", "shape"):
        steep = [each for each in element.findall(f"lateralProfile/{name}") if any(place(each, k) for k in "abcd")]
        if steep:
            found.remark(name, f"{len(steep)} entries", road, place(steep[0], "s"), "roads have no slope across")
    for each in element.findall("surface/CRG"):
        found.remark("surface", f"CRG {each.get('file')}", road, place(each, "sStart"), "roads are even")
    for each in element.findall("railroad/switch"):
        found.remark("railway", f"switch {each.get('id')}", road, 0.0, "rails are not built")
