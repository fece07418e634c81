"""Notices: what has happened in a tick, found by compiled code and written into a table that is emptied now and then.

A notice is a row of numbers; words are made of it only when somebody reads the table (execution/event.py). Everything is noticed once,
but for company, waiting at red lights, drivers who overrule applications and who commands, which come and go, and for red lights that are
passed.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, isnan, nan

import numpy as np

from studio.bound import bound
from studio.compiled import inlined, lean
from studio.road.network.signals import RED
from studio.rows import Role, Table
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import ACTIVE, ROLL, V_X, X, Y
from studio.world.board.air import EARLY
from studio.world.board.host import Hosted
from studio.world.table.event import (
    ARRIVED,
    COMMAND_TAKEN,
    COMPANY_CAME,
    COMPANY_LEFT,
    HIT,
    MESSAGE_LOST,
    NOTICE_SHOWN,
    RED_PASSED,
    ROLLED_OVER,
    SCRIPT_BEGUN,
    SCRIPT_CUT,
    SCRIPT_ENDED,
    SCRIPT_VAIN,
    TAKES_OVER,
    WAITS,
)
from studio.world.table.mind import ACTS_COLLISION, AHEAD, COMMANDED, COMMANDS_WHEEL, INTERVENTION_HAS, RED_STATION, STATION
from studio.world.table.street import HIT_FIRST, HIT_SECOND, HIT_SPEED, HIT_TIME
from studio.world.table.unit import H_CAME, H_MISSED, TRUE_X, TRUE_Y
from studio.world.world import World

NOTICE = Table("notice", Role.RECORD, per="notice")
N_TIME = NOTICE.row("time", "s", "when it happened")
N_KIND = NOTICE.row("kind", "1", "what has happened, as table/event.py numbers it")
N_WORLD = NOTICE.row("world", "1", "number of the world")
N_SUBJECT = NOTICE.row("subject", "1", "number of the vehicle in its world, or of the entry of the script or the follower in the batch")
N_OTHER = NOTICE.row("other", "1", "number of another vehicle, or OBJECT - i; -1 for none")
N_X = NOTICE.row("x", "m", "east position of what it is about; not a number when it has none")
N_Y = NOTICE.row("y", "m", "north position")
N_VALUE = NOTICE.row("value", "1", "its number, in the unit that table/event.py gives it")

AT_THE_LINE = 8.0  # [m] before the stop line and nearer, a car that stands is the one that waits
STANDING = 0.1  # [m/s]
ROLLED = 1.0  # [rad] a vehicle that leans farther has rolled over
REASONS = 3  # for which a driver overrules an application
HANDS = len(COMMANDED)  # wheel, brake, drive, gear
SETTLED = 0.5  # [s] a change of hands is told at once when there was none for so long, else once it has lasted so long
NUMBERS = 1024  # a change of hands is one number: which of the four, who had them, who has them now
TOLD_OF_A_VEHICLE = 4 + REASONS + HANDS  # notices that one vehicle may give in one tick


@dataclass
class Watch:
    """What is looked out for, what has been told of it, and the table of notices, [row, notice]; `count` of them stand in it."""

    named: np.ndarray  # int64[vehicle], 1 for a vehicle of the file, whose arrival and waiting is told
    script_world: np.ndarray  # per entry
    follower: np.ndarray  # column of each car that listens to the one ahead of it
    member_first: np.ndarray  # of its chain, per follower
    member_count: np.ndarray
    member: np.ndarray  # numbers of the chains' vehicles in their world
    script_told: np.ndarray  # [s] float64[begun or over, entry]: when the turn that was told last came, not a number before
    hits_told: np.ndarray  # per world
    vehicles_told: np.ndarray  # [rolled over or arrived, vehicle]
    waiting: np.ndarray  # int64[vehicle], 1 while it stands at a red light
    front: np.ndarray  # [m] per vehicle, the station of its bumper at the tick before; not a number when it was on another path
    path: np.ndarray  # per vehicle, the first point of its path at the tick before
    acting: np.ndarray  # int64[reason, vehicle], 1 while its driver overrules its application
    hands: np.ndarray  # int64[hand, vehicle]: who has it as told last, -1 while nobody has been seen to have it
    hands_since: np.ndarray  # [s] float64[hand, vehicle]: when this was told
    between: np.ndarray  # per follower, the number of the car between it and the one that it listens to
    listened: list[np.ndarray]  # per post, the links whose losses are told
    shown: list[tuple[Hosted, np.ndarray]]  # applications that show notices, with what each unit showed at the tick before
    hits: int  # collisions that there is room for in one tick
    table: np.ndarray
    count: np.ndarray  # int64[1]

    @property
    def is_nearly_full(self) -> bool:
        """Whether all that may happen in one more tick might not find room."""
        return 2 * int(self.count[0]) > self.table.shape[1]

    def make_room(self, hits: int) -> None:
        """There may be more collisions now."""
        if hits > self.hits:
            self.table = np.concatenate([self.table, np.zeros((len(NOTICE), 2 * (hits - self.hits)))], axis=1)
            self.hits = hits


def watch(world: World, named: np.ndarray, followers: list[tuple[int, tuple[int, ...]]], listened: list[np.ndarray]) -> Watch:
    """Looks out for everything; followers are columns, each with the numbers of its chain's vehicles; `listened` are links, per post."""
    w, e, s, n = world.worlds, world.events, world.script, world.size
    sizes = np.array([len(members) for _, members in followers], dtype=np.int64)
    links, shown = sum(each.size for each in listened), [each for each in world.hosted if each.shows]
    on_board = links + sum(each.unit.size for each in shown)
    most = 2 * s.phase.size + e.hits.shape[1] + TOLD_OF_A_VEHICLE * n + sizes.size + on_board
    return Watch(
        named=named,
        script_world=s.world,
        follower=np.array([column for column, _ in followers], dtype=np.int64),
        member_first=np.cumsum(sizes) - sizes,
        member_count=sizes,
        member=np.array([number for _, members in followers for number in members], dtype=np.int64),
        script_told=np.full((2, s.phase.size), nan),
        hits_told=np.zeros(w.first.size, dtype=np.int64),
        vehicles_told=np.zeros((2, n), dtype=np.int64),
        waiting=np.zeros(n, dtype=np.int64),
        front=np.full(n, nan),
        path=np.full(n, -1),
        acting=np.zeros((REASONS, n), dtype=np.int64),
        hands=np.full((HANDS, n), -1),
        hands_since=np.full((HANDS, n), -inf),
        between=np.full(sizes.size, -1),
        listened=listened,
        shown=[(each, np.zeros(each.unit.size)) for each in shown],
        hits=e.hits.shape[1],
        table=np.zeros((len(NOTICE), 2 * most)),
        count=np.zeros(1, dtype=np.int64),
    )


