"""Frequency of the greatest gain from the first to the last car: at which rhythm a chain of cars amplifies most.

Of the gain that `platoon_gain_peak` tells; studio/assess/string_stability.py says how it is found.
"""

from studio.assess.string_stability import platoon_peaks
from studio.kind.metric import Found

KIND = "metric"
TITLE = "Frequency of greatest gain, whole chain"
UNIT = "Hz"
BETTER = None
ABOUT = "from {0} to {1}"


def measure(record):
    """Frequency [Hz]; nothing without a chain, or without a disturbance to pass on."""
    peak = max(platoon_peaks(record), default=None, key=lambda each: each.gain)
    return Found(peak.frequency, (peak.ahead, peak.behind)) if peak else float("nan")
