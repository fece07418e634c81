"""Adhesion: how much of what they can transmit the tyres did. Of light vehicles nothing is known of single tyres."""

from math import nan

import numpy as np

from studio.execution.record import Record
from studio.kind.metric import Found

WHEELS = ("front_left", "front_right", "rear_left", "rear_right")
CHANNELS = tuple(f"adhesion_{wheel}" for wheel in WHEELS)


def used(record: Record) -> np.ndarray:
    """Use of adhesion [1], float64[wheel, vehicle, n]."""
    return np.array([record.channel(name) for name in CHANNELS])


def sliding(record: Record) -> np.ndarray:
    """Which tyres are past their peak of slip, bool[wheel, vehicle, n]."""
    bits = np.nan_to_num(record.channel("tyres_sliding")).astype(np.int64)
    return np.array([bits >> wheel & 1 for wheel in range(len(WHEELS))], dtype=bool)


def light_among(record: Record) -> tuple[str, ...]:
    """The recorded vehicles that are light."""
    manned = record.cast.manned
    return tuple(name for name in record.vehicles if name in manned and manned[name].dynamics == "light")


def nothing_known(record: Record) -> Found | None:
    """What a measure of tyres finds where all recorded vehicles are light; None where some have tyres."""
    light = light_among(record)
    return Found(nan, why="light vehicles have no tyres") if light and len(light) == len(record.vehicles) else None


def most_used(record: Record) -> np.ndarray:
    """Of the wheel that uses most of it, float64[vehicle, n]."""
    return used(record).max(axis=0)
