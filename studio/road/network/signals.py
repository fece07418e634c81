"""Traffic lights: where the stop lines are, and programmes in which conflicting ways are never green together.

    link        the stop line of one lane
    approach    all signalled lanes of one road: they show the same
    conflict    two approaches whose traffic crosses or merges within `SIGHT` behind the stop lines
    programme   approaches that conflict, directly or by way of others; each gets a phase, phases follow one another

A stop line without conflict guards a pedestrian crossing; it shows what the others of its junction show. Programmes share
one cycle; their offsets let the traffic that starts at one stop line reach the next one at green.
"""

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
import shapely

from studio.compiled import lean
from studio.portable import arctan2

RED, RED_AMBER, GREEN, AMBER = range(4)

CYCLE = 66.0  # [s] short: waiting stays below a minute (RiLSA names 30 to 120 s)
RED_AMBER_TIME = 1.0  # [s] RiLSA
AMBER_TIME = 3.0  # [s] RiLSA, at 50 km/h
ALL_RED_TIME = 2.0  # [s] until the last car has left the crossing
CROSSING_RED_TIME = 12.0  # [s] for those who walk
SHORTEST_SLOT = 15.0  # [s] of a phase with its changes
DEAD_END = 8.0  # [m] between a mapped signal and the end of a road that nothing follows
SIGHT = 60.0  # [m] behind a stop line, where conflicts are looked for
STORAGE = 40.0  # [m] a stop line closer than this to the next one shows the same
WAVE = 300.0  # [m] stop lines farther apart are not coordinated
WAVE_SPEED = 10.0  # [m/s] of a platoon that starts at green


@dataclass(frozen=True, eq=False)
class Signals:
    """Arrays with one entry per link; times within the cycle are in `phase_end` [s], states in `phase_state`."""

    link_lane: np.ndarray
    link_x: np.ndarray
    link_y: np.ndarray
    link_heading: np.ndarray
    link_width: np.ndarray
    programme: np.ndarray
    cycle: np.ndarray
    offset: np.ndarray
    first: np.ndarray
    count: np.ndarray
    phase_end: np.ndarray
    phase_state: np.ndarray
    conflicts: np.ndarray  # int64[2, m] pairs of links that must not be green together

    def __len__(self) -> int:
        return len(self.link_x)

    def state(self, link: int, t: float) -> int:
        """What the link shows at time t [s]."""
        return signal_state(
            t,
            self.cycle[link],
            self.offset[link],
            self.first[link],
            self.count[link],
            self.phase_end,
            self.phase_state,
        )


@lean
def signal_state(t, cycle, offset, first, count, phase_end, phase_state):
    """What a link shows at time t [s]: RED, RED_AMBER, GREEN or AMBER."""
    within = (t - offset) % cycle
    for i in range(first, first + count):
        if within < phase_end[i]:
            return phase_state[i]
    return phase_state[first + count - 1]


@dataclass(frozen=True)
class Approach:
    """The signalled lanes of one road, and where their traffic goes.

    `crossing` are the ways through the junction with the lanes behind it, `reached` all lanes within `SIGHT`, `next` the
    approaches met with their distance [m].
    """

    road: str
    name: str
    junction: str
    lanes: tuple[int, ...]
    crossing: frozenset[int]
    reached: frozenset[int]
    next: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Phase:
    """When an approach is let go: its programme, the start within the programme [s], red-amber to amber [s]."""

    programme: int
    start: float
    duration: float


def dead_ends(lanes, roads, connections, places: list[np.ndarray]) -> frozenset[int]:
    """Lanes that nothing follows, because the map is cut there, and that end at one of these mapped signals [m].

    netconvert signals connections, so it loses a stop line at the border of the map.
    """
    feeding = {connection.from_lane for connection in connections if connection.direction != "turn"}
    ended = [road for road in roads.values() if not road.internal and not feeding & set(road.lanes)]
    found = set()
    for road in ended:
        end = np.mean([lanes[lane].centre[:, -1] for lane in road.lanes], axis=0)
        if any(np.hypot(*(place - end)) < DEAD_END for place in places):
            found |= set(road.lanes)
    return frozenset(found)


def signals(lanes, roads, connections, signalled: frozenset[int]) -> Signals:
    """Stop lines at the ends of the `signalled` lanes, and their programmes."""
    approaches = approaches_of(lanes, roads, connections, signalled)
    against = conflicts(approaches, lanes)
    phases, cycle = plan(approaches, against)
    return arrays(approaches, against, phases, offsets(approaches, phases), cycle, lanes)


