"""For how long a tyre of one vehicle was outside its linear span; the vehicle that was so longest counts.

A tyre's force grows with its slip in proportion up to about 0.4 of what it can transmit: 4 m/s² on a dry road, up to which the linear
single-track model holds (M. Mitschke, H. Wallentowitz, Dynamik der Kraftfahrzeuge, 5th edition 2014). Of the wheel that uses most of
its adhesion at each moment. Light vehicles have no tyres, and do not count.
"""

from studio.assess.adhesion import most_used, nothing_known
from studio.assess.effort import lasting
from studio.assess.search import worst_vehicle
from studio.kind.metric import Scope
from studio.kind.settings import number

KIND = "metric"
TITLE = "Time outside the tyres' linear span"
UNIT = "s"
BETTER = "lower"


class Settings(Scope):
    """How far the span goes."""

    share: float = number(0.4, unit="1", title="Share of the adhesion", description="up to which a tyre is linear", gt=0, le=1)


def measure(record, settings):
    """Time [s]."""
    return nothing_known(record) or worst_vehicle(record, lasting(most_used(record) > settings.share, record.time))
