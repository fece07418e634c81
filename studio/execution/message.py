"""Messages of a run: what was sent, and what became of it at everybody who was in range.

    record.messages.time[m], .sender[m], .kind[m]          of message m
    record.messages.cause[e], .delay[e], .distance[e]      of entry e, one for every receiver in range
    record.messages.of[e]                                  the message that entry e is about

A receiver without an entry was out of range. Units and kinds are numbers into `units` and `kinds`, causes those of world/table/cause.py.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from studio.world.board.log import Book, after, book_of
from studio.world.table.cause import RECEIVED
from studio.world.world import World

OF_EACH = (np.float64, np.int32, np.uint8, np.int32, np.float32, np.float32, np.float32, np.int32)
DTYPES = (*OF_EACH, np.int32, np.uint8, np.float32, np.float32)  # of messages, then of entries
OF_ENTRIES = ("receiver", "cause", "delay", "distance")


@dataclass(frozen=True)
class Messages:
    """Messages in the order of sending, and their entries, message after message."""

    kinds: tuple[str, ...]
    units: tuple[str, ...]
    time: np.ndarray  # [s] of sending, float64[message]
    sender: np.ndarray
    kind: np.ndarray
    number: np.ndarray  # how many of this kind the sender had sent before
    size: np.ndarray  # [bytes]
    said_0: np.ndarray  # the first number that it carries, and the second; not a number where it carries fewer
    said_1: np.ndarray
    count: np.ndarray  # entries of each message
    receiver: np.ndarray
    cause: np.ndarray
    delay: np.ndarray  # [s] float32[entry], not a number where it is lost
    distance: np.ndarray  # [m] from antenna to antenna

    @cached_property
    def of(self) -> np.ndarray:
        """The message that each entry is about."""
        return np.repeat(np.arange(self.time.size), self.count)

    @property
    def came(self) -> np.ndarray:
        """When each was there [s], float64[entry]; not a number for what was lost."""
        return self.time[self.of] + self.delay

    @property
    def is_received(self) -> np.ndarray:
        """Whether it arrived, per entry; it may have been under way when the run ended."""
        return self.cause == RECEIVED

    @property
    def is_late(self) -> np.ndarray:
        """Whether one that arrived was overtaken by a newer one of its sender, and so told nothing new."""
        late = np.zeros(self.of.size, dtype=bool)
        for entries in self.links():
            came = np.where(self.is_received[entries], self.came[entries], np.inf)
            newest = np.minimum.accumulate(came[::-1])[::-1]
            late[entries] = (came > newest) & np.isfinite(came)
        return late

    def links(self) -> Iterator[np.ndarray]:
        """The entries of every kind, sender and receiver that has some, in the order of sending."""
        keys = np.stack([self.receiver, self.sender[self.of], self.kind[self.of]])
        order = np.lexsort(keys)
        ends = np.flatnonzero(np.any(np.diff(keys[:, order]), axis=0)) + 1
        yield from (part for part in np.split(order, ends) if part.size)

    def link(self, sender: str, receiver: str, kind: str) -> np.ndarray:
        """The entries of one link; raises ValueError for what has no number."""
        s, r, k = self.units.index(sender), self.units.index(receiver), self.kinds.index(kind)
        return np.flatnonzero((self.receiver == r) & (self.sender[self.of] == s) & (self.kind[self.of] == k))

    def part(self, messages: np.ndarray, entries: np.ndarray) -> "Messages":
        """Some messages, bool[message], and of their entries some, bool[entry]."""
        kept = entries & messages[self.of]
        count = np.bincount(self.of[kept], minlength=self.time.size)[messages]
        parts = {each.name: getattr(self, each.name)[kept if each.name in OF_ENTRIES else messages] for each in fields(Messages)[2:]}
        return Messages(self.kinds, self.units, **parts | {"count": count.astype(self.count.dtype)})


def none(kinds: tuple[str, ...] = (), units: tuple[str, ...] = ()) -> Messages:
    """No messages."""
    return Messages(kinds, units, *(np.zeros(0, kind) for kind in DTYPES))


def messages(world: World, number: int) -> Messages:
    """Those of one world so far."""
    units, posts = world.units, [post for post in world.units.posts if number in post.worlds]
    first = int(units.first[number])
    parts = [of_book(own(post.log.joined(), units.world == number), post.link_receiver, first, i) for i, post in enumerate(posts)]
    return joined(parts, tuple(post.kind.name for post in posts), units.names[number])


def joined(parts: Sequence[Messages], kinds: tuple[str, ...], names: tuple[str, ...]) -> Messages:
    """Those of several kinds, in the order of sending."""
    parts = [part for part in parts if part.time.size]
    if not parts:
        return none(kinds, names)
    columns = {each.name: np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(Messages)[2:]}
    return sorted_by_time(Messages(kinds, names, **columns))


def lately(world: World, since: float) -> Messages:
    """Those of the first world that were sent after a time [s], as far as they have not been put away: for the eye."""
    units, posts = world.units, [post for post in world.units.posts if 0 in post.worlds]
    parts = []
    for i, post in enumerate(posts):
        fresh = after(post.log.written(), since)
        parts.append(of_book(own(book_of([fresh]), units.world == 0), post.link_receiver, int(units.first[0]), i))
    return joined(parts, tuple(post.kind.name for post in posts), units.names[0])


def own(book: Book, units: np.ndarray) -> Book:
    """What some units have sent, bool[unit]."""
    sent = units[book.sender]
    entries = np.repeat(sent, book.count)
    return Book(*(each[..., sent] for each in book[:6]), *(each[entries] for each in book[6:]))


def of_book(book: Book, link_receiver: np.ndarray, first: int, kind: int) -> Messages:
    """Those of one kind and one world, in the order of the log; `first` is its first unit."""
    columns = {
        "time": book.time,
        "sender": book.sender - first,
        "kind": np.full(book.time.size, kind),
        "number": book.number,
        "size": book.size,
        "said_0": book.said[0],
        "said_1": book.said[1],
        "count": book.count,
        "receiver": link_receiver[book.link] - first,
        "cause": book.cause,
        "delay": book.delay,
        "distance": book.distance,
    }
    return Messages((), (), **{name: each.astype(kind) for (name, each), kind in zip(columns.items(), DTYPES, strict=True)})


def sorted_by_time(found: Messages) -> Messages:
    """The same in the order of sending; what was sent at the same time stays as it was."""
    order = np.argsort(found.time, kind="stable")
    first, count = np.cumsum(found.count) - found.count, found.count[order]
    shift = first[order] - (np.cumsum(count) - count)  # by how much the entries of each message move
    entries = np.arange(found.cause.size) + np.repeat(shift, count)
    parts = {each.name: getattr(found, each.name)[entries if each.name in OF_ENTRIES else order] for each in fields(Messages)[2:]}
    return Messages(found.kinds, found.units, **parts)
