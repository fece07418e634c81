"""Values of XML elements, checked; and the rule that a flawed element costs that element."""

import math
from collections.abc import Callable
from typing import TypeVar
from xml.etree.ElementTree import Element

from studio.errors import MapError
from studio.road.opendrive.document import Document

LARGEST = 1e9  # of any number
T = TypeVar("T")


def number(element: Element, name: str, where: str, default: float | None = None) -> float:
    """A finite number in an attribute; raises MapError."""
    text = element.get(name)
    if text is None and default is not None:
        return default
    try:
        value = math.nan if text is None else float(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= LARGEST:
        what = "is missing" if text is None else f"is no number that a road has (got {text[:40]!r})"
        raise MapError(f"{where}: {name} of <{element.tag}> {what}")
    return value


def whole(element: Element, name: str, where: str) -> int:
    """A whole number in an attribute; raises MapError."""
    value = number(element, name, where)
    if value != int(value):
        raise MapError(f"{where}: {name} of <{element.tag}> is not a whole number (got {element.get(name)!r})")
    return int(value)


def place(element: Element, name: str) -> float:
    """A station for a remark [m]: 0 where there is none."""
    try:
        return number(element, name, "", 0.0)
    except MapError:
        return 0.0


def spared(found: Document, kind: str, road: str, s: float, read: Callable[[], T]) -> T | None:
    """What a reader makes of an element; where it cannot be used, that is told, and nothing else is lost."""
    try:
        return read()
    except MapError as error:
        found.remark(kind, f"a flawed {kind}", road, s, error.message)
        return None
