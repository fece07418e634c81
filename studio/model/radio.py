"""Ad hoc radio: every message reaches every unit in range, after a delay, or is lost.

Delay and loss of one message on one link depend on (seed, sender, receiver, message number) only, so nothing is queued:
a receiver looks back at what was sent and asks whether it has arrived by now.
Parameters as Massow & Radusch 2018, Table 3: mean delay, variation, loss rate, loss growing with distance, range.

Buildings between two units weaken the signal by A = 9 dB a wall + 0.4 dB a metre inside (C. Sommer, D. Eckhoff, R. German,
F. Dressler, A computationally inexpensive empirical model of IEEE 802.11p radio shadowing in urban environments, WONS 2011).
Where power falls with distance as d^-n, that is as much as a distance of d · 10^(A/(10 n)) without buildings; range and loss
are those of this distance.
"""

from studio.compiled import compiled

WALL_LOSS = 9.0  # [dB]
METRE_LOSS = 0.4  # [dB/m]


@compiled
def delay(mean, variation, draw):
    """Time in the air and in both units [s]: uniform within mean ± variation; draw in (0, 1)."""
    return max(mean + variation * (2.0 * draw - 1.0), 0.0)


@compiled
def is_lost(distance, reach, loss, loss_per_metre, draw):
    """Whether the message is lost: beyond reach always, else with loss + loss_per_metre · distance."""
    return distance > reach or draw < loss + loss_per_metre * distance


@compiled
def attenuation(walls, inside):
    """What buildings take from a signal [dB]: walls crossed, metres inside."""
    return WALL_LOSS * walls + METRE_LOSS * inside


@compiled
def felt_distance(distance, weakened, exponent):
    """Distance [m] at which a signal would be as weak without buildings; `weakened` is their attenuation [dB]."""
    return distance * 10.0 ** (weakened / (10.0 * exponent))
