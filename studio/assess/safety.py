"""Safety: how near the recorded vehicles came to what was ahead of them."""

import numpy as np

from studio.execution.record import Record

CLOSING = 0.1  # [m/s] slower than this nobody comes nearer: it would take minutes, and sensors could not tell


def smallest(values: np.ndarray) -> float:
    """The least number among values that may be missing; not a number when all are."""
    present = values[np.isfinite(values)]
    return float(present.min()) if present.size else float("nan")


def time_to_collision(gap: np.ndarray, speed: np.ndarray, ahead_speed: np.ndarray) -> np.ndarray:
    """TTC [s] = gap/(v - v_ahead) while closing, else infinite; not a number while nobody is ahead.

    J. C. Hayward, Near miss determination through use of a scale of danger, 1972.
    """
    closing = speed - ahead_speed
    ttc = np.full(gap.shape, np.inf)
    np.divide(gap, closing, out=ttc, where=closing > CLOSING)
    return np.where(np.isnan(gap), np.nan, ttc)


def ttc(record: Record) -> np.ndarray:
    """TTC [s] of every recorded vehicle over time."""
    return time_to_collision(record.channel("gap"), record.channel("speed"), record.channel("ahead_speed"))
