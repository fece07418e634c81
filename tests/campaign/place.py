"""A small place as every kind of OpenStreetMap file: streets that cross at lights, a ban on turning, houses, parking, a crossing."""

import gzip
import json
from pathlib import Path
from xml.etree import ElementTree

import osmium

NODES = {
    1: (52.5000, 13.4000, {}),
    2: (52.5005, 13.4010, {"highway": "crossing", "crossing": "zebra"}),
    3: (52.5010, 13.4020, {"highway": "traffic_signals"}),
    4: (52.5015, 13.4030, {}),
    5: (52.5020, 13.4040, {"highway": "stop", "direction": "backward"}),
    6: (52.5014, 13.4012, {}),
    7: (52.5006, 13.4028, {"barrier": "gate"}),
    8: (52.5002, 13.4036, {}),
    9: (52.5004, 13.4014, {}),
    10: (52.5004, 13.4018, {}),
    11: (52.5002, 13.4018, {}),
    12: (52.5002, 13.4014, {}),
    13: (52.5012, 13.4026, {"natural": "tree"}),
}
WAYS = {
    20: (
        [1, 2, 3],
        {
            "highway": "primary",
            "name": "Alte Straße",
            "lanes": "3",
            "lanes:forward": "2",
            "turn:lanes:forward": "left|through;right",
            "maxspeed": "50",
        },
    ),
    21: ([3, 4, 5], {"highway": "primary", "name": "Alte Straße", "maxspeed": "30 mph", "surface": "cobblestone", "incline": "3%"}),
    22: ([6, 3, 7], {"highway": "residential", "oneway": "yes", "lanes": "2", "width": "6.5 m", "maxspeed": "DE:zone30"}),
    23: ([7, 8], {"highway": "service", "service": "parking_aisle"}),
    24: ([9, 10, 11, 12, 9], {"building": "yes", "building:levels": "3", "height": "9.5"}),
    25: ([4, 5, 8, 4], {"amenity": "parking", "parking": "surface"}),
    26: ([2, 9], {"highway": "footway", "footway": "crossing", "bridge": "yes", "layer": "1"}),
}
BAN = ([("way", 20, "from"), ("node", 3, "via"), ("way", 22, "to")], {"type": "restriction", "restriction": "no_right_turn"})


def xml() -> bytes:
    """As OSM XML."""
    root = ElementTree.Element("osm", version="0.6", generator="campaign")
    for number, (latitude, longitude, tags) in NODES.items():
        tagged(ElementTree.SubElement(root, "node", id=f"{number}", version="1", lat=f"{latitude}", lon=f"{longitude}"), tags)
    for number, (nodes, tags) in WAYS.items():
        way = ElementTree.SubElement(root, "way", id=f"{number}", version="1")
        for node in nodes:
            ElementTree.SubElement(way, "nd", ref=f"{node}")
        tagged(way, tags)
    relation = ElementTree.SubElement(root, "relation", id="30", version="1")
    for sort, ref, role in BAN[0]:
        ElementTree.SubElement(relation, "member", type=sort, ref=f"{ref}", role=role)
    tagged(relation, BAN[1])
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)


def tagged(element: ElementTree.Element, tags: dict[str, str]) -> None:
    """Puts tags into an element."""
    for key, value in tags.items():
        ElementTree.SubElement(element, "tag", k=key, v=value)


def overpass() -> bytes:
    """As an Overpass server answers."""
    nodes = [{"type": "node", "id": each, "lat": lat, "lon": lon, "tags": tags} for each, (lat, lon, tags) in NODES.items()]
    ways = [{"type": "way", "id": each, "nodes": refs, "tags": tags} for each, (refs, tags) in WAYS.items()]
    members = [{"type": sort, "ref": ref, "role": role} for sort, ref, role in BAN[0]]
    relation = {"type": "relation", "id": 30, "members": members, "tags": BAN[1]}
    return json.dumps({"version": 0.6, "elements": [*nodes, *ways, relation]}, indent=1).encode()


def pbf(folder: Path) -> bytes:
    """As PBF; written in a folder."""
    source, target = folder / "place.osm", folder / "place.osm.pbf"
    source.write_bytes(xml())
    target.unlink(missing_ok=True)
    with osmium.SimpleWriter(str(target)) as writer:
        for each in osmium.FileProcessor(str(source)):
            writer.add(each)
    return target.read_bytes()


def packed() -> bytes:
    """As gzipped XML."""
    return gzip.compress(xml(), mtime=0)
