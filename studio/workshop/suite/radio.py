"""Radio models: every message is lost, or comes within the longest delay; compiled and as Python the same."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from studio.kind.registry import Kind
from studio.workshop import draw, twice
from studio.workshop.check import Check, tried
from studio.world.view import Draw, Way

DRAWS = 300
ROUNDING = 1e-9  # [s]


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, on drawn ways and chances."""
    module, seed = kind.module, np.random.default_rng(1)
    chosen = [draw.settings(module.Settings, seed) for _ in range(DRAWS)]
    draws = [
        (draw.settings_tuple(module, each), way(seed, kind.module.largest(each)), Draw(*seed.uniform(1e-6, 1.0 - 1e-6, 2).tolist()))
        for each in chosen
    ]
    yield tried("longest(), reach() and largest() are finite, and not negative", lambda: bounds(kind, chosen))
    yield tried("transmit() gives the same compiled and as Python", lambda: twice.agree(module.transmit, draws))
    yield tried("transmit() gives finite numbers", lambda: twice.finite(module.transmit, draws))
    yield tried("transmit() gives the same to the same", lambda: twice.steady(module.transmit, draws))
    yield tried("no message comes before it was sent, or after longest()", lambda: delays(kind, chosen, draws))


def way(seed: np.random.Generator, largest: float) -> Way:
    """A way, long or short, through houses now and then, of a message that the radio takes."""
    walls = float(seed.integers(0, 4))
    return Way(
        float(seed.uniform(0.0, 1000.0)), walls, float(10.0 * walls), float(seed.uniform(1.0, largest)), float(seed.uniform(0.0, 60.0))
    )


def bounds(kind: Kind, chosen: list[Any]) -> str | None:
    """What the rings of messages are made for."""
    for each in chosen:
        found = {
            "longest": float(kind.module.longest(each)),
            "reach": float(kind.module.reach(each)),
            "largest": float(kind.module.largest(each)),
        }
        for name, value in found.items():
            if not (math.isfinite(value) and value >= 0.0):
                return f"{name}() gave {value!r} for {each}: give a bound that the settings imply"
    return None


def delays(kind: Kind, chosen: list[Any], draws: list[tuple]) -> str | None:
    """A delay that is longer than was said would be taken for one of another message."""
    for settings, given in zip(chosen, draws, strict=True):
        lost, delay = kind.module.transmit(*given)
        if not lost and not 0.0 <= delay <= kind.module.longest(settings) + ROUNDING:
            return f"transmit() gave a delay of {delay} s, longest() {kind.module.longest(settings)} s, for {settings}"
    return None
