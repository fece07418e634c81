"""Greatest deceleration that just avoids a collision with what is ahead while it keeps its speed: DRAC = Δv²/(2 s).

D. F. Cooper, N. Ferguson, Traffic studies at T-junctions, 1976. Above 3 m/s² it is a conflict.
"""

from studio.assess.following import drac, pairs
from studio.assess.search import greatest_behind

KIND = "metric"
TITLE = "Greatest deceleration to avoid a crash"
UNIT = "m/s²"
BETTER = "lower"
ABOUT = "{0} behind {1}"


def measure(record):
    """Deceleration [m/s²]; nothing when nobody had somebody ahead."""
    return greatest_behind(record, drac(pairs(record)))