# -- who goes where --------------------------------------------------------------------------------


def approaches_of(lanes, roads, connections, signalled: frozenset[int]) -> dict[str, Approach]:
    """The approaches by road id, in order."""
    onward = defaultdict(list)
    for connection in connections:
        onward[connection.from_lane].append(connection)
    found = {}
    for road in sorted({lanes[lane].road for lane in signalled}):
        own = tuple(lane for lane in roads[road].lanes if lane in signalled)
        crossing = frozenset(x for lane in own for c in onward[lane] for x in (*c.via, c.to_lane))
        reached, _ = downstream(own, onward, lanes, signalled, SIGHT)
        _, following = downstream(own, onward, lanes, signalled, WAVE)
        found[road] = Approach(road, roads[road].name, roads[road].to_junction, own, crossing, reached, following)
    return found


def downstream(start, onward, lanes, signalled, limit: float):
    """Lanes reached within `limit` [m] behind the stop lines, and the approaches met there."""
    best, reached, met = dict.fromkeys(start, 0.0), set(), {}
    waiting = list(start)
    while waiting:
        lane = waiting.pop()
        for connection in onward[lane]:
            through = best[lane] + sum(lanes[via].length for via in connection.via)
            reached |= {*connection.via, connection.to_lane}
            distance = through + lanes[connection.to_lane].length
            if connection.to_lane in signalled:
                road = lanes[connection.to_lane].road
                met[road] = min(distance, met.get(road, np.inf))
            elif distance < min(limit, best.get(connection.to_lane, np.inf)):
                best[connection.to_lane] = distance
                waiting.append(connection.to_lane)
    return frozenset(reached), tuple(sorted((road, far) for road, far in met.items() if far < limit))


def conflicts(approaches: dict[str, Approach], lanes) -> dict[str, set[str]]:
    """For each approach those that it must not be green with.

    Where one approach leads to the other, what they share farther on is no conflict, but what crosses in the junction is.
    """
    crossed = crossings(lanes)
    against = {road: set() for road in approaches}
    for a in approaches.values():
        over = a.reached.union(*(crossed[lane] for lane in a.reached))
        here = a.crossing.union(*(crossed[lane] for lane in a.crossing))
        for b in approaches.values():
            serial = any(road == b.road for road, _ in a.next) or any(road == a.road for road, _ in b.next)
            if a.road < b.road and (here & b.crossing or (not serial and over & b.reached)):
                against[a.road].add(b.road)
                against[b.road].add(a.road)
    return against


def crossings(lanes) -> dict[int, set[int]]:
    """For each way through a junction the ways that cross it."""
    inside = [lane for lane in lanes if lane.internal]
    crossed = defaultdict(set)
    if inside:
        lines = [shapely.LineString(lane.centre.T) for lane in inside]
        for a, b in shapely.STRtree(lines).query(lines, predicate="intersects").T:
            if a != b:
                crossed[inside[a].id].add(inside[b].id)
    return crossed


# -- when they go ----------------------------------------------------------------------------------


def plan(approaches: dict[str, Approach], against: dict[str, set[str]]) -> tuple[dict[str, Phase], float]:
    """The phase of every approach, and the cycle that all programmes share [s]."""
    groups = [group for group in components(against) if len(group) > 1]
    colours = [colouring(group, against) for group in groups]
    cycle = max([CYCLE, *(SHORTEST_SLOT * (max(colour.values()) + 1) for colour in colours)])
    phases = {}
    for programme, colour in enumerate(colours):
        slot = cycle / (max(colour.values()) + 1)
        for road, number in colour.items():
            phases[road] = Phase(programme, number * slot, slot - ALL_RED_TIME)
    for road in approaches:
        if road not in phases:
            alone = Phase(programmes(phases), 0.0, cycle - CROSSING_RED_TIME)
            own = follow(approaches[road], phases) or neighbour(approaches[road], approaches, phases)
            phases[road] = own or alone
    return phases, cycle


def programmes(phases: dict[str, Phase]) -> int:
    """How many programmes there are."""
    return max((phase.programme + 1 for phase in phases.values()), default=0)


