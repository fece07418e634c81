"""Mean time from one reception to the next over the links that applications use; the worst link counts.

With messages every T and independent losses p it is T/(1 - p).
"""

import numpy as np

from studio.assess.freshness import inter_reception
from studio.assess.search import worst_link

KIND = "metric"
TITLE = "Mean time between receptions, worst link"
UNIT = "s"
BETTER = "lower"
ABOUT = "{0} heard by {1}"


def measure(record):
    """Time [s]; nothing without a link on which two messages came."""
    sent, found = record.messages, {}
    for link in sent.links():
        name = f"{sent.units[sent.sender[sent.of[link[0]]]]}→{sent.units[sent.receiver[link[0]]]}"
        times = inter_reception(np.where(sent.is_received[link], sent.came[link], np.inf))
        found[name] = max(found.get(name, 0.0), times.mean()) if times.size else found.get(name, np.nan)
    return worst_link(record, np.array([found.get(name, np.nan) for name in record.links]))
