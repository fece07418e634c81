"""Messages: who sends, what is under way, and what every link has heard last. One Post per kind of message and kind of radio.

A message that is sent gets a slot in a ring of its sender. On every link of that sender the radio decides at once whether it is lost and
when it is there; a receiver looks at every instant at which it may act which slots have come in. Nothing is drawn in the order of calls:
delay and loss depend on seed, sender, receiver and the message's number, and on what a radio remembers of the link.

At a tick: beacons go out, then what has come in by now is taken; what applications send goes out after they have decided. Units whose
cycle is shorter than the tick take what has come in, and send, at instants between two ticks as well. Times are those of sending and
arriving, whatever the instant at which somebody looks. What was sent, and what became of it on every link, is written into a log.
"""

import traceback
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from math import ceil, inf, nan, sqrt
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numba import literal_unroll

from studio.application.contract import Own
from studio.bound import bound
from studio.compiled import inlined, lean
from studio.errors import ApplicationError
from studio.kind.loop import written
from studio.kind.number import numbers, shapes, spelled, tuple_of
from studio.kind.quantity import quantities, width
from studio.kind.registry import Kind
from studio.model.random import uniform
from studio.road.network.shadow import walls_between
from studio.rows import Moving
from studio.world.board.air import EARLY, Air, remembered
from studio.world.board.host import Fault
from studio.world.board.log import Log, log_link
from studio.world.board.sensing import stored
from studio.world.passes.level import OTHER_LEVEL, STEEPNESS
from studio.world.table.cause import ABSENT, DROPPED, JAMMED, OUT_OF_RANGE, RECEIVED
from studio.world.table.unit import (
    COSINE,
    DRIFT,
    DROPS,
    H_CAME,
    H_MISSED,
    H_NUMBER,
    H_SENDER,
    H_STAMP,
    H_TIME,
    HEARD,
    HEIGHT,
    OFFSET,
    OWN_FIRST,
    PRESENT,
    S_NEXT,
    S_NUMBER,
    S_SIZE,
    S_STAMP,
    S_TIME,
    S_X,
    S_Y,
    S_Z,
    SENT,
    SINE,
    TRUE_SPEED,
    TRUE_X,
    TRUE_Y,
    TRUE_Z,
)  # fmt: skip
from studio.world.table.unit import JAMMED as IS_JAMMED
from studio.world.view import Way

LOT = 1  # tells the lots for turns from the draws of radios
WORD = 2**32 - 1
SENT_ROWS, HEARD_ROWS = len(SENT), len(HEARD)

