"""Census: what is counted of everybody, traffic included, and not told one by one. Measures of traffic are made of it.

    arrived      a vehicle has come to the end of its way, whether it comes in again or not
    at red       its front has passed a stop line that shows red
    off          its centre of gravity has left the lanes of its direction
    waited       it has stood, and drives again; how long it stood
    ring         it has stood in a ring of vehicles each of whom waits for the next; how long. Looked for once a second among whom drivers
                 mind (MINDED), so that a long queue is none
    conflict     its front has entered a place where it gives way to another who was on his way there, or on it; how hard the other braked
    violation    a conflict in which the other braked harder than drivers do to be kind, or came to a crossing where the first had only
                 just left, or had not yet
    entered      a car of a flow has come in; how late
    outside      one that is due has not come in when the run is over; how long it has waited

Whoever stands behind a line is in no conflict: what counts is who enters the place, and whether this cost the other anything. StVO § 8 (2)
has it so: who gives way must neither endanger nor substantially hinder. Rows of the table are emptied now and then.
"""

from dataclasses import dataclass
from math import inf, nan

import numpy as np

from studio.bound import bound
from studio.compiled import inlined, lean
from studio.model.driver import COURTESY
from studio.road.ways.conflict import ACROSS, GIVE
from studio.road.ways.path import PATH_SPACING
from studio.rows import Role, Table
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import ACTIVE, V_X
from studio.world.passes.junction import STANDING
from studio.world.passes.notice import has_passed_red
from studio.world.passes.queue import EARLY, KEY, NEAR, WHO, first_drive, from_station, station_on
from studio.world.passes.traffic import ARRIVAL
from studio.world.table.chart import LANE_WIDTH, LANES_LEFT, LANES_RIGHT
from studio.world.table.mind import ASIDE, FOLLOWING, MINDED, OFFSET, OUT_BY, RED_STATION, STATION, STOOD, YIELDING
from studio.world.table.web import ENTER, ITS_ENTER, ITS_LEAVE, LANE, OWN_ENTER, OWN_LEAVE
from studio.world.world import World

COUNTED = ("arrived", "at red", "off", "waited", "ring", "conflict", "violation", "entered", "outside")
CAME, AT_RED, OFF, WAITED, RING, CONFLICT, VIOLATION, ENTERED, OUTSIDE = range(len(COUNTED))

CENSUS = Table("census", Role.RECORD, per="event")
C_TIME = CENSUS.row("time", "s", "when it was over; of a conflict, when it began")
C_KIND = CENSUS.row("kind", "1", "what is counted, its place in COUNTED")
C_WORLD = CENSUS.row("world", "1", "number of the world")
C_WHO = CENSUS.row("who", "1", "number of the vehicle in its world")
C_OTHER = CENSUS.row("other", "1", "number of the vehicle that goes first; -1 for none")
C_VALUE = CENSUS.row("value", "1", "how long [s], or how hard the other braked [m/s²]")

PAIR = Table("pair", Role.RECORD, per="place where two may meet")
P_OTHER = PAIR.row("other", "1", "column of the vehicle that goes first; -1 of a place that is free")
P_BEGAN = PAIR.row("began", "s", "when the other one entered")
P_LEAVES = PAIR.row("leaves", "m", "station of its front when it has left")
P_COMES = PAIR.row("comes", "m", "station of the front of the one that goes first, when it is there")
P_LEFT = PAIR.row("left", "s", "when the first had left; not a number before")
P_BRAKED = PAIR.row("braked", "m/s²", "hardest braking of the one that goes first while the other asked it to")
P_ACROSS = PAIR.row("across", "1", "1 where one crosses the other's way")

MOST = 6  # others whom one that enters is watched with
JUST = 0.5  # [s] one who comes so soon after the first has left was hindered
AFTERWARDS = 5.0  # [s] that a pair is watched once the first has left
LEAST_WAIT = 1.0  # [s] a shorter stand is not counted
EVERY = 1.0  # [s] rings are looked for so often
IN_RING = 1 << 40  # a mark; no column is so large
ONE_TICK = 2.0  # [m] before the end, whoever is there may arrive in a tick
ROWS_OF_ONE = 6 + 2 * MOST  # that one vehicle may add in a tick


