"""Marks on roads off the land: arrows, bars before lights and crossings of a bridge lie on its deck, not on the ground below it."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import shapely

from studio.road.network import Crossing, Network
from studio.road.ways.relief import Relief
from studio.scene.city.deck import PAINT
from studio.scene.city.marking import Marks, arrows, crossing_pieces, marks_of
from studio.scene.city.mesh import Mesh, flat, merged
from studio.scene.city.stretch import SAME, Neighbours
from studio.scene.light import on_level_ground
from studio.scene.shape import Surface, surface

WHITE = "#eceae3"


def parted(network: Network, relief: Relief) -> tuple[Marks, list[Surface]]:
    """The marks on the land, and those off it at the height of their road."""
    shown, low, high = marks_of(network), Marks([], [], []), []
    ends = [(lane, network.lanes[lane].length) for lane in network.signals.link_lane.tolist()]
    rows: list[tuple[list[Any], Any, Mesh, tuple[int, float]]] = [
        *((low.arrows, mesh, mesh, (lane, s)) for mesh, lane, s in arrows(network)),
        *((low.bars, bar, flat(bar), place) for bar, place in zip(shown.bars, ends, strict=True)),
        *((low.crossings, each, stripes(each), place) for each, place in roads_under(network, relief, shown.crossings)),
    ]
    for kept, mark, mesh, place in rows:
        if is_off(relief, *place):
            high.append(painted(mesh, relief, *place))
        else:
            kept.append(mark)
    return low, high


def stripes(crossing: Crossing) -> Mesh:
    """What is painted of a crossing."""
    return merged([flat(each) for each in crossing_pieces(crossing)])


def is_off(relief: Relief, lane: int, s: float) -> bool:
    """Whether a lane is off the land at a station [m]."""
    station, _, lift = relief.of_lane(lane)
    return bool(np.interp(s, station, lift) != 0.0)


def roads_under(network: Network, relief: Relief, crossings: list[Crossing]) -> Iterator[tuple[Crossing, tuple[int, float]]]:
    """Each crossing with the lane on which it lies and the station there [m]: the lowest where roads lie above each other."""
    if not crossings:
        return
    others = Neighbours(network, relief)
    middles = np.array([crossing.line.mean(axis=1) for crossing in crossings]).T
    place, lane, lift = others.near(middles, SAME)
    s = shapely.line_locate_point(others.lines[lane], np.asarray(shapely.points(middles.T))[place])
    for i, crossing in enumerate(crossings):
        own = np.flatnonzero(place == i)
        lowest = own[int(np.abs(lift[own]).argmin())] if own.size else None
        yield crossing, (0, 0.0) if lowest is None else (int(lane[lowest]), float(s[lowest]))


def painted(mesh: Mesh, relief: Relief, lane: int, s: float) -> Surface:
    """A mark at the height of its lane above the land, and a little more."""
    station = relief.of_lane(lane)[0]
    height = np.interp(s, station, relief.points[2, relief.first[lane] : relief.first[lane + 1]])
    x, y = mesh.vertices[:, 0].astype(float), mesh.vertices[:, 1].astype(float)
    z = relief.at(x, y, np.full(x.size, height))[0] + PAINT
    return surface(np.column_stack([x, y, z]), mesh.faces, on_level_ground(WHITE))
