"""Reads OpenDRIVE (.xodr): the whole document as a plan, and a report of what was not used or had to be guessed.

OpenDRIVE says exactly where every lane lies and how lanes join, so it is read as it stands, without netconvert. That one (1.28)
reads it too, but puts lanes beside borders up to 1 m from their place, opens hard shoulders to cars, drives on the right whatever
`rule` says, and has 50 km/h where the document says 33.33 m/s.
"""

from collections import defaultdict
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyproj

from studio.errors import MapError
from studio.road.assembly.plan import Plan, Wish
from studio.road.assembly.priority import counts, law_by_limits
from studio.road.formats import limit as limits
from studio.road.formats import osm
from studio.road.network import Connection, Net, Network, Scenery
from studio.road.network.report import DriveSide, LimitCount, Notes, Report, SignalCount, Spot
from studio.road.opendrive.document import Document, Header, Remark, XRoad
from studio.road.opendrive.file import WIDEST, document, read_header

ENDINGS = (".xodr",)
HEAD = 2**16  # [B] at the start of a file, in which its header stands
MARGIN = 50.0  # [m] of ground around the lanes
LEAST_EASTING = 100_000.0  # [m] of a place in a UTM zone
TRUE_SCALE = "+k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m"
NEAR = 25.0  # [m] from a light to its stop line
PLACES = {  # kinds of road, as OpenDRIVE names them, as `limit.Rules` names them
    "motorway": "motorway",
    "rural": "rural",
    "townExpressway": "town",
    "town": "town",
    "townCollector": "town",
    "townArterial": "town",
    "townLocal": "town",
    "townPrivate": "living_street",
    "townPlayStreet": "living_street",
    "lowSpeed": "living_street",
    "pedestrian": "living_street",
    "bicycle": "living_street",
    "unknown": "town",
}
ALPHA_3 = {  # ISO 3166-1, of the countries whose rules are known
    "DEU": "DE",
    "AUT": "AT",
    "CHE": "CH",
    "FRA": "FR",
    "ITA": "IT",
    "ESP": "ES",
    "PRT": "PT",
    "NLD": "NL",
    "BEL": "BE",
    "POL": "PL",
    "CZE": "CZ",
    "DNK": "DK",
    "SWE": "SE",
    "NOR": "NO",
    "FIN": "FI",
    "IRL": "IE",
    "GBR": "GB",
    "USA": "US",
    "CAN": "CA",
    "AUS": "AU",
    "NZL": "NZ",
    "JPN": "JP",
    "KOR": "KR",
    "CHN": "CN",
    "IND": "IN",
    "SGP": "SG",
    "ZAF": "ZA",
}


def attribution(path: Path) -> str:
    """Who made the map, by its header; "" where it does not say."""
    return credit(header_of(path))


def licence(path: Path) -> str:
    """What others may do with the map, by its header; "" where it does not say."""
    return header_of(path).licence


def header_of(path: Path) -> Header:
    """The header of a file; raises MapError."""
    try:
        with path.open("rb") as file:
            return read_header(file.read(HEAD))
    except OSError as error:
        raise MapError(f"{path}: the map file cannot be read ({error.strerror or error})") from None


def credit(header: Header) -> str:
    """Name and maker in one line."""
    return ", ".join(filter(None, (header.name, header.vendor)))


def read(path: Path) -> bytes:
    """The content of a file.

    Raises:
        MapError: the file is missing or too large.
    """
    try:
        return osm.unpack(path)
    except FileNotFoundError:
        raise MapError(f"{path}: there is no such map file") from None
    except OSError as error:
        raise MapError(f"{path}: the map file cannot be read ({error.strerror or error})") from None


def part(path: Path, wish: Wish) -> str:
    """The whole map, whatever radius a scenario has; raises MapError when a box of it is asked for."""
    if wish.corrections:
        raise MapError(f"{path}: corrections change tags of OpenStreetMap, and OpenDRIVE has none; change the document itself")
    if wish.bbox is not None:
        raise MapError(f"{path}: bbox {wish.bbox!r}: an OpenDRIVE map is taken whole; leave the bbox out")
    return "whole"


def plan(path: Path, data: bytes, kept: str, progress: Callable[[str], None]) -> Plan:
    """The plan of a document.

    Raises:
        MapError: it cannot be used; the message names the file, the element and the reason.
    """
    try:
        found = document(data)
        progress("building lanes and junctions")
        return planned(found)
    except MapError as error:
        raise MapError(f"{path}: {error.message}", error.problems) from None


