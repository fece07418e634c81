"""Reads the lanes of an OpenDRIVE road."""

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from xml.etree.ElementTree import Element

from studio.errors import MapError
from studio.road.opendrive.document import DRIVABLE, KEPT_FOR_OTHERS, Document, Section, Strip
from studio.road.opendrive.element import number, place, spared, whole
from studio.road.opendrive.reference_line import NOTHING, Profile
from studio.road.opendrive.speed import read_speed
from studio.road.opendrive.width import offset_of, width_of

SHORTEST = 1e-6  # [m] a section that is shorter is none
MOST_LANES = 64  # of one section
UNUSABLE = "cars cannot use lanes of this type"
SIDES = (("left", 1), ("right", -1))
CARS = {"passengerCar", "motorVehicle"}
DIRECTIONS = {"standard", "reversed", "both"}


def read_sections(element: Element, length: float, road: str, found: Document) -> Iterator[Section]:
    """The lane sections of a road, in order; raises MapError where there is none."""
    sections = element.findall("lanes/laneSection")
    if not sections:
        raise MapError(f"road {road}: <lanes> has no <laneSection>")
    made = (spared(found, "lane section", road, place(each, "s"), lambda each=each: start_of(each, road)) for each in sections)
    begun = sorted(((s, each) for s, each in zip(made, sections, strict=True) if s is not None), key=lambda pair: pair[0])
    before: Section | None = None
    for k, (s, each) in enumerate(begun):
        following = begun[k + 1][0] if k + 1 < len(begun) else math.inf
        if s >= length - min(SHORTEST, 0.5 * length) or (following <= s + SHORTEST and is_whole(each)):
            found.remark("lane section", f"from {s:g} m on", road, s, "has no length on its road")
            continue
        here = read_section(each, s, f"road {road}, <laneSection> at s = {s:g}", road, found)
        if before is not None:
            before, here = (before, here) if is_whole(each) else gone_on(before, here, each)
            yield before
        before = here
    if before is not None:
        yield before


def start_of(section: Element, road: str) -> float:
    """Where a section begins [m]; raises MapError."""
    s = number(section, "s", f"road {road}")
    if s < 0.0:
        raise MapError(f"road {road}, <laneSection> at s = {s:g}: lane sections begin from s = 0 on")
    return s


def is_whole(section: Element) -> bool:
    """Whether a section tells of both sides of its road, and not only of one."""
    return section.get("singleSide") not in ("true", "1")


def gone_on(before: Section, section: Section, element: Element) -> tuple[Section, Section]:
    """Two sections of which the second tells of one side only: on the other one the lanes of the first go on."""
    moved = before.s - section.s
    kept = {
        strip.id: strip for strip in before.strips.values() for side, sign in SIDES if sign * strip.id > 0 and not element.findall(side)
    }
    on = {
        name: replace(strip, before=(name,), width=Profile(strip.width.starts + moved, strip.width.k),
                      speeds=tuple((s + moved, speed) for s, speed in strip.speeds))
        for name, strip in kept.items()
    }  # fmt: skip
    led = {name: replace(strip, after=(name,)) for name, strip in kept.items()}
    return replace(before, strips=before.strips | led), replace(section, strips=section.strips | on)


def read_section(element: Element, s: float, where: str, road: str, found: Document) -> Section:
    """One lane section, with the lanes that cars cannot use noted."""
    strips, unused = {}, defaultdict(int)
    for side, sign in SIDES:
        for strip in read_side(element, side, sign, s, where, road, found):
            strips[strip.id] = strip
            if strip.type not in DRIVABLE | KEPT_FOR_OTHERS:
                unused[strip.type] += 1
    for kind, count in unused.items():
        found.remark("lane", f"{count} of type {kind}", road, s, UNUSABLE)
    return Section(s, strips)


def read_side(element: Element, side: str, sign: int, s: float, where: str, road: str, found: Document) -> Iterator[Strip]:
    """The lanes of one side, from the middle outwards. Where one cannot be read, nobody knows where those beyond it lie."""
    lanes = sorted(numbered(element.findall(f"{side}/lane"), sign, s, where, road, found), key=lambda pair: abs(pair[0]))
    if len(lanes) > MOST_LANES:
        found.remark("lane", f"{len(lanes) - MOST_LANES} lanes", road, s, f"{where}: <{side}> has more than {MOST_LANES} lanes")
    edge, seen = NOTHING, 0
    for name, lane in lanes[:MOST_LANES]:
        if abs(name) == seen:
            found.remark("lane", f"lane {name}", road, s, f"{where}: <lane> {name} stands twice; the first one counts")
            continue
        if abs(name) != seen + 1:
            found.derive(
                "lane numbers", f"lane {name} is {abs(name) - seen - 1} nearer to the middle", road, s, "lanes count from the middle"
            )
        seen = abs(name)
        made = spared(
            found, "lane", road, s, lambda name=name, lane=lane, edge=edge: read_strip(lane, name, sign, edge, s, where, road, found)
        )
        if made is None:
            beyond = [str(other) for other, _ in lanes if abs(other) > abs(name)]
            if beyond:
                found.remark("lane", f"lanes {', '.join(beyond)}", road, s, f"lie beyond lane {name}, which cannot be read")
            return
        strip, edge = made
        yield strip


