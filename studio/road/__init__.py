"""Maps: roads, signals, scenery, and the paths that vehicles drive on them."""

from studio.road.network import Network
from studio.road.place import load

__all__ = ["Network", "load"]
