"""Conditions: asked at many ticks in a small world, whether it is so or not, compiled and as Python the same."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from studio.execution.simulation import Simulation
from studio.kind.number import shapes, tuple_of
from studio.kind.registry import Kind
from studio.workshop import draw, twice
from studio.workshop.check import Check, tried
from studio.workshop.stage import stage
from studio.world.condition import ROUNDING, Parts
from studio.world.script import view_of

WAITING = 8  # entries that wait for it, with drawn settings each
PARTS = 40  # draws of what is known of others, for each of these settings
LOOKS, APART = 12, 20  # how often is looked, and how many ticks lie between


def checks(kind: Kind) -> Iterator[Check]:
    """All of them."""
    seed = np.random.default_rng(1)
    chosen = [draw.settings(kind.module.Settings, seed) for _ in range(WAITING)]
    if hasattr(kind.module, "joins"):
        draws = [(draw.settings_tuple(kind.module, each), parts(seed)) for each in chosen for _ in range(PARTS)]
        yield tried("joins() gives the same compiled and as Python", lambda: twice.agree(kind.module.joins, draws))
        yield tried("joins() gives the same to the same", lambda: twice.steady(kind.module.joins, draws))
    found: dict[str, str | None] = {}
    yield tried("is asked in the script of a scenario", lambda: looks(kind, chosen, found))
    for what, wrong in found.items():
        yield Check(what, wrong or "")
    if hasattr(kind.module, "moment"):
        yield tried("moment() is a time that the settings tell", lambda: untimely(kind, chosen))


def looks(kind: Kind, chosen: list[Any], found: dict[str, str | None]) -> None:
    """Looks now and then during a run, and keeps the first thing that is wrong of each sort."""
    current = stage(script=script(kind, chosen))
    compared, steady = "holds() gives the same compiled and as Python", "holds() gives the same to the same"
    found |= {compared: None, steady: None} if hasattr(kind.module, "holds") else {}
    for _ in range(LOOKS):
        current.advance(APART)
        if found:
            draws = asked(kind, current)
            found[compared] = found[compared] or twice.agree(kind.module.holds, draws)
            found[steady] = found[steady] or twice.steady(kind.module.holds, draws)


def parts(seed: np.random.Generator) -> Parts:
    """What may be known of some conditions at a time."""
    time, count = float(seed.uniform(0.0, 60.0)), int(seed.integers(1, 5))
    true = int(seed.integers(0, count + 1))
    met = float(seed.uniform(0.0, time)) if true == count or seed.random() < 0.5 else math.inf
    since = float(seed.uniform(min(met, time), time + ROUNDING)) if true == count else math.inf
    return Parts(time, true, count, since, met)


def script(kind: Kind, chosen: list[Any]) -> dict[str, Any]:
    """Entries that wait for it, behind one that others may count from."""
    brakes = {"kind": "brake", "vehicle": "far", "deceleration": 2.0, "duration": 0.5}
    waiting = {f"w{i}": {"when": {"kind": kind.name} | each.model_dump(mode="json"), "do": brakes} for i, each in enumerate(chosen)}
    return {"first": {"when": {"kind": "time", "at": 0.5}, "do": brakes | {"vehicle": "ahead"}}} | waiting


def asked(kind: Kind, current: Simulation) -> list[tuple]:
    """What it would be asked now, for everybody who waits for it."""
    view, module = view_of(current.world), kind.module
    rows = next(each for each in current.world.script.asked if each.kind is kind).settings.T.tolist()
    return [(view, tuple_of(module, module.Settings)(*folded(module, row))) for row in rows]


def folded(module: Any, row: list[float]) -> Iterator[Any]:
    """The numbers of settings field by field."""
    values = iter(row)
    for each in shapes(module.Settings):
        yield next(values) if each.size == 1 else tuple(next(values) for _ in range(each.size))


def untimely(kind: Kind, chosen: list[Any]) -> str | None:
    """A time that is none."""
    for each in chosen:
        found = kind.module.moment(each)
        if found is not None and not math.isfinite(float(found)):
            return f"moment() gave {found!r} for {each}: give the time [s], or None where it is not known"
    return None
