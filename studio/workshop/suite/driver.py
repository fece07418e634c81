"""Drivers: whatever they see, they want an acceleration and a steering angle, compiled and as Python the same."""

from collections.abc import Iterator

import numpy as np

from studio.kind.driver import Sees
from studio.kind.registry import Kind
from studio.workshop import draw, twice
from studio.workshop.check import Check, tried

DRAWS = 300


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, on drawn settings and sights."""
    module, seed = kind.module, np.random.default_rng(1)
    draws = [(draw.settings_tuple(module, draw.settings(module.Settings, seed)), draw.quantity_tuple(Sees, seed)) for _ in range(DRAWS)]
    yield tried("decide() gives the same compiled and as Python", lambda: twice.agree(module.decide, draws))
    yield tried("decide() gives finite numbers", lambda: twice.finite(module.decide, draws))
    yield tried("decide() gives the same to the same", lambda: twice.steady(module.decide, draws))