def notice(world: World, at: Watch) -> None:
    """The pass: all that has happened in the tick that is over."""
    at.make_room(world.events.hits.shape[1])
    time = world.clock.time
    now = time - world.clock.tick  # the instant at which everybody looked, decided and told
    if notice not in world.ready:
        world.ready[notice] = [bound(*each, at.table, at.count, then=(time, now)) for each in noticing(world, at)]
    for look in world.ready[notice]:
        look(time, now)


def noticing(world: World, at: Watch) -> Iterator[tuple]:
    """What is looked at, with its arrays, which stay where they are as long as there is room for collisions."""
    v, e, s, w, r, u = world.vehicles, world.events, world.script, world.worlds, world.roads, world.units
    script, hits = (s.turned, s.cut, s.vehicle, at.script_world, at.script_told), (e.found, e.hits, w.first, at.hits_told)
    arrivals = (w.of, w.number, at.named, v.removed, at.vehicles_told)
    company = (at.follower, at.member_first, at.member_count, at.member, at.between)
    yield notice_events, *script, *hits, *arrivals, *company, at.acting, at.hands, at.hands_since, v.state, v.mind
    if r.stop_station.size:
        stops = (r.path_first, r.stop_first, r.stop_count, r.stop_station, r.stop_link, r.shown)
        yield notice_lights, v.state, v.mind, v.parameter, w.of, w.number, at.named, *stops, at.waiting, at.front, at.path
    for post, links in zip(u.posts, at.listened, strict=True):
        if links.size:
            ends = (post.link_receiver, post.sender, post.link_sender)
            yield notice_messages, links, post.inbox, *ends, u.world, u.first, u.now
    for i, (hosted, told) in enumerate(at.shown):
        yield notice_shown, i, hosted.shown, told, hosted.unit, u.world, u.first, u.now


@lean
def note(time, kind, world, subject, other, x, y, value, table, count):
    """Writes one notice."""
    i = count[0]
    table[N_TIME, i] = time
    table[N_KIND, i] = kind
    table[N_WORLD, i] = world
    table[N_SUBJECT, i] = subject
    table[N_OTHER, i] = other
    table[N_X, i] = x
    table[N_Y, i] = y
    table[N_VALUE, i] = value
    count[0] = i + 1


