"""What was counted of everybody in a run, traffic included, with names."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from studio.world.passes.census import C_KIND, C_OTHER, C_TIME, C_VALUE, C_WHO, C_WORLD, COUNTED, nothing
from studio.world.world import World


class Counted(NamedTuple):
    """One thing: when [s], what of COUNTED, who, the other one or "", and a number whose unit the kind gives."""

    time: float
    kind: str
    who: str
    other: str
    value: float


def counted(rows: Sequence[np.ndarray], world: World, number: int, until: float) -> tuple[Counted, ...]:
    """What was counted in one world until a time [s], in the order of time and names."""
    table = np.concatenate([nothing(), *rows], axis=1)
    own = table[:, (table[C_WORLD] == number) & (table[C_TIME] <= until)]
    columns = own[[C_TIME, C_KIND, C_WHO, C_OTHER, C_VALUE]].T.tolist()
    return tuple(sorted(named(world.names[number], *each) for each in columns))


def named(names: Sequence[str], time: float, kind: float, who: float, other: float, value: float) -> Counted:
    """One row with names."""
    return Counted(time, COUNTED[int(kind)], names[int(who)], names[int(other)] if other >= 0 else "", value)
