"""What every link has heard last, sample by sample, kept as what has changed: most links hear nothing from one sample to the next.

hearing.make_room()            so that the next sample finds room
Chain(hearing.links(world))    writes it, and then hearing.mark() says that it is there
hearing.ages(links, time)  →   [s] float64[link, n], the age of the newest message on some links at the first samples
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from studio.bound import Link, step
from studio.execution.shelf import Arrays, Shelf
from studio.execution.trail import stop
from studio.world import channel
from studio.world.board.post import Post
from studio.world.world import World

ROOM = 1 << 16  # changes that room is made for at a time at least
BLOCK = 1 << 22  # ages that are made at a time
NEVER = -1.0  # [s] in place of a time of sending


@dataclass
class Hearing:
    """Changes so far: of which link, when what it has heard last was sent, and how many there were up to every sample."""

    sender: np.ndarray  # units at the ends of every link
    receiver: np.ndarray
    looked: np.ndarray  # per sender, how often its links had taken a message when it was looked last
    seen: np.ndarray  # per post, how often it had looked itself
    newest: np.ndarray  # [s] float64[link], when the newest message was sent; NEVER while none has come
    shelf: Shelf
    link: np.ndarray = field(init=False)  # room for changes that are being written
    sent: np.ndarray = field(init=False)
    count: np.ndarray = field(default_factory=lambda: np.zeros(1, np.int64))
    full: list[Callable[[], Arrays]] = field(default_factory=list)
    written: int = 0  # changes in `full`
    until: list[int] = field(default_factory=list)  # per sample, how many changes there had been
    here: np.ndarray = field(init=False)  # which units were there when they were looked at last
    there: list[tuple[int, np.ndarray]] = field(default_factory=list)  # from which sample on which units are there

    def __post_init__(self) -> None:
        room = max(ROOM, 2 * self.newest.size)
        self.link, self.sent = np.empty(room, np.int32), np.empty(room)

    def mark(self) -> None:
        """One more sample has been looked at."""
        self.until.append(self.written + int(self.count[0]))

    def links(self, world: World) -> list[Link]:
        """All that looks at a sample: at one post after the other, and last at who is there; arrays stay where they are."""
        if not self.newest.size:
            return []
        present = channel.present(world)
        self.here = np.zeros(present.size, dtype=bool)
        self.there.append((0, self.here.copy()))
        return [*self.noting(world.units.posts), Link(step(channel.look, present, self.here), self.others)]

    def others(self, found: Any) -> None:
        """Others are there than before."""
        if isinstance(found, BaseException):
            raise found
        self.there.append((len(self.until), self.here.copy()))

    def noting(self, posts: Sequence[Post]) -> Iterator[Link]:
        """What notes down who has heard something newer, post by post."""
        first = sender = 0
        for i, post in enumerate(posts):
            own, newest = self.looked[sender : sender + post.sender.size], self.newest[first : first + post.link_receiver.size]
            heard = (post.link_first, post.taken, post.looks, post.came, post.came_count, post.inbox)
            own = (own, self.seen[i : i + 1], newest, self.link, self.sent, self.count)
            yield Link(step(channel.note, first, *heard, *own), stop)
            first, sender = first + post.link_receiver.size, sender + post.sender.size

    def make_room(self) -> None:
        """So that a change of every link finds room."""
        if self.count[0] + self.newest.size > self.link.size:
            count = int(self.count[0])
            self.full.append(self.shelf.append("heard", self.link[:count].copy(), self.sent[:count].copy()))
            self.written, self.count[0] = self.written + count, 0

    def ages(self, links: Sequence[int], time: np.ndarray) -> np.ndarray:
        """True age [s] of the newest message on some links at the first samples, the time since the start while none has come.

        Not a number once one of its ends has left.
        """
        found = self.shelf.room("ages", (len(links), time.size))
        if found.size:
            changes, there = self.changes(time.size), self.presence(time.size)
            for some in range(0, len(links), max(BLOCK // time.size, 1)):
                some = slice(some, some + max(BLOCK // time.size, 1))
                self.age(np.asarray(links[some]), time, changes, there, found[some])
        return found

    def age(self, links: np.ndarray, time: np.ndarray, changes: Arrays, there: np.ndarray, found: np.ndarray) -> None:
        """Those of a few of the links, written to `found`."""
        changed, sent, sample = changes
        place = np.full(self.newest.size, -1)
        place[links] = np.arange(links.size)
        row = place[changed]
        found[:] = NEVER
        found[row[row >= 0], sample[row >= 0]] = sent[row >= 0]
        np.maximum.accumulate(found, axis=1, out=found)
        found[:] = np.where(found >= 0.0, time - found, time)
        found[~(there[:, self.receiver[links]] & there[:, self.sender[links]]).T] = np.nan

    def changes(self, samples: int) -> Arrays:
        """All changes up to a sample: of which link, when what it has heard was sent [s], which never goes back, and at which sample."""
        parts = [*(each() for each in self.full), (self.link[: self.count[0]], self.sent[: self.count[0]])]
        changed, sent = (np.concatenate(each) for each in zip(*parts, strict=True))
        sample = np.repeat(np.arange(samples), np.diff(self.until[:samples], prepend=0))
        return changed[: sample.size], sent[: sample.size], sample

    def presence(self, samples: int) -> np.ndarray:
        """Which units are there, bool[sample, unit]."""
        since, units = [first for first, _ in self.there], np.array([each for _, each in self.there])
        return units[np.searchsorted(since, np.arange(samples), side="right") - 1]


def hearing(posts: Sequence[Post], shelf: Shelf) -> Hearing:
    """Of all links, which have heard nothing."""
    sender = np.concatenate([np.zeros(0, np.int64), *(post.sender[post.link_sender] for post in posts)])
    receiver = np.concatenate([np.zeros(0, np.int64), *(post.link_receiver for post in posts)])
    looked = np.zeros(sum(post.sender.size for post in posts), dtype=np.int64)
    return Hearing(sender, receiver, looked, np.zeros(len(posts), dtype=np.int64), np.full(sender.size, NEVER), shelf)
