"""Oncoming lanes of all maps: by strand, what road/ways/oncoming.py tells of one map, and who goes over to them."""

from typing import NamedTuple

import numpy as np

OWN_FROM, OWN_TO, ITS_FROM, ITS_TO = range(4)  # rows of spans: from where to where on the own strand, and where on the other that is [m]


class Facing(NamedTuple):
    """Per strand, and which vehicles may pass on the lane of the others."""

    passes: np.ndarray  # int64[vehicle]: 1 of one that changes lanes where nothing asks for it
    watched: np.ndarray  # int64[vehicle]: 1 in a world in which somebody does
    lane: np.ndarray  # int64[strand]: the lane that comes towards it, -1 for none
    span: np.ndarray  # float64[4, strand]
    room: np.ndarray  # float64[strand]: from the own line to the far edge of that lane [m], left positive
    limit: np.ndarray  # float64[strand]: what is allowed there [m/s], 0 of ways
    length: np.ndarray  # float64[strand] [m]
    into_first: np.ndarray  # int64[strand + 1]: the first strand that leads to each
    into: np.ndarray  # int64[lead]
