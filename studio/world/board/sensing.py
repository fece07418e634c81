"""Sensors: all of one kind are asked in one call, by a loop that is written for the kind.

mounted(kind, sensors)   →  Mounted        the sensors of one kind of all worlds
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from studio.kind.loop import written
from studio.kind.number import numbers, shapes, spelled, tuple_of
from studio.kind.quantity import Quantity, first_values, quantities, width
from studio.kind.registry import Kind, stream
from studio.rows import Moving
from studio.world.view import View

TEMPLATE = '''"""Asks all sensors of the kind {name}."""

from studio.compiled import lean
from studio.world.table.unit import PRESENT
from studio.world.view import View, about
from {module} import {imports}


@lean
def run(k, time, {seen}, mounted_on, stream, settings, memory, out):
    view = View(k, time, {seen})
    for i in range(mounted_on.size):
        if out[0, i] > 0.0:
            out[:, i] = 0.0
        if view.unit[PRESENT, mounted_on[i]] > 0.0:
            me = about(view, mounted_on[i], i, stream[i])
            {found} = measure(view, me, SettingsTuple({settings}), {memory}, out)
            out[0, i] = min(max(found, 0), {capacity})
{store}'''


class Sensor(NamedTuple):
    """A sensor before it is a column: the number of its unit, its name on the unit, its settings."""

    unit: int
    name: str
    settings: Any


@dataclass
class Mounted:
    """All sensors of one kind. `out` holds how many targets each has, then target after target; [row, sensor]."""

    kind: Kind
    names: tuple[str, ...]
    unit: np.ndarray
    stream: np.ndarray
    settings: np.ndarray
    memory: Moving
    out: Moving
    run: Callable

    @property
    def reading(self) -> list[Quantity]:
        """What a target consists of."""
        return quantities(self.kind.module.Reading)

    @property
    def capacity(self) -> int:
        """How many targets one gives at most."""
        return capacity(self.kind)


def capacity(kind: Kind) -> int:
    """How many targets a sensor gives at most."""
    return getattr(kind.module, "CAPACITY", 1)


def mounted(kind: Kind, sensors: Sequence[Sensor]) -> Mounted:
    """Sensors of one kind before the first tick."""
    module = kind.module
    remembered = first_values(module.Memory) if hasattr(module, "Memory") else []
    return Mounted(
        kind=kind,
        names=tuple(each.name for each in sensors),
        unit=np.array([each.unit for each in sensors], dtype=np.int64),
        stream=np.array([stream(f"sensor.{kind.name}.{each.name}") for each in sensors], dtype=np.int64),
        settings=np.array([numbers(each.settings) for each in sensors]).reshape(len(sensors), -1).T.copy(),
        memory=np.tile(np.array(remembered, dtype=float)[:, None], len(sensors)),
        out=np.zeros((1 + capacity(kind) * width(module.Reading), len(sensors))),
        run=loop(kind),
    )


def loop(kind: Kind) -> Callable:
    """The loop over all sensors of a kind."""
    module = kind.module
    tuple_of(module, module.Settings)
    remembers = [each.size for each in quantities(module.Memory)] if hasattr(module, "Memory") else []
    source = TEMPLATE.format(
        name=kind.name,
        seen=", ".join(View._fields[2:]),
        module=module.__name__,
        imports="Memory, SettingsTuple, measure" if remembers else "SettingsTuple, measure",
        settings=spelled([each.size for each in shapes(module.Settings)], "settings", "i"),
        memory=f"Memory({spelled(remembers, 'memory', 'i')})" if remembers else "0",
        found="found, remembered" if remembers else "found",
        capacity=capacity(kind),
        store=stored(quantities(module.Memory), "i", " " * 12) if remembers else "",
    )
    return written(f"sensor_{kind.name}", source, kind).run


def stored(fields: Sequence[Quantity], column: str, indent: str) -> str:
    """Lines that put what was remembered into the rows of `memory`."""
    lines, row = [], 0
    for each in fields:
        parts = [f"[{i}]" for i in range(each.size)] if each.size > 1 else [""]
        lines += [f"{indent}memory[{row + i}, {column}] = remembered.{each.name}{part}\n" for i, part in enumerate(parts)]
        row += each.size
    return "".join(lines)
