"""The tags of car ways and of their nodes that say something about driving and are not used: each with the reason that is told.

Keys are those of the OpenStreetMap wiki (Map features: Highway, Restrictions, Lanes, Barrier, Traffic calming; Key:…). A key may be
said for a direction, a side, a lane or a condition (`overtaking:forward:conditional`); then the reason of the key holds. What is used
stands where it is used, in netconvert or in this package. Values that change nothing are told of nobody.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from studio.road.formats.access import KEYS
from studio.road.formats.identity import named
from studio.road.formats.way import Way, spot_of
from studio.road.network.report import Notes, Spot

TIMES = "nothing changes with time"
LIMITS = "one limit holds for all lanes and vehicles"
SIZES = "vehicles of every size and weight drive there"
LINES = "lines between lanes forbid nothing"
SHAPE = "lanes have one width, about the line of their way"
NARROW = "nobody waits but on streets with one lane for both directions"
GROUND = "roads are even, dry and paved unless the scenario says otherwise"
BESIDE = "lanes of others are not built"
CLASSES = "who may drive there is asked for cars alone"
PARKED = "who may park where, and for how long, is not asked"
NO_ROAD = "at the junction itself it does not say for which road; stop=all, stop=minor or a place before the junction would"
SIGNED = "junctions are what the ways that meet make of them"
WAYS = {
    "maxspeed:lanes": LIMITS, "maxspeed:hgv": LIMITS, "maxspeed:bus": LIMITS, "maxspeed:trailer": LIMITS, "maxspeed:variable": LIMITS,
    "maxspeed:advisory": LIMITS, "maxspeed:practical": LIMITS, "maxspeed:hazard": LIMITS, "maxspeed:wet": LIMITS, "minspeed": LIMITS,
    "overtaking": "drivers overtake where lanes allow it", "change": LINES, "change:lanes": LINES, "lane_markings": LINES, "divider": LINES,
    "placement": SHAPE, "placement:end": SHAPE, "placement:start": SHAPE, "width:lanes": SHAPE, "width:carriageway": SHAPE,
    "est_width": SHAPE, "width:start": SHAPE, "width:end": SHAPE, "lanes:transition": SHAPE, "transition": SHAPE, "narrow": SHAPE,
    "turn": "arrows are read of lanes, not of ways", "hov": "only lanes and ways closed to cars are known", "hgv": SIZES, "goods": SIZES,
    "hov:lanes": "lanes for several passengers are open to all", "taxi:lanes": BESIDE, "bicycle:lanes": BESIDE, "hgv:lanes": SIZES,
    "motorcar:lanes": "lanes are closed by access:lanes, vehicle:lanes, motor_vehicle:lanes, bus:lanes or psv:lanes",
    "maxweight": SIZES, "maxheight": SIZES, "maxlength": SIZES, "maxwidth": SIZES, "maxaxleload": SIZES, "maxweightrating": SIZES,
    "maxbogieweight": SIZES, "maxheight:physical": SIZES, "maxwidth:physical": SIZES, "toll": "nobody pays", "motorroad": LIMITS,
    "traffic_calming": GROUND, "incline": "heights come from ele of nodes", "surface": GROUND, "smoothness": GROUND, "tracktype": GROUND,
    "ford": GROUND, "winter_road": GROUND, "ice_road": GROUND, "embedded_rails": GROUND, "flood_prone": GROUND, "seasonal": TIMES,
    "hazard": "drivers see hazards, not signs", "shoulder": BESIDE, "cycleway": BESIDE, "busway": BESIDE, "passing_places": SHAPE,
    "priority": NARROW, "traffic_sign": "signs count by the tags of what they mean",
    "bicycle_road": "drivers do not mind cyclists more than elsewhere", "cyclestreet": "drivers do not mind cyclists more than elsewhere",
    "tunnel": "who crosses above is not met; drawn below the ground where roads cross", "covered": "roofs over roads are not built",
    "bridge": "who crosses below is not met; drawn above the ground where roads cross",
    "layer": "who crosses on another layer is not met; drawn off the ground where roads cross",
    "cutting": "ground is level but for ramps", "embankment": "ground is level but for ramps",
    "lhv": CLASSES, "hazmat": CLASSES, "trailer": CLASSES, "caravan": CLASSES, "motorhome": CLASSES, "coach": CLASSES,
    "tourist_bus": CLASSES, "junction": SIGNED,
    "bridge:movable": "bridges do not open", "temporary": TIMES, "opening_hours": TIMES, "lanes:hov": BESIDE, "reversible": TIMES,
}  # fmt: skip
FAMILIES = {  # of keys with more behind them than is known, such as maxheight:lanes
    *(
        "maxheight",
        "maxwidth",
        "maxlength",
        "maxweight",
        "maxaxleload",
        "surface",
        "smoothness",
        "incline",
        "hgv",
        "goods",
        "hazmat",
        "change",
    ),
    *("overtaking", "width", "placement", "hov"),
}
USED_LIMITS = {"maxspeed", "maxspeed:conditional", "maxspeed:type", "maxspeed:source", "source:maxspeed"}
RULES = {"restriction", "maxstay", "condition", "access", "authentication", "fee"}  # of parking
SILENT = {
    "surface": {"asphalt", "paved", "concrete", "chipseal", "concrete:plates"},
    "smoothness": {"excellent", "good", "intermediate"},
    "layer": {"0"},
    "maxheight": {"default", "below_default", "unsigned"},
    "lane_markings": {"yes"},
    "hgv": {"yes", "designated", "permissive"},
    "goods": {"yes", "designated", "permissive"},
    "incline": {"0", "0%"},
    "junction": {"roundabout", "circular", "yes", "intersection", "uncontrolled"},
}
NOTHING = {"no", "none", "separate", "unspecified"}
FORBID = {"overtaking", "lane_markings", "change", "hgv", "goods"}
NODES = {
    "traffic_calming": GROUND, "hazard": "drivers see hazards, not signs", "ford": GROUND, "maxheight": SIZES, "maxwidth": SIZES,
    "maxweight": SIZES, "toll": "nobody pays", "traffic_sign": "signs count by the tags of what they mean",
    "priority": NARROW, "overtaking": "drivers overtake where lanes allow it",
    "give_way": "signs are read from highway", "maxspeed": LIMITS, "railway": "trains and trams do not run", "crossing:barrier": TIMES,
    "bridge:movable": "bridges do not open",
}  # fmt: skip
PLACES = {  # highway=… of a node
    "turning_circle": "turning places are not wider than their road",
    "turning_loop": "turning places are not wider than their road",
    "passing_place": SHAPE,
    "speed_camera": "nobody is caught",
    "toll_gantry": "nobody pays",
    "traffic_mirror": "drivers see what they can see themselves",
    "ford": GROUND,
}
MODES = {*FAMILIES, *KEYS, "oneway", "maxspeed", "lanes", "turn", "overtaking", "hov", "change", "parking", "bus", "psv", "restriction"}


def tell(ways: Iterable[Way], nodes: Mapping[int, Mapping[str, str]], notes: Notes) -> None:
    """Tells what the ways that are kept, and their nodes, say of driving and is not used; one entry for each of them."""
    seen: set[int] = set()
    ways = list(ways)
    arms = Counter(node for way in ways for node in (*way.nodes, *way.nodes[1:-1]))
    for way in ways:
        entry(unused(way.tags), spot_of(way), notes)
        for node, (longitude, latitude) in zip(way.nodes, way.points, strict=True):
            if node in nodes and node not in seen:
                seen.add(node)
                name = named("node", node)
                spot = Spot(name, latitude, longitude, name)
                entry(unused_of_node(nodes[node]), spot, notes)
                if arms[node] > 2 and is_of_no_road(nodes[node]):
                    notes.skip("sign", f"highway={nodes[node]['highway']}", spot, NO_ROAD)


def is_of_no_road(tags: Mapping[str, str]) -> bool:
    """Whether a sign at a junction does not say for which of its roads it counts."""
    return tags.get("highway") in ("stop", "give_way") and not {tags.get("stop"), tags.get("give_way")} & {"all", "minor"}


def entry(found: Iterator[tuple[str, str]], spot: Spot, notes: Notes) -> None:
    """One entry for all that is not used of an element."""
    reasons = dict(found)
    if reasons:
        notes.skip("tags", ", ".join(reasons), spot, "; ".join(dict.fromkeys(reasons.values())))


def unused(tags: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """The tags of a way that are not used, and why.

    >>> dict(unused({"overtaking:forward": "no", "name": "A 1", "maxheight": "3.8"}))
    {'overtaking:forward=no': 'drivers overtake where lanes allow it', 'maxheight=3.8': 'vehicles of every size and weight drive there'}
    """
    for key, value in tags.items():
        reason = reason_of(key)
        if reason and not says_nothing(key, value) and not is_sign(tags, key):
            yield f"{key}={value[:60]}", reason


def reason_of(key: str) -> str:
    """Why a key of a way is not used, or nothing."""
    parts = key.split(":")
    if "conditional" in parts:
        return TIMES if parts[0] in MODES and key != "maxspeed:conditional" else ""
    plain = ":".join(part for part in parts if part not in ("forward", "backward", "left", "right", "both"))
    return WAYS.get(plain, "") or reason_of_family(parts[0], plain)


def reason_of_family(first: str, plain: str) -> str:
    """Why a key is not used that says more than its first word, or nothing."""
    if first == "parking":
        return PARKED if RULES & set(plain.split(":")) else ""
    if first == "maxspeed":
        return LIMITS if plain not in USED_LIMITS else ""
    return WAYS.get(first, SHAPE if first == "width" else "") if first in FAMILIES and plain != first else ""


def is_sign(tags: Mapping[str, str], key: str) -> bool:
    """Whether a key tells who goes first on a street with one lane."""
    return key == "priority" and tags.get("lanes") == "1" and tags[key] in ("forward", "backward")


def says_nothing(key: str, value: str) -> bool:
    """Whether a value is what is built anyway."""
    name = key.partition(":")[0]
    is_rule = name in FORBID or WAYS.get(name) == CLASSES  # of which a no says something
    return (value in NOTHING and not is_rule) or value in SILENT.get(name, ())


def unused_of_node(tags: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """The tags of a node on a way that are not used, and why."""
    if reason := PLACES.get(tags.get("highway", "")):
        yield f"highway={tags['highway']}", reason
    for key in (key for key in tags if key in NODES):
        if not says_nothing(key, tags[key]):
            yield f"{key}={tags[key][:60]}", NODES[key]
    closing = [key for key in ("barrier", *KEYS) if key in tags]
    is_barred = tags.get("barrier") not in (None, "kerb", "entrance", "no")
    if is_barred or any(tags.get(key) in ("no", "private") for key in KEYS):
        yield ", ".join(f"{key}={tags[key]}" for key in closing), "cars drive through; a road ends at no node"
