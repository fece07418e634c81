"""Counts: flows and trips become as many as were counted at places of the road.

counted(streams, scenario, network, where, locks)   →  (Stream, ...), (Counted, ...)

Of all demands that fit the counts the most likely one is the nearest to what flows and matrices say (H. J. Van Zuylen, L. G. Willumsen, The
most likely trip matrix estimated from traffic counts, Transportation Research Part B 14 (1980) 281): with the rate q of a stream, the
share a of its cars that drive over a counted road, and the count c there,

    q'_i = q_i Π_j x_j^a_ij,    Σ_i a_ij q'_i = c_j

The factors x are found by balancing one count after the other until all are met. Counts that begin and end cut the time into
intervals, each balanced by itself. The time of a count is that of departure: how long cars take to the place is not reckoned with.
Cars of a route file are there as the file says; what they bring is not scaled.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from studio.errors import Problem, ScenarioError, nearest
from studio.road.network import Network
from studio.scenario.schema import Scenario
from studio.scenario.traffic import Count
from studio.world.demand.lock import Locks
from studio.world.demand.source import HOUR, Stream, usual_ways, varying

SWEEPS, EXACT, ENOUGH = 2000, 1e-9, 1e-3  # until every count is met so well, relative; with less it cannot be met


class Counted(NamedTuple):
    """What a count does when it begins: cars an hour that flows and trips would bring to its road, and that were counted there."""

    name: str
    road: str
    brought: float
    rate: float


def counted(
    asked: Sequence[Stream], scenario: Scenario, network: Network, where: str, locks: Locks
) -> tuple[tuple[Stream, ...], tuple[Counted, ...]]:
    """The streams as the counts have them, and what that changes; raises ScenarioError for counts that cannot be."""
    counts = dict(sorted(scenario.traffic.counts.items()))
    if not counts:
        return tuple(asked), ()
    refuse(list(unknown_roads(counts, network, where)), where)
    shares = np.array([passing(each, list(counts.values()), network, where, locks) for each in asked]).reshape(len(asked), len(counts))
    pieces, problems, told = [], [], {}
    for begin, end in intervals(asked, counts, scenario):
        names = [name for name, each in counts.items() if each.begin <= begin and end <= end_of(each, scenario)]
        a, wanted = shares[:, [name in names for name in counts]], np.array([counts[name].rate for name in names])
        free, fixed = rates_in(asked, begin, end)
        factors, found = balanced(a, free, fixed, wanted)
        for name, met, brought in zip(names, found, (free + fixed) @ a, strict=True):
            told.setdefault(name, Counted(name, counts[name].road, float(brought), counts[name].rate))
            problems += unmet(name, counts[name], float(met), begin, where)
        pieces.append((end, factors))
    refuse(problems, where)
    return tuple(scaled(each, i, pieces, scenario) for i, each in enumerate(asked)), tuple(told.values())


def refuse(problems: list[Problem], where: str) -> None:
    """Raises ScenarioError with all problems, if there is one."""
    if problems:
        raise ScenarioError(f"The counts of {where} cannot be met.", list(dict.fromkeys(problems)))


def unknown_roads(counts: dict[str, Count], network: Network, where: str) -> Iterator[Problem]:
    """Counts on roads that are not there."""
    for name, each in counts.items():
        if each.road not in network.roads:
            remedy = nearest(each.road, network.roads)
            yield Problem(f"{where}: traffic.counts.{name}.road", "is not a road of this map", repr(each.road), remedy=remedy)


def unmet(name: str, count: Count, found: float, begin: float, where: str) -> Iterator[Problem]:
    """A count that no demand fits."""
    if abs(found - count.rate) <= ENOUGH * max(count.rate, 1.0):
        return
    what = "cannot be met" if found else "is on a road that no flow and no trip leads over"
    nearby = f"from {begin:g} s on, {found:.0f} /h is the nearest" if found else f"from {begin:g} s on"
    remedy = f"{nearby}; change it, another count, or what flows, trips and route file bring"
    yield Problem(f"{where}: traffic.counts.{name}.rate", what, f"{count.rate:g} /h", remedy=remedy)


# -- who drives there ------------------------------------------------------------------------------


def passing(stream: Stream, counts: Sequence[Count], network: Network, where: str, locks: Locks) -> list[float]:
    """The shares of a stream's cars that drive over the roads of the counts: its ways are taken in turn."""
    ways = [set(way.roads(network)) for _, way in usual_ways(stream, network, locks.of_traffic(stream.model), where)]
    return [sum(each.road in roads for roads in ways) / len(ways) for each in counts]


def end_of(each: Count, scenario: Scenario) -> float:
    """When a count ends [s]: with the run at the latest."""
    return min(each.end or np.inf, scenario.clock.duration)


def intervals(asked: Sequence[Stream], counts: dict[str, Count], scenario: Scenario) -> Iterator[tuple[float, float]]:
    """The times [s] between which neither a count nor a stream begins or ends."""
    ends = scenario.clock.duration
    turns = {0.0, ends, *(each.begin for each in counts.values()), *(end_of(each, scenario) for each in counts.values())}
    turns |= {time for each in asked if each.rated for time in (each.rated.begin, each.rated.end)}
    return pairwise(sorted(time for time in turns if time <= ends))


def rates_in(asked: Sequence[Stream], begin: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Cars an hour of every stream between two times [s]: those that may be scaled, and those that stand in a route file."""
    free = [each.rated.rate if each.rated and each.rated.begin <= begin and end <= each.rated.end else 0.0 for each in asked]
    fixed = [0.0 if each.rated else HOUR * np.sum((each.due >= begin) & (each.due < end)) / (end - begin) for each in asked]
    return np.array(free), np.array(fixed)


# -- the most likely demand ------------------------------------------------------------------------


def balanced(a: np.ndarray, free: np.ndarray, fixed: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The factor of every stream, and what then drives at every count [1/h]."""
    log_x, there = np.zeros(c.size), fixed @ a
    met = there
    for _ in range(SWEEPS):
        for j in range(c.size):
            wanted, found = c[j] - there[j], float((free * np.exp(a @ log_x)) @ a[:, j])
            if found > 0.0:
                log_x[j] += np.log(max(wanted, 1e-12 * found) / found)
        met = there + (free * np.exp(a @ log_x)) @ a
        if (np.abs(met - c) <= EXACT * np.maximum(c, 1.0)).all():
            break
    return np.exp(a @ log_x), met


def scaled(stream: Stream, number: int, pieces: Sequence[tuple[float, np.ndarray]], scenario: Scenario) -> Stream:
    """A stream whose rate is multiplied, until each of some times [s], by its own of the factors."""
    own = [(end, float(factors[number])) for end, factors in pieces]
    if stream.rated is None or all(factor == 1.0 for _, factor in own):
        return stream
    return replace(stream, due=varying(stream.name, stream.rated, own, scenario))
