"""Passage: when a driver comes to a place, and whether there is time to pass before others do.

Who has to wait takes a gap in a stream that goes first if it is as long as the critical gap t_c, counted from the line where one would
wait. Who comes to the line rolling needs less, by the time that this saves on the way across.
"""

from math import sqrt

from studio.compiled import compiled

SLOWEST = 1e-3  # [m/s]
PATIENT = 30.0  # [s] from then on shorter gaps are taken, and after as long again gaps of half the length
HEADWAY, GENTLE = 1.0, 2.0  # [s], [m/s²]
AFTER = 0.5  # [s] that are left between one who has passed and the next


@compiled
def arrival(d, v, a):
    """Time [s] to drive d [m] from a speed v [m/s] with an acceleration a [m/s²] ≥ 0: the root of v t + a t²/2 = d."""
    return 2.0 * d / max(v + sqrt(v * v + 2.0 * a * d), SLOWEST) if d > 0.0 else 0.0


@compiled
def arrival_below(d, v, a, top):
    """The same for one who accelerates no further than to a speed `top` [m/s], as in a bend, and slows down to it where he is faster."""
    if v >= top or a <= 0.0:
        return d / max(min(v, top), SLOWEST) if d > 0.0 else 0.0
    until = (top * top - v * v) / (2.0 * a)
    return arrival(d, v, a) if d <= until else (top - v) / a + (d - until) / top


@compiled
def saved(d, v, a):
    """Time [s] that rolling with v saves over starting from rest, on d [m]."""
    return arrival(d, 0.0, a) - arrival(d, v, a)


@compiled
def wanted_gap(t_c, waited):
    """The critical gap [s] of one who has waited so long [s]: who waits for long takes shorter ones, half of it in the end."""
    return t_c * (1.0 - 0.5 * min(max((waited - PATIENT) / PATIENT, 0.0), 1.0))


@compiled
def merging_headway(v, u):
    """Headway [s] that one with v [m/s] needs to one who comes in before him with u: a second, and Δv/(2 b), what braking with b takes."""
    return HEADWAY + max(v - u, 0.0) / (2.0 * GENTLE)


@compiled
def is_enough(lag, t_c, across, v, a):
    """Whether a lag [s] is enough to pass, `across` [m] from the line until the place is left."""
    return lag >= t_c - saved(across, max(v, 0.0), a)
