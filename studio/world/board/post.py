"""Messages: who sends, what is under way, and what every link has heard last. One Post per kind of message and kind of radio.

A message that is sent gets a slot in a ring of its sender. On every link of that sender the radio decides at once whether it is lost and
when it is there; a receiver looks at every tick which slots have come in. Nothing is drawn in the order of calls: delay and loss
depend on seed, sender, receiver and the message's number only.

At a tick: beacons go out, then what has come in by now is taken; what applications send goes out after they have decided.
"""

import traceback
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from math import ceil, inf, sqrt
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numba import literal_unroll

from studio.application.contract import Own
from studio.compiled import bound, inlined, lean
from studio.errors import ApplicationError
from studio.kind.loop import written
from studio.kind.number import numbers, shapes, spelled, tuple_of
from studio.kind.quantity import width
from studio.kind.registry import Kind
from studio.model.random import uniform
from studio.road.network.grid import COLUMNS
from studio.road.network.shadow import walls_between
from studio.rows import Moving
from studio.world.board.host import Fault
from studio.world.table.unit import (
    DRIFT,
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
    OWN_SPEED,
    PRESENT,
    S_NUMBER,
    S_STAMP,
    S_TIME,
    S_X,
    S_Y,
    SENT,
    TRUE_X,
    TRUE_Y,
)  # fmt: skip
from studio.world.view import Draw, Way

EARLY = 1e-9  # [s] a delay that is a whole number of ticks must not come a tick late by rounding
SENT_ROWS, HEARD_ROWS = len(SENT), len(HEARD)
PAIR = 65536  # a link is numbered receiver · PAIR + sender

TEXT = '''"""Messages of the kind {name} on the radio {radio}."""

from studio.application.contract import Own
from studio.compiled import lean
from studio.world.board.post import arrival_on, draws, receive, send, way_of
from studio.world.table.unit import PRESENT
from {radio_module} import SettingsTuple as Radio, transmit
{imports}

@lean
def dispatch(size, stream, reach, air, world_of, entity, seed, place_of, shadow, fixed, now, sender, fresh, last, ring, link_first,
             link_receiver, arrival, lost, time):
    for i in range(sender.size):
        if fresh[i] == 0:
            continue
        for link in range(link_first[i], link_first[i + 1]):
            u, j = link_receiver[link], world_of[sender[i]]
            for number in range(last[i] - fresh[i] + 1, last[i] + 1):
                slot = number % arrival.shape[0]
                way = way_of(i, sender[i], u, slot, size, reach[j], place_of[j], shadow, fixed, now, ring, sender.size)
                found = transmit(Radio({air}), way, draws(entity[u], entity[sender[i]], stream, seed[j], number))
                arrival[slot, link] = arrival_on(time, found, way, reach[j], u, link, now, lost)
        fresh[i] = 0


@lean
def exchange(period, settings, link_sender, inbox, size, stream, reach, air, world_of, entity, seed, place_of, shadow, fixed, now, sender,
             fresh, last, ring, link_first, link_receiver, arrival, lost, k, time, tick):
{beacons}
    dispatch(size, stream, reach, air, world_of, entity, seed, place_of, shadow, fixed, now, sender, fresh, last, ring, link_first,
             link_receiver, arrival, lost, time)
    receive(time, tick, sender.size, last, ring, link_sender, arrival, inbox)
'''
BEACONS = """    for i in range(sender.size):
        u = sender[i]
        j = world_of[u]
        if now[PRESENT, u] > 0.0 and (k + entity[u]) % period[j] == 0:
            send(i, u, time, fixed, beacon(Own({own}), SettingsTuple({settings})), now, ring, last, fresh)"""


