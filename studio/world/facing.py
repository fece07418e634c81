"""Facing: the lanes that come towards one, of all maps of a batch, and who passes on them.

facing_of(settings)   →  Facing
"""

from collections.abc import Sequence

import numpy as np

from studio.road.network import Network
from studio.road.ways.oncoming import oncoming_of
from studio.world.line import starts
from studio.world.setting import Setting
from studio.world.table.oncoming import Facing


def facing_of(settings: Sequence[Setting]) -> Facing:
    """That of all maps, in the order in which `web_of` has them; without any lanes where nobody changes lanes."""
    passes = np.array([int(car.changes_lanes) for each in settings for car in each.cars], dtype=np.int64)
    maps = list({id(each.network): each.network for each in settings}.values()) if passes.any() else []
    found = [oncoming_of(each) for each in maps]
    base = starts(np.array([each.lane.size for each in found], dtype=np.int64)) if found else []
    counts = np.concatenate([np.zeros(1, dtype=np.int64), *(np.diff(each.into_first) for each in found)])
    watched = [int(any(car.changes_lanes for car in each.cars)) for each in settings for _ in each.cars]
    return Facing(
        passes=passes,
        watched=np.array(watched, dtype=np.int64),
        lane=np.concatenate([np.zeros(0, dtype=np.int64), *(shifted(each.lane, at) for each, at in zip(found, base, strict=True))]),
        span=np.concatenate([np.zeros((4, 0)), *(each.span for each in found)], axis=1),
        room=np.concatenate([np.zeros(0), *(each.room for each in found)]),
        limit=np.concatenate([np.zeros(0), *(limits(each) for each in maps)]),
        length=np.concatenate([np.zeros(0), *(each.length for each in found)]),
        into_first=np.cumsum(counts),
        into=np.concatenate([np.zeros(0, dtype=np.int64), *(each.into + at for each, at in zip(found, base, strict=True))]),
    )


def shifted(lanes: np.ndarray, by: int) -> np.ndarray:
    """Numbers of lanes in the batch; -1 stays none."""
    return np.where(lanes >= 0, lanes + by, -1)


def limits(network: Network) -> np.ndarray:
    """What is allowed on each strand [m/s], 0 on ways."""
    return np.array([lane.speed for lane in network.lanes] + [0.0] * len(network.connections))
