"""Lanes beside the usual ones: which lines lead along them, and where one may go over."""

from typing import NamedTuple

import numpy as np

from studio.rows import Role, Table

GATE = Table("gate", Role.PARAMETER, per="stretch on which one may change lanes")
TO = GATE.row("to", "1", "number of the block of lines over there")
STEP = GATE.row("step", "1", "1 towards the middle of the road, -1 towards the kerb, 0 where the line has come back to the usual lanes")
HERE_FROM = GATE.row("here_from", "m", "where it begins on the own line")
HERE_TO = GATE.row("here_to", "m", "where it ends there")
THERE_FROM = GATE.row("there_from", "m", "where it begins on the other line")
THERE_TO = GATE.row("there_to", "m", "where it ends there")
HERE_BACK = GATE.row("here_back", "m", "from where the own line goes back to the usual lane, infinite where it need not")
THERE_BACK = GATE.row("there_back", "m", "the same of the other line")


class Beside(NamedTuple):
    """Blocks of lines: those along the usual lanes of a vehicle, one for every choice among works, and those along lanes beside."""

    home: np.ndarray  # int64[vehicle]: the block along the usual lanes, -1 for one that keeps to them
    aside: np.ndarray  # int64[block]: how many lanes beside the usual ones
    line: np.ndarray  # int64[block]: its first line
    work: np.ndarray  # int64[MOST_WORKS, block]: entries of the script that its works belong to, -1 for none
    span: np.ndarray  # float64[2 · MOST_WORKS, line]: where a line enters and leaves these
    first: np.ndarray  # int64[block]: its first gate
    count: np.ndarray  # int64[block]
    gate: np.ndarray  # float64[GATE, gate]
    detour: np.ndarray  # int64[vehicle]: its place among those that pass works, -1 for none
    lines: np.ndarray  # int64[LINE, line]
