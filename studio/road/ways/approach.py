"""Approaches: what one drives before and behind a way through a junction, straight on over roads of a few metres too."""

from collections.abc import Iterable

import numpy as np

from studio.road.network import Connection, Lane, Net, Network, curve
from studio.road.ways.path import CORRIDOR, GRAIN, Draft

REACH = 25.0  # [m] of the lanes before and behind
STRAIGHTEST = ("straight", "slight_left", "slight_right", "left", "right")


class Approaches:
    """For each lane the straightest connection by which one comes onto it, and by which one leaves it; turning back does not count."""

    def __init__(self, net: Net | Network) -> None:
        self.lanes, self.before, self.behind = net.lanes, {}, {}
        for each in sorted((each for each in net.connections if each.direction != "turn"), key=rank):
            self.before.setdefault(each.to_lane, each)
            self.behind.setdefault(each.from_lane, each)

    def draft(self, connection: Connection) -> tuple[Draft, int, int]:
        """The rough line of a connection with the metres before and behind, and which of its pieces begin with the way itself and with
        what comes behind it."""
        draft = Draft()
        before, behind = list(self.towards(connection.from_lane)), list(self.onwards(connection.to_lane))
        add(draft, reversed(before), -1)
        first = len(draft.pieces)
        for via in connection.via:
            draft.add(*resampled(self.lanes[via]), CORRIDOR, self.lanes[via].speed)
        last = len(draft.pieces)
        add(draft, behind, 1)
        return draft, first, last

    def towards(self, lane: int) -> Iterable[tuple[Lane, float]]:
        """The lanes on which one comes to the end of a lane, backwards, and how many metres of each."""
        return self.along(lane, self.before, lambda each: (*reversed(each.via), each.from_lane))

    def onwards(self, lane: int) -> Iterable[tuple[Lane, float]]:
        """The lanes on which one drives on from the start of a lane, and how many metres of each."""
        return self.along(lane, self.behind, lambda each: (*each.via, each.to_lane))

    def along(self, lane: int, links: dict[int, Connection], lanes_of) -> Iterable[tuple[Lane, float]]:
        """The same in one of the directions; each lane once."""
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
