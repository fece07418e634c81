"""Reads the signals of an OpenDRIVE road: lights, and the signs that say who goes first; others are told.

Types of signs are those of a country's catalogue of signs: Germany, StVO annexes 2 and 3; United States, MUTCD part 2B; Sweden,
vägmärkesförordningen (2007:90); Switzerland, SSV annex 2; France, arrêté du 24 novembre 1967; United Kingdom, TSRGD 2016; the
Netherlands, RVV 1990 annex 1. Simulators write the German numbers without a country.
"""

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from studio.errors import MapError
from studio.road.opendrive.document import Document, Signal
from studio.road.opendrive.element import number, place, spared, whole

CAR_LIGHTS = {"1000001", "1000008", "1000009", "1000010", "1000011", "1000012"}  # three lamps, two, arrows
OTHER_LIGHTS = {"1000002", "1000003", "1000007", "1000013", "1000014", "1000015"}  # for people on foot and on bicycles, trams
GERMAN = {"205": "yield", "206": "stop", "301": "priority", "306": "priority"}
SIGNS = {
    ("DE", "DEU", "GER", "D"): GERMAN,
    ("US", "USA"): {"R1-1": "stop", "R1-2": "yield"},
    ("SE", "SWE", "S"): {"B1": "yield", "B2": "stop", "B4": "priority"},
    ("CH", "CHE"): {"3.01": "stop", "3.02": "yield", "3.03": "priority"},
    ("FR", "FRA", "F"): {"AB3A": "yield", "AB4": "stop", "AB6": "priority"},
    ("GB", "GBR", "UK"): {"601.1": "stop", "602": "yield"},
    ("NL", "NLD"): {"B1": "priority", "B6": "yield", "B7": "stop"},
    ("", "OPENDRIVE"): GERMAN,
}
BEYOND = 0.5  # [m] by which programs write signals behind the end of their road
CODES = {code: signs for codes, signs in SIGNS.items() for code in codes}


def read_signals(element: Element, length: float, road: str, found: Document) -> Iterator[Signal]:
    """The lights and signs of a road that are used."""
    for each in element.findall("signals/signal"):
        made = spared(found, "signal", road, place(each, "s"), lambda each=each: read_signal(each, length, road, found))
        if made is not None:
            yield made
    for each in element.findall("signals/signalReference"):
        name = each.get("id") or ""
        rule = found.rules.get(name)
        if name not in found.rules:
            found.remark("signal", f"signalReference {name}", road, place(each, "s"), "names no signal of the document")
        made = rule and spared(
            found, "signal", road, place(each, "s"), lambda each=each, rule=rule: signal(each, length, road, rule, found)
        )
        if made:
            yield made


def read_signal(element: Element, length: float, road: str, found: Document) -> Signal | None:
    """A light or sign that is used; None of another, which is noted. Raises MapError."""
    rule, kind, country = rule_of(element), element.get("type") or "-1", element.get("country") or ""
    named = f"signal {element.get('id')} of type {kind}" + (f" in {country}" if country and country != "OpenDRIVE" else "")
    made = signal(element, length, road, rule, found)
    if rule in ("yield", "stop", "priority") and not country.replace("OpenDRIVE", ""):
        found.derive("sign", f"{named}: {rule}", road, made.s, "no country: German numbers, as simulators use them")
    if rule:
        return made
    if kind in OTHER_LIGHTS:
        found.remark("light", named, road, made.s, "is not for cars")
    elif element.get("dynamic") == "yes":
        found.remark("light", named, road, made.s, "is no traffic light that is known")
    else:
        found.remark("sign", named, road, made.s, "only signs about who goes first are read; limits come from <speed>")
    return None


def rule_of(element: Element) -> str:
    """What a signal is for cars: "light", "yield", "stop", "priority" or nothing."""
    kind = element.get("type") or "-1"
    if element.get("dynamic") == "yes":
        return "light" if kind in CAR_LIGHTS else ""
    return CODES.get((element.get("country") or "").upper(), {}).get(kind.upper(), "")


def signal(element: Element, length: float, road: str, rule: str, found: Document) -> Signal:
    """A light or sign, for the lanes that it is valid for; a `<validity>` for lane 0 alone means all. Raises MapError."""
    spans = [(whole(each, "fromLane", "<validity>"), whole(each, "toLane", "<validity>")) for each in element.findall("validity")]
    lanes = tuple((min(span), max(span)) for span in spans if span != (0, 0))
    orientation = element.get("orientation") or "none"
    if orientation not in ("+", "-", "none"):
        raise MapError(f"road {road}: orientation of <{element.tag}> is unknown (got {orientation[:20]!r}); allowed: +, -, none")
    return Signal(element.get("id") or "", station_of(element, length, road, found), orientation, lanes, rule)


def station_of(element: Element, length: float, road: str, found: Document) -> float:
    """Where a signal stands on its road [m]: one that stands beyond its ends stands at the nearer one, which is told. Raises MapError."""
    said = number(element, "s", f"road {road}")
    s = min(max(0.0, said), length)
    if abs(said - s) > BEYOND:
        source = f"road {road}: s of <{element.tag}> {element.get('id')} is {said:g} m; allowed: 0 to {length:g} m"
        found.derive(element.tag, f"at s = {s:g} m", road, s, source)
    return s
