"""Sensors: all of one kind are asked in one call, by a loop that is written for the kind.

mounted(kind, sensors)   →  Mounted        the sensors of one kind of all worlds
"""

import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from studio.compiled import bound, inlined
from studio.kind.loop import written
from studio.kind.number import numbers, shapes, spelled, tuple_of
from studio.kind.quantity import Quantity, first_values, quantities, width
from studio.kind.registry import Kind, stream
from studio.rows import Moving
from studio.world.view import MISSHAPEN, View

TEMPLATE = '''"""Asks all sensors of the kind {name}."""

from studio.compiled import lean
from studio.world.table.unit import PRESENT
from studio.world.board.sensing import unfit
from studio.world.view import View, about
from {module} import {imports}


@lean
def run({seen}, mounted_on, stream, settings, memory, out, fault, k, time):
    view, faults = View(k, time, {seen}), 0
    for i in range(mounted_on.size):
        fault[i] = 0
        if out[0, i] > 0.0:
            out[:, i] = 0.0
        if view.unit[PRESENT, mounted_on[i]] > 0.0:
            out[0, i] = 0.0
            me = about(view, mounted_on[i], i, stream[i], {width})
            {found} = measure(view, me, SettingsTuple({settings}), {memory}, out)
            fault[i] = unfit(found, {capacity}, {width}, i, out)
            faults += fault[i] != 0
            out[0, i] = min(max(found, 0), {capacity})
{store}    return faults
'''
WRONG = {
    1: "reported something that is no whole Reading: give every field of it",
    2: "returned a number of targets that is none: 0 to {capacity} is meant, as CAPACITY says",
    3: "reported a number that is not finite: look for a division by zero, or a root of something negative",
}


@inlined
def unfit(found, capacity, width, i, out):
    """What is wrong with an answer of sensor i, as WRONG numbers it; 0 when nothing is."""
    if out[0, i] == MISSHAPEN:
        return 1
    if not 0 <= found <= capacity:
        return 2
    for row in range(1, 1 + found * width):
        if not isfinite(out[row, i]):
            return 3
    return 0


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
    fault: np.ndarray  # scratch: what is wrong with the answer of each, as WRONG numbers it
    run: Callable
    ready: dict[str, Callable] = field(default_factory=dict)  # "run" with all arrays given, once it has been called

    def ask(self, k: int, time: float, view: tuple) -> dict[int, str]:
        """All of them measure; says what went wrong, by the number of the sensor."""
        try:
            if not self.ready:
                own = (self.unit, self.stream, self.settings, self.memory, self.out, self.fault)
                self.ready["run"] = bound(self.run, *view, *own, then=(k, time))
            faults = self.ready["run"](k, time)
        except (Exception, SystemExit):
            return dict.fromkeys(range(self.unit.size), f"cannot be asked:\n{traceback.format_exc()}")
        wrong = np.flatnonzero(self.fault).tolist() if faults else []
        return {i: WRONG[int(self.fault[i])].format(capacity=self.capacity) for i in wrong}

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
        fault=np.zeros(len(sensors), dtype=np.int64),
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
        width=width(module.Reading),
        store=stored(quantities(module.Memory), "i", " " * 12) if remembers else "",
    )
    return written(f"sensor_{kind.name}", source, kind).run


def stored(fields: Sequence[Quantity], column: str, indent: str, array: str = "memory") -> str:
    """Lines that put what was remembered into the rows of an array."""
    lines, row = [], 0
    for each in fields:
        parts = [f"[{i}]" for i in range(each.size)] if each.size > 1 else [""]
        lines += [f"{indent}{array}[{row + i}, {column}] = remembered.{each.name}{part}\n" for i, part in enumerate(parts)]
        row += each.size
    return "".join(lines)
