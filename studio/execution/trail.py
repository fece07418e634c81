"""What probes have read, sample by sample, kept as what has changed: a sensor measures every few samples, and most see few targets.

trail.make_room()               so that the next sample finds room
Chain([trail.link])             writes it
trail.parts.at(samples, probes) →   float64[sample, probe], what some probes had read at some samples

What is written together is a piece: of a sensor when it has measured, how many targets there were, and these; of anything else numbers that
follow each other. A piece that has changed is written behind everything else; every sample says of every piece where it stands. Whether a
sensor has given something since it was looked at last, the time of what it has measured and its number of targets tell.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from math import nan
from typing import NamedTuple

import numpy as np

from studio.bound import Link, step
from studio.compiled import inlined, lean
from studio.execution.shelf import Roll, Shelf
from studio.world.board.sensing import Mounted
from studio.world.probe import Probe, Reader, follows, measured_at, place, runs, stretch

NUMBERS = 1 << 20  # that a part holds at least
SAMPLES = 1024  # that a part holds at most
NOTHING = 0  # where a piece stands of which nothing has been written
# Of a piece: numbers of the buffer that follow each other, how many at most; of a sensor where it stands when it has measured, and how many
# numbers a target has. Of a sensor the first number is that of its targets.
FIRST, STEP, MOST, GATE, WIDTH = range(5)
SAMPLE, NUMBER = range(2)  # of what is used of a part
ALWAYS = -1  # in place of a gate, for what is no sensor's


class Part(NamedTuple):
    """Some samples that follow each other: from which on, where each piece stands, int32[sample, piece], and the numbers."""

    first: int
    place: np.ndarray
    numbers: np.ndarray


@dataclass
class Parts:
    """All parts, on a shelf; where the probes stand in them."""

    piece: np.ndarray  # of every probe
    within: np.ndarray  # the place of every probe within its piece
    slot: np.ndarray  # the target that every probe is about, -1 for none
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
        found = np.empty((samples.size, self.piece[probes].size))
        number = np.searchsorted(self.first, samples, side="right") - 1
        for i in np.unique(number) if found.size else []:
            place, here = self.places[i][samples[number == i] - self.first[i]], number == i
            found[here] = self.within_part(place[:, self.piece[probes]], self.numbers[i], probes)
        return found

    def within_part(self, at: np.ndarray, numbers: np.ndarray, probes: slice) -> np.ndarray:
        """The same of one part; the pieces of the probes stand `at` some places."""
        slot = self.slot[probes]
        is_there = (slot < 0) | (numbers[at + 1] > slot)
        return np.where(is_there, numbers[at + self.within[probes]], nan)

    def series(self, samples: np.ndarray, probes: slice, shelf: Shelf) -> np.ndarray:
        """The same probe by probe, float64[probe, sample]."""
        found = shelf.room("probes", (self.piece[probes].size, samples.size))
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
    pieces: np.ndarray = field(init=False)  # int64[row, piece]
    seen: np.ndarray = field(init=False)  # float64[2, piece]: when a sensor had measured, and how many targets it had, at the last look
    newest: np.ndarray = field(init=False)  # where every piece stands now
    longest: int = field(init=False)  # numbers of a piece at most
    now: Part | None = None
    total: np.ndarray = field(default_factory=lambda: np.zeros(2, np.int64))  # of the open part: samples and numbers
    link: Link = field(init=False)  # writes a sample into the open part

    def __post_init__(self) -> None:
        probes = self.reader.probes
        found = [probes[first : first + count] for first, count in runs(probes, is_together)]
        start = self.reader.numbers.ctypes.data
        self.pieces = np.array([piece_of(each, start) for each in found], dtype=np.int64).reshape(-1, 5).T.copy()
        self.seen, self.newest = np.full((2, len(found)), nan), np.full(len(found), NOTHING, np.int32)
        self.longest = int(self.pieces[MOST].max(initial=1)) + 1
        self.parts = parts_of(found, self.shelf, self.room)

    @cached_property
    def room(self) -> int:
        """Numbers of a sample at most."""
        return int(self.pieces[MOST].sum()) + self.newest.size

    @property
    def count(self) -> int:
        """Samples so far."""
        return 0 if self.now is None else self.now.first + int(self.total[SAMPLE])

    @property
    def used(self) -> int:
        """Numbers of the open part that are written."""
        return int(self.total[NUMBER])

    def make_room(self) -> bool:
        """So that the next sample finds room; whether `link` is another one now."""
        if self.now is not None and not self.is_full(self.now):
            return False
        self.now = self.begin(self.count)
        return True

    def is_full(self, part: Part) -> bool:
        """Whether a part may not take one more sample."""
        samples, numbers = self.total.tolist()
        return samples == len(part.place) or numbers + self.room > part.numbers.size

    def begin(self, first: int) -> Part:
        """A part, into which everything from a sample on is written anew."""
        part = self.parts.begin(first)
        part.numbers[: self.longest] = nan
        self.newest[:], self.seen[:], self.total[:] = NOTHING, nan, (0, self.longest)
        written = (self.newest, part.place, part.numbers, self.total)
        self.link = Link(step(keep, self.reader.numbers, self.pieces, self.seen, *written), stop)
        return part


# -- pieces ----------------------------------------------------------------------------------------------


def is_together(one: Probe, other: Probe) -> bool:
    """Whether a probe is in the piece of the one before it."""
    if isinstance(one.owner, Mounted):
        return one.owner is other.owner and one.column == other.column
    return follows(one, other)


def piece_of(probes: list[Probe], start: int) -> tuple[int, ...]:
    """The piece that some probes are of; `start` is the address of the buffer."""
    first = probes[0]
    if not isinstance(first.owner, Mounted):
        return *stretch(first, len(probes), 0, start)[:3], ALWAYS, 0
    out, rows = first.owner.out, first.owner.out.shape[1]
    return place(out, start) + first.column * rows, 1, rows, measured_at(first, start), (rows - 1) // first.owner.capacity


def parts_of(pieces: list[list[Probe]], shelf: Shelf, most: int) -> Parts:
    """The parts on a shelf, those that have begun and those that will; `most` numbers come with a sample."""
    piece = np.repeat(np.arange(len(pieces)), [len(each) for each in pieces])
    within = np.array([i for each in pieces for i in places_within(each)], dtype=np.int64)
    slot = np.array([each.slot for some in pieces for each in some], dtype=np.int64)
    size = max(NUMBERS, 4 * most) if pieces else 2
    places, numbers = shelf.roll("places", (SAMPLES, len(pieces)), np.int32), shelf.roll("numbers", (size,))
    return Parts(piece, within, slot, places, numbers, shelf.roll("beginnings", (1,), np.int64))


def places_within(probes: list[Probe]) -> Iterator[int]:
    """Where every one of these stands in its piece."""
    for i, each in enumerate(probes):
        yield i if not isinstance(each.owner, Mounted) else 1 + each.row if each.field == "out" else 0


# -- keeping ---------------------------------------------------------------------------------------------


def stop(error: BaseException) -> None:
    """Nothing is told of a sample but what is raised."""
    raise error


@lean
def keep(numbers, pieces, seen, newest, place, kept, total):
    """Writes pieces that have changed behind what is used of `kept`, and where every piece stands."""
    sample, used = total[SAMPLE], total[NUMBER]
    for i in range(pieces.shape[1]):
        first, gate = pieces[FIRST, i], pieces[GATE, i]
        if gate == ALWAYS:
            used = keep_numbers(i, numbers, first, pieces[STEP, i], pieces[MOST, i], newest, kept, used)
        elif numbers[gate] != seen[0, i] or numbers[first] != seen[1, i]:
            seen[0, i], seen[1, i] = numbers[gate], numbers[first]
            used = keep_targets(i, numbers[gate], numbers, first, 1 + int(numbers[first]) * pieces[WIDTH, i], newest, kept, used)
        place[sample, i] = newest[i]
    total[SAMPLE], total[NUMBER] = sample + 1, used


@inlined
def keep_targets(i, measured, numbers, first, count, newest, kept, used):
    """The same of what a sensor has given: when it has measured [s], and so many numbers."""
    newest[i], kept[used] = used, measured
    for j in range(count):
        kept[used + 1 + j] = numbers[first + j]
    return used + 1 + count


@inlined
def keep_numbers(i, numbers, first, step, count, newest, kept, used):
    """The same of a piece that is no sensor's."""
    if newest[i] != NOTHING and is_same(numbers, first, step, count, kept, newest[i]):
        return used
    newest[i] = used
    for j in range(count):
        kept[used + j] = numbers[first + j * step]
    return used + count


@inlined
def is_same(numbers, first, step, count, kept, at):
    """Whether numbers are what was written of them at a place."""
    for j in range(count):
        now, before = numbers[first + j * step], kept[at + j]
        if now != before and (now == now or before == before):
            return False
    return True
