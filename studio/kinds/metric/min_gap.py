"""Least bumper-to-bumper distance of any recorded vehicle to the vehicle or object ahead; none is left where bodies have touched."""

import numpy as np

from studio.assess.impact import impacts
from studio.assess.search import least_behind
from studio.execution.record import SAME_TIME

KIND = "metric"
TITLE = "Least gap"
UNIT = "m"
BETTER = "higher"
ABOUT = "{0} behind {1}"


def measure(record):
    """Gap [m], 0 with the first collision of a recorded vehicle; nothing when nobody had somebody ahead."""
    hit = min((found for found in impacts(record) if set(found.subject) & set(record.vehicles)), key=lambda each: each.time, default=None)
    return touched(record, hit) if hit else least_behind(record, record.channel("gap"))


def touched(record, hit):
    """A collision as a gap of none: of who had the other one ahead until then, where one had."""
    one, other = hit.subject
    before = max(int(np.searchsorted(record.time, hit.time - SAME_TIME)) - 1, 0)
    is_ahead = other in record.vehicles and record.ahead(record.vehicles.index(other), before) == one
    return hit._replace(value=0.0, subject=(other, one) if is_ahead else (one, other))
