"""Route files of SUMO (.rou.xml), read: types of cars, and every departure with its edges. What is not used is told.

read(path, seed, duration)   →  Plan

    vType, vTypeDistribution     models and drivers
    route, routeDistribution     edges, under a name
    vehicle, trip, flow          departures, with a route or between edges

Where a file leaves something to chance, that hangs on the seed of the traffic and on the id that stands there.
"""

import gzip
import re
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import inf, log
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element
from zlib import crc32

from studio.errors import MapError, Problem, ScenarioError
from studio.model.random import TRAFFIC_HEADWAY, TRAFFIC_MODEL, TRAFFIC_ROUTE, uniform
from studio.road.formats.plain_xml import parse
from studio.scenario.traffic import Normal

LARGEST = 128 * 2**20  # [B] unpacked
MOST_DEPARTURES = 200_000
ENDINGS = (".rou.xml", ".rou.xml.gz")
HOUR = 3600.0  # [s]
SETTING_OF = {"accel": "acceleration", "decel": "deceleration", "tau": "time_headway", "minGap": "standstill_gap"}
USED = {
    "vType": {"id", "speedFactor", "speedDev", "vClass", "length", "probability", *SETTING_OF},
    "vTypeDistribution": {"id", "vTypes", "probabilities"},
    "route": {"id", "edges", "probability"},
    "routeDistribution": {"id", "routes", "probabilities"},
    "vehicle": {"id", "type", "route", "depart", "departLane"},
    "trip": {"id", "type", "from", "to", "via", "depart", "departLane"},
    "flow": {"id", "type", "route", "from", "to", "via", "begin", "end", "number", "vehsPerHour", "perHour", "period", "probability",
             "departLane"},
}  # fmt: skip
MODEL_OF = {"truck": "truck", "trailer": "truck", "bus": "truck", "coach": "truck", "evehicle": "electric_compact"}
CARS = {"", "passenger", "private", "taxi", "hov", "custom1", "custom2", "ignoring", "delivery", "emergency", "authority", "army", "vip"}
NO_ROUTE: tuple[str, ...] = ()
SPREAD = re.compile(r"normc?\(([^)]*)\)")
DEVIATION = 0.1  # of the speed factor, where only another mean is given


class Vtype(NamedTuple):
    """A type of cars: its model, None where any car will do, and what is said of its drivers."""

    id: str
    model: str | None
    length: float | None  # [m]
    settings: dict[str, float]
    speed_factor: Normal | None


class Departure(NamedTuple):
    """Somebody who comes in: when [s], along which edges, of which type, on which lane."""

    time: float
    edges: tuple[str, ...]
    vtype: str
    lane: int | None


@dataclass
class Plan:
    """What stands in a file: types by their ids, departures, and what was not used, by what it is."""

    types: dict[str, Vtype] = field(default_factory=dict)
    departures: list[Departure] = field(default_factory=list)
    unused: Counter = field(default_factory=Counter)


@dataclass
class Reader:
    """A file while it is read."""

    seed: int
    duration: float
    plan: Plan = field(default_factory=Plan)
    mixes: dict[str, list[tuple[str, float]]] = field(default_factory=dict)  # shares of types
    routes: dict[str, tuple[str, ...]] = field(default_factory=dict)
    choices: dict[str, list[tuple[str, float]]] = field(default_factory=dict)  # shares of routes


def read(path: Path, seed: int, duration: float, where: str) -> Plan:
    """The plan in a file; raises ScenarioError, with the element that is wrong."""
    try:
        root = parse(unpacked(path), "route file")
        if root.tag not in ("routes", "additional"):
            raise MapError(f"this is no route file: its root element is <{root.tag}>, not <routes>")
        reader = Reader(seed, duration)
        for element in root:
            take(reader, element)
        if len(reader.plan.departures) > MOST_DEPARTURES:
            raise MapError(f"{len(reader.plan.departures)} cars depart; allowed: {MOST_DEPARTURES}")
    except MapError as error:
        problem = Problem(f"{where}: traffic.routes", error.message, path.name)
        raise ScenarioError(f"The route file of {where} cannot be used.", [problem]) from None
    return reader.plan


