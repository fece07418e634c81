"""Sensors: mounted on a car among others they give finite readings, compiled and as Python the same."""

from collections.abc import Iterator
from types import ModuleType
from typing import Any

import numpy as np

from studio.execution.simulation import Simulation
from studio.kind.preset import FIELD
from studio.kind.quantity import quantities
from studio.kind.registry import Kind
from studio.kind.sensor import Looking
from studio.workshop import draw, twice
from studio.workshop.check import Check, tried
from studio.workshop.stage import stage
from studio.world.board.sensing import Mounted
from studio.world.tick import gather
from studio.world.view import MISSHAPEN, View, about, looking, placed

SENSORS = 6  # on the car, with drawn settings each, the first with those that count when nothing is set
LOOKS, APART = 8, 25  # how often is looked, and how many ticks lie between


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, in a small world."""
    seed = np.random.default_rng(1)
    model = kind.module.Settings
    chosen = [model(), *(draw.settings(model, seed) for _ in range(SENSORS - 1))]
    given = {f"s{i}": {"kind": kind.name} | each.model_dump(mode="json") for i, each in enumerate(chosen)}
    current = stage(vehicles={"own": {"sensors": given}})
    found: dict[str, str | None] = {}
    yield tried("works on a car among others", lambda: looks(current, found))
    for what, wrong in found.items():
        yield Check(what, wrong or "")


def looks(current: Simulation, found: dict[str, str | None]) -> None:
    """Looks now and then during a run, and keeps the first thing that is wrong of each sort."""
    compared, counted, numbered = "measure() gives the same compiled and as Python", "no more targets than CAPACITY", "finite readings"
    found |= {compared: None, counted: None, numbered: None}
    for _ in range(LOOKS):
        current.advance(APART)
        gather(current.world)
        (each,) = current.world.units.mounted
        for i in range(each.unit.size):
            compiled, plain = (asked(current, each, i, way) for way in (each.kind.module.measure, each.kind.module.measure.py_func))
            found[compared] = found[compared] or differs(compiled, plain)
            found[counted] = found[counted] or beyond(compiled[0], each.capacity)
            found[numbered] = found[numbered] or missing(compiled[1], compiled[0], each)


def asked(current: Simulation, each: Mounted, i: int, measure) -> tuple[int, np.ndarray]:
    """What one sensor answers now: how many targets, and its column."""
    module = each.kind.module
    out = np.zeros_like(each.out).T
    seen = View(current.world.clock.k, current.world.clock.time, *current.world.view)
    chosen = current.cases[0].setting.scenario.vehicles["own"].sensors[each.names[i]].model_dump(exclude={"kind", FIELD})
    settings = draw.settings_tuple(module, module.Settings.model_validate(chosen))
    who = about(seen, each.unit[i], i, each.stream[i], sum(one.size for one in each.reading), 1.0)
    me = (looking if issubclass(module.Settings, Looking) else placed)(who, i, settings)
    memory = remembered(module, each.memory[i]) if hasattr(module, "Memory") else 0
    answer = measure(seen, me, settings, memory, out)
    if out[0, i] == MISSHAPEN:
        raise ValueError(f"report() was given something that is no whole Reading: {', '.join(one.name for one in each.reading)} are meant")
    return int(answer[0] if isinstance(answer, tuple) else answer), out[:, i]


def remembered(module: ModuleType, rows: np.ndarray) -> Any:
    """What a sensor remembers, as its kind gets it."""
    left = iter(rows.tolist())
    return module.Memory(
        *[next(left) if one.size == 1 else tuple(next(left) for _ in range(one.size)) for one in quantities(module.Memory)]
    )


def differs(compiled: tuple[int, np.ndarray], plain: tuple[int, np.ndarray]) -> str | None:
    """Whether machine code and Python see the same."""
    same = compiled[0] == plain[0] and all(twice.same(float(a), float(b)) for a, b in zip(compiled[1], plain[1], strict=True))
    return None if same else f"compiled it sees {compiled}, as Python {plain}"


def beyond(count: int, capacity: int) -> str | None:
    """A count that is none."""
    return None if 0 <= count <= capacity else f"measure() returned {count}: 0 to {capacity} is meant, CAPACITY says so"


def missing(out: np.ndarray, count: int, each: Mounted) -> str | None:
    """Readings that are no numbers."""
    width = sum(one.size for one in quantities(each.kind.module.Reading))
    return None if np.isfinite(out[1 : 1 + count * width]).all() else f"it reported {out.tolist()}: look for a division by zero"
