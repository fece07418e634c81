"""Whether and when a message arrives, as chance alone, without a signal: the simple form of a radio.

Parameters as Massow & Radusch 2018, Table 3: mean delay, variation, delay growing with distance; loss rate, loss growing with distance,
range.

Delays that were measured are skewed: most messages take little longer than the quickest, a few take long. A shortest delay a and an
exponential rest of the mean b, which is what a queue with one server and arrivals at random gives (L. Kleinrock, Queueing Systems 1, 1975,
section 3.2), has the quantiles

    a - b ln(1 - p)
"""

from math import exp, log

from studio.compiled import compiled


@compiled
def delay(mean, variation, draw):
    """Time in the air and in both units [s]: uniform within mean ± variation; draw in (0, 1)."""
    return max(mean + variation * (2.0 * draw - 1.0), 0.0)


@compiled
def not_cut(shortest, rest, longest):
    """The share of skewed delays that are not longer than `longest` [s]."""
    return 1.0 - exp(-max(longest - shortest, 0.0) / rest) if rest > 0.0 else 1.0


@compiled
def skewed_delay(shortest, rest, longest, share, draw):
    """Shortest delay and an exponential rest of the given mean [s], cut where the whole is `longest`; draw in (0, 1).

    Cut: what would be longer is drawn from what is not, which is this share, so that no delay is more frequent than its neighbours.
    """
    return min(shortest - rest * log(1.0 - share * draw), longest)


@compiled
def is_lost(distance, reach, loss, loss_per_metre, draw):
    """Whether the message is lost: beyond reach always, else with loss + loss_per_metre · distance."""
    return distance > reach or draw < loss + loss_per_metre * distance
