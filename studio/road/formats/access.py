"""Who may drive a car on a way of OpenStreetMap, and in which direction.

Keys of access go from the wide to the exact: access, vehicle, motor_vehicle, motorcar; each may be said for one direction
(`motor_vehicle:backward`), which is more exact than the same key without. The most exact one counts. Values are those of the wiki
(Key:access); whoever needs a permit, a purpose or a bus is not everyone.
"""

from collections.abc import Mapping
from dataclasses import replace

from studio.road.formats.way import Way, spot_of
from studio.road.network.report import Notes

KEYS = ("motorcar", "motor_vehicle", "vehicle", "access")  # the more exact first
OPEN = {"yes", "designated", "permissive", "official", "public", "allowed", "unknown"}
TOLD = {"destination", "discouraged", "avoid"}  # open, but not as any other road
CLOSED = {
    *("no", "private", "agricultural", "forestry", "delivery", "customers", "permit", "permits", "military", "residents", "resident"),
    *("employees", "staff", "members", "guests", "students", "emergency", "bus", "psv", "taxi", "hov", "hgv", "goods", "bicycle", "foot"),
    *(
        "use_sidepath",
        "dismount",
        "restricted",
        "disabled",
        "service",
        "maintenance",
        "authorised",
        "authorized",
        "visitors",
        "tourist_bus",
    ),
    *("school", "university", "license", "variable", "destination_bus", "trolleybus", "share_taxi", "motorcycle", "moped", "horse", "none"),
}
BOTH, FORWARD, BACKWARD = "", ":forward", ":backward"
ONE_WAY = ("oneway:motorcar", "oneway:motor_vehicle", "oneway:vehicle", "oneway")


def closed(tags: Mapping[str, str], direction: str = BOTH) -> str:
    """Why not everyone may drive a car there in a direction (`FORWARD`, `BACKWARD`), or nothing."""
    if tags.get("area") == "yes":
        return "area=yes is no way"
    key, value = access(tags, direction)
    if value is not None and not is_open(value):
        return f"{key}={value}"
    return next((f"{key}={tags[key]}" for key in lanewise(direction) if key in tags and not any(map(is_open, tags[key].split("|")))), "")


def lanewise(direction: str) -> list[str]:
    """The keys that say for each lane of a direction who may drive there."""
    return [f"{key}:lanes{each}" for key in KEYS for each in dict.fromkeys((direction, BOTH))]


def access(tags: Mapping[str, str], direction: str = BOTH) -> tuple[str, str | None]:
    """The tag that says who may drive in a direction, its key and its value."""
    for key in KEYS:
        for exact in dict.fromkeys((key + direction, key)):
            if exact in tags:
                return exact, tags.get(exact)
    return "", None


def is_open(value: str) -> bool:
    """Whether everyone may drive there by a value; of several one is enough. A value that nobody knows closes no road."""
    return any(each.strip() not in CLOSED for each in value.split(";"))


def directed(way: Way, notes: Notes) -> Way | None:
    """The way as cars drive it: drawn along where it is one-way, without what is closed to them; None where all of it is."""
    way = drawn_along(way, notes)
    ways = {direction: closed(way.tags, direction) for direction in (FORWARD, BACKWARD)}
    note_value(way, notes)
    only = one_way(way.tags) == "yes"
    if ways[FORWARD] and (ways[BACKWARD] or only):
        notes.skip("closed way", f"highway={way.tags['highway']}", spot_of(way), ways[FORWARD])
        return None
    if only or not any(ways.values()):
        return way
    gone = FORWARD if ways[FORWARD] else BACKWARD
    notes.skip("closed direction", f"highway={way.tags['highway']}", spot_of(way), ways[gone] + ": only the other direction is built")
    return without(way, gone)


def without(way: Way, gone: str) -> Way:
    """A two-way street of which cars may drive one direction: one-way, with the lanes of that direction."""
    if gone == FORWARD:
        way = turned(way)
    own = {key: value for key, value in way.tags.items() if not key.endswith(BACKWARD)}
    lanes = own.pop("lanes:forward", None) or half(own.pop("lanes", ""))
    plain = {key.removesuffix(FORWARD): value for key, value in own.items() if key != "width"}  # it is that of both directions
    return way.with_tags({**plain, "oneway": "yes"} | ({"lanes": lanes} if lanes else {}))


def half(lanes: str) -> str:
    """The lanes of one direction of a way that does not say; "" where it says nothing."""
    return str(max(1, int(lanes) // 2)) if lanes.isdecimal() and len(lanes) < 6 else ""


def one_way(tags: Mapping[str, str]) -> str:
    """In which direction cars may drive: "yes" in the way's own, "-1" against it, "no" in both, or another word as it is."""
    value = next((tags[key] for key in ONE_WAY if key in tags), "")
    if not value and tags.get("junction") in ("roundabout", "circular"):
        return "yes"
    return {"true": "yes", "1": "yes", "reverse": "-1", "false": "no", "0": "no", "": "no"}.get(value, value)


def drawn_along(way: Way, notes: Notes) -> Way:
    """The way with a `oneway` of yes or no, drawn in the direction in which it is driven."""
    value = one_way(way.tags)
    tags = {key: text for key, text in way.tags.items() if key not in ONE_WAY}
    if value == "-1":
        return turned(way.with_tags({**tags, "oneway": "yes"}))
    if value == "reversible":
        notes.skip("one way", "oneway=reversible", spot_of(way), "its direction does not change with time; it is built as drawn")
        # netconvert takes motorways so by themselves; arrows of such lanes hold at times too
        return way.with_tags({**tags, "oneway": "reversible" if tags["highway"].startswith("motorway") else "yes"})
    if value == "alternating":
        notes.skip("one way", "oneway=alternating", spot_of(way), "directions do not take turns; both are built side by side")
    elif value not in ("yes", "no"):
        notes.skip("one way", f"oneway={value}", spot_of(way), "is no value of oneway; both directions are built")
    return way.with_tags({**tags, "oneway": "yes"} if value == "yes" else {**tags, "oneway": "no"} if "oneway" in way.tags else tags)


def turned(way: Way) -> Way:
    """The same way drawn from its end to its start, with all that it says of its directions."""
    swap = {"forward": "backward", "backward": "forward"}
    tags = {":".join(swap.get(part, part) for part in key.split(":")): value for key, value in way.tags.items()}
    gaps = frozenset(len(way.nodes) - 2 - gap for gap in way.gaps)
    return replace(way, nodes=way.nodes[::-1], points=way.points[::-1], tags=tags, gaps=gaps)


def note_value(way: Way, notes: Notes) -> None:
    """Tells of ways that are open, but not as any other, and of values that nobody knows."""
    for key, value in {access(way.tags, direction) for direction in (FORWARD, BACKWARD)}:
        parts = {each.strip() for each in (value or "yes").split(";")}
        if parts & TOLD and not parts & OPEN:
            notes.skip("access", f"{key}={value}", spot_of(way), "is built as open, with through traffic")
        elif parts - OPEN - TOLD - CLOSED:
            notes.skip("access", f"{key}={value}", spot_of(way), "is no value of access; it is built as open")
