"""Stubs: roads of which the junctions at both ends leave next to nothing. Nobody starts there, and the report says so."""

from collections.abc import Callable

from studio.road.network import Connection, Net
from studio.road.network.report import Notes, Spot

SHORT = 1.0  # [m]
SOURCE = "its junctions need the room: turns of cars begin before the middle of a crossing"


def tell(net: Net, spot: Callable[[Connection], Spot], notes: Notes) -> None:
    """Each of them, once."""
    onward = {net.lanes[each.from_lane].road: each for each in reversed(net.connections)}
    for name, road in net.roads.items():
        left = max(net.lanes[lane].length for lane in road.lanes)
        if not road.internal and left < SHORT and name in onward:
            notes.guess("short road", f"road {name} has {left:.1f} m between its junctions", spot(onward[name]), source=SOURCE, sure="high")
