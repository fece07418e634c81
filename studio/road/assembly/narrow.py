"""Turns that are drawn narrower than a car's lock: cars drive a wider line there, as `ways/path.py` draws it, and the report says so."""

from collections.abc import Callable

import numpy as np

from studio.road.assembly.alignment import sharpest
from studio.road.network import Connection, Net, curve
from studio.road.network.report import Notes, Spot
from studio.road.ways.path import CORRIDOR, Draft, curvature_of, smooth

REACH = 40.0  # [m] of the lanes before and behind


def tell(net: Net, spot: Callable[[Connection], Spot], notes: Notes) -> None:
    """Tells every such turn with what is driven; where that is still too sharp, between roads of a few metres, cars leave their lane."""
    for each in net.connections:
        drawn = sharpest(net, each)
        if each.direction == "turn" or drawn <= curve.LOCK:
            continue
        start, end = (net.lanes[lane].road for lane in (each.from_lane, each.to_lane))
        bend = bend_of(net, each)
        what = f"from road {start} to road {end}, drawn with a radius of {1.0 / drawn:.1f} m, driven with {1.0 / bend:.1f} m"
        source = "the map leaves less room than a car's lock needs" + ("; cars leave their lane" if bend > curve.LOCK else "")
        notes.guess("wider turn", what, spot(each), source=source, sure="low" if bend > curve.LOCK else "medium")


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