@inlined
def note_vehicle(time, kind, v, other, value, state, world_of, number, table, count):
    """Writes one notice about a vehicle, at its place."""
    note(time, kind, world_of[v], number[v], other, state[X, v], state[Y, v], value, table, count)


@lean
def is_news(true, told, i):
    """Whether something has become true, and this has not been told; from now on it has."""
    if not true or told[i] != 0:
        return False
    told[i] = 1
    return True


@lean
def notice_events(turned, cut, vehicle, script_world, script_told, found, hits, first, hits_told, world_of, number, named, removed,
                  vehicles_told, follower, member_first, member_count, member, between, acting, hands, hands_since, state, mind, table,
                  count, time, now):  # fmt: skip
    """What may happen in every world, in one call: what the script, collisions, routes, chains and drivers have brought."""
    notice_script(turned, cut, vehicle, state, script_world, script_told, table, count)
    notice_hits(found, hits, first, state, hits_told, table, count)
    notice_vehicles(time, state, world_of, number, named, removed, vehicles_told, table, count)
    notice_company(now, state, mind, world_of, follower, member_first, member_count, member, between, table, count)
    notice_drivers(now, state, mind, world_of, number, acting, table, count)
    notice_hands(now, state, mind, world_of, number, named, hands, hands_since, table, count)


@lean
def notice_script(turned, cut, vehicle, state, script_world, told, table, count):
    """Entries of the script that have begun or ended, and who has ended them."""
    for i in range(cut.size):
        v = vehicle[i]
        x, y = (state[X, v], state[Y, v]) if v >= 0 else (nan, nan)
        for turn in range(2):
            when = turned[turn, i]
            if when == told[turn, i] or isnan(when):
                continue
            told[turn, i] = when
            kind = SCRIPT_BEGUN if turn == 0 else ending(turned[0, i], when, cut[i], v, state)
            note(when, kind, script_world[i], i, cut[i], x, y, nan, table, count)


@inlined
def ending(began, ended, cut, v, state):
    """How an entry has ended: by another, at once because the vehicle that it commands was not there, or else by itself."""
    if cut >= 0:
        return SCRIPT_CUT
    return SCRIPT_VAIN if v >= 0 and ended == began and state[ACTIVE, v] == 0.0 else SCRIPT_ENDED


@lean
def notice_hits(found, hits, first, state, told, table, count):
    """Collisions, at the place of their first vehicle."""
    share = hits.shape[1] // found.size
    for w in range(found.size):
        for i in range(w * share + told[w], w * share + found[w]):
            a, b = int(hits[HIT_FIRST, i]), int(hits[HIT_SECOND, i])
            v = first[w] + a
            note(hits[HIT_TIME, i], HIT, w, a, b, state[X, v], state[Y, v], hits[HIT_SPEED, i], table, count)
        told[w] = found[w]


@lean
def is_waiting(v, state, mind, parameter):
    """Whether a vehicle stands at a red light."""
    distance = mind[RED_STATION, v] - mind[STATION, v] - parameter[FRONT, v]
    return distance < AT_THE_LINE and state[V_X, v] < STANDING


@lean
def notice_vehicles(time, state, world_of, number, named, removed, told, table, count):
    """Vehicles that have rolled over, and named ones that have arrived."""
    for v in range(named.size):
        if is_news(abs(state[ROLL, v]) > ROLLED, told[0], v):
            note_vehicle(time, ROLLED_OVER, v, -1, nan, state, world_of, number, table, count)
    for v in range(named.size):
        if named[v] != 0 and removed[v] == 0 and is_news(state[ACTIVE, v] == 0.0, told[1], v):
            note_vehicle(time, ARRIVED, v, -1, nan, state, world_of, number, table, count)


@lean
def notice_lights(state, mind, parameter, world_of, number, named, path_first, stop_first, stop_count, stop_station, stop_link, shown,
                  waiting, front, path, table, count, time, now):  # fmt: skip
    """Named vehicles that have come to a stand at a red light, or have passed one.

    A line is passed between the last look at the own place and the one before it, so it is told for the beginning of the tick.
    """
    for v in range(named.size):
        if named[v] == 0 or stop_count[v] == 0:
            continue
        waits = is_waiting(v, state, mind, parameter)
        if waits and waiting[v] == 0:
            note_vehicle(time, WAITS, v, -1, nan, state, world_of, number, table, count)
        waiting[v] = 1 if waits else 0
        bumper = mind[STATION, v] + parameter[FRONT, v]
        before = front[v] if path[v] == path_first[v] else nan
        front[v], path[v] = bumper, path_first[v]
        if state[ACTIVE, v] > 0.0 and has_passed_red(before, bumper, stop_first[v], stop_count[v], stop_station, stop_link, shown):
            note_vehicle(now, RED_PASSED, v, -1, state[V_X, v], state, world_of, number, table, count)


