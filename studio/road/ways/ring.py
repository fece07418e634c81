"""Rings: roads of one name that lead around to themselves, as a roundabout does, whether it is mapped as one or not.

Whoever drives on a ring can leave it only while it moves, and it moves only while it is not full. So it must not be filled up from outside:
who comes in leaves room for others, who is in needs room for himself alone. With that a gap stays in every ring, and it goes round against
the traffic. (Bubble flow control: C. Carrión et al., A flow control mechanism to avoid message deadlock in k-ary n-cube networks,
HiPC 1997; a street is entered as the ring of a network is.)
"""

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from studio.road.network import Network
from studio.road.network.index import once

LONGEST = 1500.0  # [m] all roads of one; what is longer is no place where drivers see each other


@once
def onto_rings(network: Network) -> np.ndarray:
    """bool[connection]: which lead from outside onto a ring."""
    ring = rings(network)
    ends = [(network.lanes[each.from_lane].road, network.lanes[each.to_lane].road) for each in network.connections]
    return np.array([ring.get(end, -1) >= 0 and ring.get(start, -1) != ring[end] for start, end in ends], dtype=bool)


def rings(network: Network) -> dict[str, int]:
    """The number of the ring that a road belongs to; only roads that belong to one."""
    roads = [each for each in network.roads.values() if not each.internal]
    number = {each.id: i for i, each in enumerate(roads)}
    ends = [
        (network.lanes[each.from_lane].road, network.lanes[each.to_lane].road) for each in network.connections if each.direction != "turn"
    ]
    alike = [(number[a], number[b]) for a, b in ends if network.roads[a].name == network.roads[b].name and a != b]
    from_road, to_road = np.array(alike, dtype=np.int64).reshape(-1, 2).T
    graph = sparse.coo_array((np.ones(from_road.size), (from_road, to_road)), (len(roads), len(roads)))
    _, part = csgraph.connected_components(graph, connection="strong")
    length, count = np.bincount(part, [each.length for each in roads]), np.bincount(part)
    return {each.id: int(p) for each, p in zip(roads, part, strict=True) if count[p] > 1 and length[p] <= LONGEST}
