"""Intact: what a record tells of vehicles until they are hit.

The studio finds that bodies have touched, and what that would do to them (`impact`); it does not push them apart. What a vehicle does after
its first collision, with whatever it was, is therefore no drive of anybody: it counts for no measure, and in no danger. From the sample of
the collision on its channels are no numbers, as those of a vehicle that has left the road.
"""

from dataclasses import replace

import numpy as np

from studio.assess.impact import COLLISION
from studio.execution.record import SAME_TIME, Record


def intact(record: Record) -> Record:
    """The record without what its vehicles did from their first collision on; the same where nobody was hit."""
    ends = {name: time for name, time in first_hits(record).items() if name in record.vehicles}
    if not ends:
        return record
    values = np.array(record.values, dtype=np.float64)
    for name, time in ends.items():
        values[:, record.vehicles.index(name), record.time >= time - SAME_TIME] = np.nan
    return replace(record, values=values)


def first_hits(record: Record) -> dict[str, float]:
    """When [s] everybody who was hit was hit first."""
    hits = sorted((event.time, name) for event in record.happenings if event.kind == COLLISION for name in event.units)
    return {name: time for time, name in reversed(hits)}