def planned(found: Document) -> Plan:
    """The same; messages do not name the file."""
    from studio.road.assembly import narrow
    from studio.road.opendrive import deck
    from studio.road.opendrive.build import build

    notes, middle = Notes(), middle_of(found)
    earth, side = Earth(found.header, middle), side_of(found)

    def spot(road: str, s: float) -> Spot:
        if road in found.roads:
            return earth.spot(found.roads[road], s)
        return Spot(f"road {road}" if road else "the map", *earth.degrees(middle))

    country = country_of(found, earth, middle)
    earth.tell(notes, spot(next(iter(found.roads)), 0.0))
    rules = Limits(found.roads, country, spot, notes)
    made = build(found, rules.of, spot, notes)
    if made.net.junctions:
        source = "signs and priorities of junctions, then limits of the roads"
        what = "who has it by sign or junction first, then the higher limit, equal ones by side"
        notes.guess("right of way", what, spot(next(iter(found.roads), ""), 0.0), source=source, sure="low")
    tell(found, earth, spot, notes)
    net, places = shifted(made.net, middle), [place - middle for place in made.places]
    net = narrow.drivable(net, lambda each: end_of(net, each, earth, middle), notes)
    net = deck.with_heights(net, lambda road: spot_of(net, road, earth, middle), notes)
    return Plan(
        net=net,
        signalled=net.signalled,
        scenery=Scenery((), (), np.empty((2, 0))),
        origin=earth.degrees(middle),
        bounds=bounds_of(net),
        attribution=credit(found.header),
        licence=found.header.licence,
        law=law_by_limits(net, country=country, left_hand=side.side == "left", signs=made.signs, before=made.before),
        report=lambda network: report(network, places, rules, notes, side=side, country=country),
        datum=(float(middle[0]), float(middle[1])),
    )


def tell(found: Document, earth: "Earth", spot: Callable[[str, float], Spot], notes: Notes) -> None:
    """What is left out and what was taken without being said, each at its place."""

    def at(each: Remark) -> Spot:
        if each.at is None:
            return spot(each.road, each.s)
        return Spot(f"road {each.road}, s = {each.s:.1f} m", *earth.degrees(np.array(each.at)))

    for each in found.remarks:
        notes.skip(each.kind, each.what, at(each), each.reason)
    for each in found.guesses:
        notes.guess(each.kind, each.what, at(each), source=each.reason, sure="medium")


def end_of(net: Net, connection: Connection, earth: "Earth", middle: np.ndarray) -> Spot:
    """Where a connection begins."""
    lane = net.lanes[connection.from_lane]
    return Spot(f"road {lane.road}", *earth.degrees(lane.centre[:, -1] + middle))


def spot_of(net: Net, road: str, earth: "Earth", middle: np.ndarray) -> Spot:
    """Where a road begins."""
    return Spot(f"road {road}", *earth.degrees(net.lanes[net.roads[road].lanes[0]].centre[:, 0] + middle))


# -- the place -------------------------------------------------------------------------------------


def middle_of(found: Document) -> np.ndarray:
    """The middle of all reference lines, in whole metres of the document's plane.

    Raises:
        MapError: the roads lie too far from each other.
    """
    ends = np.concatenate([road.line.at(np.linspace(0.0, road.length, 16))[:2] for road in found.roads.values()], axis=1)
    low, high = ends.min(axis=1), ends.max(axis=1)
    if not (high - low).max() <= WIDEST:
        raise MapError(f"the map is {(high - low).max() / 1000:.3g} km wide; allowed: up to {WIDEST / 1000:g} km")
    return np.round((low + high) / 2.0)


def shifted(net: Net, middle: np.ndarray) -> Net:
    """The network about its middle."""
    lanes = tuple(replace(lane, centre=lane.centre - middle[:, None]) for lane in net.lanes)
    return replace(net, lanes=lanes, junctions=tuple(each - middle[:, None] for each in net.junctions))


def bounds_of(net: Net) -> tuple[float, float, float, float]:
    """The box around all lanes, with a margin [m]."""
    points = np.concatenate([lane.centre for lane in net.lanes], axis=1)
    (x0, y0), (x1, y1) = (points.min(axis=1) - MARGIN).tolist(), (points.max(axis=1) + MARGIN).tolist()
    return x0, y0, x1, y1


class Earth:
    """Where the document's plane lies: as its geoReference says, else around 0° north, 0° east.

    Some programs write a UTM zone, which has no origin of its own, together with one, and small coordinates: these mean it.
    """

    def __init__(self, header: Header, middle: np.ndarray) -> None:
        self.shift, text, self.guess, self.known = header.shift, header.projection, "", bool(header.projection)
        parts = [part.lstrip("+").partition("=") for part in text.split()] if text.startswith("+") else []
        named = {name: value for name, _, value in parts}
        if {"lat_0", "lon_0"} <= set(named) and named.get("proj") == "utm" and middle[0] + self.shift[0] < LEAST_EASTING:
            text = f"+proj=tmerc +lat_0={named['lat_0']} +lon_0={named['lon_0']} {TRUE_SCALE}"
            self.guess = "lat_0 and lon_0 in the <geoReference> of a UTM zone"
        try:
            self.projection = pyproj.Proj(flat(text or f"+proj=tmerc +lat_0=0 +lon_0=0 {TRUE_SCALE}"))
            self.guess = self.guess or ("" if self.known else "no <geoReference>")
        except pyproj.exceptions.CRSError:
            self.projection, self.known = pyproj.Proj(f"+proj=tmerc +lat_0=0 +lon_0=0 {TRUE_SCALE}"), False
            self.guess = f"<geoReference> cannot be read: {text[:60]}"

    def degrees(self, point: np.ndarray) -> tuple[float, float]:
        """Latitude and longitude [deg] of a point in the plane [m]."""
        (x, y), (x0, y0) = point, self.shift
        longitude, latitude = self.projection(x + x0, y + y0, inverse=True)
        finite = np.isfinite(latitude) and np.isfinite(longitude)
        return (float(latitude), float(longitude)) if finite else (0.0, 0.0)

    def spot(self, road: XRoad, s: float) -> Spot:
        """A station of a road."""
        named = f" ({road.name})" if road.name else ""
        point = road.line.at(np.array([min(max(s, 0.0), road.length)]))[:2, 0]
        return Spot(f"road {road.id}{named}, s = {s:.1f} m", *self.degrees(point))

    def tell(self, notes: Notes, at: Spot) -> None:
        """Notes an origin that the document does not give."""
        if self.guess:
            what = f"{at.latitude:.5f}°, {at.longitude:.5f}°"
            notes.guess("origin", what, at, source=self.guess, sure="low")