TEXT = '''"""Messages of the kind {name} on the radio {radio}."""

from math import inf

from studio.application.contract import Own
from studio.compiled import lean
from studio.world.board.air import occupy
from studio.world.board.log import log_message
from studio.world.board.post import apart, behind, hindrance, is_any, is_free, receive, send, settle, way_of, whose_turn
from studio.world.table.cause import OUT_OF_RANGE, RECEIVED, TOO_WEAK
from studio.world.table.unit import ADDED, DRIFT, DROPS, OFFSET, PRESENT, S_SIZE, S_TIME, S_NEXT, S_X, S_Y, TRUE_X, TRUE_Y
from studio.world.view import Draw, Sent, Spot, Turn
from {radio_module} import SettingsTuple as Radio, {radio_parts}
{imports}{places}

@lean
def dispatch({given}):
{located}{turn}        s = sender[i]
        j = world_of[s]
        radio, known = Radio({air}), table[j]
        for number in range(last[i] - fresh[i] + 1, last[i] + 1):
            slot = number % arrival.shape[0]
            column = slot * sender.size + i
            time, size, wait, next_ = ring[S_TIME, column], ring[S_SIZE, column], 0.0, inf
            log_message(time, s, number, size, column, ring, log_message_rows, log_count)
{admission}            for link in range(link_first[i], link_first[i + 1]):
                u = link_receiver[link]
                distance = apart(column, u, now, ring)
                cause, delay = hindrance(distance, reach[j], s, u, now, trouble), 0.0
                if cause == RECEIVED:
                    draw = Draw(seed[j], entity[u], entity[s], stream, number, common)
                    way = way_of(s, u, column, distance, wait, known, felt, fixed, now, load, ring)
                    {found} = transmit(radio, way, draw{memory})
                    if minds_walls[j] and found.lost != TOO_WEAK and found.lost != OUT_OF_RANGE:
                        {found} = transmit(radio, behind(way, place_of[j], shadow), draw{memory})
{store}                    cause, delay = int(found.lost), found.delay + trouble[ADDED, s]
                came = settle(slot, link, time, cause, delay, distance, arrival, log_links, log_causes, log_delays, log_distances,
                              log_count)
                next_ = min(next_, came)
            ring[S_NEXT, column] = next_
            soonest[i] = min(soonest[i], next_)
            trouble[DROPS, s] = max(trouble[DROPS, s] - 1.0, 0.0)
        fresh[i] = 0


@lean
def exchange(period, settings, kept, inbox, taken, looks, came, came_count, gap, {given}, k, now_time):
{beacons}
    dispatch({given})
    receive(now_time, soonest, last, ring, link_first, arrival, inbox, taken, looks, came, came_count)
'''
GIVEN = (
    "stream, common, air, reach, within, minds_walls, table, felt, around, busy, load, cell, world_of, unit_first, entity, seed, place_of, "
    "shadow, fixed, now, trouble, sender, fresh, soonest, last, ring, link_first, link_receiver, arrival, memory, "
    "log_message_rows, log_links, log_causes, log_delays, log_distances, log_count"
)
ONE_BY_ONE = """    for i in range(sender.size):
        if fresh[i] == 0:
            continue
"""
BY_LOT = """    for _ in range(sender.size):
        i = whose_turn(fresh, last, sender, world_of, entity, seed, stream)
        if i < 0:
            break
"""
ADMISSION = """            sent = Sent(time, ring[S_X, column], ring[S_Y, column], size, load[s])
            wait, remembered = admit(radio, sent, Cell({cell}))
"""
WAITING = """            sent = Sent(time, ring[S_X, column], ring[S_Y, column], size, load[s])
            wait = wait_of(radio, sent, Draw(seed[j], entity[s], entity[s], stream, number, common))
"""
PLACES = """

@lean
def locate(common, air, felt, around, world_of, seed, now, fresh):
    if not is_any(fresh):
        return
    for u in range(world_of.size):
        if now[PRESENT, u] == 0.0:
            continue
        j = world_of[u]
        spot = Spot(now[TRUE_X, u], now[TRUE_Y, u], seed[j], common)
        felt[u], remembered = place(Radio({air}), spot, Around({around}))
{store}"""
OCCUPATION = """            spent = airtime(radio, size)
            occupy(j, ring[S_X, column], ring[S_Y, column], within[j], spent, world_of, unit_first, now, busy)
"""
BEACONS = """    for i in range(sender.size):
        u = sender[i]
        j = world_of[u]
        if now[PRESENT, u] > 0.0 and (k + entity[u]) % period[j] == 0{free}:
            own = Own({own})
            chosen = SettingsTuple({settings})
{due}            payload = beacon(own, chosen{remembered})
            send(i, u, now_time, fixed, {size}, payload, now, ring, last, fresh)"""
DUE = """            turn = Turn(now_time * (1.0 + fixed[DRIFT, u]) + fixed[OFFSET, u], gap[u], load[u])
            is_due, remembered = due(own, chosen, Memory({kept}), turn)
{store}            if not is_due:
                continue
"""


