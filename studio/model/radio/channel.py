"""A channel that all share: how busy it is, how long one waits for it, how often two speak at once (IEEE 802.11, outside a cell).

**Busy.** The share b of time in which somebody can be heard (channel busy ratio). The studio adds it up of times on the air; N units that
hear each other and send f messages a second of T seconds make N f T.

**Waiting.** Whoever finds the channel idle for AIFS sends. Whoever finds it busy, with the probability b of its ratio, waits for its end,
for AIFS, and for n of 0 to CW slots, during which others may begin: with r, a draw, the wait is

    W = r T + AIFS + n sigma/(1 - b)

**Speaking at once.** Two kinds, both told without capture, so the figures are upper bounds. Of the units that hear each other and have
waited for the same end, on average b of them, each draws the sender's slot with 1/(CW + 1):

    P_slot = b (1 - exp(-b/(CW + 1)))

Units that the receiver hears and the sender does not are hidden: of two discs of the radius R whose centres are D apart, this share h of
the one lies outside the other, and whoever of them begins within T before or after spoils the message (N. Abramson, AFIPS 1970):

    h = 1 - 2/pi (acos(x) - x sqrt(1 - x²))        x = D/(2 R)        P_hidden = 1 - exp(-2 h b)

h is concave and begins with the slope 4/pi, and 1 - exp(-y) is below y, so both together are below b²/(CW + 1) + 2 b min(4 x/pi, 1).
"""

from math import acos, exp, floor, pi, sqrt

from studio.compiled import compiled

SLOT, CW = 13e-6, 15.0  # [s], slots: aCWmin of IEEE 802.11p
AIFS = 58e-6  # [s] of the highest access category (voice): 32 + 2 slots
BUSIEST = 0.95  # ratio from which on waiting grows no longer


@compiled
def waiting(ratio, airtime, draw, slot_draw):
    """W [s] of a message; both draws in (0, 1)."""
    b = min(ratio, BUSIEST)
    if draw >= b:
        return AIFS
    return draw / b * airtime + AIFS + floor(slot_draw * (CW + 1.0)) * SLOT / (1.0 - b)


@compiled
def longest_wait(airtime):
    """No message waits longer [s]."""
    return airtime + AIFS + CW * SLOT / (1.0 - BUSIEST)


@compiled
def hidden(distance, hearing):
    """h, the share of the units around a receiver that a sender at this distance [m] does not hear; all hear as far as `hearing` [m]."""
    x = min(distance / (2.0 * hearing), 1.0)
    return 1.0 - 2.0 / pi * (acos(x) - x * sqrt(1.0 - x * x))


@compiled
def collision(ratio, share):
    """The probability that a message is spoilt by another: P_slot and P_hidden; `share` is h."""
    return 1.0 - (1.0 - ratio * (1.0 - exp(-ratio / (CW + 1.0)))) * exp(-2.0 * share * ratio)


@compiled
def collision_bound(ratio, distance, hearing):
    """What that probability is not above; cheap."""
    return ratio * (ratio / (CW + 1.0) + 2.0 * min(2.0 / pi * distance / hearing, 1.0))
