"""Sources: where the cars of flows and of matrices come in, on which way, and when.

streams(scenario)                             →  Stream, those of the flows and matrices
sources_of(streams, network, works, where, locks)    →  (Source, ...), (Detour, ...)

A stream, which is a flow, a trip of a matrix, or cars of a route file, has a source for every lane that it may start in; cars are due
there in the order of time.
Where works close a road altogether, those that are due meanwhile take the quickest way around it, if there is one.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf, log
from typing import NamedTuple
from zlib import crc32

import numpy as np

from studio.errors import Problem, RouteError
from studio.model.random import TRAFFIC_HEADWAY, uniform
from studio.road.network import Network
from studio.road.network.curve import LOCK
from studio.road.ways.lane_path import LanePath
from studio.road.ways.path import Path, annotated, path
from studio.road.ways.route import connect
from studio.scenario.schema import Scenario, moment_of
from studio.scenario.traffic import Departures, Matrix, Trip
from studio.world.demand.lock import Locks
from studio.world.effect import Closing
from studio.world.site import Site
from studio.world.way import Works, is_led

HOUR = 3600.0  # [s]
_paths: dict[tuple[str, tuple[int, ...], float], Path] = {}


class Source(NamedTuple):
    """Where cars of a stream come in: the path that they take, the times [s] at which they are due, and how chance knows them."""

    stream: str
    path: Path
    due: np.ndarray
    model: str | None  # or a type; None: as in the traffic


class Detour(NamedTuple):
    """What becomes of a stream whose way a closed road cuts: how much longer it is [m], infinitely when there is no other."""

    field: str
    road: str
    longer: float


class Closure(NamedTuple):
    """A road that works close altogether from a time to a time [s]."""

    road: str
    begin: float
    end: float


class Rated(NamedTuple):
    """So many cars an hour from a time to a time [s], one like the other or at random."""

    rate: float
    begin: float
    end: float
    is_even: bool


@dataclass(frozen=True)
class Stream:
    """Cars from a road to another: where it stands in the scenario, its roads, when they are due, and the rate behind it if one is."""

    name: str
    field: str
    roads: tuple[str, ...]
    due: np.ndarray
    model: str | None
    lane: int | None = None
    speeds: tuple = ()
    rated: Rated | None = None


def sources_of(
    asked: Iterable[Stream], network: Network, works: Works, where: str, locks: Locks
) -> tuple[tuple[Source, ...], tuple[Detour, ...]]:
    """All sources, in the order of streams, and what closed roads do to them; raises RouteError for what cannot be driven."""
    sources: list[Source] = []
    detours: list[Detour] = []
    problems: list[Problem] = []
    closures = list(closures_of(works.sites))
    for stream in asked:
        lock = locks.of_traffic(stream.model) if stream.due.size else LOCK
        try:
            for closed, due in parts(stream, closures):
                ways, found = ways_of(stream, closed, network, lock, where)
                detours += found
                sources += [
                    Source(f"{stream.name}/{lane}", way, due[turn :: len(ways)], stream.model) for turn, (lane, way) in enumerate(ways)
                ]
        except RouteError as error:
            problems += error.problems
    if problems:
        raise RouteError(f"{where} cannot be driven.", problems)
    return tuple(sources), tuple(dict.fromkeys(detours))


# -- streams ---------------------------------------------------------------------------------------


def streams(scenario: Scenario) -> Iterator[Stream]:
    """The flows, then the trips of all matrices; nothing hangs on their order in the file."""
    for name, flow in sorted(scenario.traffic.flows.items()):
        route, field = scenario.routes[flow.route], f"traffic.flows.{name}"
        rated = rate_of(flow, flow.rate, scenario)
        due = departures(name, rated, scenario)
        yield Stream(name, field, tuple(route.roads), due, flow.model, flow.lane, tuple(route.speeds), rated)
    for name, matrix in sorted(scenario.traffic.matrices.items()):
        numbered = sorted(enumerate(matrix.trips), key=lambda each: (each[1].origin, each[1].destination))
        yield from (stream_of(name, matrix, i, trip, scenario) for i, trip in numbered)


def stream_of(matrix: str, of: Matrix, number: int, trip: Trip, scenario: Scenario) -> Stream:
    """A trip of a matrix."""
    name, roads = f"{matrix}: {trip.origin} to {trip.destination}", dict.fromkeys((trip.origin, trip.destination))
    rated = rate_of(of, trip.rate, scenario)
    due = departures(name, rated, scenario)
    return Stream(name, f"traffic.matrices.{matrix}.trips.{number}", tuple(roads), due, of.model, rated=rated)


def rate_of(of: Departures, rate: float, scenario: Scenario) -> Rated:
    """A rate [1/h] from the beginning of a stream to its end, or that of the run."""
    return Rated(rate, of.begin, min(of.end or np.inf, scenario.clock.duration), of.headways == "even")


def departures(name: str, of: Rated, scenario: Scenario) -> np.ndarray:
    """Times [s] at which cars of a stream are due; those at random hang on its name, and not on other streams."""
    end, every = of.end, HOUR / of.rate
    if of.is_even:
        return np.arange(of.begin + 0.5 * every, end, every)
    seed, who = scenario.seed_of("traffic"), crc32(name.encode())
    times, time = [], of.begin
    while time < end:
        time -= every * log(1.0 - uniform(seed, who, TRAFFIC_HEADWAY, len(times)))
        times.append(time)
    return np.array(times[:-1])


def varying(name: str, of: Rated, pieces: Sequence[tuple[float, float]], scenario: Scenario) -> np.ndarray:
    """The same with a rate that is multiplied, until each of some times [s], by a factor: cars are due by a clock that goes so fast."""
    ends = np.array([of.begin, *(min(max(end, of.begin), of.end) for end, _ in pieces)])
    own = np.concatenate([[0.0], np.cumsum(np.diff(ends) * [factor for _, factor in pieces])])
    due = departures(name, Rated(of.rate, 0.0, float(own[-1]), of.is_even), scenario)
    return np.interp(due, own, ends)


# -- closed roads ----------------------------------------------------------------------------------


def closures_of(sites: Sequence[Site]) -> Iterator[Closure]:
    """The roads that no lane leads along while an entry of the script acts, as far as its times are known beforehand."""
    for site in sites:
        begin, end = moment_of(site.entry.when), moment_of(site.entry.until)
        shut = {each.effect.stretch.road for each in site.laid if isinstance(each.effect, Closing) and each.work and not is_led(each.work)}
        yield from (Closure(road, begin, inf if end is None else end) for road in sorted(shut) if begin is not None)


def parts(stream: Stream, closures: Sequence[Closure]) -> Iterator[tuple[frozenset[str], np.ndarray]]:
    """The times of a stream between those at which roads are closed or opened, with the roads that are closed then."""
    turns = sorted({-inf, inf, *(time for each in closures for time in (each.begin, each.end))})
    for begin, end in pairwise(turns):
        due = stream.due[(stream.due >= begin) & (stream.due < end)]
        if due.size or len(turns) == 2:
            yield frozenset(each.road for each in closures if each.begin <= begin and end <= each.end), due


def ways_of(
    stream: Stream, closed: frozenset[str], network: Network, lock: float, where: str
) -> tuple[list[tuple[int, Path]], list[Detour]]:
    """The paths of a stream by their first lanes while some roads are closed, and what that does to it."""
    usual = usual_ways(stream, network, lock, where)
    cut = [road for road in usual[0][1].roads(network) if road in closed]
    if not cut:
        return [(lane, path_along(way, stream.speeds, network, lock)) for lane, way in usual], []
    around = list(lanewise(stream, tuple(road for road in stream.roads if road not in closed), closed, network, lock))
    if not around or stream.roads[0] in closed or stream.roads[-1] in closed:
        return [(lane, path_along(way, stream.speeds, network, lock)) for lane, way in usual], [Detour(stream.field, cut[0], inf)]
    made = [(lane, path_along(way, (), network, lock)) for lane, way in around]
    longer = min(each.length for _, each in made) - path_along(usual[0][1], (), network, lock).length
    return made, [Detour(stream.field, cut[0], round(longer, 1))]


def usual_ways(stream: Stream, network: Network, lock: float, where: str) -> list[tuple[int, LanePath]]:
    """Its ways, from the lane that it names or from every lane of its first road from which it can be driven; raises RouteError."""
    try:
        connect(network, stream.roads, start_lane=stream.lane, lock=lock)
    except RouteError as error:
        field = f"{where}: {stream.field}" + (".lane" if stream.lane is not None else ".route" if ".flows." in stream.field else "")
        problem = Problem(field, error.message, " to ".join(stream.roads[:: max(len(stream.roads) - 1, 1)]),
                          remedy="; ".join(map(str, error.problems)))  # fmt: skip
        raise RouteError(error.message, [problem]) from None
    return list(lanewise(stream, stream.roads, frozenset(), network, lock))


def lanewise(
    stream: Stream, roads: tuple[str, ...], avoid: frozenset[str], network: Network, lock: float
) -> Iterator[tuple[int, LanePath]]:
    """The ways through some roads, by their first lanes."""
    if not roads:
        return
    for lane in range(len(network.roads[roads[0]].lanes)) if stream.lane is None else (stream.lane,):
        try:
            yield lane, connect(network, roads, start_lane=lane, avoid=avoid, lock=lock)
        except RouteError:
            continue


def path_along(way: LanePath, speeds: Sequence, network: Network, lock: float) -> Path:
    """The path along a way, made once as far as nobody has annotated it."""
    key = network.digest, way.lanes, lock
    if key not in _paths:
        _paths[key] = path(network, way, lock=lock)
    return annotated(_paths[key], list(speeds), 0.0) if speeds else _paths[key]