@dataclass
class Census:
    """What is known of the tick before, who is in a conflict, and what is counted, [row, event]; `count` of them stand there."""

    front: np.ndarray  # [m] per vehicle, the station of its bumper at the tick before; not a number when it was on another path
    path: np.ndarray  # per vehicle, the first point of its path then
    end: np.ndarray  # [m] per vehicle, the station at which that path ends
    speed: np.ndarray  # [m/s] per vehicle
    stood: np.ndarray  # [s] per vehicle
    off: np.ndarray  # per vehicle, 1 while it is off its lanes
    ringed: np.ndarray  # [s] per vehicle, how long it has been in a ring
    mark: np.ndarray  # int64[vehicle], scratch
    watched: np.ndarray  # int64[vehicle], how many others it is watched with
    pairs: np.ndarray  # float64[row, MOST, vehicle]
    table: np.ndarray
    count: np.ndarray  # int64[1]

    @property
    def is_nearly_full(self) -> bool:
        """Whether all that may be counted in one more tick might not find room."""
        return 2 * int(self.count[0]) > self.table.shape[1]

    def taken(self) -> np.ndarray:
        """Empties the table: what stood in it."""
        rows, self.count[0] = self.table[:, : self.count[0]].copy(), 0
        return rows


def census(world: World) -> Census:
    """Nothing counted yet."""
    n = world.size
    pairs = np.full((len(PAIR), MOST, n), nan)
    pairs[P_OTHER] = -1.0
    return Census(
        front=np.full(n, nan),
        path=np.full(n, -1),
        end=np.zeros(n),
        speed=np.zeros(n),
        stood=np.zeros(n),
        off=np.zeros(n, dtype=np.int64),
        ringed=np.zeros(n),
        mark=np.zeros(n, dtype=np.int64),
        watched=np.zeros(n, dtype=np.int64),
        pairs=pairs,
        table=np.zeros((len(CENSUS), 2 * ROWS_OF_ONE * n)),
        count=np.zeros(1, dtype=np.int64),
    )


def take(world: World, at: Census) -> None:
    """The pass: everybody, as of the instant at which they looked."""
    clock = world.clock
    now = (clock.k - 1) * clock.tick
    run = world.ready.get(take)
    if run is None:
        run = world.ready[take] = bound(*taking(world, at), then=(now, clock.tick))
    run(now, clock.tick)


def taking(world: World, at: Census) -> tuple:
    """With its arrays, which stay where they are."""
    v, r, q, w = world.vehicles, world.roads, world.queues, world.worlds
    who = (v.state, v.parameter, v.mind, v.removed, w.of, w.number, w.first)
    road = (
        r.chart,
        0.5 * float(r.chart[LANE_WIDTH].min(initial=inf)),
        r.path_first,
        r.path_count,
        r.stop_first,
        r.stop_count,
        r.stop_station,
        r.stop_link,
        r.shown,
    )
    before = (at.front, at.path, at.end, at.speed, at.stood, at.off)
    own = (world.demand.came, *before, at.ringed, at.mark, at.watched, at.pairs, at.table, at.count)
    return everybody, *who, *road, r.drive_first, r.drive_count, r.web, q.first, q.place, q.at, *own


@lean
def everybody(state, parameter, mind, removed, world_of, number, first_of, chart, within, path_first, path_count, stop_first,
              stop_count, stop_station, stop_link, shown, drive_first, drive_count, web, first, place, at, came, front,
              path, end, speed, stood, off, ringed, mark, watched, pairs, table, count, now, tick):  # fmt: skip
    """Each for himself, then the pairs, then the rings."""
    for v in range(state.shape[1]):
        bumper = mind[STATION, v] + parameter[FRONT, v]
        before = front[v] if path[v] == path_first[v] else nan
        is_there = state[ACTIVE, v] > 0.0
        is_at_end = front[v] > end[v] - ARRIVAL - ONE_TICK
        if removed[v] == 0 and is_at_end and (not is_there or bumper < front[v]):
            note(now, CAME, v, -1, nan, world_of, number, table, count)
        if is_there and front[v] != front[v] and came[v] >= 0.0:
            note(now, ENTERED, v, -1, came[v], world_of, number, table, count)
        if is_there and has_passed_red(before, bumper, stop_first[v], stop_count[v], stop_station, stop_link, shown):
            note(now, AT_RED, v, -1, state[V_X, v], world_of, number, table, count)
        if is_there and bumper > before:
            enter(
                v, before, bumper, now, state, parameter, mind, world_of, drive_first[v], drive_count[v], web, first, place, at, watched,
                pairs,
            )  # fmt: skip
        wait(v, now, is_there, mind, world_of, number, stood, table, count)
        if off[v] != 0 or abs(mind[OFFSET, v]) > within:  # nobody is off who is nearer to his line than the edge of any lane
            keep_to_lanes(v, now, is_there, mind, chart, path_first[v], path_count[v], world_of, number, off, table, count)
        front[v], path[v], end[v] = bumper if is_there else nan, path_first[v], (path_count[v] - 1) * PATH_SPACING
    for v in range(state.shape[1]):
        if watched[v] > 0:
            watch(v, now, tick, state, parameter, mind, world_of, number, speed, watched, pairs, table, count)
    for v in range(state.shape[1]):
        speed[v] = state[V_X, v]
    if int(now / EVERY) != int((now - tick) / EVERY):
        find_rings(now, state, mind, world_of, number, first_of, ringed, mark, table, count)


