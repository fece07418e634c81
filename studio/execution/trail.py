"""What probes have read, sample by sample, kept as what has changed: a sensor measures every few samples, and most see few targets.

trail.take()                    the next sample
trail.parts.at(samples, probes) →   float64[sample, probe], what some probes had read at some samples

Numbers that a probe's owner writes together are a stretch (studio/world/probe.py). A stretch that differs from what was written of it
last is written behind everything else; every sample says of every stretch where it stands. A sensor that has given nothing since then,
as the time of what it has measured and its number of targets tell, is not looked at.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from math import nan
from typing import NamedTuple

import numpy as np

from studio.bound import bound
from studio.compiled import inlined, lean
from studio.execution.shelf import Roll, Shelf
from studio.world.probe import COUNT, COUNTER, FIRST, SLOT, STEP, WHERE, Reader, Share

NUMBERS = 1 << 20  # that a part holds at least
SAMPLES = 1024  # that a part holds at most
NOTHING = 0  # where a stretch stands that has nothing to tell


class Part(NamedTuple):
    """Some samples that follow each other: from which on, where each stretch stands, int32[sample, stretch], and the numbers."""

    first: int
    place: np.ndarray
    numbers: np.ndarray


@dataclass
class Parts:
    """All parts, on a shelf; where the probes stand in them."""

    stretch: np.ndarray  # of every probe
    within: np.ndarray  # the place of every probe within its stretch
    places: Roll
    numbers: Roll
    beginnings: Roll  # the first sample of every part
    first: list[int] = field(default_factory=list)

    def begin(self, first: int) -> Part:
        """The next one, from a sample on."""
        made = Part(first, self.places.begin(), self.numbers.begin())
        self.beginnings.begin()[0] = first
        self.first.append(first)
        return made

    def at(self, samples: np.ndarray, probes: slice) -> np.ndarray:
        """What some probes had read at some samples, float64[sample, probe]; not a number where there was no target."""
        found = np.empty((samples.size, self.stretch[probes].size))
        number = np.searchsorted(self.first, samples, side="right") - 1
        for i in np.unique(number) if found.size else []:
            place, here = self.places[i][samples[number == i] - self.first[i]], number == i
            found[here] = self.numbers[i][place[:, self.stretch[probes]] + self.within[probes]]
        return found

    def series(self, samples: np.ndarray, probes: slice, shelf: Shelf) -> np.ndarray:
        """The same probe by probe, float64[probe, sample]."""
        found = shelf.room("probes", (self.stretch[probes].size, samples.size))
        for first in range(0, samples.size, SAMPLES):
            some = samples[first : first + SAMPLES]
            found[:, first : first + SAMPLES] = self.at(some, probes).T
        return found


@dataclass
class Trail:
    """What is written; the last part is open."""

    reader: Reader
    shelf: Shelf
    parts: Parts = field(init=False)
    newest: np.ndarray = field(init=False)  # where every stretch stands now
    longest: int = field(init=False)
    now: Part | None = None
    used: int = 0
    count: int = 0  # samples so far
    gates: list["Gate"] = field(init=False)  # of every array that is read
    ready: list[Callable] = field(default_factory=list)

    def __post_init__(self) -> None:
        shares = [each.stretches for each in self.reader.shares] or [np.zeros((6, 0), np.int64)]
        count, where = (np.concatenate([each[row] for each in shares]) for row in (COUNT, WHERE))
        stretch, within = np.zeros((2, int(count.sum())), np.int64)
        for number, (first, length) in enumerate(zip(where.tolist(), count.tolist(), strict=True)):
            stretch[first : first + length], within[first : first + length] = number, np.arange(length)
        self.newest = np.full(count.size, NOTHING, np.int32)
        self.longest = int(count.max(initial=1))
        self.parts = parts_on(self.shelf, stretch, within, count.size, self.longest)
        self.gates = [gate_of(each) for each in self.reader.shares]

    def take(self) -> None:
        """The next sample."""
        if self.now is None or self.is_full(self.now):
            self.now = self.begin()
        for keep_share in self.ready:
            self.used = keep_share(self.used)
        self.now.place[self.count - self.now.first] = self.newest
        self.count += 1

    def shares(self, kept: np.ndarray) -> Iterator[Callable]:
        """What keeps the stretches of each array; arrays stay where they are while a part is written."""
        own = np.split(self.newest, np.cumsum([each.stretches.shape[1] for each in self.reader.shares])[:-1])
        for each, gate, newest in zip(self.reader.shares, self.gates, own, strict=False):
            yield bound(keep, each.numbers, each.stretches, *gate, newest, kept, then=(self.used,))

    def is_full(self, part: Part) -> bool:
        """Whether a part may not take one more sample."""
        return self.count - part.first == len(part.place) or self.used + self.parts.stretch.size > part.numbers.size

    def begin(self) -> Part:
        """A part, into which everything is written anew."""
        part = self.parts.begin(self.count)
        part.numbers[: self.longest] = nan
        self.newest[:], self.used = NOTHING, self.longest
        self.ready = list(self.shares(part.numbers))
        for gate in self.gates:
            gate.seen[:] = nan
        return part


def parts_on(shelf: Shelf, stretch: np.ndarray, within: np.ndarray, stretches: int, longest: int) -> Parts:
    """The parts on a shelf, those that have begun and those that will."""
    size = max(NUMBERS, longest + 2 * stretch.size) if stretch.size else longest
    places, numbers = shelf.roll("places", (SAMPLES, stretches), np.int32), shelf.roll("numbers", (size,))
    return Parts(stretch, within, places, numbers, shelf.roll("beginnings", (1,), np.int64))


class Gate(NamedTuple):
    """Groups of the stretches of an array that are looked at together: those of one sensor, when it has given something."""

    measured: np.ndarray  # [s] per sensor, of when is what it has given last; nothing for an array that is always looked at
    groups: np.ndarray  # int64[row, group]: first stretch, the one behind the last, where the number of targets stands, which sensor
    seen: np.ndarray  # float64[2, group]: when it had measured, and how many targets it had, when it was looked at last


def gate_of(share: Share) -> Gate:
    """That of an array."""
    counter = share.stretches[COUNTER]
    if not share.measured.size:
        return Gate(share.measured, np.array([[0], [counter.size], [0], [0]]), np.full((2, 1), nan))
    first = np.flatnonzero(np.diff(counter, prepend=-1))
    groups = np.array([first, np.append(first[1:], counter.size), counter[first], counter[first] // share.owner.out.shape[1]])
    return Gate(share.measured, groups, np.full((2, first.size), nan))


@lean
def keep(numbers, stretches, measured, groups, seen, newest, kept, used):
    """Writes stretches of an array that have changed behind the first `used` of `kept`; how many are used then."""
    for g in range(groups.shape[1]):
        if measured.size > 0:
            when, count = measured[groups[3, g]], numbers[groups[2, g]]
            if when == seen[0, g] and count == seen[1, g]:
                continue
            seen[0, g], seen[1, g] = when, count
        used = keep_group(groups[0, g], groups[1, g], numbers, stretches, newest, kept, used)
    return used


@inlined
def keep_group(begin, end, numbers, stretches, newest, kept, used):
    """The same of some of the stretches."""
    for i in range(begin, end):
        slot = stretches[SLOT, i]
        if slot >= 0 and numbers[stretches[COUNTER, i]] <= slot:
            newest[i] = NOTHING
            continue
        first, step, count = stretches[FIRST, i], stretches[STEP, i], stretches[COUNT, i]
        if newest[i] != NOTHING and is_same(numbers, first, step, count, kept, newest[i]):
            continue
        for j in range(count):
            kept[used + j] = numbers[first + j * step]
        newest[i] = used
        used += count
    return used


@lean
def is_same(numbers, first, step, count, kept, at):
    """Whether a stretch is what was written of it at a place."""
    for j in range(count):
        now, before = numbers[first + j * step], kept[at + j]
        if now != before and (now == now or before == before):
            return False
    return True
