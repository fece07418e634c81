"""The log of messages: what was sent and what became of it on every link, as compiled code writes it down.

A message is a column of a table; its links stand one after another in arrays beside it, 13 bytes each. A link whose receiver was out of
range has no entry: of such nothing is known but that it was so.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import nan
from typing import NamedTuple

import numpy as np

from studio.compiled import inlined, lean
from studio.world.table.unit import L_FIRST, L_NUMBER, L_SAID, L_SENDER, L_SIZE, L_TIME, LOGGED, SENT

SAID = 2  # numbers that a message carries first, which are kept
SENT_ROWS = len(SENT)
ROOM = 4096  # messages, and four times as many links, that room is made for at a time at least


class Logged(NamedTuple):
    """Messages [row, message], and of every entry the link, what became of the message there, the delay [s] and the distance [m]."""

    message: np.ndarray
    link: np.ndarray
    cause: np.ndarray
    delay: np.ndarray
    distance: np.ndarray


class Book(NamedTuple):
    """All of a log: of every message time [s], sender (a unit), number, size [bytes], what it says first, how many entries; and these."""

    time: np.ndarray
    sender: np.ndarray
    number: np.ndarray
    size: np.ndarray
    said: np.ndarray  # [number, message]
    count: np.ndarray
    link: np.ndarray
    cause: np.ndarray
    delay: np.ndarray
    distance: np.ndarray


def room(messages: int, entries: int) -> Logged:
    """For so many messages and entries."""
    entry = np.empty(entries, np.int32), np.empty(entries, np.uint8), np.empty(entries, np.float32), np.empty(entries, np.float32)
    return Logged(np.empty((len(LOGGED), messages)), *entry)


def held(part: Logged) -> Callable[[], Logged]:
    """Keeps a part in memory."""
    return lambda: part


@dataclass
class Log:
    """The log of one kind of message. `most` messages and entries come in one call at most; `count` of them stand in `now`.

    What stands there is put away when there is no more room, or when somebody asks for it; `keep` says how it is got again.
    """

    most: tuple[int, int]
    now: Logged = field(init=False)  # arrays that stay where they are, for compiled code
    count: np.ndarray = field(default_factory=lambda: np.zeros(2, dtype=np.int64))
    full: list[Callable[[], Logged]] = field(default_factory=list)
    keep: Callable[[Logged], Callable[[], Logged]] = held
    books: dict[tuple[int, ...], Book] = field(default_factory=dict)  # the last that was asked for, by how much stood in it

    def __post_init__(self) -> None:
        messages, entries = self.most
        self.now = room(max(ROOM, 2 * messages), max(4 * ROOM, 2 * entries))

    def make_room(self) -> None:
        """So that all that may come in one call finds room."""
        if is_full(*self.filling):
            self.put_away()

    @property
    def filling(self) -> tuple:
        """What `is_full` looks at."""
        return (*self.most, self.now.message.shape[1], self.now.link.size, self.count)

    def put_away(self) -> None:
        """So that nothing stands in `now`."""
        if self.count[0]:
            self.full.append(self.keep(self.written()))
            self.count[:] = 0

    def forget(self, time: float) -> None:
        """What was sent from a time [s] on, for a world that has gone back to it."""
        kept = [before(each, time) for each in self.parts()]
        self.full, self.count[:] = [self.keep(each) for each in kept if each.message.size], 0
        self.books.clear()

    def written(self) -> Logged:
        """What stands in `now`."""
        messages, entries = self.count.tolist()
        return Logged(self.now.message[:, :messages].copy(), *(each[:entries].copy() for each in self.now[1:]))

    def parts(self) -> list[Logged]:
        """All that was written, part by part."""
        return [*(each() for each in self.full), self.written()]

    def joined(self) -> Book:
        """All of it; the worlds of a batch ask for the same one after another."""
        size = (len(self.full), *self.count.tolist())
        if size not in self.books:
            self.books = {size: book_of(self.parts())}
        return self.books[size]


def book_of(parts: list[Logged]) -> Book:
    """Parts of a log, joined."""
    message, *entries = [np.concatenate(each, axis=-1) for each in zip(*parts, strict=True)]
    count = np.concatenate([np.diff(np.append(each.message[L_FIRST], each.link.size)) for each in parts])
    units, said = message[L_SENDER].astype(np.int64), message[L_SAID : L_SAID + SAID]
    return Book(message[L_TIME], units, message[L_NUMBER], message[L_SIZE], said, count.astype(np.int32), *entries)


def before(part: Logged, time: float) -> Logged:
    """The messages of a part that were sent before a time [s]."""
    count = int(np.searchsorted(part.message[L_TIME], time))
    last = int(part.message[L_FIRST, count]) if count < part.message.shape[1] else part.link.size
    return Logged(part.message[:, :count], *(each[:last] for each in part[1:]))


def after(part: Logged, time: float) -> Logged:
    """The messages of a part that were sent after a time [s]."""
    count = int(np.searchsorted(part.message[L_TIME], time, side="right"))
    first = int(part.message[L_FIRST, count]) if count < part.message.shape[1] else part.link.size
    message = part.message[:, count:].copy()
    message[L_FIRST] -= first
    return Logged(message, *(each[first:] for each in part[1:]))


@lean
def is_full(messages, entries, message_room, entry_room, count):
    """Whether all that may come in one call might not find room."""
    return count[0] + messages > message_room or count[1] + entries > entry_room


@inlined
def log_message(time, unit, number, size, column, ring, message, count):
    """Writes a message down, which stands in a column of the ring; its entries follow."""
    m = count[0]
    for i in range(SAID):
        message[L_SAID + i, m] = ring[SENT_ROWS + i, column] if SENT_ROWS + i < ring.shape[0] else nan
    message[L_TIME, m], message[L_SENDER, m], message[L_NUMBER, m] = time, unit, number
    message[L_SIZE, m], message[L_FIRST, m] = size, count[1]
    count[0] = m + 1


@inlined
def log_link(at, cause, wait, distance, link, causes, delay, distances, count):
    """Writes down what became of it on one link: the cause, the delay [s] of one that arrives, the distance [m]."""
    e = count[1]
    link[e], causes[e], delay[e], distances[e] = at, cause, wait, distance
    count[1] = e + 1