@dataclass
class Post:
    """One kind of message on one kind of radio. Slots of a ring are [slot · senders + sender], links stand sender after sender."""

    kind: Kind
    radio: Kind
    air: int  # number of the air that it shares with others
    worlds: tuple[int, ...]
    is_of_applications: bool  # whether applications send it, besides or instead of beacons
    sender: np.ndarray  # units that send it, world after world, as chance numbers them
    slots: np.ndarray  # per world, how many messages of one sender are kept there at least
    period: np.ndarray  # [ticks] per world, of beacons
    settings: np.ndarray  # of beacons, [row, world]
    kept: Moving  # what senders remember of beacons, [row, sender]
    ring: Moving
    last: Moving  # number of the newest message per sender
    fresh: Moving  # messages per sender that the radio has not decided about
    soonest: Moving  # [s] per sender, when the next of its messages is there at somebody; infinite when none is under way
    link_first: np.ndarray  # per sender, and one more
    link_sender: np.ndarray  # index into `sender`
    link_receiver: np.ndarray  # unit
    arrival: Moving  # [s] float64[slot, link], infinite for a message that is lost
    memory: Moving  # what the radio remembers, [row, link]
    inbox: Moving  # [row, link]
    taken: np.ndarray  # int64[sender], how often links have taken a message of it, for those who look for what is new
    looks: np.ndarray  # int64[1], how often it has been looked whether something has come in
    came: np.ndarray  # int64[link], the links that have taken a message when it was looked last
    came_count: np.ndarray  # int64[1], how many they are
    log: Log
    dispatch: Callable  # the radio decides about what was sent
    exchange: Callable  # beacons go out, the radio decides, what has come in is taken
    ready: dict[str, Callable] = field(default_factory=dict)  # the same with all arrays given, once they have been called

    def exchanged(self, k: int, time: float, air: Air, around: tuple) -> Iterable[Fault]:
        """Calls `exchange`; `around` are the arrays of the world, which stay where they are. Returns what went wrong."""
        return self.called("exchange", air, around, (k, time))

    def dispatched(self, air: Air, around: tuple) -> Iterable[Fault]:
        """Calls `dispatch` when applications have sent something, likewise."""
        if not self.is_of_applications or not self.fresh.any():
            return ()
        return self.called("dispatch", air, around, ())

    def called(self, name: str, air: Air, around: tuple, now: tuple) -> Iterable[Fault]:
        """A message or radio that raises ends the runs of all worlds that have it; told with the traceback."""
        self.log.make_room()
        try:
            if name not in self.ready:
                own = self.of_exchange(air) if name == "exchange" else ()
                self.ready[name] = bound(getattr(self, name), *own, *self.given(air, around), then=now)
            self.ready[name](*now)
        except (Exception, SystemExit):
            return self.raised()
        return ()

    def raised(self) -> tuple[Fault]:
        """What is said of a message or radio that raises."""
        text = f"The message {self.kind.name!r} on the radio {self.radio.name!r} cannot be sent:\n{traceback.format_exc()}"
        return (Fault(self.worlds, ApplicationError(text)),)

    def of_exchange(self, air: Air) -> tuple:
        """What `exchange` is given besides: beacons, and what has come in."""
        return self.period, self.settings, self.kept, self.inbox, self.taken, self.looks, self.came, self.came_count, air.gap

    def given(self, air: Air, around: tuple) -> tuple:
        """What the radio decides about, and what it looks at for that, as GIVEN names it."""
        settings = (self.radio.stream, air.settings, air.reach, air.within, air.minds_walls, air.table)
        channel = (air.felt, air.around, air.busy, air.load, air.cell)
        sent = (self.sender, self.fresh, self.soonest, self.last, self.ring)
        links = (self.link_first, self.link_receiver, self.arrival, self.memory)
        return (self.stream, *settings, *channel, *around, *sent, *links, *self.log.now, self.log.count)

    def newest(self, world: int, world_of: np.ndarray) -> np.ndarray:
        """What is kept of the messages of a world, float64[row, slot, sender], the newest first: the same in every batch."""
        own = np.flatnonzero(world_of[self.sender] == world)
        numbers = self.last[own] - np.arange(self.slots[world])[:, None]
        found = self.ring[:, numbers % self.arrival.shape[0] * self.sender.size + own]
        return np.where((numbers >= 0) & (found[S_NUMBER] == numbers), found, 0.0)

    def received(self, time: float) -> None:
        """What has come in between two ticks is taken."""
        links = (self.link_first, self.arrival, self.inbox)
        receive(time, self.soonest, self.last, self.ring, *links, self.taken, self.looks, self.came, self.came_count)

    @property
    def stream(self) -> int:
        """The first of its random streams."""
        return self.kind.stream

    @property
    def senders(self) -> dict[int, int]:
        """Index of every sender by its unit."""
        return {int(unit): i for i, unit in enumerate(self.sender)}

    @property
    def links(self) -> dict[tuple[int, int], int]:
        """Number of every link by the units of receiver and sender."""
        pairs = zip(self.link_receiver.tolist(), self.sender[self.link_sender].tolist(), strict=True)
        return {pair: link for link, pair in enumerate(pairs)}


