"""Turns that are drawn narrower than a car's lock. What cars drive there is wider, as `ways/path.py` draws it; where even that cannot be
driven, the turn is left out if other ways lead on and in. Both are told.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from studio.road.assembly.alignment import sharpest
from studio.road.network import Connection, Net, curve
from studio.road.network.report import Notes, Spot
from studio.road.ways.path import CORRIDOR, Draft, curvature_of, smooth

BEYOND = 0.3  # [1/m] of the line that is driven: a car with its wheels at full lock would leave its lane by more than a metre
REACH = 40.0  # [m] of the lanes before and behind


def driven(net: Net, spot: Callable[[Connection], Spot], notes: Notes) -> Net:
    """The network without turns that no car can take."""
    tight = [each for each in net.connections if each.direction != "turn" and sharpest(net, each) > curve.LOCK]
    ways_on, ways_in = (Counter(net.lanes[lane(each)].road for each in net.connections if each.direction != "turn") for lane in ENDS)
    gone = set()
    for each in tight:
        start, end = (net.lanes[lane(each)].road for lane in ENDS)
        bend = bend_of(net, each)
        lone = ways_on[start] < 2 or ways_in[end] < 2
        what = f"from road {start} to road {end}, drawn with a radius of {1.0 / sharpest(net, each):.1f} m, driven with {1.0 / bend:.1f} m"
        if bend > BEYOND and not lone:
            gone.add(id(each))
            ways_on[start] -= 1
            ways_in[end] -= 1
            notes.skip("narrow turn", what, spot(each), "no car can turn so sharply; it is left out")
        elif bend > BEYOND:
            notes.skip(
                "narrow turn",
                what,
                spot(each),
                "no car can turn so sharply; it is kept, since nothing else leads on or in",
            )
        else:
            notes.guess("wider turn", what, spot(each), source="the map leaves less room than a car's lock needs", sure="medium")
    return replace(net, connections=tuple(each for each in net.connections if id(each) not in gone)) if gone else net


ENDS = (lambda each: each.from_lane, lambda each: each.to_lane)


def bend_of(net: Net, connection: Connection) -> float:
    """The sharpest curvature of the line that is driven over a connection [1/m]."""
    draft = Draft()
    before, behind = net.lanes[connection.from_lane], net.lanes[connection.to_lane]
    lines = [part(before.centre, -1), *(net.lanes[via].centre for via in connection.via), part(behind.centre, 0)]
    for line in lines:
        draft.add(line, np.zeros(line.shape[1]), CORRIDOR, before.speed)
    line, _ = smooth(draft)
    return max(float(np.abs(curvature_of(line)).max()), 1e-6)


def part(line: np.ndarray, end: int) -> np.ndarray:
    """The metres of a lane at its start (0) or its end (-1)."""
    own = curve.stations(line)
    return line[:, own <= REACH] if end == 0 and (own <= REACH).sum() > 1 else line[:, own >= own[-1] - REACH] if end else line
