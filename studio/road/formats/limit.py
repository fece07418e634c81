"""Speed limits: what a tag says in km/h, and what holds where there is none.

Sources of the country table: the statutory limits for cars as OpenStreetMap's wiki lists them ("Default speed limits").
Residential streets are the exception: there the usual zone is taken where zones are the rule.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from studio.road.formats.way import Way, spot_of
from studio.road.network.report import Notes

MILE, KNOT = 1.609344, 1.852  # [km]
WALK = 7.0  # [km/h] walking pace, as courts read it
NO_LIMIT = 130.0  # [km/h] what is advised in Germany where there is no limit
FASTEST = 250.0  # [km/h] above this the tag is a slip


@dataclass(frozen=True)
class Rules:
    """Statutory limits of a country [km/h]."""

    town: float
    residential: float
    rural: float
    motorway: float
    living_street: float


def mph(town: float, residential: float, rural: float, motorway: float, living_street: float) -> Rules:
    """Rules that are given in miles per hour."""
    return Rules(*(limit * MILE for limit in (town, residential, rural, motorway, living_street)))


ELSEWHERE = Rules(50, 50, 90, 120, 20)
RULES = {
    "Germany": Rules(50, 30, 100, NO_LIMIT, 10),
    "Austria": Rules(50, 30, 100, 130, 10),
    "Switzerland": Rules(50, 30, 80, 120, 20),
    "France": Rules(50, 50, 80, 130, 20),
    "Italy": Rules(50, 50, 90, 130, 30),
    "Spain": Rules(50, 30, 90, 120, 20),
    "Portugal": Rules(50, 50, 90, 120, 20),
    "Netherlands": Rules(50, 30, 80, 100, 15),
    "Belgium": Rules(50, 50, 70, 120, 20),
    "Poland": Rules(50, 50, 90, 140, 20),
    "Czechia": Rules(50, 50, 90, 130, 20),
    "Denmark": Rules(50, 50, 80, 130, 15),
    "Sweden": Rules(50, 50, 70, 110, WALK),
    "Norway": Rules(50, 50, 80, 110, WALK),
    "Finland": Rules(50, 50, 80, 120, 20),
    "Ireland": Rules(50, 50, 80, 120, 20),
    "United Kingdom": mph(30, 30, 60, 70, 20),
    "United States of America": mph(35, 25, 55, 65, 15),
    "Canada": Rules(50, 50, 80, 100, 20),
    "Australia": Rules(50, 50, 100, 100, 10),
    "New Zealand": Rules(50, 50, 100, 100, 10),
    "Japan": Rules(60, 60, 60, 100, 20),
    "South Korea": Rules(50, 50, 60, 100, 20),
    "China": Rules(50, 50, 70, 120, 20),
    "India": Rules(50, 50, 70, 120, 20),
    "Singapore": Rules(50, 50, 50, 90, 15),
    "South Africa": Rules(60, 60, 100, 120, 20),
}
# the two letters before a zone's name, as in maxspeed=DE:urban
CODES = {
    "DE": "Germany",
    "AT": "Austria",
    "CH": "Switzerland",
    "FR": "France",
    "IT": "Italy",
    "ES": "Spain",
    "PT": "Portugal",
    "NL": "Netherlands",
    "BE": "Belgium",
    "PL": "Poland",
    "CZ": "Czechia",
    "DK": "Denmark",
    "SE": "Sweden",
    "NO": "Norway",
    "FI": "Finland",
    "IE": "Ireland",
    "GB": "United Kingdom",
    "UK": "United Kingdom",
    "US": "United States of America",
    "CA": "Canada",
    "AU": "Australia",
    "NZ": "New Zealand",
    "JP": "Japan",
    "KR": "South Korea",
    "CN": "China",
    "IN": "India",
    "SG": "Singapore",
    "ZA": "South Africa",
}
ZONES = {
    "urban": "town",
    "rural": "rural",
    "trunk": "rural",
    "motorway": "motorway",
    "living_street": "living_street",
    "nsl_restricted": "town",
    "nsl_single": "rural",
    "nsl_dual": "motorway",
}
ZONE_KEYS = ("maxspeed:type", "source:maxspeed", "zone:maxspeed", "zone:traffic")
KEYS = ("maxspeed", "maxspeed:forward", "maxspeed:backward")


def kilometres_per_hour(text: str) -> float | None:
    """What a limit's tag means [km/h]; None where it names no speed.

    >>> kilometres_per_hour("50"), kilometres_per_hour("30 mph"), kilometres_per_hour("DE:urban")
    (50.0, 48.28032, 50)
    >>> kilometres_per_hour("DE:zone:30"), kilometres_per_hour("none"), kilometres_per_hour("signals")
    (30.0, 130.0, None)
    """
    text = text.strip()
    if text in ("none", "walk"):
        return NO_LIMIT if text == "none" else WALK
    found = re.fullmatch(r"(\d+(?:\.\d+)?)\s*(km/h|kmh|kph|mph|knots)?", text)
    if not found:
        return zone_limit(text)
    value = float(found[1]) * {"mph": MILE, "knots": KNOT}.get(found[2], 1.0)
    return value if 0.0 < value <= FASTEST else None


def zone_limit(text: str) -> float | None:
    """The limit of a zone, "DE:urban" or "FR:zone30" or "RU:20" [km/h]; a country without rules has the usual ones."""
    found = re.fullmatch(r"([A-Z]{2}):(?:zone)?:?(\w+)", text)
    if not found:
        return None
    imperial = MILE if found[1] in ("GB", "UK", "US") else 1.0
    if found[2].isdigit():
        value = float(found[2]) * imperial
        return value if 0.0 < value <= FASTEST else None
    zone = ZONES.get(found[2])
    return getattr(RULES.get(CODES.get(found[1], ""), ELSEWHERE), zone) if zone else None


def usual(highway: str, rules: Rules) -> float:
    """The limit of a kind of road where none is mapped, taken to lie in a town [km/h]."""
    if highway == "motorway":
        return rules.motorway
    if highway == "motorway_link":
        return min(80.0, rules.motorway)  # what ramps are built for
    slow = rules.living_street
    return {"residential": rules.residential, "living_street": slow, "service": slow}.get(highway, rules.town)


def limited(way: Way, country: str, notes: Notes) -> Way:
    """The way with every limit in km/h: what is mapped, else its zone's, else the country's usual one."""
    others = {key: value for key, value in way.tags.items() if key not in KEYS}
    mapped = dict(readable(way, notes))
    if "maxspeed:conditional" in way.tags:
        notes.skip(
            "limit at times", f"maxspeed:conditional={way.tags['maxspeed:conditional']}", spot_of(way), "limits do not change with time"
        )
    zone = next((limit for key in ZONE_KEYS if (limit := kilometres_per_hour(way.tags.get(key, "")))), None)
    if "maxspeed" not in mapped and zone is not None:
        mapped["maxspeed"] = zone
    if "maxspeed" not in mapped and not {"maxspeed:forward", "maxspeed:backward"} <= set(mapped):
        mapped["maxspeed"] = guessed(way, country, notes)
    return way.with_tags({**others, **{key: f"{limit:.3f}" for key, limit in by_direction(mapped).items()}})


def by_direction(mapped: dict[str, float]) -> dict[str, float]:
    """Limits as netconvert takes them: that of the way's own direction without a direction, which it would leave aside beside one."""
    usual = mapped.get("maxspeed", 0.0)
    forward, backward = (mapped.get(key, usual) for key in KEYS[1:])
    return {"maxspeed": forward} | ({"maxspeed:backward": backward} if backward != forward else {})


def readable(way: Way, notes: Notes) -> Iterator[tuple[str, float]]:
    """The limits of a way that can be read [km/h]."""
    for key in KEYS:
        text = way.tags.get(key)
        limit = kilometres_per_hour(text) if text else None
        if limit is not None:
            yield key, limit
        elif text:
            notes.skip("speed limit", f"{key}={text}", spot_of(way), "names no speed")
        if text == "none":
            notes.guess("no limit", f"{NO_LIMIT:.0f} km/h", spot_of(way), source=f"{key}=none", sure="medium", key=key)


def guessed(way: Way, country: str, notes: Notes) -> float:
    """The limit [km/h] of a way that has none."""
    highway = way.tags["highway"]
    limit = usual(highway, RULES.get(country, ELSEWHERE))
    known = country if country in RULES else f"{country}, whose rules are not known"
    sure = "low" if country not in RULES else "high" if highway in ("motorway", "living_street") else "medium"
    notes.guess("speed limit", f"{limit:.0f} km/h", spot_of(way), source=f"highway={highway} in {known}", sure=sure, key="maxspeed")
    return limit
