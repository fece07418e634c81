"""Mean load of the radio channel, at the unit where it is greatest: the share of the time in which it was busy.

As ETSI TS 102 687 measures it, over a tenth of a second; of radios on which messages keep the channel busy.
"""

import numpy as np

from studio.kind.metric import Found

KIND = "metric"
TITLE = "Mean channel load where it is greatest"
UNIT = "1"
BETTER = "lower"
LOAD = ".channel_load"


def measure(record):
    """Share [1]; nothing where the channel's load is no matter."""
    loads = {name.removesuffix(LOAD): np.mean(each.values) for name, each in record.probes.items() if name.endswith(LOAD)}
    worst = max(loads, default=None, key=loads.__getitem__)
    return Found(loads[worst], (worst,)) if worst else float("nan")
