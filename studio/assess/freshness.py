"""Freshness: how old what is known of somebody is, and how often news of him comes.

A message that was made at g and came at r is the newest until the next one comes. The age of information at t is t - g of the newest
(S. Kaul, R. Yates, M. Gruteser, Real-time status: how often should one update?, INFOCOM 2012): a saw tooth that rises with slope 1 and
falls to r - g whenever something newer comes. Between two arrivals r_i and r_{i+1} it rises from r_i - g_i to the peak r_{i+1} - g_i:

    mean age = Σ ((r_{i+1} - g_i)² - (r_i - g_i)²) / 2 / Σ (r_{i+1} - r_i)

With period T, delay L and independent losses p the mean age is L + T (1 + p)/(2 (1 - p)) and the mean peak L + T/(1 - p).
"""

import numpy as np


def mean(ages: np.ndarray) -> np.ndarray:
    """Mean [s] of sampled ages, float64[link, n], over the samples at which there are any; not a number for a link without."""
    known = np.isfinite(ages)
    with np.errstate(invalid="ignore"):
        return np.where(known, ages, 0.0).sum(axis=-1) / known.sum(axis=-1)


def share_older(ages: np.ndarray, limit: float) -> np.ndarray:
    """Share [1] of the samples with an age at which it is more than the limit [s], per link; not a number for a link without."""
    known = np.isfinite(ages)
    with np.errstate(invalid="ignore"):
        return (known & (ages > limit)).sum(axis=-1) / known.sum(axis=-1)


def newest(made: np.ndarray, came: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """When the messages were made and came [s] that were news when they came, in that order; what never came is not among them."""
    order = np.argsort(came, kind="stable")
    order = order[np.isfinite(came[order])]
    made, came = made[order], came[order]
    is_news = made > np.concatenate([[-np.inf], np.maximum.accumulate(made)[:-1]]) if made.size else np.zeros(0, bool)
    return made[is_news], came[is_news]


def mean_age(made: np.ndarray, came: np.ndarray) -> float:
    """Mean age [s] from the first arrival to the last one; not a number with fewer than two."""
    made, came = newest(made, came)
    if made.size < 2:
        return float("nan")
    low, peak = came[:-1] - made[:-1], came[1:] - made[:-1]
    return float(((peak**2 - low**2) / 2.0).sum() / (came[-1] - came[0]))


def peaks(made: np.ndarray, came: np.ndarray) -> np.ndarray:
    """Peaks of the age [s], each just before something newer comes."""
    made, came = newest(made, came)
    return came[1:] - made[:-1]


def share_of_time_older(made: np.ndarray, came: np.ndarray, limit: float) -> float:
    """Share [1] of the time from the first arrival to the last one at which the age is more than the limit [s]."""
    made, came = newest(made, came)
    if made.size < 2:
        return float("nan")
    low, peak = came[:-1] - made[:-1], came[1:] - made[:-1]
    return float((peak - np.clip(limit, low, peak)).sum() / (came[-1] - came[0]))


def inter_reception(came: np.ndarray) -> np.ndarray:
    """Times [s] between one reception and the next; with period T and independent losses p their mean is T/(1 - p)."""
    return np.diff(np.sort(came[np.isfinite(came)]))


def runs_of_losses(came: np.ndarray) -> np.ndarray:
    """Lengths [1] of the runs of messages, in the order of sending, that did not come: those that never do have an infinite time."""
    lost = np.concatenate([[0], ~np.isfinite(came), [0]]).astype(int)
    turns = np.flatnonzero(np.diff(lost))
    return turns[1::2] - turns[::2]
