"""Sensors: all of one kind are asked in one call, by a loop that is written for the kind.

What every sensor has (studio/kind/sensor.py) is done here, for all kinds. A sensor looks when its turn has come; a look may fail. What it
measures without a delay goes straight to `out`, from which applications and records take it. With a delay it goes into a ring, with the
time at which it is due, and the newest that is due goes to `out`. What a sensor gives may so be older than a tick: `measured` says of when.

mounted(kind, sensors, tick)   →  Mounted        the sensors of one kind of all worlds
"""

import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, inf, isfinite
from typing import Any, NamedTuple

import numpy as np

from studio.compiled import inlined
from studio.kind.loop import written
from studio.kind.number import numbers, row_of, shapes, spelled, tuple_of
from studio.kind.quantity import Quantity, first_values, quantities, width
from studio.kind.registry import Kind, stream
from studio.kind.sensor import LONGEST, Looking
from studio.model.random import first_normal, uniform
from studio.rows import Moving
from studio.world.table.unit import DUE, MEASURED, NEXT, NOISE, OUTPUT, SENSOR, TAKEN
from studio.world.view import LATE, LOST, MISSHAPEN, OF_THE_STUDIO, View

TEMPLATE = '''"""Asks all sensors of the kind {name}."""

from studio.compiled import lean
from studio.world.table.unit import FAILS, MEASURED, NEXT, NOISE, PRESENT
from studio.world.board.sensing import ROUNDING, comes, fails, forget, give, put, unfit
from studio.world.view import View, about, {eye}
from {module} import {imports}


@lean
def run({seen}, mounted_on, stream, settings, memory, health, first, ring, output, out, fault, k, time):
    view, faults, period, is_turn = View(k, time, {seen}), 0, -1.0, False
    settings, memory, ring, out = settings.T, memory.T, ring.T, out.T
    for i in range(mounted_on.size):
        fault[i] = 0
        if view.unit[PRESENT, mounted_on[i]] == 0.0 or health[FAILS, i] > 0.0:
            forget(i, first, output, health, out)
            continue
        if settings[{period}, i] != period:  # most sensors of a kind are alike
            period = settings[{period}, i]
            is_turn = comes(view, period)
        if is_turn:
            chosen = SettingsTuple({settings})
            me = about(view, mounted_on[i], i, stream[i], {width}, health[NOISE, i])
            if not fails(view, me, chosen.drop_out):
                place, column = out, i
                if first[i + 1] > first[i]:
                    place, column = ring, put(view, me, chosen, first, output, health)
                place[0, column] = 0.0
                {found} = measure(view, {eye}(me, column, chosen), chosen, {memory}, place)
                fault[i] = unfit(found, {capacity}, {width}, column, place)
                faults += fault[i] != 0
                place[0, column] = min(max(found, 0), {capacity})
                if first[i + 1] == first[i]:
                    health[MEASURED, i] = time
{store}        if health[NEXT, i] <= time + ROUNDING:
            give(i, {width}, time, first, ring, output, health, out)
    return faults
'''
WRONG = {
    1: "reported something that is no whole Reading: give every field of it",
    2: "returned a number of targets that is none: 0 to {capacity} is meant, as CAPACITY says",
    3: "reported a number that is not finite: look for a division by zero, or a root of something negative",
}
ROUNDING = 1e-9  # [s] by which times give way


# -- what the text calls -------------------------------------------------------------------------------


@inlined
def turn(time, period):
    """How many turns have come by a time [s]."""
    return int((time + ROUNDING) / period)


@inlined
def comes(view, period):
    """Whether the turn of a sensor has come at this tick."""
    return period <= view.tick or view.k == 0 or turn(view.time, period) != turn(view.time - view.tick, period)


@inlined
def fails(view, me, drop_out):
    """Whether this look fails."""
    return drop_out > 0.0 and uniform(view.seed[me.world], view.entity[me.unit], me.stream + LOST, view.k, OF_THE_STUDIO) < drop_out


@inlined
def put(view, me, settings, first, output, health):
    """The slot for what is measured now, with the time at which it is due."""
    delay, i = settings.delay, me.sensor
    if settings.delay_variation > 0.0:
        w = first_normal(view.seed[me.world], view.entity[me.unit], me.stream + LATE, view.k, OF_THE_STUDIO)
        delay = max(delay + settings.delay_variation * min(max(w, -LONGEST), LONGEST), 0.0)
    number = view.k if settings.period <= view.tick else turn(view.time, settings.period)
    slot = first[i] + number % (first[i + 1] - first[i])
    output[DUE, slot], output[TAKEN, slot] = view.time + delay, view.time
    health[NEXT, i] = min(health[NEXT, i], view.time + delay)
    return slot


@inlined
def give(i, width, time, first, ring, output, health, out):
    """Of what is due the newest is given; what is older than what was given before is not."""
    best, soonest = -1, inf
    for slot in range(first[i], first[i + 1]):
        if output[DUE, slot] <= time + ROUNDING:
            output[DUE, slot] = inf
            if output[TAKEN, slot] > health[MEASURED, i]:
                best, health[MEASURED, i] = slot, output[TAKEN, slot]
        soonest = min(soonest, output[DUE, slot])
    health[NEXT, i] = soonest
    if best >= 0:
        for row in range(1 + int(ring[0, best]) * width):
            out[row, i] = ring[row, best]


