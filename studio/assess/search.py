"""Search: where in a record the least, the greatest or the worst is, as a `Found` with its vehicles and its time."""

import numpy as np

from studio.execution.record import Record
from studio.kind.metric import Found

NOTHING = Found(float("nan"))
SAME = 1e-9  # relative difference below which two values are the same: that one was a rounding later is no news


def least(record: Record, values: np.ndarray, of: list[str] | None = None) -> Found:
    """The least finite value, float64[vehicle, n], of all recorded vehicles or of those that the rows stand for; the first of several."""
    values = np.where(np.isfinite(values), values, np.inf)
    if not values.size or not np.isfinite(best := values.min()):
        return NOTHING
    as_good = values <= best + SAME * max(abs(best), 1.0)
    sample = int(as_good.any(axis=0).argmax())
    row = int(as_good[:, sample].argmax())
    names = record.vehicles if of is None else of
    return Found(float(values[row, sample]), (names[row],), float(record.time[sample]))


def greatest(record: Record, values: np.ndarray, of: list[str] | None = None) -> Found:
    """The greatest finite value."""
    found = least(record, -values, of)
    return found._replace(value=-found.value)


def with_ahead(record: Record, found: Found) -> Found:
    """The same with the vehicle or object that was ahead of the one it is about."""
    if not found.subject:
        return found
    sample = int(np.searchsorted(record.time, found.time))
    ahead = record.ahead(record.vehicles.index(found.subject[0]), sample)
    return found._replace(subject=(*found.subject, *([ahead] if ahead else [])))


def least_behind(record: Record, values: np.ndarray, of: list[str] | None = None) -> Found:
    """The least value of somebody behind somebody."""
    return with_ahead(record, least(record, values, of))


def greatest_behind(record: Record, values: np.ndarray, of: list[str] | None = None) -> Found:
    """The greatest value of somebody behind somebody."""
    return with_ahead(record, greatest(record, values, of))


def worst_vehicle(record: Record, totals: np.ndarray) -> Found:
    """The vehicle with the greatest total over the whole record, float64[vehicle]."""
    if not np.isfinite(totals).any():
        return NOTHING
    row = int(np.nanargmax(totals))
    return Found(float(totals[row]), (record.vehicles[row],))


def worst_link(record: Record, values: np.ndarray) -> Found:
    """The link with the greatest value, float64[link]: sender and receiver."""
    if not np.isfinite(values).any():
        return NOTHING
    place = int(np.nanargmax(values))
    sender, _, receiver = record.links[place].partition("→")
    return Found(float(values[place]), (sender, receiver))
