"""Drivers: whatever they see, they want an acceleration and a steering angle, compiled and as Python the same."""

from collections.abc import Iterator

import numpy as np

from studio.kind.driver import Sees
from studio.kind.registry import Kind
from studio.workshop import draw, twice
from studio.workshop.check import Check, tried

DRAWS = 300
RANGES = {"steering_max": (0.2, 1.2), "steering_rate": (0.1, 1.0), "wheelbase": (1.0, 7.0)}  # what a vehicle is like, in units of `Sees`


def seen(seed: np.random.Generator) -> Sees:
    """Anything, in a vehicle that there may be."""
    return draw.quantity_tuple(Sees, seed)._replace(**{name: float(seed.uniform(*span)) for name, span in RANGES.items()})


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, on drawn settings and sights."""
    module, seed = kind.module, np.random.default_rng(1)
    draws = [(draw.settings_tuple(module, draw.settings(module.Settings, seed)), seen(seed)) for _ in range(DRAWS)]
    yield tried("decide() gives the same compiled and as Python", lambda: twice.agree(module.decide, draws))
    yield tried("decide() gives finite numbers", lambda: twice.finite(module.decide, draws))
    yield tried("decide() gives the same to the same", lambda: twice.steady(module.decide, draws))
