"""Notices: what has happened in a tick, found by compiled code and written into a table that is emptied now and then.

A notice is a row of numbers; words are made of it only when somebody reads the table. Everything is noticed once, but for
company, waiting at red lights and drivers who overrule applications, which come and go.
"""

from dataclasses import dataclass

import numpy as np

from studio.compiled import lean
from studio.rows import Role, Table
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import ACTIVE, ROLL, V_X
from studio.world.table.mind import ACTS_COLLISION, AHEAD, RED_STATION, STATION
from studio.world.world import World

NOTICE = Table("notice", Role.RECORD, per="notice")
N_TIME = NOTICE.row("time", "s", "at the end of the tick in which it was found")
N_KIND = NOTICE.row("kind", "1", "what has happened")
N_WORLD = NOTICE.row("world", "1", "number of the world")
N_SUBJECT = NOTICE.row("subject", "1", "number of the trigger, change or follower in the batch, of the collision or vehicle in its world")
N_OTHER = NOTICE.row("other", "1", "number of the vehicle that has come between, or of the reason; -1 for none")
TRIGGERED, BEGUN, ENDED, HIT, ROLLED_OVER, ARRIVED, COMPANY, WAITS, TAKES_OVER = range(9)

AT_THE_LINE = 8.0  # [m] before the stop line and nearer, a car that stands is the one that waits
STANDING = 0.1  # [m/s]
ROLLED = 1.0  # [rad] a vehicle that leans farther has rolled over
REASONS = 3  # for which a driver overrules an application
TOLD_OF_A_VEHICLE = 3 + REASONS  # notices that one vehicle may give in one tick


@dataclass
class Watch:
    """What is looked out for, what has been told of it, and the table of notices, [row, notice]; `count` of them stand in it."""

    named: np.ndarray  # int64[vehicle], 1 for a vehicle of the file, whose arrival and waiting is told
    trigger_world: np.ndarray
    change_world: np.ndarray
    follower: np.ndarray  # column of each car that listens to the one ahead of it
    member_first: np.ndarray  # of its chain, per follower
    member_count: np.ndarray
    member: np.ndarray  # numbers of the chains' vehicles in their world
    triggers_told: np.ndarray
    changes_told: np.ndarray  # [begun or over, change]
    hits_told: np.ndarray  # per world
    vehicles_told: np.ndarray  # [rolled over or arrived, vehicle]
    waiting: np.ndarray  # int64[vehicle], 1 while it stands at a red light
    acting: np.ndarray  # int64[reason, vehicle], 1 while its driver overrules its application
    between: np.ndarray  # per follower, the number of the car between it and the one that it listens to
    table: np.ndarray
    count: np.ndarray  # int64[1]

    @property
    def is_nearly_full(self) -> bool:
        """Whether all that may happen in one more tick might not find room."""
        return 2 * int(self.count[0]) > self.table.shape[1]


def watch(world: World, named: np.ndarray, followers: list[tuple[int, tuple[int, ...]]]) -> Watch:
    """Looks out for everything; followers are columns, each with the numbers of the vehicles of its chain."""
    w, e, c, n = world.worlds, world.events, world.changes, world.size
    sizes = np.array([len(members) for _, members in followers], dtype=np.int64)
    most = e.fired.size + 2 * c.phase.size + e.hits.shape[1] + TOLD_OF_A_VEHICLE * n + sizes.size
    return Watch(
        named=named,
        trigger_world=w.of[e.trigger_vehicle],
        change_world=c.world,
        follower=np.array([column for column, _ in followers], dtype=np.int64),
        member_first=np.cumsum(sizes) - sizes,
        member_count=sizes,
        member=np.array([number for _, members in followers for number in members], dtype=np.int64),
        triggers_told=np.zeros(e.fired.size, dtype=np.int64),
        changes_told=np.zeros((2, c.phase.size), dtype=np.int64),
        hits_told=np.zeros(w.first.size, dtype=np.int64),
        vehicles_told=np.zeros((2, n), dtype=np.int64),
        waiting=np.zeros(n, dtype=np.int64),
        acting=np.zeros((REASONS, n), dtype=np.int64),
        between=np.full(sizes.size, -1),
        table=np.zeros((len(NOTICE), 2 * most)),
        count=np.zeros(1, dtype=np.int64),
    )


