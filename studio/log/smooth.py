"""Smoothing and slopes of sampled signals, the same for what was recorded and what was simulated, so that neither gains by it."""

import numpy as np
from scipy import signal

CUT_OFF = 6.0  # [Hz] of the low-pass: a car's own motions end at 3 Hz, extrema are wanted to a hundredth of a second


def smooth(time: np.ndarray, values: np.ndarray, cut_off: float = CUT_OFF) -> np.ndarray:
    """Low-pass without delay: a Butterworth filter of second order, there and back. Gaps are bridged for it, and are gaps again."""
    known, rate = np.isfinite(values), 1.0 / float(np.median(np.diff(time)))
    if known.sum() < 16 or cut_off >= 0.45 * rate:
        return values
    bridged = np.interp(time, time[known], values[known])
    sections = signal.butter(2, cut_off, fs=rate, output="sos")
    return np.where(known, signal.sosfiltfilt(sections, bridged, padlen=min(time.size - 1, int(rate))), np.nan)


def slope(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Rate of change of the smoothed signal."""
    return np.gradient(smooth(time, values, 2.0), time)


def crossing(time: np.ndarray, values: np.ndarray, level: float) -> float:
    """The first time at which a signal reaches a level from below, between samples linear; not a number when it never does."""
    above = np.flatnonzero(values >= level)
    if not above.size:
        return float("nan")
    i = int(above[0])
    if i == 0:
        return float(time[0])
    return float(np.interp(level, [values[i - 1], values[i]], [time[i - 1], time[i]]))


def rise(time: np.ndarray, values: np.ndarray, level: float) -> float:
    """The same; not a number either for a signal that is there when it begins, for nobody knows since when."""
    known = values[np.isfinite(values)]
    return crossing(time, values, level) if known.size and known[0] < level else float("nan")


def stretches(mask: np.ndarray) -> list[tuple[int, int]]:
    """Where a mask is true without a break: first index, and the one after the last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
