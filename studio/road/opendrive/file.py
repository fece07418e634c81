"""Reads an OpenDRIVE file: header and document. The file is hostile until proven otherwise."""

from collections import Counter
from dataclasses import replace
from xml.etree.ElementTree import Element

import numpy as np

from studio.errors import MapError
from studio.road.formats.plain_xml import parse
from studio.road.opendrive.document import Document, Header, XRoad
from studio.road.opendrive.element import number, spared
from studio.road.opendrive.junction import read_group, read_junction
from studio.road.opendrive.road import read_roads
from studio.road.opendrive.signal import rule_of
from studio.road.opendrive.vocabulary import ANYWHERE, TOLD, USED, reason_of

WIDEST = 100_000.0  # [m] from one end of the map to the other


def read_header(data: bytes) -> Header:
    """The header alone, quickly: what comes after it is not looked at; empty where there is none."""
    end = data.find(b"</header>")
    head = data[: end + 9] if end >= 0 else data[: data.find(b"/>", data.find(b"<header")) + 2]
    try:
        return header_of(parse(head + b"</OpenDRIVE>", "map file"))
    except (MapError, ValueError):
        return Header("", "", "", "")


def header_of(root: Element, found: Document | None = None) -> Header:
    """Who made the map, and its place on the earth."""
    head = root.find("header")
    if head is None:
        return Header("", "", "", "")
    licence, offset = head.find("license"), head.find("offset")
    named = "" if licence is None else licence.get("name") or licence.get("spdxid") or licence.get("resource") or ""
    text = head.findtext("geoReference") or ""
    header = Header(head.get("name", "").strip(), head.get("vendor", "").strip(), named.strip(), text.strip())
    if offset is None or found is None:
        return header
    shift = spared(found, "offset", "", 0.0, lambda: (number(offset, "x", "<header>", 0.0), number(offset, "y", "<header>", 0.0)))
    return replace(header, shift=shift or (0.0, 0.0))


def document(data: bytes) -> Document:
    """The document of an OpenDRIVE file.

    Raises:
        MapError: this is no OpenDRIVE, or it has no road that can be used.
    """
    root = parse(data, "map file")
    if root.tag != "OpenDRIVE":
        raise MapError(f"this is not OpenDRIVE: its root element is <{root.tag}>, not <OpenDRIVE>")
    head = root.find("header")
    version = "1" if head is None else head.get("revMajor") or "1"
    if version.strip().partition(".")[0] != "1":
        raise MapError(f"<header>: revMajor {version!r} cannot be read; allowed: 1")
    found = Document(Header("", "", "", ""), rules={each.get("id") or "": rule_of(each) for each in root.iter("signal")})
    found.header = header_of(root, found)
    read_roads(root.iter("road"), found)
    check_roads(found)
    keep_together(found)
    keep_side(found)
    for element in root.iter("junction"):
        read_junction(element, found)
    for element in root.iter("junctionGroup"):
        read_group(element, found)
    note_rest(root, found)
    return found


def check_roads(found: Document) -> None:
    """Refuses a document without a usable road, with the reasons."""
    if found.roads:
        return
    reasons = [each.reason for each in found.remarks if each.kind == "road"]
    if not reasons:
        raise MapError("there are no roads in this map; <OpenDRIVE> has no <road>")
    more = f" (and {len(reasons) - 1} more)" if len(reasons) > 1 else ""
    raise MapError(f"there is no road in this map that can be used: {reasons[0]}{more}")


def keep_together(found: Document) -> None:
    """Leaves out roads that lie farther than a map reaches from where most are."""
    starts = {name: road.line.at(np.zeros(1))[:2, 0] for name, road in found.roads.items()}
    middle = np.percentile(np.array(list(starts.values())), 50.0, axis=0, method="lower")
    for name, start in starts.items():
        if not np.abs(start - middle).max() <= WIDEST / 2.0:
            leave_out(found, name, f"lies {np.abs(start - middle).max() / 1000:.3g} km from most; allowed: up to {WIDEST / 2000:g} km")


def keep_side(found: Document) -> None:
    """Leaves out the roads that are driven on another side than most: a map is driven on one."""
    sides = Counter(road.left_hand for road in found.roads.values())
    left = sides[True] > sides[False]
    for road in [road for road in found.roads.values() if road.left_hand != left]:
        mine, others = ("LHT", "RHT") if road.left_hand else ("RHT", "LHT")
        leave_out(found, road.id, f"rule of <road> is {mine}, that of most is {others}; a map is driven on one side")


def leave_out(found: Document, name: str, reason: str) -> None:
    """Takes a road out of the document, and tells why."""
    road: XRoad = found.roads.pop(name)
    x, y = road.line.at(np.zeros(1))[:2, 0]
    found.remark("road", f"road {name}", name, 0.0, f"road {name}: {reason}", (float(x), float(y)))


def note_rest(root: Element, found: Document) -> None:
    """Tells what stands beside the roads and junctions and is not used."""
    counted = Counter(each.tag for each in root if each.tag not in USED["OpenDRIVE"])
    for tag, count in counted.items():
        if tag not in ANYWHERE:
            found.remark(tag, f"{count} <{tag}>", "", 0.0, reason_of(f"OpenDRIVE/{tag}"))
    head = root.find("header")
    for each in head if head is not None else ():
        if f"header/{each.tag}" in TOLD:
            found.remark(each.tag, f"<{each.tag}>", "", 0.0, TOLD[f"header/{each.tag}"])
