"""On which side of the road one drives: what the map's tags say, else the country; near its border the roundabouts."""

from collections import Counter

import numpy as np

from studio.portable import arctan2
from studio.road.formats.country import Country
from studio.road.formats.way import Way
from studio.road.network.report import DriveSide, Side

SIDES: tuple[Side, Side] = ("left", "right")
ROUND = np.radians(60.0)  # [rad] a way that turns less tells nothing


def drive_side(ways: list[Way], country: Country) -> DriveSide:
    """The side for a whole map: netconvert builds one side only."""
    tagged = Counter(side for way in ways for side in SIDES if way.tags.get("driving_side") == side)
    if tagged:
        side, count = tagged.most_common(1)[0]
        return DriveSide(side, f"driving_side={side} on {count} of {tagged.total()} ways that have the tag")
    if not country.certain:
        turning = Counter(side for way in ways if (side := around(way)))
        if turning:
            side, count = turning.most_common(1)[0]
            return DriveSide(side, f"{count} of {turning.total()} roundabout ways; {country.name} is near a border")
        return DriveSide(country.drives, f"{country.name}, but a border to the other side may be near")
    return DriveSide(country.drives, country.name)


def around(way: Way) -> Side | None:
    """The side that a roundabout's direction tells of: the island lies on the driver's left where one drives right."""
    if way.tags.get("junction") not in ("roundabout", "circular"):
        return None
    turned = turning(way)
    if way.tags.get("oneway") == "-1":
        turned = -turned
    return None if abs(turned) < ROUND else "right" if turned > 0.0 else "left"


def turning(way: Way) -> float:
    """How far a way turns to the left from its start to its end [rad]."""
    longitude, latitude = np.array(way.points).T
    x, y = longitude * np.cos(np.radians(latitude[0])), latitude
    heading = arctan2(np.diff(y), np.diff(x))
    return float(((np.diff(heading) + np.pi) % (2.0 * np.pi) - np.pi).sum())
