"""Traffic: how well the recorded vehicles got along, and whether they kept their lane."""

import numpy as np

from studio.assess.metric import metric
from studio.execution.record import Record


@metric("mean_speed", unit="m/s", goal="higher", title="Mean speed")
def mean_speed(record: Record) -> float:
    """Of all recorded vehicles over the whole run."""
    return float(np.nanmean(record.channel("speed")))


@metric("mean_gap", unit="m", goal="lower", title="Mean gap of the followers")
def mean_gap(record: Record) -> float:
    """While somebody is ahead."""
    gap = record.of_followers("gap")
    return float(np.mean(gap[np.isfinite(gap)])) if np.isfinite(gap).any() else float("nan")


@metric("max_lateral_offset", unit="m", goal="lower", title="Greatest offset from the path")
def max_lateral_offset(record: Record) -> float:
    """Of any recorded vehicle."""
    return float(np.nanmax(np.abs(record.channel("lateral_offset"))))