@inlined
def forget(i, first, output, health, out):
    """A sensor that is not there, or fails, gives nothing, and loses what is under way."""
    if out[0, i] > 0.0:
        out[:, i] = 0.0
    for slot in range(first[i], first[i + 1]):
        output[DUE, slot] = inf
    health[NEXT, i] = inf


@inlined
def unfit(found, capacity, width, column, out):
    """What is wrong with an answer in a column, as WRONG numbers it; 0 when nothing is."""
    if out[0, column] == MISSHAPEN:
        return 1
    if not 0 <= found <= capacity:
        return 2
    for row in range(1, 1 + found * width):
        if not isfinite(out[row, column]):
            return 3
    return 0


# -- the sensors of a kind -----------------------------------------------------------------------------


class Sensor(NamedTuple):
    """A sensor before it is a column: the number of its unit, its name on the unit, its settings."""

    unit: int
    name: str
    settings: Any


@dataclass
class Mounted:
    """All sensors of one kind. `out` holds how many targets each has, then target after target; [sensor, row].

    What sensor i has measured and not given yet stands in first[i] to first[i + 1] of `ring`, in the same order. What belongs to one sensor
    stands together, as a look reads and writes all of it; the loop turns these arrays, so that kinds see [row, sensor] as everywhere.
    """

    kind: Kind
    names: tuple[str, ...]
    unit: np.ndarray
    stream: np.ndarray
    settings: np.ndarray  # [sensor, row]
    memory: Moving  # [sensor, row]
    health: Moving  # [row, sensor]
    first: np.ndarray
    ring: Moving  # [slot, row]
    output: Moving  # [row, slot]
    out: Moving
    fault: np.ndarray  # scratch: what is wrong with the answer of each, as WRONG numbers it
    run: Callable

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """What the loop reads and writes besides what they see."""
        own = self.unit, self.stream, self.settings, self.memory, self.health
        return *own, self.first, self.ring, self.output, self.out, self.fault

    def raised(self) -> dict[int, str]:
        """What is said of one that raises, by the number of the sensor, with the traceback."""
        return dict.fromkeys(range(self.unit.size), f"cannot be asked:\n{traceback.format_exc()}")

    def wrong(self) -> dict[int, str]:
        """What is wrong with the answers of this look, by the number of the sensor."""
        return {i: WRONG[int(self.fault[i])].format(capacity=self.capacity) for i in np.flatnonzero(self.fault).tolist()}

    @property
    def reading(self) -> list[Quantity]:
        """What a target consists of."""
        return quantities(self.kind.module.Reading)

    @property
    def capacity(self) -> int:
        """How many targets one gives at most."""
        return capacity(self.kind)

    @property
    def slots(self) -> np.ndarray:
        """The sensor that each slot of the ring belongs to."""
        return np.repeat(np.arange(self.unit.size), np.diff(self.first))


def capacity(kind: Kind) -> int:
    """How many targets a sensor gives at most."""
    return getattr(kind.module, "CAPACITY", 1)


def depth(settings: Any, tick: float) -> int:
    """How many measurements of a sensor may be under way at once; 0 for one that gives them at once."""
    longest = settings.delay + LONGEST * settings.delay_variation
    return ceil(longest / max(settings.period, tick)) + 2 if longest > 0.0 else 0


def mounted(kind: Kind, sensors: Sequence[Sensor], tick: float) -> Mounted:
    """Sensors of one kind before the first tick."""
    module = kind.module
    remembered = first_values(module.Memory) if hasattr(module, "Memory") else []
    first = np.cumsum([0, *(depth(each.settings, tick) for each in sensors)])
    health, output = np.zeros((len(SENSOR), len(sensors))), np.zeros((len(OUTPUT), first[-1]))
    health[NOISE], health[MEASURED], health[NEXT], output[DUE] = 1.0, -1.0, inf, inf
    rows = 1 + capacity(kind) * width(module.Reading)
    return Mounted(
        kind=kind,
        names=tuple(each.name for each in sensors),
        unit=np.array([each.unit for each in sensors], dtype=np.int64),
        stream=np.array([stream(f"sensor.{kind.name}.{each.name}") for each in sensors], dtype=np.int64),
        settings=np.array([numbers(each.settings) for each in sensors]).reshape(len(sensors), -1),
        memory=np.tile(np.array(remembered, dtype=float), (len(sensors), 1)),
        health=health,
        first=first,
        ring=np.zeros((first[-1], rows)),
        output=output,
        out=np.zeros((len(sensors), rows)),
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
        eye="looking" if issubclass(module.Settings, Looking) else "placed",
        period=row_of(module.Settings, "period"),
        settings=spelled([each.size for each in shapes(module.Settings)], "settings", "i"),
        memory=f"Memory({spelled(remembers, 'memory', 'i')})" if remembers else "0",
        found="found, remembered" if remembers else "found",
        capacity=capacity(kind),
        width=width(module.Reading),
        store=stored(quantities(module.Memory), "i", " " * 16) if remembers else "",
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
