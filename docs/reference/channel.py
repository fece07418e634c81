"""What can be recorded, and the rows of the arrays."""

from docs.reference.table import code, table
from studio.rows import Table
from studio.world import channel
from studio.world.glossary import TABLES

HEAD = """# Channels and rows

## Channels

What is recorded of every named vehicle, as `vehicle.channel`: in Python `run.trace("follower_1.speed")`, over REST
`/api/runs/1/trace?channels=follower_1.speed`. `recording.channels` of a scenario chooses those that are kept.
"""
ROWS = """## Rows

The simulated world is arrays shaped [quantity, entity], float64. These are their rows, in order, in SI units.
"""
RECORDED = ("name", "unit", "meaning")
STORED = ("name", "unit", "role", "recorded as", "meaning")


def page() -> str:
    """Channels, then rows."""
    channels = table(RECORDED, [[code(each.name), each.unit, each.label] for each in channel.catalogue().values()])
    return "\n".join([HEAD, channels, ROWS, *map(rows, TABLES)])


def rows(listed: Table) -> str:
    """One table of rows."""
    head = f"### {listed.name.replace('_', ' ').capitalize()}\n\nOne column per {listed.per}.\n\n"
    return head + table(STORED, [[code(each.name), each.unit, each.role, each.label, each.meaning] for each in listed])