def unpacked(path: Path) -> bytes:
    """The content of the file, no more than `LARGEST`; raises MapError."""
    if not path.name.lower().endswith(ENDINGS):
        raise MapError(f"not a route file; allowed: {', '.join(ENDINGS)}")
    if path.exists() and not path.is_file():
        raise MapError("is no file")  # a pipe would be waited for
    try:
        with (gzip.open if path.name.lower().endswith(".gz") else open)(path, "rb") as file:
            data = file.read(LARGEST + 1)
    except (OSError, EOFError, zlib.error) as error:
        raise MapError(f"cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if len(data) > LARGEST:
        raise MapError(f"is larger than {LARGEST // 2**20} MiB")
    return data


# -- elements --------------------------------------------------------------------------------------


def take(reader: Reader, element: Element) -> None:
    """One element of the file."""
    if element.tag not in TAKERS:
        reader.plan.unused[f"<{element.tag}>"] += 1
        return
    note_unused(reader, element)
    TAKERS[element.tag](reader, element)


def note_unused(reader: Reader, element: Element) -> None:
    """Attributes and elements within that say what is not used here."""
    nested = {"vTypeDistribution": {"vType"}, "routeDistribution": {"route"}, "vehicle": {"route"}, "flow": {"route"}}
    for name in element.attrib.keys() - USED[element.tag]:
        reader.plan.unused[f"{element.tag}.{name}"] += 1
    for inner in element:
        if inner.tag not in nested.get(element.tag, set()):
            reader.plan.unused[f"<{inner.tag}> in {element.tag}"] += 1


def take_type(reader: Reader, element: Element) -> None:
    """A vType."""
    kind, name = element.get("vClass", ""), named(element)
    model = MODEL_OF.get(kind)
    if model is None and kind not in CARS:
        reader.plan.unused[f"vType.vClass {kind}, which drives as a car"] += 1
    settings = {mine: number(element, theirs) for theirs, mine in SETTING_OF.items() if theirs in element.attrib}
    length = number(element, "length") if "length" in element.attrib and model is None else None
    reader.plan.types[name] = Vtype(name, model, length, settings, factor(element))


def take_types(reader: Reader, element: Element) -> None:
    """A vTypeDistribution: of types within, or of those that it names."""
    for inner in element.iter("vType"):
        note_unused(reader, inner)
        take_type(reader, inner)
    reader.mixes[named(element)] = shares(element, "vType", "vTypes")


def take_route(reader: Reader, element: Element) -> None:
    """A route with a name."""
    reader.routes[named(element)] = edges_of(element)


def take_routes(reader: Reader, element: Element) -> None:
    """A routeDistribution: of routes within, or of those that it names."""
    for inner in element.iter("route"):
        take_route(reader, inner)
    reader.choices[named(element)] = shares(element, "route", "routes")


def take_vehicle(reader: Reader, element: Element) -> None:
    """A vehicle or a trip: one departure."""
    time = moment(element, "depart", None)
    if time is None:
        reader.plan.unused[f"<{element.tag}> with depart={element.get('depart')!r}"] += 1
    else:
        depart(reader, element, named(element), time)


def take_flow(reader: Reader, element: Element) -> None:
    """A flow: as many departures as it says."""
    for turn, time in enumerate(times(reader, element)):
        depart(reader, element, f"{named(element)}.{turn}", time)


TAKERS = {
    "vType": take_type,
    "vTypeDistribution": take_types,
    "route": take_route,
    "routeDistribution": take_routes,
    "vehicle": take_vehicle,
    "trip": take_vehicle,
    "flow": take_flow,
}


def depart(reader: Reader, element: Element, name: str, time: float) -> None:
    """Puts one departure down, if it has a route and comes within the run."""
    edges = way_of(reader, element, name)
    if not 0.0 <= time < reader.duration:
        reader.plan.unused["departures before the beginning or after the end of the run"] += 1
    elif not edges:
        reader.plan.unused[f"<{element.tag}> without a route, or with one that the file does not have"] += 1
    else:
        vtype = chosen(reader, reader.mixes, element.get("type", ""), name, TRAFFIC_MODEL)
        reader.plan.departures.append(Departure(time, edges, vtype, lane_of(reader, element)))


def way_of(reader: Reader, element: Element, name: str) -> tuple[str, ...]:
    """The edges of a departure: its route's, or from where, over what and to where; none where nothing says so."""
    inner = element.find("route")
    if inner is not None:
        return edges_of(inner)
    if "route" in element.attrib:
        return reader.routes.get(chosen(reader, reader.choices, element.attrib["route"], name, TRAFFIC_ROUTE), NO_ROUTE)
    start, end = element.get("from"), element.get("to")
    return (start, *element.get("via", "").split(), end) if start and end else NO_ROUTE


def chosen(reader: Reader, choices: dict[str, list[tuple[str, float]]], name: str, who: str, stream: int) -> str:
    """A name, or of a distribution with this name one of its own by chance."""
    if name not in choices:
        return name
    draw = uniform(reader.seed, crc32(who.encode()), stream, 0) * sum(share for _, share in choices[name])
    for each, share in choices[name]:
        draw -= share
        if draw < 0.0:
            return each
    return choices[name][-1][0]


def lane_of(reader: Reader, element: Element) -> int | None:
    """The lane that it starts on; left to us where the file leaves it to SUMO."""
    given = element.get("departLane", "best")
    if given.isdecimal():
        return int(given)
    if given not in ("best", "free", "random", "allowed", "first", "best_prob"):
        reader.plan.unused[f"{element.tag}.departLane {given!r}"] += 1
    return None


# -- times -----------------------------------------------------------------------------------------


def times(reader: Reader, element: Element) -> Iterator[float]:
    """When the cars of a flow depart [s], as long as the run lasts."""
    begin = moment(element, "begin", 0.0) or 0.0
    end = min(moment(element, "end", inf) or inf, reader.duration if "number" not in element.attrib else inf)
    seed, who = reader.seed, crc32(named(element).encode())
    exponential = re.fullmatch(r"exp\(([^)]*)\)", element.get("period", ""))
    if exponential or "probability" in element.attrib:
        rate = read_number(element, "period", exponential[1]) if exponential else number(element, "probability")
        yield from at_random(begin, end, rate, seed, who)
    else:
        yield from evenly(element, begin, end, reader.duration)


def at_random(begin: float, end: float, rate: float, seed: int, who: int) -> Iterator[float]:
    """Independent of each other, so many a second (Poisson)."""
    time, turn = begin, 0
    while rate > 0.0 and turn <= MOST_DEPARTURES:
        time -= log(1.0 - uniform(seed, who, TRAFFIC_HEADWAY, turn)) / rate
        if time >= end:
            return
        yield time
        turn += 1


def evenly(element: Element, begin: float, end: float, duration: float) -> Iterator[float]:
    """One like the other: so many in all, so many an hour, or one in every period; the first at the beginning."""
    rate = element.get("vehsPerHour") or element.get("perHour")
    count = number(element, "number") if "number" in element.attrib else inf
    if rate is not None:
        every = HOUR / positive(element, "vehsPerHour", rate)
    elif "period" in element.attrib:
        every = positive(element, "period", element.attrib["period"])
    else:
        every = (min(end, HOUR * 24) - begin) / max(count, 1.0)
    if not 0.0 < every < inf:
        raise MapError(f"{told(element)} does not say how many cars come in: number, vehsPerHour, period or probability")
    turn = 0
    while turn < count and begin + turn * every < min(end, duration) and turn <= MOST_DEPARTURES:
        yield begin + turn * every
        turn += 1


def moment(element: Element, name: str, usual: float | None) -> float | None:
    """A time [s], also as hours, minutes and seconds; None where it hangs on something that is not here, as "triggered" does."""
    given = element.get(name)
    if given is None:
        return usual
    if re.fullmatch(r"(\d+:)?\d+:\d\d?:\d\d?(\.\d+)?", given):
        days, hours, minutes, seconds = ["0", *given.split(":")][-4:]
        return float(days) * 86400.0 + float(hours) * HOUR + float(minutes) * 60.0 + float(seconds)
    return None if re.fullmatch(r"[A-Za-z]+", given) and given != "inf" else read_number(element, name, given)


# -- values ----------------------------------------------------------------------------------------


def told(element: Element) -> str:
    """An element in a message."""
    return f"<{element.tag} id={element.get('id', '')!r}>"


def named(element: Element) -> str:
    """Its id; raises MapError."""
    if not element.get("id"):
        raise MapError(f"a <{element.tag}> has no id")
    return element.attrib["id"]


def number(element: Element, name: str) -> float:
    """An attribute that is a number; raises MapError."""
    return read_number(element, name, element.attrib[name])


def read_number(element: Element, name: str, given: str) -> float:
    """A number; raises MapError."""
    try:
        value = float(given)
    except ValueError:
        value = inf
    if not abs(value) < inf:
        raise MapError(f"{told(element)}: {name}={given!r} is no number")
    return value


def positive(element: Element, name: str, given: str) -> float:
    """A number above zero; raises MapError."""
    if (value := read_number(element, name, given)) <= 0.0:
        raise MapError(f"{told(element)}: {name}={given!r} must be above 0")
    return value


def edges_of(element: Element) -> tuple[str, ...]:
    """The edges of a route."""
    return tuple(element.get("edges", "").split())


def shares(element: Element, inner: str, names: str) -> list[tuple[str, float]]:
    """What a distribution consists of, with shares that are alike where none are given; raises MapError."""
    given = [(named(each), number(each, "probability") if "probability" in each.attrib else 1.0) for each in element.iter(inner)]
    listed = element.get(names, "").split()
    weights = [read_number(element, "probabilities", each) for each in element.get("probabilities", "").split()] or [1.0] * len(listed)
    found = given + list(zip(listed, weights, strict=False))
    if sum(share for _, share in found) <= 0.0 or any(share < 0.0 for _, share in found) or len(weights) < len(listed):
        raise MapError(f"{told(element)} has nothing to choose from: its shares must be above 0, one for each")
    return found


def factor(element: Element) -> Normal | None:
    """How the wanted speeds of a type are spread about the permitted ones; None where it does not say. Raises MapError."""
    given, deviation = element.get("speedFactor"), element.get("speedDev")
    if given is None and deviation is None:
        return None
    found = SPREAD.fullmatch(given or "1")
    values = [read_number(element, "speedFactor", each) for each in (found[1].split(",") if found else [given or "1"])]
    spread = values[1] if len(values) > 1 else DEVIATION if deviation is None else read_number(element, "speedDev", deviation)
    least, most = values[2:4] if len(values) > 3 else (None, None)
    if least is not None and most is not None and least >= most:
        raise MapError(f"{told(element)}: speedFactor={given!r} has no room between its bounds")
    return Normal(mean=values[0], deviation=max(spread, 1e-9), least=least, most=most)