@dataclass
class Post:
    """One kind of message on one kind of radio. Slots of a ring are [slot · senders + sender], links stand sender after sender."""

    kind: Kind
    radio: Kind
    worlds: tuple[int, ...]
    is_of_applications: bool  # whether applications send it, besides or instead of beacons
    sender: np.ndarray  # units that send it
    period: np.ndarray  # [ticks] per world, of beacons
    settings: np.ndarray  # of beacons, [row, world]
    air: np.ndarray  # settings of the radio, [row, world]
    reach: np.ndarray  # [m] per world, beyond it nothing is heard
    ring: Moving
    last: Moving  # number of the newest message per sender
    fresh: Moving  # messages per sender that the radio has not decided about
    link_first: np.ndarray  # per sender, and one more
    link_sender: np.ndarray  # index into `sender`
    link_receiver: np.ndarray  # unit
    arrival: Moving  # [s] float64[slot, link], infinite for a message that is lost
    lost: Moving  # messages lost so far, per link
    inbox: Moving  # [row, link]
    dispatch: Callable  # the radio decides about what was sent
    exchange: Callable  # beacons go out, the radio decides, what has come in is taken
    ready: dict[str, Callable] = field(default_factory=dict)  # the same with all arrays given, once they have been called

    def exchanged(self, k: int, time: float, tick: float, around: tuple) -> Iterable[Fault]:
        """Calls `exchange`; `around` are the arrays of the world, which stay where they are. Returns what went wrong."""
        own = () if "exchange" in self.ready else (self.period, self.settings, self.link_sender, self.inbox, *self.given(around))
        return self.called("exchange", own, (k, time, tick))

    def dispatched(self, time: float, around: tuple) -> Iterable[Fault]:
        """Calls `dispatch` when applications have sent something, likewise."""
        if not self.is_of_applications or not self.fresh.any():
            return ()
        return self.called("dispatch", () if "dispatch" in self.ready else self.given(around), (time,))

    def called(self, name: str, arrays: tuple, now: tuple) -> Iterable[Fault]:
        """A message or radio that raises ends the runs of all worlds that have it; told with the traceback."""
        try:
            if name not in self.ready:
                self.ready[name] = bound(getattr(self, name), *arrays, then=now)
            self.ready[name](*now)
        except (Exception, SystemExit):
            text = f"The message {self.kind.name!r} on the radio {self.radio.name!r} cannot be sent:\n{traceback.format_exc()}"
            return (Fault(self.worlds, ApplicationError(text)),)
        return ()

    def given(self, around: tuple) -> tuple:
        """What the radio decides about, and what it looks at for that."""
        own = (self.sender, self.fresh, self.last, self.ring, self.link_first, self.link_receiver, self.arrival, self.lost)
        return (self.size, self.stream, self.reach, self.air, *around, *own)

    @property
    def size(self) -> float:
        """Bytes of one message."""
        return float(self.kind.module.SIZE)

    @property
    def stream(self) -> int:
        """The first of its random streams."""
        return self.kind.stream

    @property
    def senders(self) -> dict[int, int]:
        """Index of every sender by its unit."""
        return {int(unit): i for i, unit in enumerate(self.sender)}

    @property
    def links_by_receiver(self) -> dict[int, list[int]]:
        """The numbers of all links of every unit that hears somebody."""
        found: dict[int, list[int]] = {}
        for link, unit in enumerate(self.link_receiver.tolist()):
            found.setdefault(unit, []).append(link)
        return found

    @property
    def links(self) -> dict[tuple[int, int], int]:
        """Number of every link by the units of receiver and sender."""
        pairs = zip(self.link_receiver.tolist(), self.sender[self.link_sender].tolist(), strict=True)
        return {pair: link for link, pair in enumerate(pairs)}


class Open(NamedTuple):
    """The inboxes of a port that hears everybody: for every unit its links, how many it has heard, and those, the freshest first."""

    post: Post
    first: np.ndarray
    count: np.ndarray
    links: np.ndarray
    heard: np.ndarray
    slots: np.ndarray


class Need(NamedTuple):
    """What a post is made for: units that send, how many messages at once, pairs
    (receiver, sender), settings per world."""

    senders: Sequence[int]
    at_once: int
    pairs: Sequence[tuple[int, int]]
    beacons: Sequence[Any]
    radios: Sequence[Any]


# -- at the start --------------------------------------------------------------------------------------


