"""Turns that are drawn narrower than a car's lock: cars swing out there, as `ways/path.py` draws it, and the report says so. A turn
that no car gets round so is left out, and the report says so too: whatever is offered can be driven.
"""

from collections.abc import Callable
from dataclasses import replace

from studio.road.assembly.alignment import sharpest
from studio.road.network import Connection, Net, curve
from studio.road.network.report import Notes, Spot
from studio.road.ways.approach import Approaches
from studio.road.ways.lock import MOST_ASIDE, Bend, bend_over

SOURCE = "the map leaves less room than a car's lock needs"
SEEN = 0.3  # [m] aside is worth a word


def drivable(net: Net, spot: Callable[[Connection], Spot], notes: Notes) -> Net:
    """The network without the turns that no car can drive; what is driven in narrow ones, and what is left out, is told."""
    net = replace(net, connections=tuple(replace(each, sharpest=sharpest(net, each)) for each in net.connections))
    approaches, gone = Approaches(net), set()
    for each in net.connections:
        drawn = each.sharpest
        if each.direction == "turn" or drawn <= curve.LOCK:
            continue
        bend = bend_over(approaches, each, curve.LOCK)
        start, end = (net.lanes[lane].road for lane in (each.from_lane, each.to_lane))
        what = f"from road {start} to road {end}, drawn with a radius of {1.0 / drawn:.1f} m"
        if bend.is_within(curve.LOCK):
            notes.guess("wider turn", f"{what}, {driven(bend)}", spot(each), source=SOURCE, sure=sure(bend))
        else:
            gone.add(id(each))
            notes.skip("turn", what, spot(each), f"no car gets round with {MOST_ASIDE:g} m beside its lane")
    return replace(net, connections=tuple(each for each in net.connections if id(each) not in gone)) if gone else net


def driven(bend: Bend) -> str:
    """What is driven, in words."""
    aside = f", {bend.aside:.1f} m beside the lane's middle" if bend.aside > SEEN else ""
    return f"driven with {1.0 / bend.curvature:.1f} m{aside}"


def sure(bend: Bend) -> str:
    """A car that leaves its lane by half of it, or more, does so on ground that the map may not have."""
    return "low" if bend.aside > 0.5 * MOST_ASIDE else "medium"
