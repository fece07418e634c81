"""Reads the limits of an OpenDRIVE document."""

import math
from xml.etree.ElementTree import Element

from studio.errors import MapError
from studio.road.formats.limit import FASTEST, MILE, NO_LIMIT
from studio.road.opendrive.element import number

UNITS = {"m/s": 1.0, "km/h": 1.0 / 3.6, "mph": MILE / 3.6}  # [m/s]


def read_speed(element: Element, where: str) -> float:
    """A limit [m/s]; not a number where none is named."""
    text, unit = element.get("max") or "undefined", element.get("unit") or "m/s"
    if text == "no limit":
        return NO_LIMIT / 3.6
    if text == "undefined":
        return math.nan
    if unit not in UNITS:
        raise MapError(f"{where}: unit of <speed> is unknown (got {unit!r}); allowed: {', '.join(UNITS)}")
    value = number(element, "max", where) * UNITS[unit]
    if not 0.0 <= value <= FASTEST / 3.6:
        raise MapError(f"{where}: max of <speed> is {text} {unit}; allowed: 0 to {FASTEST:g} km/h")
    return value or math.nan
