"""Energy at the wheels: the integral of the positive drive power of all recorded vehicles.

What the drive puts in, over how the vehicles went; engines and motors need more, and what brakes take out is not given back
(studio/assess/effort.py).
"""

from studio.assess.effort import energy_of
from studio.assess.total import total

KIND = "metric"
TITLE = "Energy at the wheels"
UNIT = "J"
BETTER = "lower"


def measure(record):
    """Energy [J]."""
    return total(energy_of(record))
