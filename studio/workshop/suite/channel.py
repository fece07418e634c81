"""Channels: a value for every vehicle and sample of any record, the same of the same."""

from collections.abc import Iterator

import numpy as np

from studio.execution.record import Derived, Record
from studio.kind.registry import Kind
from studio.workshop import draw
from studio.workshop.check import Check, tried

SIZES = ((1, 2), (1, 60), (3, 60), (5, 200))  # cars, samples


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, on drawn records."""
    seed = np.random.default_rng(1)
    records = [draw.drive(seed, *size) for size in SIZES for _ in range(5)]
    yield tried("gives a value for every vehicle and sample", lambda: shapes(kind, records))
    yield tried("gives finite values, or nan where there are none", lambda: finite(kind, records))
    yield tried("gives the same of the same record", lambda: repeated(kind, records))


def traced(kind: Kind, record: Record) -> np.ndarray:
    """Its values, float64[vehicle, sample]."""
    return Derived(record).made(kind)


def shapes(kind: Kind, records: list[Record]) -> None:
    """Raises TypeError for another shape."""
    for each in records:
        traced(kind, each)


def finite(kind: Kind, records: list[Record]) -> str | None:
    """Nothing is infinite."""
    infinite = any(np.isinf(traced(kind, each)).any() for each in records)
    return "trace() gave infinite values: divide by nothing that may be zero, or give nan there" if infinite else None


def repeated(kind: Kind, records: list[Record]) -> str | None:
    """No hidden memory."""
    same = all(np.array_equal(traced(kind, each), traced(kind, each), equal_nan=True) for each in records)
    return None if same else "trace() gave other values the second time: keep nothing between calls, and draw no random numbers"
