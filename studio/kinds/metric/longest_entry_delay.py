"""Longest time that a car of a flow waited outside since it was due, because there was no room where its way begins.

Those that have not come in when the run is over count too. Who it was is named by a car of that flow.
"""

from studio.assess.census import longest

KIND = "metric"
TITLE = "Longest wait outside"
UNIT = "s"
BETTER = "lower"


def measure(record):
    """Time [s], 0 when nobody has waited."""
    return longest(record, "entered", "outside")