@inlined
def note(time, kind, v, other, value, world_of, number, table, count):
    """Writes one row; the other one by its column, -1 for none."""
    i = count[0]
    table[C_TIME, i], table[C_KIND, i], table[C_WORLD, i], table[C_WHO, i] = time, kind, world_of[v], number[v]
    table[C_OTHER, i], table[C_VALUE, i] = number[other] if other >= 0 else -1, value
    count[0] = i + 1


@inlined
def wait(v, now, is_there, mind, world_of, number, stood, table, count):
    """One who has stood drives again, or is gone."""
    stands = mind[STOOD, v] if is_there else 0.0
    if stands == 0.0 and stood[v] >= LEAST_WAIT:
        note(now, WAITED, v, -1, stood[v], world_of, number, table, count)
    stood[v] = stands


@inlined
def keep_to_lanes(v, now, is_there, mind, chart, first, points, world_of, number, off, table, count):
    """One who has left the lanes of his direction; who passes on the oncoming lane, the way that he means to drive."""
    at = first + int(min(max(mind[STATION, v] / PATH_SPACING, 0.0), points - 1.0))
    width = chart[LANE_WIDTH, at]
    offset = mind[OFFSET, v] - mind[ASIDE, v] if mind[OUT_BY, v] != 0.0 else mind[OFFSET, v]
    is_off = is_there and not -(chart[LANES_RIGHT, at] + 0.5) * width <= offset <= (chart[LANES_LEFT, at] + 0.5) * width
    if is_off and off[v] == 0:
        note(now, OFF, v, -1, mind[OFFSET, v], world_of, number, table, count)
    off[v] = 1 if is_off else 0


# -- who goes first --------------------------------------------------------------------------------


@lean
def enter(v, before, bumper, now, state, parameter, mind, world_of, drive_first, drive_count, web, first, place, at, watched,
          pairs):  # fmt: skip
    """The places where v gives way that its front has entered in this tick, and who was on his way there."""
    for d in range(first_drive(bumper - parameter[LENGTH, v], drive_first, drive_count, web), drive_first + drive_count):
        if web.drive[ENTER, d] > bumper:
            return
        strand = web.strand[d]
        if web.right[strand] == LANE:
            continue
        nose = station_on(d, mind[STATION, v], web) + parameter[FRONT, v]
        for m in range(web.first[strand], web.first[strand + 1]):
            if web.turn[m] == GIVE and nose - (bumper - before) < web.span[OWN_ENTER, m] <= nose:
                key = world_of[v] * web.right.size + web.partner[m]
                meet(v, m, key, nose, bumper, now, state, parameter, mind, web, first, place, at, watched, pairs)


@inlined
def meet(v, m, key, nose, bumper, now, state, parameter, mind, web, first, place, at, watched, pairs):
    """Everybody who was on his way to a place that v has entered, or on it."""
    i, end = from_station(key, -inf, first, place, at)
    while i < end and place[KEY, i] == key:
        other, left, i = place[WHO, i], web.span[ITS_ENTER, m] - at[i] - parameter[FRONT, place[WHO, i]], i + 1
        red = mind[RED_STATION, other] - mind[STATION, other] - parameter[FRONT, other]
        is_there = (
            web.shape[m] == ACROSS and left <= 0.0 and left + parameter[LENGTH, other] > web.span[ITS_ENTER, m] - web.span[ITS_LEAVE, m]
        )
        if other != v and (is_there or 0.0 < left < min(red, NEAR + EARLY * max(state[V_X, other], 0.0))):
            open_pair(v, other, m, nose, bumper, left, now, parameter, mind, web, watched, pairs)