@dataclass
class Open:
    """The inboxes of a port where somebody hears everybody: before every member the links that it has heard, the freshest first."""

    post: Post
    is_open: np.ndarray  # bool[member], whether it hears everybody; the others are left as they are
    kept: np.ndarray  # [s] per member, for how long what was heard counts
    heard: np.ndarray  # how many of `slots` are filled, per member
    slots: np.ndarray  # int64[place, member], the links
    when: np.ndarray  # [s] float64[place, member], when their messages were sent
    member_first: np.ndarray  # per unit of all worlds, and one more: where the members that it is begin
    member: np.ndarray
    ready: Callable | None = None  # `lay` with all arrays given, once it has been called

    def lay(self, time: float) -> None:
        """What has come in since the last time is laid before the members, and what is too old is taken away."""
        if self.ready is None:
            self.ready = bound(lay, *self.arrays, then=(time,))
        self.ready(time)

    def lay_anew(self, time: float) -> None:
        """The same with all that every link has heard last."""
        self.heard[self.is_open], self.slots[:, self.is_open] = 0, -1
        came = np.flatnonzero(self.post.inbox[H_NUMBER] >= 0.0)
        lay(*(came, np.array([came.size]), self.post.link_receiver, self.post.inbox, *self.given, time))

    @property
    def arrays(self) -> tuple:
        """What `lay` reads and writes."""
        return self.post.came, self.post.came_count, self.post.link_receiver, self.post.inbox, *self.given

    @property
    def given(self) -> tuple:
        """What is there of every member."""
        return self.member_first, self.member, self.is_open, self.kept, self.heard, self.slots, self.when


class Need(NamedTuple):
    """What a post is made for: units that send, how many messages at once, pairs (receiver, sender); per world the settings of beacons,
    and how many messages of one sender may have to be kept."""

    senders: Sequence[int]
    at_once: int
    pairs: Sequence[tuple[int, int]]
    beacons: Sequence[Any]
    slots: Sequence[int]


class Known(NamedTuple):
    """Of all units: how chance tells them apart, their numbers in their worlds, and their worlds."""

    entity: np.ndarray
    number: np.ndarray
    world_of: np.ndarray


# -- at the start --------------------------------------------------------------------------------------


def post(kind: Kind, radio: Kind, air: int, need: Need, units: Known, tick: float) -> Post:
    """Nothing has been sent. The radio looks at senders as chance numbers them, so that their order in a file changes nothing."""
    entity, world_of = units.entity, units.world_of
    sender = np.array(sorted(need.senders, key=lambda unit: (world_of[unit], entity[unit])), dtype=np.int64)
    index = {int(unit): i for i, unit in enumerate(sender)}
    pairs = sorted((index[s], world_of[r], entity[r], r) for r, s in set(need.pairs))
    links = np.array([(s, r) for s, _, _, r in pairs], dtype=np.int64).reshape(-1, 2).T
    periods = np.array([round(each.period / tick) if hasattr(each, "period") else 1 for each in need.beacons], dtype=np.int64)
    slots = max(need.slots)
    carried = width(kind.module.Payload)
    inbox = np.zeros((len(HEARD) + carried, links.shape[1]))
    inbox[H_NUMBER] = -1.0
    inbox[H_SENDER] = units.number[sender[links[0]]]
    ring = np.zeros((len(SENT) + carried, slots * sender.size))
    ring[S_NUMBER], ring[S_NEXT] = -1.0, inf
    has_beacon, is_regular, loops = hasattr(kind.module, "beacon"), not hasattr(kind.module, "due"), written_for(kind, radio)
    first = [before_first(int(entity[u]), int(periods[world_of[u]])) if has_beacon and is_regular else -1 for u in sender]
    most = 1 + need.at_once
    return Post(
        kind=kind,
        radio=radio,
        air=air,
        worlds=tuple(sorted({int(world_of[unit]) for unit in need.senders})),
        is_of_applications=need.at_once > 0,
        sender=sender,
        slots=np.array(need.slots, dtype=np.int64),
        period=periods,
        settings=np.array([numbers(each) if has_beacon else [] for each in need.beacons]).T.copy(),
        kept=remembered(kind.module, "Memory", sender.size),
        ring=ring,
        last=np.array(first, dtype=np.int64),
        fresh=np.zeros(sender.size, dtype=np.int64),
        soonest=np.full(sender.size, inf),
        link_first=np.searchsorted(links[0], np.arange(sender.size + 1)),
        link_sender=links[0].copy(),
        link_receiver=links[1].copy(),
        arrival=np.full((slots, links.shape[1]), inf),
        memory=remembered(radio.module, "Memory", links.shape[1]),
        inbox=inbox,
        taken=np.zeros(sender.size, dtype=np.int64),
        looks=np.zeros(1, dtype=np.int64),
        came=np.zeros(links.shape[1], dtype=np.int64),
        came_count=np.zeros(1, dtype=np.int64),
        log=Log((most * sender.size, most * links.shape[1])),
        dispatch=loops.dispatch,
        exchange=loops.exchange,
    )