@lean
def has_passed_red(before, bumper, first, count, stop_station, stop_link, shown):
    """Whether a bumper has come over a stop line that shows red; [m]."""
    for i in range(first, first + count):
        if before < stop_station[i] <= bumper and shown[stop_link[i]] == RED:
            return True
    return False


@lean
def notice_drivers(time, state, mind, world_of, number, acting, table, count):
    """Drivers who have begun to overrule their application, and for which reason."""
    for i in range(REASONS):
        for v in range(number.size):
            acts = mind[ACTS_COLLISION + i, v] != 0.0
            if acts and acting[i, v] == 0:
                note_vehicle(time, TAKES_OVER, v, -1, i, state, world_of, number, table, count)
            acting[i, v] = 1 if acts else 0


@lean
def notice_hands(time, state, mind, world_of, number, named, hands, since, table, count):
    """Wheel, brake, drive and gear of named vehicles that have changed hands; those that did so alike are one notice."""
    for v in range(number.size):
        if named[v] == 0 or state[ACTIVE, v] == 0.0:
            continue
        for i in range(HANDS):
            before, who = hands[i, v], int(mind[COMMANDS_WHEEL + i, v])
            if not is_new_hand(i, v, time, mind, hands, since):
                continue
            which = 0
            for j in range(i, HANDS):
                if hands[j, v] == before and int(mind[COMMANDS_WHEEL + j, v]) == who and is_new_hand(j, v, time, mind, hands, since):
                    hands[j, v], since[j, v] = who, time
                    which += 1 << j
            if before >= 0 and who != INTERVENTION_HAS:  # that he takes over is told with his reason
                told = which + (before + who * NUMBERS) * NUMBERS
                note_vehicle(time, COMMAND_TAKEN, v, -1, told, state, world_of, number, table, count)


@inlined
def is_new_hand(i, v, time, mind, hands, since):
    """Whether a hand is another's than was told, and this may be told now."""
    return int(mind[COMMANDS_WHEEL + i, v]) != hands[i, v] and time - since[i, v] >= SETTLED


@lean
def notice_messages(links, inbox, link_receiver, sender, link_sender, unit_world, unit_first, unit, table, count, time, now):
    """Messages that came at this tick after others had been lost, as their numbers tell."""
    for link in links:
        if inbox[H_MISSED, link] > 0.0 and 2.0 * now - time < inbox[H_CAME, link] - EARLY <= now:
            u, s = link_receiver[link], sender[link_sender[link]]
            w = unit_world[u]
            receiver, other, missed = u - unit_first[w], s - unit_first[w], inbox[H_MISSED, link]
            note(now, MESSAGE_LOST, w, receiver, other, unit[TRUE_X, u], unit[TRUE_Y, u], missed, table, count)


@lean
def notice_shown(which, shown, told, mounted_on, unit_world, unit_first, unit, table, count, time, now):
    """Notices that applications have begun to show to their drivers."""
    for j in range(mounted_on.size):
        if shown[j] != told[j] and shown[j] > 0:
            u = mounted_on[j]
            w = unit_world[u]
            note(now, NOTICE_SHOWN, w, u - unit_first[w], which, unit[TRUE_X, u], unit[TRUE_Y, u], shown[j], table, count)
        told[j] = shown[j]


@lean
def is_member(number, first, count, member):
    """Whether a vehicle belongs to a chain."""
    for i in range(first, first + count):
        if member[i] == number:
            return True
    return False


@lean
def notice_company(time, state, mind, world_of, follower, member_first, member_count, member, between, table, count):
    """Somebody has come between a follower and the car that it listens to, or has gone again."""
    for i in range(follower.size):
        v = follower[i]
        seen = int(mind[AHEAD, v])
        if seen < 0 or is_member(seen, member_first[i], member_count[i], member):
            seen = -1
        if seen != between[i]:
            between[i] = seen
            kind = COMPANY_LEFT if seen < 0 else COMPANY_CAME
            note(time, kind, world_of[v], i, seen, state[X, v], state[Y, v], nan, table, count)
