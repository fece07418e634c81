"""Metrics: a number of any record, the same of the same, and no word about a run that was too short."""

import math
from collections.abc import Iterator

import numpy as np

from studio.assess.measure import found_by, usual
from studio.execution.record import Record
from studio.kind.metric import Found
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
    yield tried("gives a number, or nan, of any part of a run", lambda: numbers(kind, [each.between(0.1, 0.5) for each in records[5:]]))
    yield tried("has a number, or nan, for a car that is alone and stands", lambda: numbers(kind, [draw.record(speed=[[0.0] * 60])]))


def numbers(kind: Kind, records: list[Record]) -> str | None:
    """Finite numbers or nan."""
    for each in records:
        found = raw(kind, each)
        value = found.value if isinstance(found, Found) else found
        if not isinstance(value, (int, float, np.number)) or math.isinf(value):
            return f"measure() returned {found!r}: give a float, or a Found of one, and nan where there is nothing to measure"
        if isinstance(found, Found) and (what := unknown(found, each)):
            return what
    return None


def raw(kind: Kind, record: Record) -> object:
    """What it gives of a record with its usual settings, as it is."""
    return kind.module.measure(record, usual(kind)) if hasattr(kind.module, "Settings") else kind.module.measure(record)


def unknown(found: Found, record: Record) -> str | None:
    """Subjects that the record does not have, and moments outside of it."""
    units = {*record.vehicles, *(unit for link in record.links for unit in link.split("→"))}
    if strange := [each for each in found.subject if each not in units]:
        return f"measure() found {found!r}: {', '.join(strange)} is no unit of the record"
    is_within = math.isnan(found.time) or record.time[0] <= found.time <= record.time[-1]
    return None if is_within else f"measure() found {found!r}: the time is not within the record"


def repeated(kind: Kind, records: list[Record]) -> str | None:
    """No hidden memory."""
    for each in records:
        first, second = (found_by(kind, each, usual(kind)).value for _ in range(2))
        if first != second and not (math.isnan(first) and math.isnan(second)):
            return f"measure() gave {first!r}, then {second!r}: keep nothing between calls, and draw no random numbers"
    return None
