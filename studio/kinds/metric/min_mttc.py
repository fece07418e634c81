"""Least time to collision while both keep their accelerations: MTTC, the least positive root of s = Δv t + Δa t²/2.

K. Ozbay et al., Derivation and validation of new simulation-based surrogate safety measure, Transportation Research Record 2083 (2008) 105.
"""

from studio.assess.following import mttc, pairs
from studio.assess.search import least_behind

KIND = "metric"
TITLE = "Least time to collision with accelerations"
UNIT = "s"
BETTER = "higher"
ABOUT = "{0} behind {1}"


def measure(record):
    """MTTC [s]; nothing when nobody would ever have met anybody."""
    return least_behind(record, mttc(pairs(record)))