def flat(projection: str) -> str:
    """A PROJ string without the parts that only concern heights, whose grids need not be at hand; others as they are."""
    if not projection.startswith("+"):
        return projection
    return " ".join(each for each in projection.split() if not each.startswith(("+geoidgrids", "+vunits", "+vto_meter")))


def side_of(found: Document) -> DriveSide:
    """The side that is driven on; a map has one."""
    left = any(road.left_hand for road in found.roads.values())
    why = f"rule={'LHT' if left else 'RHT'} of its roads, or OpenDRIVE's default"
    return DriveSide("left", why) if left else DriveSide("right", why)


def country_of(found: Document, earth: Earth, middle: np.ndarray) -> str:
    """The country by its code in a `<type>`, else by the map's place, else ""."""
    for road in found.roads.values():
        for _, _, code, _ in road.kinds:
            if country := limits.CODES.get(ALPHA_3.get(code.upper(), code.upper())):
                return country
    if not earth.known:
        return ""
    from studio.road.formats.country import country_at

    return country_at(*earth.degrees(middle)).name


class Limits:
    """The limits of roads whose lanes have none, with a guess for every road that does not say."""

    def __init__(self, roads: dict[str, XRoad], country: str, spot: Callable[[str, float], Spot], notes: Notes) -> None:
        self.roads, self.country, self.spot, self.notes = roads, country, spot, notes
        self.guesses: set[tuple[str, str]] = set()  # road and kind

    def of(self, road: XRoad, s: float) -> float:
        """The limit [m/s] at a station of a road; on a way through a junction that of the roads that it joins."""
        ends = [(self.roads[link.id], link.contact) for link in (road.before, road.after) if link is not None and link.id in self.roads]
        ends = [(other, contact) for other, contact in ends if other.junction == "-1"]
        if road.junction != "-1" and ends and not road.kinds:
            return float(np.mean([self.of(other, 0.0 if contact == "start" else other.length) for other, contact in ends]))
        here = [kind for kind in road.kinds if kind[0] <= s + 0.5] or [(0.0, "unknown", "", float("nan"))]
        _, kind, _, speed = here[-1]
        return speed if np.isfinite(speed) else self.guessed(road, kind, s)

    def guessed(self, road: XRoad, kind: str, s: float) -> float:
        """The usual limit of a kind of road [m/s]; noted once for a road."""
        speed = getattr(limits.RULES.get(self.country, limits.ELSEWHERE), PLACES.get(kind, "town"))
        if (road.id, kind) not in self.guesses:
            self.guesses.add((road.id, kind))
            source = f"type={kind} in {self.country or 'an unknown country'}, without <speed>"
            sure = "medium" if self.country and kind != "unknown" else "low"
            self.notes.guess("speed limit", f"{speed:.0f} km/h", self.spot(road.id, s), source=source, sure=sure)
        return speed / 3.6


# -- the report ------------------------------------------------------------------------------------


def report(
    network: Network, places: list[np.ndarray], rules: Limits, notes: Notes, *, side: DriveSide, country: str
) -> Report:  # fmt: skip
    """What became of the document."""
    links, roads = network.signals, [road.id for road in rules.roads.values() if road.junction == "-1"]
    guessed = len({road for road, _ in rules.guesses} & set(roads))
    near = [bool((np.hypot(links.link_x - x, links.link_y - y) <= NEAR).any()) for x, y in places]
    length: dict[int, float] = defaultdict(float)
    for lane in network.lanes:
        if not lane.internal:
            length[round(lane.speed * 3.6)] += lane.length / 1000.0
    return Report(
        drive_side=side,
        country=country,
        lane_km=sum(length.values()),
        junctions=len(network.junctions),
        signals=SignalCount(len(places), sum(near), len(set(links.programme.tolist()))),
        right_of_way=counts(network.connections),
        speed_limits=LimitCount(
            len(roads) - guessed, guessed, {str(speed): round(length[speed], 3) for speed in sorted(length)},
        ),
        guesses=tuple(notes.guesses),
        skipped=tuple(notes.skipped),
    )  # fmt: skip
