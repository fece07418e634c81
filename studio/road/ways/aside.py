"""Sides: the lanes beside a path that lead where it leads, as paths of their own.

sides(network, path)     →  Side, ...     one for every number of lanes to go over, towards the middle of the road or the kerb

The path on a side leaves the usual one wherever there is such a lane and every lane between is open to cars, where it leads on over all
junctions as the usual one does, and for long enough. It comes back before that lane ends or leads elsewhere; where the last road is
reached on it, it stays there. Around a ring nobody drives beside his path.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from typing import NamedTuple

import numpy as np

from studio.road.network import Lane, Network, curve
from studio.road.network.index import once
from studio.road.ways.detour import bent
from studio.road.ways.meeting import meetings_of
from studio.road.ways.path import CORRIDOR, PATH_SPACING, PATH_SPEED, PATH_X, PATH_Y, WAVELENGTH, Path, Station, ease
from studio.road.ways.ring import rings
from studio.road.ways.strand import Strands, beside, strands_of, ways

FARTHEST = 2  # lanes beside the own one
WIDTH = (2.0, 5.5)  # [m] from lane to lane
SHORTEST = 120.0  # [m] a lane beside that is shorter is not worth it
BACK, LEAST, MOST = 4.0, 30.0, 150.0  # [s], [m] over which a path comes back
END = 5  # points at either end of a path
LAST = 10.0  # [m] before the end of the lane it is back
CLEAR, BEHIND = 25.0, 3.0  # [m] before and behind a junction where others are met nobody changes lanes


class Group(NamedTuple):
    """A road of a path: its lane, none where the path changes lanes there; from where to where [m]; and where the next road begins."""

    lane: Lane | None
    begin: float
    end: float
    following: float


class Run(NamedTuple):
    """From the `first` to the `last` point a path runs beside another; over so many metres it comes back, none where it ends there."""

    first: int
    last: int
    back: float

    def out(self, path: Path) -> float:
        """Over how many metres it leaves the other one, which nobody drives."""
        return taper(path, self.first) if self.first > 0 else 0.0


@dataclass(frozen=True, eq=False)
class Side:
    """`step` lanes towards the middle of the road, below zero towards the kerb. `at` is where on `path` every point of the usual one lies.

    `spans` are where on the usual path this one runs beside it [m], and from where it comes back, infinite where it does not; `free`, for
    every point of the usual path, whether one may change over there.
    """

    step: int
    path: Path
    at: np.ndarray
    spans: tuple[tuple[float, float, float], ...]
    free: np.ndarray


def sides(network: Network, path: Path) -> tuple[Side, ...]:
    """The nearest lanes first."""
    groups = list(groups_of(network, path))
    steps = [sign * step for step in range(1, FARTHEST + 1) for sign in (1, -1)]
    made = [side(network, path, groups, step) for step in steps if any(lane_beside(network, each.lane, step) for each in groups)]
    return tuple(each for each in made if each is not None)


def groups_of(network: Network, path: Path) -> Iterator[Group]:
    """The roads of a path."""
    roads = [list(group) for _, group in groupby(path.stations, key=lambda station: station.road)]
    ends = [*(each[0].s for each in roads[1:]), path.length]
    lanes = [[network.roads[one.road].lanes[one.lane_index] for one in each] for each in roads]
    inside = lengths_inside(network)
    for i, (road, following) in enumerate(zip(roads, ends, strict=True)):
        within = inside.get((lanes[i][-1], lanes[i + 1][0]), 0.0) if i + 1 < len(roads) else 0.0
        yield Group(network.lanes[lanes[i][0]] if len(road) == 1 else None, road[0].s, max(following - within, road[0].s), following)


@once
def lengths_inside(network: Network) -> dict[tuple[int, int], float]:
    """The length [m] of the way from a lane to another."""
    return {(each.from_lane, each.to_lane): sum(network.lanes[via].length for via in each.via) for each in network.connections}


@once
def ring_roads(network: Network) -> frozenset[str]:
    """The roads of all rings."""
    return frozenset(rings(network))


def lane_beside(network: Network, lane: Lane | None, step: int) -> Lane | None:
    """The lane so many lanes towards the middle, when it and all between are for cars."""
    if lane is None or lane.road in ring_roads(network):
        return None
    lanes, to = network.lanes_of(lane.road), lane.index + step
    if not 0 <= to < len(lanes) or not all(each.open for each in lanes[min(lane.index, to) : max(lane.index, to) + 1]):
        return None
    return lanes[to]


def side(network: Network, path: Path, groups: list[Group], step: int) -> Side | None:
    """The path so many lanes aside, where there are such lanes."""
    goals, found = path.points[[PATH_X, PATH_Y]].copy(), []
    for chain in chains(network, groups, step):
        if chain := without_short_ends(path, chain):
            run = longest(on_side(network, path, chain, step, goals))
            found += [run_of(path, run, chain[-1])] if run.size and is_long_enough(path, run) else []
    if not found:
        return None
    made, at, spans = path, np.arange(path.points.shape[1], dtype=float), []
    share = np.zeros(at.size)
    for run in reversed(found):
        part = shares(path, run)
        share += part
        made, at = gone(path, made, at, goals, part)
        spans.append((float(run.first), float(run.last), run.last - run.back if run.back else np.inf))
    lanes = {station.s: lane_beside(network, lane_of(network, station), step) for station in path.stations}
    made = replace(made, stations=tuple(stations_on(path, share, at, lanes)), stop_lines=tuple(stops_on(network, path, share, at, lanes)))
    return Side(step, made, at, tuple(reversed(spans)), free_of(network, groups, step, share))


def lane_of(network: Network, station: Station) -> Lane:
    """The lane of a station."""
    return network.lanes_of(station.road)[station.lane_index]


def chains(network: Network, groups: list[Group], step: int) -> Iterator[list[Group]]:
    """Roads one after the other with a lane beside that leads from each to the next."""
    chain: list[Group] = []
    for each in groups:
        lane = lane_beside(network, each.lane, step)
        if chain and (lane is None or (lane_beside(network, chain[-1].lane, step).id, lane.id) not in ways(network)):  # pyrefly: ignore
            yield chain
            chain = []
        if lane is not None:
            chain.append(each)
    if chain:
        yield chain


def on_side(network: Network, path: Path, chain: list[Group], step: int, goals: np.ndarray) -> np.ndarray:
    """Puts down where the points of a path lie on the lanes beside a chain of its roads; at which points these are so near as lanes are."""
    strands, number = strands_of(network), ways(network)
    lanes = [lane_beside(network, each.lane, step).id for each in chain]  # pyrefly: ignore[missing-attribute]
    order = [strand for lane, then in zip(lanes, [*lanes[1:], -1], strict=True) for strand in (lane, number.get((lane, then), -1))]
    line = joined(strands, [strand for strand in order if strand >= 0])
    last = int(path.length) if chain[-1].following >= path.length else int(chain[-1].end - LAST)
    columns = np.arange(int(np.ceil(chain[0].begin)), max(last, int(chain[0].begin)) + 1)
    columns = columns[columns < path.points.shape[1]]
    at, apart = np.empty(columns.size), np.empty(columns.size)
    if columns.size:
        beside(path.points, columns[0], line, 0, line.shape[1], at, apart)
    near = (np.abs(apart) > abs(step) * WIDTH[0]) & (np.abs(apart) < abs(step) * WIDTH[1]) & (at > 0.0) & (at < line.shape[1] - 1)
    for row, values in enumerate((line[PATH_X], line[PATH_Y])):
        goals[row, columns[near]] = np.interp(at[near], np.arange(line.shape[1]), values)
    return to_the_ends(path, columns[near], goals)


def to_the_ends(path: Path, columns: np.ndarray, goals: np.ndarray) -> np.ndarray:
    """The same points, with those up to an end of the path where they all but reach it: there lanes end a little sooner or later."""
    places, count = path.points[[PATH_X, PATH_Y]], path.points.shape[1]
    if columns.size and columns[0] <= END:
        goals[:, : columns[0]] = places[:, : columns[0]] + (goals - places)[:, columns[0], None]
        columns = np.concatenate([np.arange(columns[0]), columns])
    if columns.size and columns[-1] >= count - 1 - END:
        goals[:, columns[-1] + 1 :] = places[:, columns[-1] + 1 :] + (goals - places)[:, columns[-1], None]
        columns = np.concatenate([columns, np.arange(columns[-1] + 1, count)])
    return columns


def joined(strands: Strands, order: list[int]) -> np.ndarray:
    """The points of strands one after the other."""
    parts = [strands.points[:, strands.first[each] : strands.first[each] + strands.count[each]] for each in order]
    points = np.concatenate(parts, axis=1)
    return points[:, np.append(True, np.hypot(*np.diff(points[[PATH_X, PATH_Y]])) > 1e-3)]


def without_short_ends(path: Path, chain: list[Group]) -> list[Group]:
    """A chain whose last road has room to come back on, unless the path ends there."""
    while chain and chain[-1].following < path.length and chain[-1].end - chain[-1].begin < LEAST + LAST:
        chain = chain[:-1]
    return chain


def longest(columns: np.ndarray) -> np.ndarray:
    """The most points one after the other without a gap."""
    return max(np.split(columns, np.flatnonzero(np.diff(columns) > 1) + 1), key=len)


def run_of(path: Path, columns: np.ndarray, last: Group) -> Run:
    """The run along some points, which comes back on its last road."""
    is_to_the_end = columns[-1] == path.points.shape[1] - 1
    room = columns[-1] - max(last.begin, columns[0] + SHORTEST / 2)
    return Run(int(columns[0]), int(columns[-1]), 0.0 if is_to_the_end else float(np.clip(room, 1.0, taper(path, columns[-1]))))


def is_long_enough(path: Path, run: np.ndarray) -> bool:
    """Whether a lane beside is worth it."""
    ends = (run[0] > 0) + (run[-1] < path.points.shape[1] - 1)
    return run.size * PATH_SPACING > SHORTEST + ends * taper(path, run[-1])


def taper(path: Path, last: int) -> float:
    """Over how many metres a path comes back by `last`."""
    return float(np.clip(BACK * path.points[PATH_SPEED, max(int(last) - 50, 0)], LEAST, MOST))


def shares(path: Path, run: Run) -> np.ndarray:
    """How far the points of a path have gone over, 0 to 1."""
    stations, length = np.arange(path.points.shape[1], dtype=float), run.out(path)
    out = ease((stations - run.first) / length) if length else np.ones(stations.size)
    back = ease((run.last - stations) / run.back) if run.back else np.ones(stations.size)
    return np.where((stations >= run.first) & (stations <= run.last), out * back, 0.0)


def gone(path: Path, made: Path, at: np.ndarray, goals: np.ndarray, share: np.ndarray) -> tuple[Path, np.ndarray]:
    """The path gone over on one stretch, before all that have been made; and where on it all points lie now."""
    inside = np.flatnonzero(share > 0.0)
    low, high = max(inside[0] - 20, 0), min(inside[-1] + 20, share.size)
    moved = made.points[[PATH_X, PATH_Y]].copy()
    places = path.points[[PATH_X, PATH_Y], low:high]
    places = places + share[low:high] * (goals[:, low:high] - places)
    room = np.full(high - low, 2.0 * CORRIDOR)
    moved[:, low:high] = curve.smoothed(places, spacing=PATH_SPACING, wavelength=WAVELENGTH, corridor=room)
    new, on = bent(made, moved, inside[0], inside[-1])
    return new, np.interp(at, np.arange(on.size), on)


def stations_on(path: Path, share: np.ndarray, at: np.ndarray, lanes: dict[float, Lane | None]) -> Iterator[Station]:
    """The stations of the path on a side: on the lane beside, with others where it goes over."""
    ends = [*(each.s for each in path.stations[1:]), path.length]
    grid = np.arange(at.size)
    for each, end in zip(path.stations, ends, strict=True):
        other = lanes[each.s]
        if other is None:
            yield replace(each, s=float(np.interp(each.s, grid, at)))
            continue
        columns = np.arange(int(np.ceil(each.s)), max(int(np.ceil(end)), int(np.ceil(each.s)) + 1))
        over = share[np.minimum(columns, share.size - 1)] > 0.5
        for begin in (0, *np.flatnonzero(np.diff(over)) + 1):
            s = each.s if begin == 0 else float(columns[begin])
            yield Station(each.road, other.index if over[begin] else each.lane_index, float(np.interp(s, grid, at)))


def stops_on(network: Network, path: Path, share: np.ndarray, at: np.ndarray, lanes) -> Iterator[tuple[float, int]]:
    """The stop lines of the path on a side, with the lights of its lanes."""
    link = {each.from_lane: each.link for each in network.connections}
    starts = [each.s for each in path.stations]
    for s, own in path.stop_lines:
        station = starts[max(int(np.searchsorted(starts, s, side="right")) - 1, 0)]
        other = lanes[station] if share[min(int(s), share.size - 1)] > 0.5 else None
        shown = own if other is None else link.get(other.id, -1)
        if shown >= 0:
            yield float(np.interp(s, np.arange(at.size), at)), shown


def free_of(network: Network, groups: list[Group], step: int, share: np.ndarray) -> np.ndarray:
    """Where one may change over: wholly beside, and not near a junction at which one stops or meets others."""
    free, met, number = share > 1.0 - 1e-6, meetings_of(network), ways(network)
    link = {(each.from_lane, each.to_lane): each.link for each in network.connections}
    for one, other in pairwise(groups):
        for beside_by in (0, step):
            lanes = lane_beside(network, one.lane, beside_by), lane_beside(network, other.lane, beside_by)
            pair = (lanes[0].id, lanes[1].id) if lanes[0] and lanes[1] else (-1, -1)
            strand = number.get(pair, -1)
            if strand < 0 or link[pair] >= 0 or met.first[strand + 1] > met.first[strand]:
                free[max(int(one.end - CLEAR), 0) : int(other.begin + BEHIND) + 1] = False
    return free