def numbered(lanes: list[Element], sign: int, s: float, where: str, road: str, found: Document) -> Iterator[tuple[int, Element]]:
    """The lanes that have a number of their side."""
    for lane in lanes:
        name = spared(found, "lane", road, s, lambda lane=lane: whole(lane, "id", where))
        if name is not None and name * sign <= 0:
            found.remark("lane", f"lane {name}", road, s, f"{where}: <lane> {name} does not belong on this side")
        elif name is not None:
            yield name, lane


def read_strip(
    element: Element, name: int, sign: int, edge: Profile, s: float, where: str, road: str, found: Document
) -> tuple[Strip, Profile]:  # fmt: skip
    """One lane, and the border it ends at; its width is given, or is what lies between two borders. Raises MapError."""
    where = f"{where}, <lane> {name}"
    shape, outer = width_of(element, edge, sign, s, where, road, found)
    kind = element.get("type") or "none"
    strip = Strip(
        id=name,
        type=kind,
        width=shape,
        before=tuple(linked(element, "predecessor", s, where, road, found)),
        after=tuple(linked(element, "successor", s, where, road, found)),
        speeds=tuple(sorted(read_speeds(element, s, where, road, found))),
        open=kind not in KEPT_FOR_OTHERS and admits_cars(element, name, s, road, found),
        direction=direction_of(element, name, s, road, found),
    )
    return strip, outer


def direction_of(element: Element, lane: int, s: float, road: str, found: Document) -> str:
    """In which direction a lane is driven: as its side, against it, or in both."""
    direction = element.get("direction") or "standard"
    if direction not in DIRECTIONS:
        found.remark("lane direction", f"lane {lane}: {direction[:20]}", road, s, f"is unknown; allowed: {', '.join(sorted(DIRECTIONS))}")
        direction = "standard"
    for name, value in (("dynamicLaneDirection", "true"), ("dynamicLaneType", "true"), ("roadWorks", "true")):
        if element.get(name) == value:
            found.remark("lane", f"lane {lane}: {name}", road, s, "lanes do not change with time")
    if element.get("advisory") not in (None, "none"):
        found.remark("lane", f"lane {lane}: advisory={element.get('advisory')}", road, s, "advisory lines are not looked at")
    return "both" if element.get("type") == "bidirectional" and direction == "standard" else direction


def linked(element: Element, tag: str, s: float, where: str, road: str, found: Document) -> Iterator[int]:
    """The lanes that a lane is linked to at one end."""
    for each in element.findall(f"link/{tag}"):
        name = spared(found, "lane link", road, s, lambda each=each: whole(each, "id", where))
        if name:
            yield name


def read_speeds(element: Element, s: float, where: str, road: str, found: Document) -> Iterator[tuple[float, float]]:
    """The limits of a lane: distance [m] from the section's start, limit [m/s]."""
    for each in element.findall("speed"):
        made = spared(found, "speed", road, s, lambda each=each: (offset_of(each, s, where, road, found), read_speed(each, where)))
        if made is not None:
            yield made


def admits_cars(element: Element, lane: int, s: float, road: str, found: Document) -> bool:
    """Whether cars may use a lane; `<access>` names who may (rule allow) or may not (deny). What is not about cars is told."""
    rules = defaultdict(set)
    for each in element.findall("access"):
        named = {each.get("restriction") or ""} | {r.get("type") or "" for r in each.findall("restriction")}
        rules[each.get("rule") or "deny"] |= named
        if place(each, "sOffset") > 0.0:
            found.remark("access", f"lane {lane}: from {each.get('sOffset')} m on", road, s, "holds for the whole section")
    others = {f"{rule} {who}" for rule, named in rules.items() for who in named - CARS if who}
    if others:
        found.remark("access", f"lane {lane}: {', '.join(sorted(others))}", road, s, "lanes are open or closed to cars, and no more")
    return not CARS & rules["deny"] and (not rules["allow"] or bool(CARS & rules["allow"]))
