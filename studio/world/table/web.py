"""The web of strands: what all worlds of a batch drive on."""

from typing import NamedTuple

import numpy as np

from studio.road.network import RIGHTS

LANE = -1  # right of way of a strand that is no way through a junction
SIGNAL, STOP, ALL_WAY_STOP, ZIPPER = (RIGHTS.index(name) for name in ("signal", "stop", "all_way_stop", "zipper"))
ENTER, LEAVE, START, END = range(4)  # rows of drives: on the line, on the strand [m]
OWN_ENTER, OWN_LEAVE, ITS_ENTER, ITS_LEAVE = range(4)  # rows of spans: on the strand, on its partner [m]


class Web(NamedTuple):
    """Strands of all maps, map after map, and drives of all lines, line after line."""

    drive: np.ndarray  # float64[4, drive]
    strand: np.ndarray  # int64[drive]
    right: np.ndarray  # int64[strand]: number of its right of way among RIGHTS, or LANE
    critical: np.ndarray  # float64[strand] [s]
    room: np.ndarray  # int64[strand]: for how many there has to be room behind a way before one enters it
    first: np.ndarray  # int64[strand + 1]: its first meeting
    partner: np.ndarray  # int64[meeting]: strands
    span: np.ndarray  # float64[4, meeting]
    shape: np.ndarray
    turn: np.ndarray
    sight: np.ndarray  # float64[place, meeting] [m]: how far one sees along the partner, from places before where they meet
    fast: np.ndarray  # float64[meeting] [m/s]: as fast one may drive who comes there on the partner
