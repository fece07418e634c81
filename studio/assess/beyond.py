"""Beyond: when a vehicle leaves the span of driving dynamics that it was validated for."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from studio.execution.record import Record
from studio.kind.metric import Found

Span = Mapping[str, list[float]]

CHANNELS = {"speed": "speed", "acceleration": "acceleration", "lateral_acceleration": "lateral acceleration", "yaw_rate": "yaw rate"}


class Stretch(NamedTuple):
    """From when until when [s] a vehicle was outside its span; what led farthest, its value at its worst, and what it was validated for."""

    begin: float
    end: float
    quantity: str
    value: float
    low: float
    high: float


class Spanned(NamedTuple):
    """A vehicle with a validated span: where it was outside, and which quantities were not recorded, so that nothing is said of them."""

    vehicle: str
    stretches: tuple[Stretch, ...]
    not_recorded: tuple[str, ...]


def outside(record: Record) -> list[Found]:
    """Of every vehicle with a validated span: the share of its time outside [1], the quantity that led farthest, and when it did."""
    return [of(record, row, name, span) for row, name, span in spans(record)]


def stretches(record: Record) -> list[Spanned]:
    """Of every vehicle with a validated span: where it was outside of it."""
    return [stretched(record, row, name, span) for row, name, span in spans(record)]


def spans(record: Record) -> Iterator[tuple[int, str, Span]]:
    """Every vehicle that was validated, its row, its name and its span; of light dynamics nothing was ever validated."""
    for row, name in enumerate(record.vehicles):
        manned = record.cast.manned.get(name)
        if manned and manned.validated and manned.dynamics != "light":
            yield row, name, manned.validated


def of(record: Record, row: int, name: str, span: Span) -> Found:
    """The share of one vehicle."""
    values = values_of(record, row)
    takes_part = np.isfinite(values).all(axis=0)
    if not takes_part.any():
        return Found(np.nan, (name, CHANNELS["speed"]))
    far = np.where(takes_part, distance(values, span), 0.0)
    which, when = np.unravel_index(int(far.argmax()), far.shape)
    share = float(np.mean(far.max(axis=0)[takes_part] > 0.0))
    return Found(share, (name, list(CHANNELS.values())[which]) if share else (name, "speed"), float(record.time[when]) if share else np.nan)


def stretched(record: Record, row: int, name: str, span: Span) -> Spanned:
    """The stretches of one vehicle, by what was recorded of it."""
    values = values_of(record, row)
    far = np.nan_to_num(distance(values, span))
    edges = np.flatnonzero(np.diff(np.concatenate([[0], far.max(axis=0) > 0.0, [0]])))
    found = tuple(stretch(record.time, values, far, int(a), int(b), span) for a, b in zip(edges[::2], edges[1::2], strict=True))
    lacking = tuple(each for each, own in zip(CHANNELS, values, strict=True) if not np.isfinite(own).any())
    return Spanned(name, found, lacking)


def stretch(time: np.ndarray, values: np.ndarray, far: np.ndarray, first: int, after: int, span: Span) -> Stretch:
    """That of the samples from `first` to before `after`; it lasts until the next sample, which is inside again."""
    which, at = np.unravel_index(int(far[:, first:after].argmax()), (len(CHANNELS), after - first))
    quantity = list(CHANNELS)[which]
    return Stretch(
        float(time[first]), float(time[min(after, time.size - 1)]), quantity, float(values[which, first + at]), *map(float, span[quantity])
    )


def values_of(record: Record, row: int) -> np.ndarray:
    """The quantities of one vehicle, [quantity, sample]."""
    return np.array([record.channel(each)[row] for each in CHANNELS])


def distance(values: np.ndarray, span: Span) -> np.ndarray:
    """How far values are outside a span, in its own width [1]; 0 inside."""
    low, high = (np.array([span[each][i] for each in CHANNELS])[:, None] for i in (0, 1))
    return np.maximum(np.maximum(low - values, values - high), 0.0) / np.maximum(high - low, 1e-9)
