"""Error of the place that cars in a garage take themselves to be at, while they drive themselves: root of the mean square."""

import numpy as np

from studio.assess.parking import errors, stays

KIND = "metric"
TITLE = "Error of the localisation in the garage"
UNIT = "m"
BETTER = "lower"


def measure(record):
    """Distance [m]; nothing when nobody was handed over."""
    found = [errors(record, stay) for stay in stays(record)]
    return float(np.sqrt(np.mean(np.concatenate(found) ** 2))) if found else float("nan")