def before_first(entity: int, period: int) -> int:
    """The number before a unit's first beacon: beacons are numbered by their place in time, spread over the period."""
    return ceil(entity / period) - 1


def slots_of(longest: float, shortest: float, together: int) -> int:
    """How many messages of one sender can be under way, and two more: with a longest delay, of so many together once in a shortest time."""
    return (int(longest / shortest + EARLY) + 2) * together + 1


def written_for(kind: Kind, radio: Kind) -> ModuleType:
    """The loops for a kind of message on a kind of radio."""
    module, air = kind.module, radio.module
    tuple_of(air, air.Settings)
    fields = quantities(air.Memory) if hasattr(air, "Memory") else []
    parts = [part for part in ("transmit", "airtime", "admit", "Cell", "place", "Around") if hasattr(air, part)]
    parts += ["wait as wait_of"] if hasattr(air, "wait") else []
    source = TEXT.format(
        name=kind.name,
        radio=radio.name,
        radio_module=air.__name__,
        radio_parts=", ".join([*parts, *(["Memory as Link"] if fields else [])]),
        given=GIVEN,
        air=spelled([each.size for each in shapes(air.Settings)], "air"),
        imports=imports(module),
        places=places(air) if hasattr(air, "place") else "",
        located="    locate(common, air, felt, around, world_of, seed, now, fresh)\n" if hasattr(air, "place") else "",
        turn=BY_LOT if hasattr(air, "admit") else ONE_BY_ONE,
        admission=admission(air),
        found="found, remembered" if fields else "found",
        memory=f", Link({spelled([each.size for each in fields], 'memory', 'link')})" if fields else "",
        store=stored(fields, "link", " " * 20),
        beacons=beacons(module, hasattr(air, "control")) if hasattr(module, "beacon") else "    pass",
    )
    return written(f"post_{kind.name}_{radio.name}", source, kind, radio)


def imports(module: ModuleType) -> str:
    """What the loops take from the file of a kind of message."""
    parts = [part for part in ("beacon", "due", "Memory", "size") if hasattr(module, part)]
    named = ["size as size_of" if part == "size" else part for part in parts]
    return f"from {module.__name__} import {', '.join(['SettingsTuple', *named])}\n" if hasattr(module, "beacon") else ""


def places(air: ModuleType) -> str:
    """The loop that tells what the radio knows of the place of every unit."""
    fields = quantities(air.Around)
    settings, around = spelled([each.size for each in shapes(air.Settings)], "air"), spelled([each.size for each in fields], "around", "u")
    return PLACES.format(air=settings, around=around, store=stored(fields, "u", " " * 8, "around"))


def admission(air: ModuleType) -> str:
    """The lines that let a message into a network of cells, or make it wait, and onto a channel."""
    fields = quantities(air.Cell) if hasattr(air, "admit") else []
    text = WAITING if hasattr(air, "wait") else ""
    if fields:
        text = ADMISSION.format(cell=spelled([each.size for each in fields], "cell")) + stored(fields, "j", " " * 12, "cell")
    return text + OCCUPATION if hasattr(air, "airtime") else text


