"""Decks: bridges and tunnels of a document. They say on which level a road lies there, and where it has no height anywhere, how high.

Then a deck that others cross on another level lies a storey above the ground, or below it, and the lanes that go on from it come back with
the slope of `storey.py`; who is crossed stays where he is.
"""

from dataclasses import replace

import numpy as np
import shapely

from studio.road.assembly.storey import RAMP, STOREY
from studio.road.network import Lane, Net, curve
from studio.road.network.report import Notes
from studio.road.ways.relief import Spots, levels, links, nearest, reached, stationed, value


def with_heights(net: Net, spot, notes: Notes) -> Net:
    """The network with heights for its decks; as it is where it has heights, or no deck that others cross."""
    if not any(lane.level.any() for lane in net.lanes) or any(lane.height.any() for lane in net.lanes):
        return net
    over, under = crossed(net.lanes)
    if not over:
        return net
    for road in dict.fromkeys(net.lanes[lane].road for lane, _ in over):
        what = f"road {road}: {STOREY:g} m a level above or below the ground, ramps of {RAMP:.0%}"
        notes.guess("storey", what, spot(road), source="a bridge or tunnel where others cross", sure="low")
    lift = risen(net, over, {lane for lane, _ in under})
    return replace(net, lanes=tuple(replace(lane, height=z, lift=z) if z.any() else lane for lane, z in zip(net.lanes, lift, strict=True)))


def crossed(lanes: tuple[Lane, ...]) -> tuple[Spots, Spots]:
    """Where lanes cross on different levels: those on a level off the ground, and those on the ground."""
    lines = np.array([shapely.LineString(lane.centre.T) for lane in lanes])
    off = [lane.id for lane in lanes if lane.level.any()]
    over, under = [], []
    for i, j in shapely.STRtree(lines).query(lines[off], predicate="intersects").T.tolist():
        one, other = lanes[off[i]], lanes[j]
        for point in shapely.get_parts(shapely.intersection(lines[off[i]], lines[j]).representative_point()):
            s = [shapely.line_locate_point(lines[each.id], point) for each in (one, other)]
            level = [round(value(levels(each), each, at)) for each, at in zip((one, other), s, strict=True)]
            if level[0] and level[0] != level[1]:
                over.append((one.id, s[0]))
                under += [] if level[1] else [(other.id, s[1])]
    return over, under


def risen(net: Net, over: Spots, under: set[int]) -> list[np.ndarray]:
    """How high every lane lies above the ground at its points [m]; `under` are lanes that stay on it."""
    stations, first = stationed(net.lanes)
    points = np.concatenate([curve.along(lane.centre, stations[a:b]) for lane, a, b in zip(net.lanes, first[:-1], first[1:], strict=True)],
                            axis=1)  # fmt: skip
    level = np.concatenate([np.interp(stations[a:b], curve.stations(lane.centre), levels(lane))
                            for lane, a, b in zip(net.lanes, first[:-1], first[1:], strict=True)]).round()  # fmt: skip
    far, height = links(net, first, points, level), np.zeros(stations.size)
    stays = np.isin(np.repeat(np.arange(len(net.lanes)), np.diff(first)), [lane for lane in under if not net.lanes[lane].level.any()])
    for each in {value_at for value_at in level[[nearest(stations, first, *spot) for spot in over]].tolist() if value_at}:
        seed = np.array([k for k in (nearest(stations, first, *spot) for spot in over) if level[k] == each])
        left = reached(far, seed, np.full(seed.size, STOREY * abs(each) / RAMP), stations.size)
        own = np.where(stays, 0.0, np.sign(each) * RAMP * np.maximum(left, 0.0))
        height = np.where(np.abs(own) > np.abs(height), own, height)
    return [np.interp(curve.stations(lane.centre), stations[a:b], height[a:b]) for lane, a, b in
            zip(net.lanes, first[:-1], first[1:], strict=True)]  # fmt: skip
