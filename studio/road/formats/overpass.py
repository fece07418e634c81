"""Overpass JSON as OSM XML, so that there is one reader for all."""

import json
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from studio.errors import MapError

ORDER = {"node": 0, "way": 1, "relation": 2}


def as_xml(path: Path, data: bytes) -> bytes:
    """The elements of an Overpass answer as OSM XML: nodes first, then ways, then relations.

    Raises:
        MapError: this is no JSON, no Overpass answer, or one that says that it is not complete.
    """
    elements = answer(path, data)["elements"]
    try:
        root = ElementTree.Element("osm", version="0.6")
        places = {n["id"]: n for n in elements if n["type"] == "node"}
        for node, longitude, latitude in drawn(elements):
            places.setdefault(node, {"id": node, "lat": latitude, "lon": longitude})
        root.extend(map(node_element, sorted(places.values(), key=lambda each: each["id"])))
        for each in sorted(elements, key=lambda each: (ORDER[each["type"]], each["id"])):
            if each["type"] != "node":
                root.append(way_element(each) if each["type"] == "way" else relation_element(each))
        return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)
    except (KeyError, TypeError, AttributeError, ValueError, OverflowError) as error:
        raise MapError(f"{path}: an element of the Overpass answer is not as it should be ({error!r})") from None


def answer(path: Path, data: bytes) -> dict:
    """The answer as plain values, checked for being complete."""
    if not data.strip():
        raise MapError(f"{path}: the map file is empty")
    try:
        found = json.loads(data)
    except (ValueError, RecursionError):
        raise MapError(f"{path}: this is not JSON, or it is cut off; fetch it again") from None
    if not isinstance(found, dict) or not isinstance(found.get("elements"), list):
        raise MapError(f"{path}: this is no Overpass answer; it has no list of elements")
    if "runtime error" in str(found.get("remark", "")):
        raise MapError(f"{path}: the Overpass server did not finish: {found['remark']}")
    return found


def drawn(elements: list[dict]) -> Iterator[tuple[int, float, float]]:
    """Node, longitude and latitude from ways that carry their own geometry (`out geom`)."""
    for each in elements:
        for node, place in zip(each.get("nodes", []), each.get("geometry", []), strict=False):
            if each["type"] == "way" and place is not None:
                yield node, place["lon"], place["lat"]


def node_element(node: dict) -> ElementTree.Element:
    """A `<node>`."""
    place = {"lat": repr(float(node["lat"])), "lon": repr(float(node["lon"]))}
    return tagged(ElementTree.Element("node", id=str(int(node["id"])), version="1", **place), node)


def way_element(way: dict) -> ElementTree.Element:
    """A `<way>`."""
    element = ElementTree.Element("way", id=str(int(way["id"])), version="1")
    for node in way["nodes"]:
        ElementTree.SubElement(element, "nd", ref=str(int(node)))
    return tagged(element, way)


def relation_element(relation: dict) -> ElementTree.Element:
    """A `<relation>`."""
    element = ElementTree.Element("relation", id=str(int(relation["id"])), version="1")
    for member in relation.get("members", []):
        ElementTree.SubElement(element, "member", type=str(member["type"]), ref=str(int(member["ref"])), role=str(member.get("role", "")))
    return tagged(element, relation)


def tagged(element: ElementTree.Element, thing: dict) -> ElementTree.Element:
    """The element with its tags."""
    for key, value in thing.get("tags", {}).items():
        ElementTree.SubElement(element, "tag", k=str(key), v=str(value))
    return element