def post(kind: Kind, radio: Kind, need: Need, entity: np.ndarray, number: np.ndarray, world_of: np.ndarray, tick: float) -> Post:
    """Nothing has been sent. `entity`, `number` and `world_of` are those of all units."""
    sender = np.array(sorted(need.senders), dtype=np.int64)
    index = {int(unit): i for i, unit in enumerate(sender)}
    pairs = sorted(((index[s], r) for r, s in set(need.pairs)), key=lambda each: each)
    links = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    periods = np.array([round(each.period / tick) if hasattr(each, "period") else 1 for each in need.beacons], dtype=np.int64)
    slots = slots_of(radio, need, periods, tick)
    carried = width(kind.module.Payload)
    inbox = np.zeros((len(HEARD) + carried, links.shape[1]))
    inbox[H_NUMBER] = -1.0
    inbox[H_SENDER] = number[sender[links[0]]]
    ring = np.zeros((len(SENT) + carried, slots * sender.size))
    ring[S_NUMBER] = -1.0
    has_beacon, loops = hasattr(kind.module, "beacon"), written_for(kind, radio)
    return Post(
        kind=kind,
        radio=radio,
        worlds=tuple(sorted({int(world_of[unit]) for unit in need.senders})),
        is_of_applications=need.at_once > 0,
        sender=sender,
        period=periods,
        settings=np.array([numbers(each) if has_beacon else [] for each in need.beacons]).T.copy(),
        air=np.array([numbers(each) for each in need.radios]).T.copy(),
        reach=np.array([float(radio.module.reach(each)) for each in need.radios]),
        ring=ring,
        last=np.array([before_first(int(entity[u]), int(periods[world_of[u]])) if has_beacon else -1 for u in sender], dtype=np.int64),
        fresh=np.zeros(sender.size, dtype=np.int64),
        link_first=np.searchsorted(links[0], np.arange(sender.size + 1)),
        link_sender=links[0].copy(),
        link_receiver=links[1].copy(),
        arrival=np.full((slots, links.shape[1]), inf),
        lost=np.zeros(links.shape[1], dtype=np.int64),
        inbox=inbox,
        dispatch=loops.dispatch,
        exchange=loops.exchange,
    )


def before_first(entity: int, period: int) -> int:
    """The number before a unit's first beacon: beacons are numbered by their place in time, spread over the period."""
    return ceil(entity / period) - 1


def slots_of(radio: Kind, need: Need, periods: np.ndarray, tick: float) -> int:
    """How many messages of one sender can be under way, and two more. Applications may send some at every tick."""
    longest = max(float(radio.module.longest(each)) for each in need.radios)
    shortest = 1 if need.at_once else int(periods.min())
    return (int(longest / (tick * shortest)) + 2) * max(need.at_once, 1) + 1


def written_for(kind: Kind, radio: Kind) -> ModuleType:
    """The loops for a kind of message on a kind of radio."""
    module, has_beacon = kind.module, hasattr(kind.module, "beacon")
    tuple_of(radio.module, radio.module.Settings)
    source = TEXT.format(
        name=kind.name,
        radio=radio.name,
        radio_module=radio.module.__name__,
        air=spelled([each.size for each in shapes(radio.module.Settings)], "air"),
        imports=f"from {module.__name__} import SettingsTuple, beacon\n" if has_beacon else "",
        beacons=beacons(module) if has_beacon else "",
    )
    return written(f"post_{kind.name}_{radio.name}", source, kind, radio)


def beacons(module: ModuleType) -> str:
    """The lines that send what every unit sends by itself."""
    tuple_of(module, module.Settings)
    own = ", ".join(f"now[{OWN_FIRST + i}, u]" for i in range(len(Own._fields)))
    return BEACONS.format(own=own, settings=spelled([each.size for each in shapes(module.Settings)], "settings"))


# -- sending -------------------------------------------------------------------------------------------