def beacons(module: ModuleType, is_controlled: bool) -> str:
    """The lines that send what every unit sends by itself."""
    tuple_of(module, module.Settings)
    is_regular = not hasattr(module, "due")
    return BEACONS.format(
        free=" and is_free(i, now_time, gap[u], last, ring)" if is_controlled and is_regular else "",
        own=", ".join(f"now[{OWN_FIRST + i}, u]" for i in range(len(Own._fields))),
        settings=spelled([each.size for each in shapes(module.Settings)], "settings"),
        due="" if is_regular else due(module),
        remembered="" if is_regular else ", remembered",
        size=spelled_size(module, "size_of", "payload"),
    )


def due(module: ModuleType) -> str:
    """The lines that ask whether a beacon is sent now."""
    fields = quantities(module.Memory)
    kept = spelled([each.size for each in fields], "kept", "i")
    return DUE.format(kept=kept, store=stored(fields, "i", " " * 12, "kept"))


def spelled_size(module: ModuleType, function: str, payload: str) -> str:
    """The bytes of a message in the text of a loop: what its file says of the payload, or the same for all."""
    return f"{function}({payload}) * 1.0" if hasattr(module, "size") else f"{float(module.SIZE)}"


# -- sending -------------------------------------------------------------------------------------------


@inlined
def is_free(i, time, gap, last, ring):
    """Whether congestion control lets sender i send by itself [s]."""
    senders = last.size
    column = last[i] % (ring.shape[1] // senders) * senders + i
    return ring[S_NUMBER, column] != last[i] or time - ring[S_TIME, column] >= gap - EARLY


@inlined
def send(i, unit, time, fixed, size, payload, now, ring, last, fresh):
    """Sender i, which is `unit`, sends some bytes: the message stands in the ring until the radio has decided."""
    last[i] += 1
    senders = last.size
    column = last[i] % (ring.shape[1] // senders) * senders + i
    ring[S_NUMBER, column] = last[i]
    ring[S_TIME, column] = time
    ring[S_STAMP, column] = time * (1.0 + fixed[DRIFT, unit]) + fixed[OFFSET, unit]
    ring[S_X, column], ring[S_Y, column], ring[S_Z, column] = now[TRUE_X, unit], now[TRUE_Y, unit], now[TRUE_Z, unit]
    ring[S_SIZE, column], ring[S_NEXT, column] = size, inf
    row = SENT_ROWS
    for value in literal_unroll(payload):
        ring[row, column] = value * 1.0
        row += 1
    fresh[i] += 1


@inlined
def is_any(fresh):
    """Whether anybody has sent something that the radio has not decided about."""
    for i in range(fresh.size):
        if fresh[i] > 0:
            return True
    return False


@lean
def whose_turn(fresh, last, sender, world_of, entity, seed, stream):
    """Of those whose messages have not gone out yet, the one with the least lot: what they share does not go to the first by name.

    -1 when there is none.
    """
    first, least = -1, inf
    for i in range(sender.size):
        if fresh[i] > 0:
            lot = uniform(seed[world_of[sender[i]]], entity[sender[i]], stream, last[i], LOT)
            if lot < least:
                first, least = i, lot
    return first


def draw_lots(posts: Sequence["Post"]) -> bool:
    """Whether it is drawn which kind goes first."""
    return len(posts) > 1 and any(hasattr(post.radio.module, "admit") for post in posts[1:])


def taking_turns(posts: Sequence["Post"], instant: int) -> Sequence["Post"]:
    """Posts in the order in which they send at an instant: by lot too where messages wait for a network, so that no kind goes first."""
    if not draw_lots(posts):
        return posts
    return sorted(posts, key=lambda post: uniform(0, instant & WORD, post.stream, instant >> WORD.bit_length(), LOT))


@inlined
def apart(column, receiver, now, ring):
    """How far a receiver is from the antenna of a message, in all three dimensions [m]."""
    dx, dy = now[TRUE_X, receiver] - ring[S_X, column], now[TRUE_Y, receiver] - ring[S_Y, column]
    dz = now[TRUE_Z, receiver] - ring[S_Z, column]
    return sqrt(dx * dx + dy * dy + dz * dz)


@inlined
def decks_between(rise, distance):
    """How many roads lie between two units of which one's road is so much higher [m]: 1 where it is a bridge over the other's, else 0.

    From an antenna 1.5 m above a bridge with 10 to 20 m of it beside, whoever is near below is in the shadow of the bridge. The bounds are
    those within which nobody is seen on the other level (passes/sight.py); beyond them it is a steep street, or a view past the edge.
    """
    return 1.0 if abs(rise) > OTHER_LEVEL + STEEPNESS * distance else 0.0


@inlined
def way_of(sender, receiver, column, distance, wait, table, felt, fixed, now, load, ring):
    """The way from a message's antenna to a receiver's, as if no building were there."""
    x0, y0, x1, y1 = ring[S_X, column], ring[S_Y, column], now[TRUE_X, receiver], now[TRUE_Y, receiver]
    return Way(
        distance, 0.0, 0.0, ring[S_SIZE, column], now[TRUE_SPEED, receiver],
        approach_of(sender, receiver, x1 - x0, y1 - y0, distance, now), ring[S_TIME, column],
        x0, y0, fixed[HEIGHT, sender], x1, y1, fixed[HEIGHT, receiver], load[sender], load[receiver], wait,
        felt[sender], felt[receiver], table, decks_between(now[TRUE_Z, receiver] - ring[S_Z, column], distance),
    )  # fmt: skip


@lean
def behind(way, place, shadow):
    """The same way with the buildings of its map."""
    walls, inside = walls_between(shadow, place, way.from_x, way.from_y, way.from_height, way.to_x, way.to_y, way.to_height)
    return Way(
        way.distance, float(walls), inside, way.size, way.speed, way.approach, way.time, way.from_x, way.from_y, way.from_height,
        way.to_x, way.to_y, way.to_height, way.from_load, way.load, way.wait, way.from_place, way.to_place, way.table,
        way.decks,
    )  # fmt: skip


@inlined
def approach_of(sender, receiver, dx, dy, distance, now):
    """How fast two units come nearer to each other [m/s], along the line between them (dx, dy)."""
    v_x = now[TRUE_SPEED, receiver] * now[COSINE, receiver] - now[TRUE_SPEED, sender] * now[COSINE, sender]
    v_y = now[TRUE_SPEED, receiver] * now[SINE, receiver] - now[TRUE_SPEED, sender] * now[SINE, sender]
    return -(dx * v_x + dy * v_y) / max(distance, 1e-3)


@inlined
def hindrance(distance, reach, sender, receiver, now, trouble):
    """Why a message cannot arrive, whatever the radio says; RECEIVED when it can."""
    if now[PRESENT, receiver] == 0.0:
        return ABSENT
    if distance > reach:
        return OUT_OF_RANGE
    if trouble[DROPS, sender] > 0.0:
        return DROPPED
    return JAMMED if trouble[IS_JAMMED, receiver] > 0.0 else RECEIVED


@inlined
def settle(slot, link, time, cause, delay, distance, arrival, links, causes, delays, distances, count):
    """Writes down what becomes of a message that was sent at a time [s] on one link; when it is there [s], infinite if never."""
    came = time + delay if cause == RECEIVED else inf
    arrival[slot, link] = came
    if cause != OUT_OF_RANGE:
        log_link(link, cause, delay if cause == RECEIVED else nan, distance, links, causes, delays, distances, count)
    return came


# -- receiving -----------------------------------------------------------------------------------------


@lean
def receive(time, soonest, last, ring, link_first, arrival, inbox, taken, looks, came, came_count):
    """Every link takes the newest of the messages that have come in; a sender of whom none comes to anybody by now is passed over."""
    looks[0] += 1
    came_count[0] = 0
    for i in range(last.size):
        if soonest[i] - EARLY <= time:
            before = came_count[0]
            soonest[i] = receive_from(time, i, last, ring, link_first, arrival, inbox, came, came_count)
            taken[i] += came_count[0] - before


@inlined
def receive_from(time, i, last, ring, link_first, arrival, inbox, came, came_count):
    """The same of one sender, the newest message first; when the next of its messages is there at somebody."""
    next_ = inf
    for number in range(last[i], max(last[i] - arrival.shape[0], -1), -1):
        column = column_of(number, i, last, ring)
        if ring[S_NUMBER, column] == number:
            if ring[S_NEXT, column] - EARLY <= time:
                deliver(time, i, number, column, last, ring, link_first, arrival, inbox, came, came_count)
            next_ = min(next_, ring[S_NEXT, column])
    return next_


@inlined
def column_of(number, i, last, ring):
    """Where message `number` of sender i stands in the ring."""
    return number % (ring.shape[1] // last.size) * last.size + i


@inlined
def deliver(time, i, number, column, last, ring, link_first, arrival, inbox, came, came_count):
    """A message of sender i is taken by the links that it has reached by a time [s] and that have no newer one."""
    slot, next_ = number % arrival.shape[0], inf
    for link in range(link_first[i], link_first[i + 1]):
        there = arrival[slot, link]
        if there - EARLY > time:
            next_ = min(next_, there)
        elif inbox[H_NUMBER, link] < number:
            inbox[H_MISSED, link] = lost_since(int(inbox[H_NUMBER, link]), number, i, link, last.size, ring, arrival)
            take(there, number, column, link, ring, inbox)
            came[came_count[0]] = link
            came_count[0] += 1
    ring[S_NEXT, column] = next_


@lean
def lost_since(before, number, i, link, sender_count, ring, arrival):
    """How many messages between two were lost; those that are still under way, or have been overtaken, were not."""
    if before < 0:
        return 0.0
    slots, lost = arrival.shape[0], 0.0
    for each in range(before + 1, number):
        slot = each % slots
        is_kept = ring[S_NUMBER, slot * sender_count + i] == each
        if not is_kept or arrival[slot, link] == inf:
            lost += 1.0
    return lost


@lean
def take(came, number, column, link, ring, inbox):
    """A message comes in, which was there at a time [s]."""
    inbox[H_NUMBER, link], inbox[H_CAME, link] = number, came
    inbox[H_TIME, link], inbox[H_STAMP, link] = ring[S_TIME, column], ring[S_STAMP, column]
    for row in range(ring.shape[0] - SENT_ROWS):
        inbox[HEARD_ROWS + row, link] = ring[SENT_ROWS + row, column]


@lean
def lay(came, came_count, link_receiver, inbox, member_first, member, is_open, kept, heard, slots, when, time):
    """Links that have taken a message come to their places before all members that their receivers are; what is too old goes."""
    for k in range(came_count[0]):
        link = came[k]
        u = link_receiver[link]
        for p in range(member_first[u], member_first[u + 1]):
            put(link, member[p], inbox[H_TIME, link], heard, slots, when)
    forget(time, is_open, kept, heard, slots, when)


@inlined
def put(link, j, time, heard, slots, when):
    """Puts a link, whose message was sent at a time [s], to its place before member j: the freshest first, of equal ones the first link."""
    place, most = 0, slots.shape[0]
    while place < heard[j] and slots[place, j] != link:
        place += 1
    if place == most:
        place -= 1
        if not is_fresher(link, time, slots[place, j], when[place, j]):
            return
    heard[j] = max(heard[j], place + 1)
    while place > 0 and is_fresher(link, time, slots[place - 1, j], when[place - 1, j]):
        slots[place, j], when[place, j] = slots[place - 1, j], when[place - 1, j]
        place -= 1
    slots[place, j], when[place, j] = link, time


@inlined
def is_fresher(link, time, other, other_time):
    """Whether a link comes before another."""
    return time > other_time or (time == other_time and link < other)


@inlined
def forget(time, is_open, kept, heard, slots, when):
    """What was sent longer ago than `kept[j]` [s] is taken away from before member j."""
    for j in range(heard.size):
        while is_open[j] and heard[j] > 0 and time - when[heard[j] - 1, j] > kept[j]:
            heard[j] -= 1
            slots[heard[j], j] = -1
