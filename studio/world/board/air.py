"""The air: how busy the channel is where every unit is, what congestion control makes of it, and what waits for a network of cells.

One Air per kind of radio; all kinds of messages share it. A message keeps the channel busy for its time on the air wherever it can be
heard, and where it is sent. Every tenth of a second this is added up to a load, as ETSI TS 102 687 measures it; congestion control
looks at it then, and says how long a unit waits between two messages that it sends by itself.

Times on the air are counted in whole nanoseconds, so that the sum does not depend on the order in which messages are looked at.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import floor
from types import ModuleType
from typing import Any

import numpy as np

from studio.compiled import inlined, lean
from studio.kind.loop import written
from studio.kind.number import numbers, shapes, spelled, tuple_of
from studio.kind.quantity import first_values, quantities
from studio.kind.registry import Kind
from studio.rows import Moving
from studio.world.board.sensing import stored
from studio.world.table.unit import PRESENT, TRUE_X, TRUE_Y

WINDOW = 0.1  # [s] over which the load is measured
EARLY = 1e-9  # [s] what is due at a whole number of ticks must not come a tick late by rounding
NANOSECOND = 1e-9

TEXT = '''"""Congestion control of the radio {radio}."""

from studio.compiled import lean
from {module} import Control, SettingsTuple, control


@lean
def assess(settings, world_of, load, memory, gap):
    for u in range(load.size):
        j = world_of[u]
        gap[u], remembered = control(SettingsTuple({settings}), load[u], Control({memory}))
{store}'''


@dataclass
class Air:
    """What all posts on one kind of radio share. Settings and cells are [row, world], control is [row, unit]."""

    radio: Kind
    worlds: tuple[int, ...]  # that have this kind of radio
    settings: np.ndarray
    reach: np.ndarray  # [m] per world, beyond it nothing is heard
    within: np.ndarray  # [m] per world, beyond it the channel is not busy
    minds_walls: np.ndarray  # bool per world, whether walls between two antennas count
    table: np.ndarray  # [world, entry], what the radio has worked out of the settings
    felt: np.ndarray  # float64[unit], what the radio knows of the place of every unit, when something has been sent
    around: np.ndarray  # [row, unit], what it keeps for that; nothing hangs on it
    busy: Moving  # [ns] int64[unit]: for how long the channel has been busy in the window that has begun
    load: Moving  # [1] float64[unit]: share of the window before
    since: Moving  # [s] float64[1]: when the window has begun
    gap: Moving  # [s] float64[unit]: least time between two messages that a unit sends by itself
    control: Moving
    cell: Moving
    assess: Callable | None  # congestion control, where the radio has one

    @cached_property
    def is_loaded(self) -> bool:
        """Whether messages keep its channel busy."""
        return hasattr(self.radio.module, "airtime")

    @property
    def state(self) -> list[np.ndarray]:
        """What it goes on from: of every unit, and last of every cell; of the channel only where messages keep it busy."""
        return [*([self.busy, self.load, self.gap] if self.is_loaded else []), self.control, self.cell]


def air(radio: Kind, worlds: Sequence[int], settings: Sequence[Any], units: int) -> Air:
    """A channel that nobody has used, for the settings of all worlds; some of these have this kind of radio."""
    module = radio.module
    tuple_of(module, module.Settings)
    reach = [float(module.reach(each)) for each in settings]
    within = [float(module.heard_within(each)) for each in settings] if hasattr(module, "heard_within") else reach
    walls = [bool(module.minds_walls(each)) for each in settings] if hasattr(module, "minds_walls") else [True] * len(settings)
    return Air(
        radio=radio,
        worlds=tuple(worlds),
        settings=np.array([numbers(each) for each in settings]).T.copy(),
        reach=np.array(reach),
        within=np.array(within),
        minds_walls=np.array(walls),
        table=np.array([module.table(each) if hasattr(module, "table") else () for each in settings], dtype=float).reshape(
            len(settings), -1
        ),
        felt=np.zeros(units),
        around=remembered(module, "Around", units),
        busy=np.zeros(units, dtype=np.int64),
        load=np.zeros(units),
        since=np.zeros(1),
        gap=np.zeros(units),
        control=remembered(module, "Control", units),
        cell=remembered(module, "Cell", len(settings)),
        assess=control(radio) if hasattr(module, "control") else None,
    )


def remembered(module: ModuleType, name: str, columns: int) -> np.ndarray:
    """What some part of a kind remembers before anything has happened, [row, column]; no rows where it remembers nothing."""
    values = first_values(getattr(module, name)) if hasattr(module, name) else []
    return np.tile(np.array(values, dtype=float).reshape(-1, 1), columns)


def control(radio: Kind) -> Callable:
    """The loop over all units that are under congestion control."""
    module = radio.module
    fields = quantities(module.Control)
    source = TEXT.format(
        radio=radio.name,
        module=module.__name__,
        settings=spelled([each.size for each in shapes(module.Settings)], "settings"),
        memory=spelled([each.size for each in fields], "memory", "u"),
        store=stored(fields, "u", " " * 8),
    )
    return written(f"control_{radio.name}", source, radio).assess


@lean
def turned(since, busy, load, time):
    """Whether a window is over at a time [s]; then what has been counted becomes the load, and the next one begins."""
    if floor((time + EARLY) / WINDOW) <= floor((since[0] + EARLY) / WINDOW):
        return False
    span = time - since[0]
    for u in range(load.size):
        load[u] = min(busy[u] * NANOSECOND / span, 1.0)
        busy[u] = 0
    since[0] = time
    return True


@inlined
def occupy(world, x, y, within, airtime, world_of, unit_first, now, busy):
    """A message keeps the channel busy for its time on the air [s] at all units of a world that are near enough."""
    spent = round(airtime / NANOSECOND)
    u = unit_first[world]
    while u < world_of.size and world_of[u] == world:
        dx, dy = now[TRUE_X, u] - x, now[TRUE_Y, u] - y
        busy[u] += spent * (now[PRESENT, u] > 0.0 and dx * dx + dy * dy <= within * within)
        u += 1
