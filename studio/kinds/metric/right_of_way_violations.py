"""Conflicts of right of way in which the one that goes first was hindered.

It braked harder than 3 m/s² while it minded the other, or came to a place where ways cross less than 0.5 s after the other had left it, or
before. StVO § 8 (2): who gives way may go on only when he neither endangers nor substantially hinders. Of all vehicles, traffic included.
"""

from studio.assess.census import number_of

KIND = "metric"
TITLE = "Violations of right of way"
UNIT = "1"
BETTER = "lower"
ABOUT = "{0} before {1}"


def measure(record):
    """Number [1]; about the first."""
    return number_of(record, "violation")
