"""What lies across a way: lane widths that a car fits into, and lanes that are kept for buses.

A mapped width is often that of the whole carriageway with its parked cars, or of what is left between them.
"""

import re

from studio.road.formats.osm import MOST_LANES, Way, is_one_way, spot_of
from studio.road.network.report import Notes

NARROWEST, WIDEST_LANE = 2.5, 4.5  # [m] of a lane (RASt 06: 2.75 to 3.50 m; a lone one up to 4.5 m)
COUNTS = ("lanes", "lanes:forward", "lanes:backward")
BUS_COUNTS = ("lanes:psv", "lanes:bus")
PER_LANE = ("bus:lanes", "psv:lanes", "access:lanes", "vehicle:lanes", "motor_vehicle:lanes")


def mended(way: Way, notes: Notes, *, left_hand: bool) -> Way:
    """The way with a width that its lanes can have, and with its bus lanes at the kerb."""
    return with_bus_lanes(with_width(with_counts(way, notes), notes), notes, left_hand=left_hand)


def with_counts(way: Way, notes: Notes) -> Way:
    """The way without numbers of lanes that cannot be read or meant; they are noted."""
    bad = {key: way.tags[key] for key in COUNTS if key in way.tags and not is_count(way.tags[key])}
    for key, text in bad.items():
        notes.skip("lanes", f"{key}={text[:40]}", spot_of(way), f"no number of lanes from 1 to {MOST_LANES}")
    return way.with_tags({key: value for key, value in way.tags.items() if key not in bad}) if bad else way


def is_count(text: str) -> bool:
    """Whether a tag is a number of lanes that a way can have.

    >>> is_count("3"), is_count("2.5"), is_count("99999"), is_count("abc")
    (True, False, False, False)
    """
    return text.isdecimal() and len(text) < 6 and 0 < int(text) <= MOST_LANES


def with_width(way: Way, notes: Notes) -> Way:
    """The way with a width [m] that makes lanes of `NARROWEST` to `WIDEST_LANE`; without one that cannot be read."""
    if "width" not in way.tags:
        return way
    text = way.tags["width"]
    others = {key: value for key, value in way.tags.items() if key != "width"}
    found = re.fullmatch(r"(\d+(?:[.,]\d+)?)\s*m?", text.strip())
    if not found:
        notes.skip("width", f"width={text}", spot_of(way), "no width in metres")
        return way.with_tags(others)
    lanes = lane_count(way)
    width = float(found[1].replace(",", ".")) / lanes
    taken = min(WIDEST_LANE, max(NARROWEST, width))
    if taken != width:
        source = f"width={text} for {lanes} lanes"
        notes.guess("lane width", f"{taken:g} m", spot_of(way), source=source, sure="medium", key="width")
    return way.with_tags({**others, "width": f"{taken * lanes:.2f}"})


def lane_count(way: Way) -> int:
    """Lanes of a way in both directions together, as mapped or one each way."""
    text = way.tags.get("lanes", "")
    return int(text) if text.isdigit() and int(text) > 0 else 1 if is_one_way(way) else 2


def with_bus_lanes(way: Way, notes: Notes, *, left_hand: bool) -> Way:
    """A one-way way that has bus lanes by number only gets them at its kerb; those for some hours stay open."""
    lanes = lane_count(way)
    count = next((int(way.tags[key]) for key in BUS_COUNTS if way.tags.get(key, "").isdigit()), 0)
    at_times = any(f"{key}:conditional" in way.tags for key in BUS_COUNTS)
    if not 0 < count < lanes or at_times or not is_one_way(way) or any(key in way.tags for key in PER_LANE):
        return way
    notes.guess("bus lane", f"{count} at the kerb", spot_of(way), source="lanes:bus or lanes:psv", sure="high", key="bus:lanes")
    marks = [*("yes",) * (lanes - count), *("designated",) * count]
    return way.with_tags({**way.tags, "bus:lanes": "|".join(reversed(marks) if left_hand else marks)})
