"""Beyond: when a vehicle leaves the span of driving dynamics that it was validated for."""

import numpy as np

from studio.execution.record import Record
from studio.kind.metric import Found

CHANNELS = {"speed": "speed", "acceleration": "acceleration", "lateral_acceleration": "lateral acceleration", "yaw_rate": "yaw rate"}


def outside(record: Record) -> list[Found]:
    """Of every vehicle with a validated span: the share of its time outside [1], the quantity that led farthest, and when it did."""
    spans = {name: manned.validated for name, manned in record.cast.manned.items() if manned.validated and manned.dynamics != "light"}
    return [of(record, row, name, spans[name]) for row, name in enumerate(record.vehicles) if name in spans]


def of(record: Record, row: int, name: str, span: dict[str, list[float]]) -> Found:
    """That of one vehicle."""
    values = np.array([record.channel(each)[row] for each in CHANNELS])
    low, high = (np.array([span[each][i] for each in CHANNELS])[:, None] for i in (0, 1))
    takes_part = np.isfinite(values).all(axis=0)
    if not takes_part.any():
        return Found(np.nan, (name, CHANNELS["speed"]))
    far = np.maximum(np.maximum(low - values, values - high), 0.0) / np.maximum(high - low, 1e-9)
    far = np.where(takes_part, far, 0.0)
    which, when = np.unravel_index(int(far.argmax()), far.shape)
    share = float(np.mean(far.max(axis=0)[takes_part] > 0.0))
    return Found(share, (name, list(CHANNELS.values())[which]) if share else (name, "speed"), float(record.time[when]) if share else np.nan)