@inlined
def open_pair(v, other, m, nose, bumper, left, now, parameter, mind, web, watched, pairs):
    """From now on the two are watched; of two places where they meet the first counts."""
    free = MOST - 1
    for i in range(MOST):
        if pairs[P_OTHER, i, v] == other:
            return
        if pairs[P_OTHER, i, v] < 0.0:
            free = min(free, i)
    watched[v] += pairs[P_OTHER, free, v] < 0.0
    pairs[P_OTHER, free, v], pairs[P_BEGAN, free, v], pairs[P_LEFT, free, v], pairs[P_BRAKED, free, v] = other, now, nan, 0.0
    pairs[P_LEAVES, free, v] = bumper + web.span[OWN_LEAVE, m] - nose + parameter[LENGTH, v]
    pairs[P_COMES, free, v] = mind[STATION, other] + parameter[FRONT, other] + left
    pairs[P_ACROSS, free, v] = 1.0 if web.shape[m] == ACROSS else 0.0


@inlined
def watch(v, now, tick, state, parameter, mind, world_of, number, speed, watched, pairs, table, count):
    """How the pairs of one who has entered go on."""
    for i in range(MOST):
        if pairs[P_OTHER, i, v] < 0.0:
            continue
        other = int(pairs[P_OTHER, i, v])
        is_asked = min(mind[FOLLOWING, other], mind[YIELDING, other]) < 0.0  # or it slows yet for somebody else, as brakes let go late
        if mind[MINDED, other] == number[v] and is_asked:
            pairs[P_BRAKED, i, v] = max(pairs[P_BRAKED, i, v], (speed[other] - state[V_X, other]) / tick)
        if pairs[P_LEFT, i, v] != pairs[P_LEFT, i, v] and mind[STATION, v] + parameter[FRONT, v] >= pairs[P_LEAVES, i, v]:
            pairs[P_LEFT, i, v] = now
        comes = mind[STATION, other] + parameter[FRONT, other] >= pairs[P_COMES, i, v]
        if comes or now > pairs[P_LEFT, i, v] + AFTERWARDS or state[ACTIVE, other] == 0.0 or state[ACTIVE, v] == 0.0:
            close_pair(v, i, other, comes, now, world_of, number, watched, pairs, table, count)


@inlined
def close_pair(v, i, other, comes, now, world_of, number, watched, pairs, table, count):
    """What it was in the end."""
    began, braked = pairs[P_BEGAN, i, v], pairs[P_BRAKED, i, v]
    is_close = comes and pairs[P_ACROSS, i, v] > 0.0 and not now > pairs[P_LEFT, i, v] + JUST
    note(began, CONFLICT, v, other, braked, world_of, number, table, count)
    if braked > COURTESY or is_close:
        note(began, VIOLATION, v, other, braked, world_of, number, table, count)
    pairs[P_OTHER, i, v] = -1.0
    watched[v] -= 1


# -- who waits for whom ----------------------------------------------------------------------------


@inlined
def waits_for(v, state, mind, world_of, first_of):
    """The column of whom a standing vehicle minds; -1 when it drives or minds nobody."""
    stands = state[ACTIVE, v] > 0.0 and abs(state[V_X, v]) < STANDING
    return first_of[world_of[v]] + int(mind[MINDED, v]) if stands and mind[MINDED, v] >= 0.0 else -1


@lean
def find_rings(now, state, mind, world_of, number, first_of, ringed, mark, table, count):
    """Rings of the graph of who waits for whom: every chain is followed once, and one that comes back to itself has a ring."""
    mark[:] = -1
    for start in range(mark.size):
        v = start
        while v >= 0 and mark[v] < 0:
            mark[v] = start
            v = waits_for(v, state, mind, world_of, first_of)
        if v >= 0 and mark[v] == start:
            while mark[v] != IN_RING:
                mark[v] = IN_RING
                v = waits_for(v, state, mind, world_of, first_of)
    for v in range(mark.size):
        if mark[v] == IN_RING:
            ringed[v] += EVERY
        elif ringed[v] > 0.0:
            note(now, RING, v, -1, ringed[v], world_of, number, table, count)
            ringed[v] = 0.0


def nothing() -> np.ndarray:
    """No rows."""
    return np.zeros((len(CENSUS), 0))


def unfinished(world: World, at: Census) -> np.ndarray:
    """Who still waits, stands in a ring, or has not come in, as rows of the table."""
    w, d, now = world.worlds, world.demand, world.clock.time
    found = [
        (now, kind, w.of[v], w.number[v], -1.0, values[v])
        for kind, values in ((WAITED, at.stood), (RING, at.ringed))
        for v in np.flatnonzero(values >= LEAST_WAIT).tolist()
    ]
    for i, column in enumerate(d.column.tolist()):
        due = d.due[d.first[i] + d.gone[i] : d.first[i + 1]]
        found += [(now, OUTSIDE, d.world[i], w.number[column], -1.0, now - time) for time in due[due < now].tolist()]
    return np.array(found, dtype=float).reshape(-1, len(CENSUS)).T
