"""The stretches of lanes that lie on the land, and those that lie off it: on bridges, in tunnels, on the ramps that lead there."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import shapely

from studio.road.network import Connection, Lane, Network, curve
from studio.road.network.outline import strip
from studio.road.ways.relief import Relief

SEAM = 1e-3  # [m] nearer to a cut a point of the lane is that of the cut
SAME = 1.5  # [m] of height between lanes that are one ground


def runs(off: np.ndarray) -> Iterator[tuple[int, int]]:
    """First and last place of every run of places that are `off`, with one on either side where there is one."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], off.astype(np.int8), [0]])))
    for a, b in edges.reshape(-1, 2).tolist():
        yield max(a - 1, 0), min(b, off.size - 1)


def off_land(network: Network, relief: Relief) -> Iterator[tuple[int, int, int]]:
    """Lane, first and last of its places in the relief, of every stretch off the land."""
    for lane in network.lanes:
        _, _, lift = relief.of_lane(lane.id)
        for a, b in runs(lift != 0.0) if lift.any() else ():
            yield lane.id, a, b


def on_land(network: Network, relief: Relief) -> Network:
    """The network of what lies on the land; a road with a bridge in it has become two."""
    stretches = {lane.id: list(land_of(lane, relief)) for lane in network.lanes}
    lanes: list[Lane] = []
    number: dict[tuple[int, int], int] = {}
    for lane in network.lanes:
        for k, (_, _, centre) in enumerate(stretches[lane.id]):
            number[lane.id, k] = len(lanes)
            road = lane.road if k == 0 else f"{lane.road}~{k}"
            lanes.append(replace(lane, id=len(lanes), road=road, centre=centre, length=curve.length(centre), height=np.zeros(0)))
    roads = {}
    for road in network.roads.values():
        for k in range(max((len(stretches[lane]) for lane in road.lanes), default=0)):
            own = tuple(number[lane, k] for lane in road.lanes if (lane, k) in number)
            name = road.id if k == 0 else f"{road.id}~{k}"
            roads[name] = replace(road, id=name, lanes=own)
    return replace(
        network, lanes=tuple(lanes), roads=roads, connections=tuple(joined(network, stretches, number)),
        junctions=tuple(each for each in network.junctions if lies_on_land(each, relief)),
    )  # fmt: skip


def land_of(lane: Lane, relief: Relief) -> Iterator[tuple[bool, bool, np.ndarray]]:
    """The stretches of a lane on the land: whether it begins and ends with its lane, and its centre line."""
    station, _, lift = relief.of_lane(lane.id)
    if not lift.any():
        yield True, True, lane.centre
        return
    cuts = [0, *(end for run in runs(lift != 0.0) for end in run), lift.size - 1]
    own = curve.stations(lane.centre)
    for a, b in zip(cuts[::2], cuts[1::2], strict=True):
        if b > a:
            inside = lane.centre[:, (own > station[a] + SEAM) & (own < station[b] - SEAM)]
            ends = curve.along(lane.centre, station[[a, b]])
            yield a == 0, b == lift.size - 1, np.column_stack([ends[:, :1], inside, ends[:, 1:]])


def joined(network: Network, stretches: dict, number: dict) -> Iterator[Connection]:
    """The connections between stretches that reach the ends of their lanes."""
    for each in network.connections:
        before, after = stretches[each.from_lane], stretches[each.to_lane]
        if before and after and before[-1][1] and after[0][0]:
            via = tuple(number[lane, 0] for lane in each.via if (lane, 0) in number)
            yield replace(each, from_lane=number[each.from_lane, len(before) - 1], to_lane=number[each.to_lane, 0], via=via)


def lies_on_land(junction: np.ndarray, relief: Relief) -> bool:
    """Whether most places of lanes on the ground of a junction are on the land."""
    x, y = relief.points[:2]
    near = np.flatnonzero((x >= junction[0].min()) & (x <= junction[0].max()) & (y >= junction[1].min()) & (y <= junction[1].max()))
    near = near[shapely.contains_xy(shapely.Polygon(junction.T).buffer(0.5), x[near], y[near])]
    return near.size == 0 or bool(np.median(np.abs(relief.lift[near])) < SAME)


@dataclass(frozen=True)
class Neighbours:
    """All lanes of a map, to be asked which lie where and how high."""

    network: Network
    relief: Relief

    @cached_property
    def strips(self) -> np.ndarray:
        """The ground of every lane."""
        return np.array([strip(lane.centre, lane.width) for lane in self.network.lanes], dtype=object)

    @cached_property
    def lines(self) -> np.ndarray:
        """The centre line of every lane."""
        return np.array([shapely.LineString(lane.centre.T) for lane in self.network.lanes])

    @cached_property
    def tree(self) -> shapely.STRtree:
        """Where they are."""
        return shapely.STRtree(self.strips)

    def near(self, places: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Which places float64[2, n] are within a reach [m] of which lanes, and the lift of the lane there [m]."""
        points = np.asarray(shapely.points(places.T))
        place, lane = self.tree.query(points, predicate="dwithin", distance=reach)
        s = shapely.line_locate_point(self.lines[lane], points[place])
        # all lanes one behind the other, so that one look-up serves them all
        begin = np.concatenate([[0.0], np.cumsum([of.length + 1.0 for of in self.lines])])[:-1]
        of_place = np.repeat(np.arange(self.lines.size), np.diff(self.relief.first))
        return place, lane, np.interp(begin[lane] + s, begin[of_place] + self.relief.station, self.relief.lift)
