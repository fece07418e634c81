"""Metrics: a number of any record, the same of the same, and no word about a run that was too short."""

import math
from collections.abc import Iterator

import numpy as np

from studio.execution.record import Record
from studio.kind.registry import Kind
from studio.workshop import draw
from studio.workshop.check import Check, tried

SIZES = ((1, 2), (1, 60), (3, 60), (5, 200))  # cars, samples


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, on drawn records."""
    seed = np.random.default_rng(1)
    records = [draw.drive(seed, *size) for size in SIZES for _ in range(5)]
    yield tried("gives a number, or nan where there is nothing to measure", lambda: numbers(kind, records))
    yield tried("gives the same number of the same record", lambda: repeated(kind, records))
    yield tried("has a number, or nan, for a car that is alone and stands", lambda: numbers(kind, [draw.record(speed=[[0.0] * 60])]))


def numbers(kind: Kind, records: list[Record]) -> str | None:
    """Finite numbers or nan."""
    for each in records:
        found = kind.module.measure(each)
        if not isinstance(found, (int, float, np.number)) or math.isinf(found):
            return f"measure() returned {found!r}: give a float, and nan where there is nothing to measure"
    return None


def repeated(kind: Kind, records: list[Record]) -> str | None:
    """No hidden memory."""
    for each in records:
        first, second = float(kind.module.measure(each)), float(kind.module.measure(each))
        if first != second and not (math.isnan(first) and math.isnan(second)):
            return f"measure() gave {first!r}, then {second!r}: keep nothing between calls, and draw no random numbers"
    return None
