"""Greatest gain over frequency from car to car, over all chains.

The ratio of the amplitudes of their accelerations, at the frequencies at which the car ahead was excited (studio/assess/string_stability.py
says how it is found). A string is stable in this sense when no frequency has a gain above 1 (D. Swaroop, J. K. Hedrick, String stability of
interconnected systems, IEEE Trans. Automatic Control 41 (1996) 349).
"""

from studio.assess.string_stability import hop_peaks
from studio.kind.metric import Found

KIND = "metric"
TITLE = "Greatest gain over frequency, car to car"
UNIT = "1"
BETTER = "lower"
ABOUT = "from {0} to {1}"


def measure(record):
    """Gain [1]; nothing without a chain, or without a disturbance to pass on."""
    peak = max(hop_peaks(record), default=None, key=lambda each: each.gain)
    return Found(peak.gain, (peak.ahead, peak.behind)) if peak else float("nan")
