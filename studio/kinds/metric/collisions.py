"""Pairs of vehicles, traffic included, whose bodies touched."""

from studio.world.table.event import EVENTS, HIT

KIND = "metric"
TITLE = "Collisions"
UNIT = "1"
BETTER = "lower"


def measure(record):
    """Number of pairs [1]."""
    return sum(event.kind == EVENTS[HIT].name for event in record.happenings)
