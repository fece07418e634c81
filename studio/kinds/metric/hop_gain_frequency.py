"""Frequency of the greatest gain from car to car: at which rhythm a chain of cars amplifies most.

Of the gain that `hop_gain_peak` tells; studio/assess/string_stability.py says how it is found.
"""

from studio.assess.string_stability import hop_peaks
from studio.kind.metric import Found

KIND = "metric"
TITLE = "Frequency of greatest gain, car to car"
UNIT = "Hz"
BETTER = None
ABOUT = "from {0} to {1}"


def measure(record):
    """Frequency [Hz]; nothing without a chain, or without a disturbance to pass on."""
    peak = max(hop_peaks(record), default=None, key=lambda each: each.gain)
    return Found(peak.frequency, (peak.ahead, peak.behind)) if peak else float("nan")