def follow(approach: Approach, phases: dict[str, Phase]) -> Phase | None:
    """A crossing close before a stop line shows what that one shows, so that nobody is caught between them."""
    near = [road for road, distance in approach.next if distance < STORAGE and road in phases]
    return phases[near[0]] if near else None


def neighbour(approach: Approach, approaches: dict[str, Approach], phases: dict[str, Phase]) -> Phase | None:
    """What another stop line of the same junction shows: both directions stop for the same people on foot."""
    same = [road for road in phases if approach.junction and approaches[road].junction == approach.junction]
    return phases[min(same)] if same else None


def components(against: dict[str, set[str]]) -> list[list[str]]:
    """Approaches that hang together by conflicts."""
    left, found = set(against), []
    for road in sorted(against):
        group, waiting = [], [road] if road in left else []
        while waiting:
            one = waiting.pop()
            if one in left:
                left.remove(one)
                group.append(one)
                waiting += against[one]
        if group:
            found.append(sorted(group))
    return found


def colouring(group: list[str], against: dict[str, set[str]]) -> dict[str, int]:
    """A phase number for each approach, different where they conflict; the most entangled choose first."""
    colour = {}
    for road in sorted(group, key=lambda road: (-len(against[road]), road)):
        taken = {colour.get(other) for other in against[road]}
        colour[road] = next(number for number in range(len(group)) if number not in taken)
    return colour


def offsets(approaches: dict[str, Approach], phases: dict[str, Phase]) -> dict[int, float]:
    """The offset of every programme [s]: from the first one on along the nearest stop lines of the same street."""
    waves = [
        (a.name != approaches[road].name, distance, a.road, road)
        for a in approaches.values()
        for road, distance in a.next
        if phases[a.road].programme != phases[road].programme
    ]
    offset = {}
    for road in sorted(approaches, key=lambda road: (phases[road].programme, road)):
        offset.setdefault(phases[road].programme, 0.0)
        while wave := min((w for w in waves if reaches_out(w, phases, offset)), default=None):
            _, distance, start, end = wave
            green = offset[phases[start].programme] + phases[start].start
            offset[phases[end].programme] = green + distance / WAVE_SPEED - phases[end].start
    return offset


def reaches_out(wave, phases: dict[str, Phase], offset: dict[int, float]) -> bool:
    """Whether a wave leads from a programme with an offset to one without."""
    _, _, start, end = wave
    return phases[start].programme in offset and phases[end].programme not in offset


# -- as arrays -------------------------------------------------------------------------------------


def arrays(approaches, against, phases, offset, cycle: float, lanes) -> Signals:
    """The programmes as the arrays that the simulation reads."""
    links = [(road, lane) for road, approach in approaches.items() for lane in approach.lanes]
    ends = np.array([lanes[lane].centre[:, -1] for _, lane in links]).reshape(-1, 2).T
    steps = np.array([lanes[lane].centre[:, -1] - lanes[lane].centre[:, -2] for _, lane in links]).reshape(-1, 2).T
    own = [phases[road] for road, _ in links]
    pairs = [(i, j) for i, (a, _) in enumerate(links) for j, (b, _) in enumerate(links) if i < j and b in against[a]]
    return Signals(
        link_lane=np.array([lane for _, lane in links], dtype=np.int64),
        link_x=ends[0].copy(),
        link_y=ends[1].copy(),
        link_heading=arctan2(steps[1], steps[0]),
        link_width=np.array([lanes[lane].width for _, lane in links], dtype=float),
        programme=np.array([phase.programme for phase in own], dtype=np.int64),
        cycle=np.full(len(links), cycle),
        offset=np.array([(offset[phase.programme] + phase.start) % cycle for phase in own], dtype=float),
        first=np.arange(len(links), dtype=np.int64) * 4,
        count=np.full(len(links), 4, dtype=np.int64),
        phase_end=np.array([end for phase in own for end in ends_of(phase, cycle)], dtype=float),
        phase_state=np.array([RED_AMBER, GREEN, AMBER, RED] * len(links), dtype=np.int64),
        conflicts=np.array(pairs, dtype=np.int64).reshape(-1, 2).T,
    )


def ends_of(phase: Phase, cycle: float) -> tuple[float, float, float, float]:
    """Ends of red-amber, green, amber and red within the cycle [s]."""
    return RED_AMBER_TIME, phase.duration - AMBER_TIME, phase.duration, cycle
