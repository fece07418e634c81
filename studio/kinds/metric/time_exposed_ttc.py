"""For how long one vehicle was nearer to a collision than a limit: TET = ∫ 1[TTC < TTC*] dt; the one that was so longest counts.

M. M. Minderhoud, P. H. L. Bovy, Extended time-to-collision measures for road traffic safety assessment, Accident Analysis and Prevention
33 (2001) 89.
"""

from studio.assess.following import time_exposed, ttc
from studio.assess.search import worst_vehicle
from studio.kind.metric import Scope
from studio.kind.settings import number

KIND = "metric"
TITLE = "Time exposed to a short time to collision"
UNIT = "s"
BETTER = "lower"


class Settings(Scope):
    """From when on it counts."""

    limit: float = number(3.0, unit="s", title="Limit", description="shorter times to collision count", gt=0, le=20)


def measure(record, settings):
    """TET [s]."""
    return worst_vehicle(record, time_exposed(ttc(record), record.time, settings.limit))
