"""Time exposed time-to-collision: for how long all recorded vehicles together were nearer to a collision than 1.5 s.

M. M. Minderhoud, P. H. L. Bovy, Extended time-to-collision measures for road traffic safety assessment, Accident Analysis and Prevention
33 (2001) 89: unlike the least time to collision it tells one short moment from a long stretch of danger.
"""

import numpy as np

from studio.assess.following import ttc

KIND = "metric"
TITLE = "Time exposed to a short time to collision"
UNIT = "s"
BETTER = "lower"
DANGER = 1.5  # [s]


def measure(record):
    """Vehicle seconds [s]; nothing for a record of one sample."""
    if record.time.size < 2:
        return float("nan")
    return np.count_nonzero(ttc(record) < DANGER) * (record.time[1] - record.time[0])
