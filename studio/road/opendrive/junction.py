"""Reads the junctions of an OpenDRIVE document, and which of them are a roundabout."""

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from studio.errors import MapError
from studio.road.opendrive.document import Document, Join, Junction
from studio.road.opendrive.element import spared, whole
from studio.road.opendrive.vocabulary import note_unread


def read_junction(element: Element, found: Document) -> None:
    """One `<junction>`."""
    name = element.get("id") or ""
    if element.get("type") == "virtual":
        found.remark("junction", f"virtual junction {name}", element.get("mainRoad") or "", 0.0, "virtual junctions are not built")
        return
    if not name or name in found.junctions:
        found.remark("junction", f"junction {name}", "", 0.0, "stands twice with this id" if name else "has no id")
        return
    note_unread(element, road_at(element, found), found)
    found.junctions[name] = Junction(tuple(read_joins(element, name, found)), tuple(read_priorities(element, name, found)))


def road_at(element: Element, found: Document) -> str:
    """A road of a junction, to say where it is."""
    named = (each.get(key) or "" for each in element.findall("connection") for key in ("connectingRoad", "linkedRoad", "incomingRoad"))
    return next((road for road in named if road in found.roads), "")


def read_joins(element: Element, name: str, found: Document) -> Iterator[Join]:
    """The connections of a junction that can be used."""
    at = road_at(element, found)
    for each in element.findall("connection"):
        road = each.get("incomingRoad") or ""
        made = spared(found, "connection", road if road in found.roads else at, 0.0, lambda each=each: read_join(each, name, found))
        if made is not None:
            yield made


def read_join(element: Element, name: str, found: Document) -> Join:
    """One `<connection>`; raises MapError."""
    where = f"junction {name}, <connection> {element.get('id')}"
    incoming, connecting = element.get("incomingRoad") or "", element.get("connectingRoad") or element.get("linkedRoad") or ""
    for attribute, road in (("incomingRoad", incoming), ("connectingRoad", connecting)):
        if road not in found.roads:
            raise MapError(f"{where}: {attribute} names no road of this map (got {road!r})")
    return Join(
        incoming, connecting, contact_of(element, incoming, connecting, where, found), tuple(read_links(element, incoming, where, found))
    )


def contact_of(element: Element, incoming: str, connecting: str, where: str, found: Document) -> str:
    """The end of a connecting road at which it is entered: as it says, else by that road's own links. Raises MapError."""
    contact, road = element.get("contactPoint") or "", found.roads[connecting]
    if contact in ("start", "end"):
        return contact
    ends = [end for link, end in ((road.before, "start"), (road.after, "end")) if link is not None and link.id == incoming]
    if len(ends) != 1:
        raise MapError(f"{where}: contactPoint is {contact!r}; allowed: start, end")
    found.derive(
        "contact", f"the {ends[0]} of road {connecting}", incoming, 0.0, f"its link; contactPoint of the <connection> is {contact!r}"
    )
    return ends[0]


def read_links(element: Element, road: str, where: str, found: Document) -> Iterator[tuple[int, int]]:
    """The pairs of lanes of a connection."""
    for link in element.findall("laneLink"):
        made = spared(found, "lane link", road, 0.0, lambda link=link: (whole(link, "from", where), whole(link, "to", where)))
        if made is not None:
            yield made


def read_priorities(element: Element, name: str, found: Document) -> Iterator[tuple[str, str]]:
    """The pairs of roads of a junction of which one goes before the other."""
    for each in element.findall("priority"):
        high, low = each.get("high") or "", each.get("low") or ""
        if high in found.roads and low in found.roads and high != low:
            yield high, low
        else:
            what = f"junction {name}: {high or 'none'} before {low or 'none'}"
            found.remark("priority", what, road_at(element, found), 0.0, "high and low must name two roads of this map")


def read_group(element: Element, found: Document) -> None:
    """One `<junctionGroup>`: a roundabout, or something else, which is noted."""
    members = frozenset(each.get("junction") or "" for each in element.findall("junctionReference"))
    if element.get("type") == "roundabout":
        found.rings.append(members)
    else:
        what = f"group {element.get('id')} of type {element.get('type')}"
        found.remark("junction group", what, "", 0.0, "its junctions are built one by one")
