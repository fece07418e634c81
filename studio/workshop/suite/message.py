"""Messages: what every unit sends by itself is of finite numbers, compiled and as Python the same."""

from collections.abc import Iterator
from types import ModuleType
from typing import Any

import numpy as np

from studio.application.contract import Own
from studio.application.port import OWN
from studio.kind.quantity import width
from studio.kind.registry import Kind
from studio.workshop import draw, twice
from studio.workshop.check import Check, tried
from studio.world.view import Turn

DRAWS = 300


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, on drawn cars."""
    module, seed = kind.module, np.random.default_rng(1)
    yield tried("SIZE has a byte for every number at least", lambda: small(kind))
    draws: list[tuple] = []
    if hasattr(module, "beacon"):
        draws = [(own(seed), chosen(module, seed), *memory(module, seed)) for _ in range(DRAWS)]
        yield tried("Settings have a period, how often every unit sends it", lambda: timeless(kind))
        yield tried("beacon() gives the same compiled and as Python", lambda: twice.agree(module.beacon, draws))
        yield tried("beacon() gives finite numbers", lambda: twice.finite(module.beacon, draws))
        yield tried("beacon() gives the same to the same", lambda: twice.steady(module.beacon, draws))
    if hasattr(module, "due"):
        asked = [(*given, turn(seed)) for given in draws]
        yield tried("due() gives the same compiled and as Python", lambda: twice.agree(module.due, asked))
        yield tried("due() gives finite numbers", lambda: twice.finite(module.due, asked))
        yield tried("due() gives the same to the same", lambda: twice.steady(module.due, asked))
    if hasattr(module, "size"):
        payloads = [(draw.quantity_tuple(module.Payload, seed),) for _ in range(DRAWS)]
        yield tried("size() gives the same compiled and as Python", lambda: twice.agree(module.size, payloads))
        yield tried("no message is larger than SIZE, or empty", lambda: sizes(kind, payloads))


def small(kind: Kind) -> str | None:
    """A size that cannot be."""
    least = width(kind.module.Payload)
    return f"SIZE is {kind.module.SIZE} bytes for {least} numbers: count the payload and its headers" if least > kind.module.SIZE else None


def timeless(kind: Kind) -> str | None:
    """Without a period nobody knows when."""
    found = kind.module.Settings.model_fields.get("period")
    return None if found and found.annotation is float else 'add it: period: float = number(0.1, unit="s", title="Period", ge=0.01, le=2)'


def chosen(module: ModuleType, seed: np.random.Generator) -> Any:
    """Drawn settings."""
    return draw.settings_tuple(module, draw.settings(module.Settings, seed))


def memory(module: ModuleType, seed: np.random.Generator) -> tuple:
    """What a unit may remember of what it has sent; nothing for a message of which nothing is remembered."""
    return (draw.quantity_tuple(module.Memory, seed),) if hasattr(module, "Memory") else ()


def sizes(kind: Kind, payloads: list[tuple]) -> str | None:
    """A size that SIZE does not allow."""
    found = ((kind.module.size(*given), given) for given in payloads)
    return next(
        (f"size() gave {size} of {given}; SIZE is {kind.module.SIZE}" for size, given in found if not 0 < size <= kind.module.SIZE), None
    )


def turn(seed: np.random.Generator) -> Turn:
    """A moment at which a unit is asked."""
    return Turn(float(seed.uniform(0.0, 3600.0)), float(seed.choice([0.0, 0.1, 0.4, 1.0])), float(seed.uniform()))


def own(seed: np.random.Generator) -> Own:
    """A car as its bus tells of it."""
    return Own(*[draw.by_unit(each.unit, seed) for each in OWN])
