"""Levels: which ways pass above others. Where no height is known they alone say that two who cross do not meet.

A way's level is its `layer`; a bridge without one is a level up, a tunnel a level down.
"""

from dataclasses import replace

import numpy as np

from studio.road.assembly.elevation import Grid, height_along
from studio.road.formats.way import Way
from studio.road.network import Net

MOST = 5  # levels above and below the ground, as the wiki has it


def level_of(tags: dict[str, str]) -> int:
    """The level of a way by its tags.

    >>> level_of({"bridge": "yes"}), level_of({"tunnel": "yes", "layer": "-2"}), level_of({"layer": "up"}), level_of({"bridge": "no"})
    (1, -2, 0, 0)
    """
    text = tags.get("layer", "").strip()
    if text.removeprefix("-").removeprefix("+").isdecimal() and len(text) < 4:
        return max(-MOST, min(MOST, int(text)))
    return int(tags.get("bridge", "no") != "no") - int(tags.get("tunnel", "no") != "no")


def with_levels(net: Net, ways: list[Way], grid: Grid) -> Net:
    """The network whose lanes have the levels of the ways that they are made of; a map that is all on the ground as it is."""
    level = {way.id: level_of(way.tags) for way in ways}
    if not any(level.values()):
        return net
    places = {way.id: np.array([grid.places[node] for node in way.nodes]).T for way in ways}
    lanes = list(net.lanes)
    for lane in net.lanes:
        own = [name for name in net.origins.get(lane.road, ()) if name in level]
        if not lane.internal and any(level[name] for name in own):
            lines = [(places[name], np.full(places[name].shape[1], float(level[name]))) for name in own]
            lanes[lane.id] = replace(lane, level=height_along(lane.centre, lines))
    return replace(net, lanes=tuple(lanes))
