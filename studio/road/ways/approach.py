"""Approaches: what one drives before and behind a way through a junction, straight on over roads of a few metres too."""

from collections import defaultdict
from collections.abc import Iterable, Iterator

import numpy as np

from studio.road.network import Connection, Lane, Net, Network, curve
from studio.road.ways.path import CORRIDOR, GRAIN, Draft

REACH = 25.0  # [m] of the lanes before and behind
STRAIGHTEST = ("straight", "slight_left", "slight_right", "left", "right")


class Approaches:
    """For each lane the straightest connection by which one comes onto it, and by which one leaves it; turning back does not count."""

    def __init__(self, net: Net | Network) -> None:
        self.lanes, self.before, self.behind = net.lanes, {}, {}
        self.into: dict[int, list[Connection]] = defaultdict(list)
        self.out: dict[int, list[Connection]] = defaultdict(list)
        for each in sorted((each for each in net.connections if each.direction != "turn"), key=rank):
            self.before.setdefault(each.to_lane, each)
            self.behind.setdefault(each.from_lane, each)
            self.into[each.to_lane].append(each)
            self.out[each.from_lane].append(each)

    def drafts(self, connection: Connection) -> Iterator[tuple[Draft, int, int]]:
        """Its drafts for all ways of coming to it and of leaving it, the straightest first, where the roads at it are short."""
        for before in self.into[connection.from_lane] or [None]:
            for behind in self.out[connection.to_lane] or [None]:
                yield self.draft(connection, before, behind)

    def draft(self, connection: Connection, before: Connection | None = None, behind: Connection | None = None) -> tuple[Draft, int, int]:
        """The rough line of a connection with the metres before and behind, and which of its pieces begin with the way itself and with
        what comes behind it. One comes to it over the straightest connections, or first over these."""
        return self.joined(
            connection,
            list(self.along(connection.from_lane, self.before | ({before.to_lane: before} if before else {}), backwards)),
            list(self.along(connection.to_lane, self.behind | ({behind.from_lane: behind} if behind else {}), forwards)),
        )

    def joined(self, connection: Connection, before: list, behind: list) -> tuple[Draft, int, int]:
        """The same of lanes."""
        draft = Draft()
        add(draft, reversed(before), -1)
        first = len(draft.pieces)
        for via in connection.via:
            draft.add(*resampled(self.lanes[via]), CORRIDOR, self.lanes[via].speed)
        last = len(draft.pieces)
        add(draft, behind, 1)
        return draft, first, last

    def along(self, lane: int, links: dict[int, Connection], lanes_of) -> Iterable[tuple[Lane, float]]:
        """The lanes on which one drives on from a lane in one of the directions, and how many metres of each; each lane once."""
        waiting, seen, left = [lane], set(), REACH
        while waiting and left > 0.0:
            number = waiting.pop(0)
            if number in seen:
                return
            seen.add(number)
            yield self.lanes[number], left
            left -= self.lanes[number].length
            if not waiting and number in links:
                waiting = list(lanes_of(links[number]))


def backwards(connection: Connection) -> tuple[int, ...]:
    """The lanes of a connection against the way one drives, without the one from which one comes there."""
    return (*reversed(connection.via), connection.from_lane)


def forwards(connection: Connection) -> tuple[int, ...]:
    """The lanes of a connection, without the one from which one comes."""
    return (*connection.via, connection.to_lane)


def rank(connection: Connection) -> int:
    """How little one turns on a connection."""
    return STRAIGHTEST.index(connection.direction) if connection.direction in STRAIGHTEST else 0


def add(draft: Draft, lanes: Iterable[tuple[Lane, float]], side: int) -> None:
    """Adds lanes to a draft; of each so many metres at its end (-1) or its start (1)."""
    for lane, metres in lanes:
        (line, height), count = resampled(lane), round(metres / GRAIN) + 2
        used = slice(0, count) if side > 0 else slice(-count, None)
        draft.add(line[:, used], height[used], CORRIDOR, lane.speed)


def resampled(lane: Lane) -> tuple[np.ndarray, np.ndarray]:
    """A lane's line with a point every `GRAIN` metres, and its height there [m]."""
    line = curve.resampled(lane.centre, GRAIN)
    at = np.linspace(0.0, lane.length, line.shape[1])
    return line, np.interp(at, curve.stations(lane.centre), lane.height)
