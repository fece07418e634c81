"""What lies across a way: lane widths that a car fits into, and lanes that are kept for buses.

A mapped width is often that of the whole carriageway with its parked cars, or of what is left between them.
"""

import re

from studio.road.assembly.shared import NARROWEST, is_shared
from studio.road.formats.correction import text
from studio.road.formats.osm import MOST_LANES
from studio.road.formats.way import Way, is_one_way, spot_of
from studio.road.network.report import Notes

WIDEST_LANE = 4.5  # [m] of a lone lane (RASt 06)
NEITHER = ("both_ways", "reversible")
COUNTS = ("lanes", "lanes:forward", "lanes:backward")
BUS_COUNTS = ("lanes:psv", "lanes:bus")
PER_LANE = ("bus:lanes", "psv:lanes", "access:lanes", "vehicle:lanes", "motor_vehicle:lanes")


def mended(way: Way, notes: Notes, *, left_hand: bool) -> Way:
    """The way with a width that its lanes can have, and with its bus lanes at the kerb."""
    counted = with_room_to_meet(without_shared_lanes(with_counts(way, notes), notes), notes)
    return with_bus_lanes(with_width(counted, notes), notes, left_hand=left_hand)


def with_counts(way: Way, notes: Notes) -> Way:
    """The way without numbers of lanes that cannot be read or meant; they are noted."""
    bad = {key: way.tags[key] for key in COUNTS if key in way.tags and not is_count(way.tags[key])}
    for key, value in bad.items():
        notes.skip("lanes", f"{key}={value[:40]}", spot_of(way), f"no number of lanes from 1 to {MOST_LANES}")
    return way.with_tags({key: value for key, value in way.tags.items() if key not in bad}) if bad else way


def without_shared_lanes(way: Way, notes: Notes) -> Way:
    """The way without lanes that belong to neither direction, a centre turn lane for instance: netconvert would make them through lanes."""
    own = {key: value for key, value in way.tags.items() if any(part in NEITHER for part in key.split(":"))}
    if not own:
        return way
    notes.skip("lanes", text(own, ()), spot_of(way), "lanes of both directions are not built; cars turn from the lanes of their own")
    tags = {key: value for key, value in way.tags.items() if key not in own}
    count = sum(int(own[f"lanes:{part}"]) for part in NEITHER if is_count(own.get(f"lanes:{part}", "")))
    if "lanes" in tags and int(tags["lanes"]) > count:
        tags["lanes"] = str(int(tags["lanes"]) - count)
    return way.with_tags(tags)


def with_room_to_meet(way: Way, notes: Notes) -> Way:
    """A two-way street with one lane gets two narrow ones. Where these have no room beside each other shared.py lays them on one ground."""
    if is_one_way(way) or way.tags["highway"].startswith("motorway") or way.tags.get("lanes") != "1":
        return way
    others = {key: value for key, value in way.tags.items() if key not in COUNTS}
    if not is_shared(way):
        source = "lanes=1 for both directions, and wide enough for two: cars pass each other"
        notes.guess("one lane", "two lanes", spot_of(way), source=source, sure="medium", key="lanes")
    return way.with_tags({"width": f"{2.0 * NARROWEST:g}"} | others | {"lanes": "2"})


def is_count(count: str) -> bool:
    """Whether a tag is a number of lanes that a way can have.

    >>> is_count("3"), is_count("2.5"), is_count("99999"), is_count("abc")
    (True, False, False, False)
    """
    return count.isdecimal() and len(count) < 6 and 0 < int(count) <= MOST_LANES


def with_width(way: Way, notes: Notes) -> Way:
    """The way with a width [m] that makes lanes of `NARROWEST` to `WIDEST_LANE`; without one that cannot be read."""
    if "width" not in way.tags:
        return way
    mapped = way.tags["width"]
    others = {key: value for key, value in way.tags.items() if key != "width"}
    found = re.fullmatch(r"(\d+(?:[.,]\d+)?)\s*m?", mapped.strip())
    if not found:
        notes.skip("width", f"width={mapped}", spot_of(way), "no width in metres")
        return way.with_tags(others)
    lanes = lane_count(way)
    width = float(found[1].replace(",", ".")) / lanes
    taken = min(WIDEST_LANE, max(NARROWEST, width))
    if taken != width:
        source = f"width={mapped} for {lanes} lanes"
        notes.guess("lane width", f"{taken:g} m", spot_of(way), source=source, sure="medium", key="width")
    return way.with_tags({**others, "width": f"{taken * lanes:.2f}"})


def lane_count(way: Way) -> int:
    """Lanes of a way in both directions together, as mapped or one each way."""
    lanes = way.tags.get("lanes", "")
    return int(lanes) if lanes.isdigit() and int(lanes) > 0 else 1 if is_one_way(way) else 2


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
