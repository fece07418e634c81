"""Ad hoc radio: every message reaches every unit in range, after a delay, or is lost.

Delay and loss of one message on one link depend on (seed, sender, receiver, message number) only, so nothing is queued:
a receiver looks back at what was sent and asks whether it has arrived by now.
Parameters as Massow & Radusch 2018, Table 3: mean delay, variation, loss rate, loss growing with distance, range.
"""

from studio.compiled import compiled


@compiled
def delay(mean, variation, draw):
    """Time in the air and in both units [s]: uniform within mean ± variation; draw in (0, 1)."""
    return max(mean + variation * (2.0 * draw - 1.0), 0.0)


@compiled
def is_lost(distance, reach, loss, loss_per_metre, draw):
    """Whether the message is lost: beyond reach always, else with loss + loss_per_metre · distance."""
    return distance > reach or draw < loss + loss_per_metre * distance
