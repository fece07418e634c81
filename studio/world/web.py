"""The web of strands that all worlds of a batch drive on: those of every map once, their meetings, and the strands of every line."""

from collections.abc import Sequence

import numpy as np

from studio.road.network import RIGHTS, Network
from studio.road.ways.conflict import ACROSS, NONE
from studio.road.ways.corner import sights_of
from studio.road.ways.gap import critical_gap
from studio.road.ways.meeting import Meetings, meetings_of
from studio.road.ways.ring import onto_rings
from studio.road.ways.strand import Drive, Strands, driven, strands_of
from studio.world.line import Lines, starts
from studio.world.setting import Setting
from studio.world.table.web import LANE, Web

ROOM_ON_RING = 4  # for as many there has to be room before one comes in: a ring that is full stands still for ever


def web_of(settings: Sequence[Setting], lines: Lines) -> tuple[Web, np.ndarray]:
    """The web, and how many drives every line has."""
    maps = {id(each.network): each.network for each in settings}
    networks, place = list(maps.values()), {name: i for i, name in enumerate(maps)}
    strands, met = [strands_of(each) for each in networks], [meetings_of(each) for each in networks]
    base = starts(np.array([each.count.size for each in strands]))
    drives, counts = drives_of(settings, lines, [int(base[place[id(each.network)]]) for each in settings])
    first = [each.first[:-1] + at for each, at in zip(met, starts(np.array([each.partner.size for each in met])), strict=True)]
    return Web(
        drive=np.array([each[1:] for each in drives], dtype=float).reshape(-1, 4).T.copy(),
        strand=np.array([each.strand for each in drives], dtype=np.int64),
        right=np.concatenate([rights(each) for each in networks]),
        critical=np.concatenate([gaps(each) for each in networks]),
        room=np.concatenate([rooms(*each) for each in zip(networks, strands, met, strict=True)]),
        first=np.append(np.concatenate(first), sum(each.partner.size for each in met)).astype(np.int64),
        partner=np.concatenate([each.partner + at for each, at in zip(met, base, strict=True)]),
        span=np.concatenate([each.span for each in met], axis=1),
        shape=np.concatenate([each.shape for each in met]),
        turn=np.concatenate([each.turn for each in met]),
        sight=np.concatenate([sights_of(each) for each in networks], axis=1),
        fast=np.concatenate([speeds(*each) for each in zip(networks, met, strict=True)]),
    ), counts


def drives_of(settings: Sequence[Setting], lines: Lines, base: list[int]) -> tuple[list[Drive], np.ndarray]:
    """The drives of all lines, and how many each has; those of a path that several lines have are looked for once."""
    known: dict[int, list[Drive]] = {}
    found, counts = [], []
    for world, path, _ in lines.laid:
        if id(path) not in known:
            known[id(path)] = driven(settings[world].network, path)
        found += [each._replace(strand=each.strand + base[world]) for each in known[id(path)]]
        counts.append(len(known[id(path)]))
    return found, np.array(counts, dtype=np.int64)


def rights(network: Network) -> np.ndarray:
    """The right of way of every strand."""
    ways = [RIGHTS.index(each.right_of_way) for each in network.connections]
    return np.array([LANE] * len(network.lanes) + ways, dtype=np.int64)


def gaps(network: Network) -> np.ndarray:
    """The critical gap of every strand [s], 0 of lanes."""
    return np.array([0.0] * len(network.lanes) + [critical_gap(each, network.drive_side) for each in network.connections])


def speeds(network: Network, met: Meetings) -> np.ndarray:
    """How fast one may come to each meeting on the partner [m/s]."""
    lanes = [lane.speed for lane in network.lanes]
    return np.array(lanes + [lanes[each.from_lane] for each in network.connections], dtype=float)[met.partner]


def rooms(network: Network, strands: Strands, met: Meetings) -> np.ndarray:
    """For how many there has to be room behind a way: for one where others cross it, so that nobody stops there; for some onto a ring."""
    found = np.zeros(strands.count.size, dtype=np.int64)
    own = np.repeat(np.arange(found.size), np.diff(met.first))
    found[own[(met.shape == ACROSS) & (met.turn != NONE)]] = 1
    found[: strands.lanes] = 0
    found[strands.lanes :][onto_rings(network)] = ROOM_ON_RING
    return found