@inlined
def send(i, unit, time, fixed, payload, now, ring, last, fresh):
    """Sender i, which is `unit`, sends: the message stands in the ring until the radio has decided."""
    last[i] += 1
    senders = last.size
    column = last[i] % (ring.shape[1] // senders) * senders + i
    ring[S_NUMBER, column] = last[i]
    ring[S_TIME, column] = time
    ring[S_STAMP, column] = time * (1.0 + fixed[DRIFT, unit]) + fixed[OFFSET, unit]
    ring[S_X, column], ring[S_Y, column] = now[TRUE_X, unit], now[TRUE_Y, unit]
    row = SENT_ROWS
    for value in literal_unroll(payload):
        ring[row, column] = value * 1.0
        row += 1
    fresh[i] += 1


@inlined
def way_of(i, sender, receiver, slot, size, reach, place, shadow, fixed, now, ring, senders):
    """The way from a message's antenna to a receiver's; walls are counted within reach only."""
    column = slot * senders + i
    x0, y0, x1, y1 = ring[S_X, column], ring[S_Y, column], now[TRUE_X, receiver], now[TRUE_Y, receiver]
    distance, walls, inside = sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0)), 0.0, 0.0
    if distance <= reach and shadow.grid.frame[COLUMNS, place] > 0.0:
        walls, inside = walls_between(shadow, place, x0, y0, fixed[HEIGHT, sender], x1, y1, fixed[HEIGHT, receiver])
    return Way(distance, float(walls), inside, size, now[OWN_SPEED, receiver])


@inlined
def draws(receiver, sender, stream, seed, number):
    """Chance's part in message `number` from one unit to another, which chance knows by these numbers."""
    link = receiver * PAIR + sender
    return Draw(uniform(seed, link, stream, number), uniform(seed, link, stream + 1, number))


@inlined
def arrival_on(time, found, way, reach, receiver, link, now, lost):
    """When a message is there [s]; infinite when it is lost."""
    if found.lost or way.distance > reach or now[PRESENT, receiver] == 0.0:
        lost[link] += 1
        return inf
    return time + found.delay


# -- receiving -----------------------------------------------------------------------------------------


@lean
def receive(time, tick, sender_count, last, ring, link_sender, arrival, inbox):
    """Every link takes the newest of the messages that have come in since the last tick."""
    slots = arrival.shape[0]
    for link in range(link_sender.size):
        i = link_sender[link]
        for number in range(last[i], max(last[i] - slots, int(inbox[H_NUMBER, link]), -1), -1):
            slot = number % slots
            column = slot * sender_count + i
            if ring[S_NUMBER, column] != number:
                break
            if time - tick < arrival[slot, link] - EARLY <= time:
                inbox[H_MISSED, link] = lost_since(int(inbox[H_NUMBER, link]), number, i, link, sender_count, ring, arrival)
                take(time, number, column, link, ring, inbox)
                break


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
def take(time, number, column, link, ring, inbox):
    """A message comes in."""
    inbox[H_NUMBER, link], inbox[H_CAME, link] = number, time
    inbox[H_TIME, link], inbox[H_STAMP, link] = ring[S_TIME, column], ring[S_STAMP, column]
    for row in range(ring.shape[0] - SENT_ROWS):
        inbox[HEARD_ROWS + row, link] = ring[SENT_ROWS + row, column]


@lean
def freshest(first, count, links, inbox, heard, slots):
    """For every car j, the links among `links[first[j]]` and the next `count[j]` that have heard something, the freshest first.

    One with a count below zero is left as it is.
    """
    most = slots.shape[0]
    for j in range(first.size):
        if count[j] < 0:
            continue
        heard[j] = 0
        slots[:, j] = -1
        for p in range(first[j], first[j] + count[j]):
            link = links[p]
            if inbox[H_NUMBER, link] < 0.0:
                continue
            place = min(heard[j], most)
            while place > 0 and inbox[H_TIME, slots[place - 1, j]] < inbox[H_TIME, link]:
                if place < most:
                    slots[place, j] = slots[place - 1, j]
                place -= 1
            if place < most:
                slots[place, j] = link
                heard[j] = min(heard[j] + 1, most)
