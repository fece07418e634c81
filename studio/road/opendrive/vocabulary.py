"""The elements of OpenDRIVE 1.4 to 1.8, each under its parent: used, or the reason for which it is told as left out.

Names are those of the standard (ASAM OpenDRIVE 1.8.1 with its changes since 1.4). `userData` and `dataQuality` may stand everywhere
and say nothing about driving; `include` names another file.
"""

from collections import Counter
from xml.etree.ElementTree import Element

from studio.road.opendrive.document import Document
from studio.road.opendrive.element import place

ANYWHERE = {"userData", "dataQuality", "error", "rawData"}
USED = {
    "OpenDRIVE": {"header", "road", "junction", "junctionGroup"},
    "header": {"geoReference", "offset", "license"},
    "road": {"link", "type", "planView", "elevationProfile", "lateralProfile", "lanes", "objects", "signals", "surface", "railroad"},
    "link": {"predecessor", "successor"},
    "type": {"speed"},
    "planView": {"geometry"},
    "geometry": {"line", "spiral", "arc", "poly3", "paramPoly3"},
    "elevationProfile": {"elevation"},
    "lanes": {"laneOffset", "laneSection"},
    "laneSection": {"left", "center", "right"},
    "left": {"lane"},
    "center": {"lane"},
    "right": {"lane"},
    "lane": {"link", "width", "border", "speed", "access"},
    "access": {"restriction"},
    "signals": {"signal", "signalReference"},
    "signal": {"validity"},
    "signalReference": {"validity"},
    "junction": {"connection", "priority"},
    "connection": {"laneLink"},
    "junctionGroup": {"junctionReference"},
}
SINGLY = {  # told one by one where they stand (road.py), with all that is in them
    *("object", "bridge", "tunnel", "objectReference", "superelevation", "crossfall", "shape", "CRG", "switch"),
}
LIGHTS = "lights change as the studio programmes them"
EVEN = "roads are even"
TOLD = {
    "OpenDRIVE/controller": LIGHTS,
    "OpenDRIVE/station": "railways are not built",
    "header/defaultRegulations": "rules come from country and road type",
    "link/neighbor": "roads beside each other are not joined",
    "lateralProfile/crossSectionSurface": "roads have no slope across",
    "lane/roadMark": "lines are drawn between lanes, and do not forbid to change them",
    "lane/material": "the friction of roads is that of the scenario",
    "lane/visibility": "visibility is that of the scenario",
    "lane/height": "lanes are as high as their road",
    "lane/rule": "rules in words are not read",
    "signal/dependency": LIGHTS,
    "signal/reference": "signals do not depend on others",
    "signal/positionRoad": "a signal stands where its s and t say",
    "signal/positionInertial": "a signal stands where its s and t say",
    "signal/semantics": "the meaning of signals comes from type and country",
    "signal/displayArea": "boards are not read",
    "signal/staticBoard": "boards are not read",
    "signal/vmsBoard": "boards are not read",
    "junction/controller": LIGHTS,
    "junction/surface": EVEN,
    "junction/planView": "a junction's own line is not used",
    "junction/elevationGrid": "junctions are as high as their roads",
    "junction/boundary": "a junction's ground is that of its ways",
    "junction/crossPath": "ways for people on foot are not built",
    "junction/roadSection": "ways for people on foot are not built",
    "junction/objects": "objects are not built",
    "connection/predecessor": "virtual junctions are not built",
    "connection/successor": "virtual junctions are not built",
}


def note_unread(element: Element, road: str, found: Document) -> None:
    """Tells what is within an element and not used, by its kind; what the standard does not know too."""
    counted: Counter[tuple[str, str, str]] = Counter()
    first: dict[str, float] = {}
    waiting = [element]
    while waiting:
        parent = waiting.pop()
        known = USED.get(parent.tag, set())
        for child in parent:
            if child.tag in known:
                waiting.append(child)
            elif child.tag not in ANYWHERE | SINGLY:
                name = f"{parent.tag}/{child.tag}"
                counted[child.tag, name, reason_of(name)] += 1
                first.setdefault(name, place(child, "s"))
    for (tag, name, reason), count in counted.items():
        found.remark(tag, f"{count} <{tag}> in <{name.partition('/')[0]}>", road, first[name], reason)


def reason_of(name: str) -> str:
    """Why an element, "parent/child", is not used."""
    if name.endswith("/include"):
        return "other files are not read"
    return TOLD.get(name, "OpenDRIVE has no such element there")
