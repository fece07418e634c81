"""Congestion control: the busier the channel, the longer a unit waits from one message to the next (ETSI TS 102 687, the reactive kind).

The channel busy ratio is sampled every 100 ms. A level, and with it the least interval between two messages of a unit, is taken as soon
as all samples of one second have been above the present one, or all samples of five seconds below it; seconds are counted from the first
sample that differs, and the nearest level among those samples is taken.

Tables, pinned:

    "oscar"    100  200  400  500  1000 ms     the ratios .20 .30 .40 .50 are LOWER bounds of the second to the fifth
               (OScar, the open ETSI stack of fillabs)
    "vanetza"  60  100  180  260  340  420  460 ms     the ratios .19 .27 .35 .43 .51 .59 are UPPER bounds of the first to the sixth
               (Vanetza, the open ETSI stack of R. Riebl: relaxed, five active states, restrictive)

Both are read in the same way: a ratio that equals a bound belongs to the level above it.
"""

from typing import Annotated, NamedTuple

from studio.compiled import compiled

SAMPLE = 0.1  # [s]
UP, DOWN = 10, 50  # samples after the first that differs
OSCAR, VANETZA = 0, 1


class Control(NamedTuple):
    """What a unit remembers of the load of its channel."""

    level: Annotated[float, "1"] = 0.0
    differs: Annotated[float, "1"] = 0.0  # samples in a row that call for a higher level, or, negative, for a lower one
    nearest: Annotated[float, "1"] = 0.0  # the level nearest to the present one among those that they call for


@compiled
def level_of(ratio, table):
    """The level that a ratio calls for."""
    if table == OSCAR:
        return 1.0 * ((ratio >= 0.2) + (ratio >= 0.3) + (ratio >= 0.4) + (ratio >= 0.5))
    low = (ratio >= 0.19) + (ratio >= 0.27) + (ratio >= 0.35)
    return 1.0 * (low + (ratio >= 0.43) + (ratio >= 0.51) + (ratio >= 0.59))


@compiled
def interval(level, table):
    """The least time [s] between two messages."""
    if table == OSCAR:
        return 0.1 if level < 1.0 else 0.2 if level < 2.0 else 0.4 if level < 3.0 else 0.5 if level < 4.0 else 1.0
    return 0.06 if level < 1.0 else 0.46 if level >= 6.0 else 0.02 + 0.08 * level


@compiled
def sampled(control, ratio, table):
    """A unit's memory after one more sample."""
    level, called = control.level, level_of(ratio, table)
    if called == level:
        return Control(level, 0.0, level)
    side = 1.0 if called > level else -1.0
    goes_on = control.differs * side > 0.0
    differs = control.differs + side if goes_on else side
    nearest = level + side * min(abs(called - level), abs(control.nearest - level)) if goes_on else called
    return Control(nearest, 0.0, nearest) if differs > UP or differs < -DOWN else Control(level, differs, nearest)
