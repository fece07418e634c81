"""Safety: how near the recorded vehicles came to what was ahead of them."""

import numpy as np

from studio.assess.metric import metric
from studio.execution.record import Record
from studio.world.table.event import EVENTS, HIT

COLLISION = EVENTS[HIT].name
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


@metric("min_ttc", unit="s", goal="higher", title="Least time to collision")
def min_ttc(record: Record) -> float:
    """Least TTC of any recorded vehicle."""
    return smallest(ttc(record))


@metric("min_gap", unit="m", goal="higher", title="Least gap")
def min_gap(record: Record) -> float:
    """Least bumper-to-bumper distance to the vehicle ahead."""
    return smallest(record.channel("gap"))


@metric("min_time_gap", unit="s", goal="higher", title="Least time gap of a follower")
def min_time_gap(record: Record) -> float:
    """Least gap over own speed, while rolling."""
    return smallest(record.of_followers("time_gap"))


@metric("max_deceleration", unit="m/s²", goal="lower", title="Strongest deceleration of a follower")
def max_deceleration(record: Record) -> float:
    """How hard the cars had to brake that were not told to by the script."""
    return -smallest(record.of_followers("acceleration"))


@metric("collisions", unit="1", goal="lower", title="Collisions")
def collisions(record: Record) -> float:
    """Pairs of vehicles, traffic included, whose bodies touched."""
    return float(sum(event.kind == COLLISION for event in record.happenings))
