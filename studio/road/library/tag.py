"""What a correction may say: the tags of OpenStreetMap that the importer reads, and the values that it understands.

Meanings are those of OpenStreetMap's wiki: Key:lanes, Key:maxspeed (km/h where no unit stands), Key:width (of the whole way, in
metres), Key:turn:lanes (from left to right as one drives). Other tags are taken as they are, as long as they are tags.
"""

import re
from collections.abc import Callable, Iterable
from typing import Any

from studio.errors import MapError, Problem
from studio.road.assembly.turn import ANGLE
from studio.road.formats.correction import Correction
from studio.road.formats.limit import FASTEST, kilometres_per_hour
from studio.road.formats.osm import CAR_WAYS, MOST_LANES, SMALL_WAYS
from studio.road.scenery import LARGEST_HEIGHT, metres

ELEMENT = re.compile(r"(node|way|relation) -?[1-9][0-9]{0,17}")
LONGEST = 255  # characters of a key or value, OpenStreetMap's own limit
MOST_TAGS = 50  # of one correction
NARROWEST_WAY, WIDEST_WAY = 1.5, 100.0  # [m]
SIGNS = {"traffic_signals", "crossing", "stop", "give_way", "turning_circle", "mini_roundabout", "motorway_junction", "street_lamp"}


def correction(element: str, tags: dict[str, str], removed: Iterable[str] = ()) -> Correction:
    """A correction whose values are understood.

    Raises:
        MapError: no such element can be, there is nothing to correct, or a value means nothing; with all problems.
    """
    removed = tuple(sorted(set(removed)))
    problems = [*element_problems(element), *size_problems(tags, removed)]
    if not problems:
        problems = [each for key, value in tags.items() for each in tag_problems(element, key, value)]
        problems += [each for key in removed for each in text_problems("removed key", key)]
    if problems:
        raise MapError("The correction cannot be made.", problems)
    return Correction(element, dict(sorted(tags.items())), removed)


def from_json(value: Any) -> Correction:
    """A correction as it stands in corrections.json; raises MapError."""
    given = value if isinstance(value, dict) else {}
    element, tags, removed = given.get("element"), given.get("tags"), given.get("removed")
    is_sound = isinstance(element, str) and isinstance(tags, dict) and isinstance(removed, list)
    if not is_sound or not all(isinstance(each, str) for each in (*tags, *tags.values(), *removed)):
        raise MapError("The correction cannot be made.", [Problem("correction", "is none", repr(value)[:80], "element, tags, removed")])
    return correction(element, tags, removed)


# -- what is wrong -----------------------------------------------------------------------------------


def element_problems(element: str) -> list[Problem]:
    """What is wrong with the name of an element."""
    if ELEMENT.fullmatch(element):
        return []
    return [Problem("element", "names no element of a map", repr(element[:60]), 'such as "way 4711", "node 7" or "relation 5"')]


def size_problems(tags: dict[str, str], removed: tuple[str, ...]) -> list[Problem]:
    """What is wrong with the number of tags, and with keys on both lists."""
    if not tags and not removed:
        return [Problem("tags", "say nothing", "", "at least one tag to set or to remove", "such as lanes=2")]
    if len(tags) + len(removed) > MOST_TAGS:
        return [Problem("tags", "are too many", str(len(tags) + len(removed)), f"at most {MOST_TAGS}")]
    return [Problem(key, "is both set and removed", remedy="choose one") for key in removed if key in tags]


def tag_problems(element: str, key: str, value: str) -> list[Problem]:
    """What is wrong with a tag."""
    found = [*text_problems("key", key), *text_problems(key, value)]
    if found:
        return found
    understood, allowed = highway(element) if key == "highway" else CHECKS.get(key, ANYTHING)
    return [] if understood(value) else [Problem(key, "has a value that means nothing", value, allowed)]


def text_problems(where: str, text: str) -> list[Problem]:
    """What is wrong with a key or value as text."""
    if not text.strip() or text != text.strip():
        return [Problem(where, "is empty, or begins or ends with a space", repr(text[:60]), remedy="to take a tag away, remove its key")]
    if len(text) > LONGEST:
        return [Problem(where, "is too long", f"{len(text)} characters", f"at most {LONGEST}")]
    if not text.isprintable():  # control characters and half characters, which no XML holds
        return [Problem(where, "holds characters that cannot be printed", ascii(text[:60]))]
    return []


# -- what values mean ------------------------------------------------------------------------------

Check = tuple[Callable[[str], bool], str]  # whether a value is understood, and what is allowed


def is_count(text: str) -> bool:
    """Whether a text is a number of lanes."""
    return re.fullmatch(r"[0-9]{1,2}", text) is not None and 1 <= int(text) <= MOST_LANES


def is_limit(text: str) -> bool:
    """Whether a text is a speed limit."""
    return kilometres_per_hour(text) is not None


def is_width(text: str) -> bool:
    """Whether a text is a width in metres."""
    found = re.fullmatch(r"(\d+(?:[.,]\d+)?)\s*m?", text)
    return found is not None and NARROWEST_WAY <= float(found[1].replace(",", ".")) <= WIDEST_WAY


def is_height(text: str) -> bool:
    """Whether a text is a height."""
    return re.fullmatch(r"\d+(?:[.,]\d+)?\s*(m|ft|feet|')?", text) is not None and 0.0 < metres(text) <= LARGEST_HEIGHT


def are_arrows(text: str) -> bool:
    """Whether a text says where each lane leads: `left|through;right|` has three lanes, the last without an arrow."""
    lanes = text.split("|")
    return len(lanes) <= MOST_LANES and all(arrow in (*ANGLE, "none", "") for lane in lanes for arrow in lane.split(";"))


def one_of(*allowed: str) -> Check:
    """A check for one of some words."""
    return lambda text: text in allowed, ", ".join(allowed)


def highway(element: str) -> Check:
    """The check for `highway`: kinds of roads on ways, signs on nodes."""
    return one_of(*sorted(SIGNS)) if element.startswith("node") else one_of(*sorted(CAR_WAYS | SMALL_WAYS))


ANYTHING: Check = (lambda text: True, "")
COUNT: Check = (is_count, f"a whole number from 1 to {MOST_LANES}")
LIMIT: Check = (is_limit, f"a speed above 0 up to {FASTEST:g} km/h such as 50 or 30 mph, a zone such as DE:urban, none or walk")
WIDTH: Check = (is_width, f"{NARROWEST_WAY:g} to {WIDEST_WAY:g} m, of all lanes together")
HEIGHT: Check = (is_height, f"a height above 0 up to {LARGEST_HEIGHT:g} m")
ARROWS: Check = (are_arrows, f"for each lane from left to right {', '.join(ANGLE)} or none; | between lanes, ; between arrows of one")
CHECKS: dict[str, Check] = {
    **dict.fromkeys(("lanes", "lanes:forward", "lanes:backward"), COUNT),
    **dict.fromkeys(("maxspeed", "maxspeed:forward", "maxspeed:backward"), LIMIT),
    **dict.fromkeys(("turn:lanes", "turn:lanes:forward", "turn:lanes:backward"), ARROWS),
    **dict.fromkeys(("height", "min_height"), HEIGHT),
    "width": WIDTH,
    "building:levels": (lambda text: re.fullmatch(r"\d{1,3}", text) is not None, "a whole number up to 999"),
    "oneway": one_of("yes", "no", "-1"),
    "driving_side": one_of("left", "right"),
}
