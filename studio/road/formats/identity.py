"""Identities of OpenStreetMap elements. Those of a plan that is drawn but not uploaded, in JOSM for instance, are negative.

osmium keeps no places of nodes below zero, and netconvert marks ways back with a minus. So such identities are moved above all that
OpenStreetMap has, and what people read has them as they stand in the file.
"""

import re
from xml.etree import ElementTree

from studio.road.formats.plain_xml import parse

DRAFTS = 10**11  # above every identity of OpenStreetMap (2026: 1.4e10), below those that the studio gives
STUDIO = 10**15
DRAFT = re.compile(rb"""(?:\bid|\bref)\s*=\s*["']-|\baction\s*=\s*["']delete["']""")


def named(kind: str, identity: int) -> str:
    """An element's name as people read it.

    >>> named("way", 12), named("way", 10**11 + 12)
    ('way 12', 'way -12')
    """
    return f"{kind} {shown(identity)}"


def shown(identity: int) -> int:
    """An identity as it stands in the file."""
    return DRAFTS - identity if DRAFTS < identity < STUDIO else identity


def kept(identity: int) -> int:
    """An identity of the file as it is here."""
    return DRAFTS - identity if identity < 0 else identity


def uploaded(data: bytes) -> bytes:
    """OSM XML without negative identities, and without what its author has deleted; other files as they are.

    Raises:
        MapError: it has such, and is no XML.
    """
    if not DRAFT.search(data):
        return data
    root = parse(data, "map file")
    for each in [each for each in root if each.get("action") == "delete"]:
        root.remove(each)
    for each in root.iter():
        for key in ("id", "ref"):
            if each.tag in ("node", "way", "relation", "nd", "member") and (each.get(key) or "").startswith("-"):
                each.set(key, moved(each.get(key) or ""))
    root[:] = sorted(root, key=lambda each: ("node", "way", "relation").index(each.tag) if each.tag in ("node", "way", "relation") else -1)
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)


def moved(text: str) -> str:
    """A negative identity above the others; text that is none stays."""
    return str(DRAFTS - int(text)) if re.fullmatch(r"-\d{1,13}", text) else text
