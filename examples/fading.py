"""Radio with Rayleigh fading: the farther, the more often a message drowns.

With many reflections and no line of sight the received power is distributed exponentially around a mean that falls with the distance,
so that a message arrives with the probability exp(-(d/d_0)^n): T. S. Rappaport, Wireless Communications, 2nd ed., 2002, section 5.6.
d_0 is the distance at which the mean power is just enough, n the path loss exponent.
"""

from math import exp

from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.world.table.cause import FADING, RECEIVED, TOO_WEAK
from studio.world.view import Transmission, chance

KIND = "radio"
TITLE = "Radio with Rayleigh fading"
ALMOST_NEVER = 1e-4  # [1] probability below which nobody listens


class Settings(Part):
    """What all units of a scenario share."""

    distance: float = number(250.0, unit="m", title="Distance d_0", description="at which the mean power is just enough", ge=10, le=2000)
    exponent: float = number(2.0, unit="1", title="Path loss exponent", ge=1.5, le=6)
    delay: float = number(0.005, unit="s", title="Shortest delay", ge=0, le=0.5)
    contention: float = number(0.01, unit="s", title="Longest wait for the channel", ge=0, le=0.5)


def longest(settings):
    """The longest delay [s]."""
    return settings.delay + settings.contention


def reach(settings):
    """The distance [m] beyond which nothing is heard."""
    return settings.distance * 9.21 ** (1.0 / settings.exponent)  # exp(-9.21) is ALMOST_NEVER


def largest(settings):
    """The largest message [bytes]: that of IEEE 802.11p, less its headers."""
    return 2304


@compiled
def transmit(settings, way, draw):
    """One message to one receiver."""
    heard = exp(-((way.distance / settings.distance) ** settings.exponent))
    lost = TOO_WEAK if heard < ALMOST_NEVER else FADING if chance(draw, 0) > heard else RECEIVED
    return Transmission(lost, settings.delay + settings.contention * chance(draw, 1))
