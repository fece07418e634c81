"""What the tags of a mapped thing mean here: kinds of areas, of lines and of points, and sizes where none are mapped.

Keys and values are those of the OpenStreetMap wiki.
"""

import re

FEET = 0.3048  # [m]
GREEN = {
    "landuse": {"grass", "meadow", "forest", "village_green", "recreation_ground", "cemetery", "flowerbed"},
    "leisure": {"park", "garden", "common", "pitch"},
    "natural": {"wood", "scrub", "grassland", "heath"},
}
INSIDE = {"underground", "multi-storey", "rooftop", "garage_boxes", "sheds", "carports"}  # of something; no ground to see
# height and thickness [m] of what stands along a line, where no height is mapped
BARRIERS = {
    "wall": (1.8, 0.25),
    "city_wall": (5.0, 1.0),
    "retaining_wall": (1.0, 0.3),
    "fence": (1.4, 0.06),
    "hedge": (1.3, 0.7),
    "guard_rail": (0.75, 0.2),
    "jersey_barrier": (0.8, 0.5),
    "handrail": (1.0, 0.05),
}
# height and thickness [m] of what stands at a point
POSTS = {
    "bollard": (0.9, 0.16),
    "block": (0.5, 0.6),
    "lamp": (6.5, 0.14),
    "flagpole": (8.0, 0.12),
    "mast": (12.0, 0.3),
    "pole": (9.0, 0.25),
}
OPENINGS = {"gate", "lift_gate", "swing_gate", "entrance", "cycle_barrier", "toll_booth", "sally_port", "height_restrictor"}
STRIPED, RULED = ("zebra", "ladder"), ("lines", "dashes", "dots")  # how values of crossing:markings begin


def metres(text: str) -> float:
    """A mapped length [m]: "12", "12.5 m", "12,5" or "40'"; 0 for what cannot be read.

    >>> metres("12,5 m"), metres("10'"), metres("tall")
    (12.5, 3.048, 0.0)
    """
    found = re.match(r"\s*(\d+(?:[.,]\d+)?)\s*(m|ft|feet|')?", text)
    if not found:
        return 0.0
    value = float(found[1].replace(",", "."))
    return round(value * FEET, 6) if found[2] in ("ft", "feet", "'") else value


def area_kind(tags) -> str:
    """What a mapped area is: "building", "part", "water", "green", "sand", "square", "parking", "space" or "" for the rest."""
    if tags.get("building:part", "no") != "no":
        return "part"
    if tags.get("building", "no") != "no":
        return "building" if tags.get("location") != "underground" else ""
    if tags.get("natural") == "water" or tags.get("waterway") == "riverbank":
        return "water"
    if tags.get("amenity") in ("parking", "parking_space"):
        return ("parking" if tags.get("amenity") == "parking" else "space") if not hidden(tags) else ""
    if tags.get("natural") in ("sand", "beach") or tags.get("golf") == "bunker":
        return "sand"
    if any(tags.get(key) in kinds for key, kinds in GREEN.items()):
        return "green"
    walked = tags.get("highway") == "pedestrian" and (tags.get("area") == "yes" or tags.get("type") == "multipolygon")
    return "square" if walked or tags.get("place") == "square" else ""


def below(tags) -> bool:
    """Whether a thing lies below the ground."""
    return tags.get("layer", "0").startswith("-") or tags.get("location") == "underground" or tags.get("tunnel", "no") != "no"


def hidden(tags) -> str:
    """Why a parking place is not seen from the street, or nothing."""
    if below(tags):
        return "lies below the ground"
    return f"parking={tags.get('parking')} is not in the open" if tags.get("parking") in INSIDE else ""


def line_kind(tags) -> str:
    """What a mapped line is: a kind of `BARRIERS`, "bollard", "tree_row", "crossing" or "" for what is not drawn."""
    if tags.get("footway") == "crossing" or tags.get("path") == "crossing" or tags.get("cycleway") == "crossing":
        return "crossing"
    if tags.get("natural") == "tree_row":
        return "tree_row"
    barrier = tags.get("barrier", "")
    return barrier if (barrier in BARRIERS or barrier in ("bollard", "block")) and not below(tags) else ""


def point_kind(tags) -> str:
    """What a mapped point is: a kind of `POSTS`, "tree", "crossing", "parking", "space" or "" for what is not drawn."""
    if tags.get("natural") == "tree":
        return "tree"
    if tags.get("highway") == "crossing" or (tags.get("highway") == "traffic_signals" and tags.get("crossing", "no") != "no"):
        return "crossing"
    if tags.get("amenity") in ("parking", "parking_space"):
        return "parking" if tags.get("amenity") == "parking" else "space"
    if tags.get("highway") == "street_lamp":
        return "lamp"
    if tags.get("power") in ("pole", "tower") or tags.get("man_made") == "utility_pole":
        return "pole"
    if tags.get("man_made") in ("flagpole", "mast"):
        return tags.get("man_made")
    return tags.get("barrier", "") if tags.get("barrier") in ("bollard", "block") else ""


def is_signalled(tags) -> bool:
    """Whether walkers have lights at a crossing."""
    lights = tags.get("crossing") == "traffic_signals" or tags.get("crossing:signals", "no") != "no"
    return lights or tags.get("crossing_ref") in ("pelican", "puffin", "toucan", "pegasus")


def markings(tags) -> str:
    """What is painted at a crossing: "zebra", "lines" or "none".

    `crossing:markings` tells it; else `crossing_ref` and `crossing`, where "uncontrolled" is an old word for a zebra.
    With lights alone there are two lines (in German "Furt").
    """
    told = tags.get("crossing:markings", "")
    if told.startswith(STRIPED):
        return "zebra"
    if told.startswith(RULED):
        return "lines"
    if told in ("no", "surface", "pictograms"):
        return "none"
    if tags.get("crossing_ref") == "zebra" or tags.get("crossing") in ("zebra", "marked", "uncontrolled") or told == "yes":
        return "zebra" if not is_signalled(tags) else "lines"
    return "lines" if is_signalled(tags) else "none"
