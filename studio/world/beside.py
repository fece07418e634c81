"""Beside: the lines along lanes beside the usual ones, and the gates from each to those next to it.

beside_of(settings, lines, detours)   →  Beside
"""

from collections.abc import Iterator, Sequence
from itertools import permutations

import numpy as np

from studio.road.ways.aside import Side
from studio.world.line import Block, Lines, starts, works_of
from studio.world.setting import Setting
from studio.world.table.lane import GATE, Beside
from studio.world.world import Detours

LEAST = 5.0  # [m] a shorter gate is none


def beside_of(settings: Sequence[Setting], lines: Lines, detours: Detours) -> Beside:
    """That of all vehicles."""
    place = {v: j for j, v in enumerate(detours.vehicle)}
    gates: list[list[tuple[float, ...]]] = [[] for _ in lines.blocks]
    for home in {each.start: each for each in lines.home}.values():
        for one, other in permutations(home, 2):
            gates[one] += gates_of(lines.blocks[one], lines.blocks[other], other)
    counts = np.array([len(each) for each in gates], dtype=np.int64)
    return Beside(
        home=np.array([each.start if len(each) > 1 else -1 for each in lines.home], dtype=np.int64),
        aside=np.array([step(each) for each in lines.blocks], dtype=np.int64),
        line=np.array([each.line for each in lines.blocks], dtype=np.int64),
        work=works_of(settings, lines),
        span=detours.span,
        first=starts(counts),
        count=counts,
        gate=np.array([gate for each in gates for gate in each], dtype=float).reshape(-1, len(GATE)).T.copy(),
        detour=np.array([place.get(v, -1) for v in range(len(lines.home))], dtype=np.int64),
        lines=detours.lines,
    )


def step(block: Block) -> int:
    """How many lanes a block is beside the usual ones."""
    return block.side.step if block.side else 0


def gates_of(here: Block, there: Block, number: int) -> Iterator[tuple[float, ...]]:
    """The gates from a block to one that is on the next lane, as rows of the table."""
    if here.side and not there.side:
        yield from returns(here.side, number)
    if abs(step(here) - step(there)) != 1:
        return
    free = np.logical_and(free_of(here.side, there.side), free_of(there.side, here.side))
    for run in np.split(np.flatnonzero(free), np.flatnonzero(np.diff(np.flatnonzero(free)) > 1) + 1):
        if run.size > LEAST:
            ends = float(run[0]), float(run[-1])
            own, other = (tuple(station(each.side, s) for s in ends) for each in (here, there))
            yield (number, step(there) - step(here), *own, *other, back(here.side, ends[0]), back(there.side, ends[0]))


def returns(side: Side, number: int) -> Iterator[tuple[float, ...]]:
    """Where a line has come back to the usual lanes, which one is on then."""
    begins = [*(first for first, _, _ in side.spans[1:]), float(side.at.size)]
    for (_, last, back_from), begin in zip(side.spans, begins, strict=True):
        if np.isfinite(back_from) and begin - last > 1.0:
            ends = last, begin - 1.0
            yield (number, 0.0, *(station(side, s) for s in ends), *ends, np.inf, np.inf)


def free_of(side: Side | None, other: Side | None) -> np.ndarray:
    """At which points of the usual path one may be on a side when one changes; on the usual lanes anywhere."""
    return side.free if side else np.ones(other.free.size if other else 0, dtype=bool)


def station(side: Side | None, s: float) -> float:
    """A station [m] of the usual path on a side."""
    return s if side is None else float(np.interp(s, np.arange(side.at.size), side.at))


def back(side: Side | None, s: float) -> float:
    """From where [m] on a side one goes back, behind a station of the usual path; infinite where one does not."""
    found = [end for first, last, end in side.spans if first <= s <= last] if side else []
    return station(side, found[0]) if found and np.isfinite(found[0]) else np.inf
