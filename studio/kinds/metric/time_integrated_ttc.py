"""How long and how deep one vehicle was below a time to collision: TIT = ∫ (TTC* - TTC)⁺ dt; the worst one counts.

M. M. Minderhoud, P. H. L. Bovy, Extended time-to-collision measures for road traffic safety assessment, Accident Analysis and Prevention
33 (2001) 89.
"""

from studio.assess.following import time_integrated, ttc
from studio.assess.search import worst_vehicle
from studio.kind.metric import Scope
from studio.kind.settings import number

KIND = "metric"
TITLE = "Time integrated below a time to collision"
UNIT = "s²"
BETTER = "lower"


class Settings(Scope):
    """From when on it counts."""

    limit: float = number(3.0, unit="s", title="Limit", description="shorter times to collision count", gt=0, le=20)


def measure(record, settings):
    """TIT [s²]."""
    return worst_vehicle(record, time_integrated(ttc(record), record.time, settings.limit))