def notice(world: World, at: Watch) -> None:
    """The pass: all that has happened in the tick that is over."""
    v, e, time = world.vehicles, world.events, world.clock.time
    notice_events(
        time, e.fired, at.trigger_world, at.triggers_told, world.changes.phase, at.change_world, at.changes_told, e.found, at.hits_told,
        at.table, at.count,
    )  # fmt: skip
    notice_vehicles(time, v.state, world.worlds.of, world.worlds.number, at.named, at.vehicles_told, at.table, at.count)
    notice_company(time, v.mind, world.worlds.of, at.follower, at.member_first, at.member_count, at.member, at.between, at.table, at.count)
    notice_waiting(time, v.state, v.mind, v.parameter, world.worlds.of, world.worlds.number, at.named, at.waiting, at.table, at.count)
    notice_drivers(time, v.mind, world.worlds.of, world.worlds.number, at.acting, at.table, at.count)


@lean
def note(time, kind, world, subject, other, table, count):
    """Writes one notice."""
    i = count[0]
    table[N_TIME, i] = time
    table[N_KIND, i] = kind
    table[N_WORLD, i] = world
    table[N_SUBJECT, i] = subject
    table[N_OTHER, i] = other
    count[0] = i + 1


@lean
def is_news(true, told, i):
    """Whether something has become true, and this has not been told; from now on it has."""
    if not true or told[i] != 0:
        return False
    told[i] = 1
    return True


@lean
def notice_events(time, fired, trigger_world, triggers_told, phase, change_world, changes_told, found, hits_told, table, count):
    """Maneuvers that have begun, changes of the road that have begun or ended, collisions."""
    for i in range(fired.size):
        if is_news(fired[i] != 0, triggers_told, i):
            note(time, TRIGGERED, trigger_world[i], i, -1, table, count)
    for i in range(phase.size):
        for turn in range(2):
            if is_news(phase[i] > turn, changes_told[turn], i):
                note(time, BEGUN + turn, change_world[i], i, -1, table, count)
    for w in range(found.size):
        for i in range(hits_told[w], found[w]):
            note(time, HIT, w, i, -1, table, count)
        hits_told[w] = found[w]


@lean
def is_waiting(v, state, mind, parameter):
    """Whether a vehicle stands at a red light."""
    distance = mind[RED_STATION, v] - mind[STATION, v] - parameter[FRONT, v]
    return distance < AT_THE_LINE and state[V_X, v] < STANDING


@lean
def notice_vehicles(time, state, world_of, number, named, told, table, count):
    """Vehicles that have rolled over, and named ones that have arrived."""
    for v in range(named.size):
        if is_news(abs(state[ROLL, v]) > ROLLED, told[0], v):
            note(time, ROLLED_OVER, world_of[v], number[v], -1, table, count)
    for v in range(named.size):
        if named[v] != 0 and is_news(state[ACTIVE, v] == 0.0, told[1], v):
            note(time, ARRIVED, world_of[v], number[v], -1, table, count)


@lean
def notice_waiting(time, state, mind, parameter, world_of, number, named, waiting, table, count):
    """Named vehicles that have come to a stand at a red light."""
    for v in range(named.size):
        waits = named[v] != 0 and is_waiting(v, state, mind, parameter)
        if waits and waiting[v] == 0:
            note(time, WAITS, world_of[v], number[v], -1, table, count)
        waiting[v] = 1 if waits else 0


@lean
def notice_drivers(time, mind, world_of, number, acting, table, count):
    """Drivers who have begun to overrule their application, and for which reason."""
    for i in range(REASONS):
        for v in range(number.size):
            acts = mind[ACTS_COLLISION + i, v] != 0.0
            if acts and acting[i, v] == 0:
                note(time, TAKES_OVER, world_of[v], number[v], i, table, count)
            acting[i, v] = 1 if acts else 0


@lean
def is_member(number, first, count, member):
    """Whether a vehicle belongs to a chain."""
    for i in range(first, first + count):
        if member[i] == number:
            return True
    return False


@lean
def notice_company(time, mind, world_of, follower, member_first, member_count, member, between, table, count):
    """Somebody has come between a follower and the car that it listens to, or has gone again."""
    for i in range(follower.size):
        seen = int(mind[AHEAD, follower[i]])
        if seen < 0 or is_member(seen, member_first[i], member_count[i], member):
            seen = -1
        if seen != between[i]:
            between[i] = seen
            note(time, COMPANY, world_of[follower[i]], i, seen, table, count)
