"""What a reader makes of a map file. What is left to do, signals and report, is the same for every kind of map."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from studio.road.assembly.priority import Law
from studio.road.formats.correction import Corrections
from studio.road.network import Net, Network, Scenery
from studio.road.network.report import Report


class Wish(NamedTuple):
    """Which part of a map is wanted, and how: as the arguments of `load`."""

    radius: float | None
    bbox: str | None
    parking_aisles: bool
    corrections: Corrections


@dataclass(frozen=True, eq=False)
class Plan:
    """Lanes and scenery with their place on the earth; `signalled` are the lanes that end at a signal, `law` tells who goes first.

    `report` looks at the finished network and tells what became of the map. The others are as in a Network.
    """

    net: Net
    signalled: frozenset[int]
    scenery: Scenery
    origin: tuple[float, float]
    bounds: tuple[float, float, float, float]
    attribution: str
    licence: str
    law: Law
    report: Callable[[Network], Report]
    datum: tuple[float, float] = (0.0, 0.0)
    bans: tuple[tuple[str, ...], ...] = ()
