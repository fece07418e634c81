"""Actions: whatever a vehicle does, it is told finite numbers, compiled and as Python the same; effects on the road are effects."""

from collections.abc import Iterator
from typing import Any, get_args

import numpy as np

from studio.kind.registry import Kind
from studio.workshop import draw, twice
from studio.workshop.check import Check, tried
from studio.workshop.stage import stage
from studio.world.effect import Effect, Place
from studio.world.maneuver import Sees

DRAWS = 300
RANGES = {  # what a vehicle may be like, in the units of `Sees`
    "elapsed": (0.0, 100.0), "speed": (-5.0, 60.0), "acceleration": (-10.0, 6.0), "steering": (-0.6, 0.6), "gap": (-1.0, 300.0),
    "ahead_speed": (0.0, 60.0), "station": (0.0, 3000.0), "offset": (-4.0, 4.0), "heading_error": (-1.0, 1.0),
    "path_curvature": (-0.1, 0.1), "driver_acceleration": (-8.0, 4.0), "driver_steering": (-0.6, 0.6),
    "x": (-500.0, 500.0), "y": (-500.0, 500.0), "heading": (-3.1, 3.1), "wheelbase": (2.0, 6.0),
}  # fmt: skip


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, on drawn settings."""
    module, seed = kind.module, np.random.default_rng(1)
    chosen = [draw.settings(module.Settings, seed) for _ in range(DRAWS)]
    if hasattr(module, "act"):
        draws = [(draw.settings_tuple(module, each), seen(seed)) for each in chosen]
        yield tried("act() gives the same compiled and as Python", lambda: twice.agree(module.act, draws))
        yield tried("act() gives finite numbers", lambda: twice.finite(module.act, draws))
        yield tried("act() gives the same to the same", lambda: twice.steady(module.act, draws))
    if hasattr(module, "effects"):
        yield tried("effects() gives a list of effects", lambda: strange(kind, chosen[:20]))
    if hasattr(module, "told"):
        yield tried("told() gives a line for people", lambda: wordless(kind, chosen[:20]))


def seen(seed: np.random.Generator) -> Sees:
    """A vehicle at a tick; now and then nobody is ahead of it."""
    values: dict[str, Any] = {name: float(seed.uniform(*span)) for name, span in RANGES.items()} | {"pool": draw.POOL}
    if seed.random() < 0.3:
        values |= {"gap": float("nan"), "ahead_speed": float("nan")}
    return Sees(**values)


def strange(kind: Kind, chosen: list[Any]) -> str | None:
    """What is no effect."""
    setting = stage().cases[0].setting
    place = Place(setting.scenario, setting.network, setting.locks)
    for each in chosen:
        found = kind.module.effects(each, place)
        if not isinstance(found, list) or not all(isinstance(one, get_args(Effect)) for one in found):
            names = ", ".join(one.__name__ for one in get_args(Effect))
            return f"effects() gave {found!r}: a list is meant of {names} (studio.world.effect)"
    return None


def wordless(kind: Kind, chosen: list[Any]) -> str | None:
    """What cannot stand in a list of events."""
    for each in chosen:
        found = kind.module.told(each)
        if not isinstance(found, str) or not found.strip() or "\n" in found:
            return f"told() gave {found!r}: a line of text is meant"
    return None
