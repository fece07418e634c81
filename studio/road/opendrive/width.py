"""The widths of the lanes of an OpenDRIVE road: cubics in the distance from the start of their section, given or between two borders.

A width that no lane can have, and a record that does not say where it holds, is told: a lane that is too narrow is no lane.
"""

from collections.abc import Sequence
from xml.etree.ElementTree import Element

import numpy as np

from studio.errors import MapError
from studio.road.opendrive.document import DRIVABLE, KEPT_FOR_OTHERS, Document, Section, Strip, XRoad
from studio.road.opendrive.element import number
from studio.road.opendrive.reference_line import NOTHING, Profile

WIDEST_LANE = 100.0  # [m] above this a width is a slip
NARROWEST = 1.8  # [m] a narrower lane holds no car
NONE = 0.05  # [m] what is narrower has run out; programs write widths that end so far below 0
PLACES = 33  # at which a width is looked at along a section


def width_of(
    element: Element, edge: Profile, sign: int, s: float, where: str, road: str, found: Document
) -> tuple[Profile, Profile]:  # fmt: skip
    """The width of a lane beyond an edge, and the border it ends at where that is what is given; raises MapError."""
    width, border = (element.findall(tag) for tag in ("width", "border"))
    if width or not border:
        shape, outer = cubics(width, s, where, road, found), NOTHING
    else:
        outer = cubics(border, s, where, road, found)
        shape = difference(outer, edge, sign)
    if shape.starts.size and np.abs(shape.k[0]).max() > WIDEST_LANE:
        raise MapError(f"{where}: it is {np.abs(shape.k[0]).max():g} m wide; allowed: up to {WIDEST_LANE:g} m")
    return shape, outer


def cubics(elements: list[Element], s: float, where: str, road: str, found: Document) -> Profile:
    """The widths or borders of a lane in a section that begins at s [m]; raises MapError."""
    rows = [(offset_of(each, s, where, road, found), *(number(each, name, where) for name in "abcd")) for each in elements]
    if not rows:
        return NOTHING
    rows = in_order(rows, elements[0].tag, where, road, found)
    if rows[0][0] > NONE:
        what = f"none for {rows[0][0]:g} m"
        found.remark(elements[0].tag, what, road, s, f"{where}: its first <{elements[0].tag}> begins so late; allowed: with its section")
    table = np.array(rows).T
    return Profile(table[0].copy(), table[1:].copy())


def offset_of(element: Element, s: float, where: str, road: str, found: Document) -> float:
    """From which distance [m] after the section's start a record holds; raises MapError.

    Some write `s`, which is the station along the road everywhere else in the standard, in place of `sOffset`.
    """
    if element.get("sOffset") is not None:
        return number(element, "sOffset", where)
    station = number(element, "s", where, s)
    offset = station - s if station >= s else station
    source = f"{where}: <{element.tag}> has no sOffset" + (f", but s = {station:g}" if element.get("s") is not None else "")
    found.derive(element.tag, f"from {offset:g} m after the section's start", road, s, source)
    return offset


def in_order(rows: Sequence[tuple[float, ...]], tag: str, where: str, road: str, found: Document) -> list[tuple[float, ...]]:
    """Records by where they begin; of several that begin at one place the last counts, which is told."""
    last = {row[0]: row for row in rows}
    if len(last) < len(rows):
        found.remark(tag, f"{len(rows) - len(last)} <{tag}>", road, 0.0, f"{where}: several begin at the same place; the last one counts")
    return sorted(last.values())


def difference(outer: Profile, inner: Profile, sign: int) -> Profile:
    """How far one border lies beyond another."""
    starts = np.union1d(outer.starts, inner.starts)
    columns = [[sign * (a - b) for a, b in zip(moved(outer, s), moved(inner, s), strict=True)] for s in starts]
    return Profile(starts, np.array(columns).T)


def moved(of: Profile, s: float) -> np.ndarray:
    """The coefficients that hold from s on, for the distance from there (Taylor's expansion)."""
    i = int(np.searchsorted(of.starts, s, side="right")) - 1
    if i < 0:
        return np.zeros(4)
    a, b, c, d = of.k[:, i]
    h = s - of.starts[i]
    return np.array([a + h * (b + h * (c + h * d)), b + h * (2 * c + h * 3 * d), c + 3 * d * h, d])


def is_wide(road: XRoad, section: Section, strip: Strip, end: float, found: Document) -> bool:
    """Whether a car fits into a lane somewhere on its section, which goes to a station [m]; a flawed or too small width is told."""
    along = np.linspace(0.0, end - section.s, PLACES)
    width = strip.width.at(along)
    low, high = float(width.min()), float(width.max())
    where = f"road {road.id}, <laneSection> at s = {section.s:g}, <lane> {strip.id}"
    if low < -NONE:
        at = section.s + along[int(width.argmin())]
        reason = f"{where}: it is {low:g} m wide at s = {at:g}; allowed: 0 to {WIDEST_LANE:g} m; 0 m is taken: correct its <width>"
        found.remark("lane", f"lane {strip.id}: width {low:g} m", road.id, at, reason)
    elif strip.type in DRIVABLE | KEPT_FOR_OTHERS and (NONE < high < NARROWEST or not strip.width.starts.size):
        what = f"it is {high:.2f} m wide at most" if strip.width.starts.size else "it has no <width> and no <border>"
        found.remark("lane", f"lane {strip.id}", road.id, section.s, f"{where}: {what}; a car needs {NARROWEST:g} m")
    return high >= NARROWEST
