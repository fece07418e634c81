"""What can be recorded, and the rows of the arrays."""

from docs.reference.table import code, table
from studio.world import channel, state

HEAD = """# Channels and rows

## Channels

What is recorded of every named vehicle, as `vehicle.channel`: in Python `run.trace("follower_1.speed")`, over REST
`/api/runs/1/trace?channels=follower_1.speed`. `recording.channels` of a scenario chooses those that are kept.
"""
ROWS = """## Rows

The simulated world is arrays shaped [quantity, entity], float64. These are their rows, in order, in SI units.
"""
RECORDED = ("name", "unit", "meaning")


def page() -> str:
    """Channels, then rows."""
    channels = table(RECORDED, [[code(each.name), each.unit, each.label] for each in channel.BY_NAME.values()])
    return "\n".join([HEAD, channels, ROWS, *(rows(name, each) for name, each in tables().items())])


def tables() -> dict[str, tuple[state.Row, ...]]:
    """The tables of rows by the name that they have in the code."""
    return {name: each for name, each in vars(state).items() if isinstance(each, tuple) and each and isinstance(each[0], state.Row)}


def rows(name: str, listed: tuple[state.Row, ...]) -> str:
    """One table of rows."""
    return f"### {name}\n\n" + table(RECORDED, [[code(each.name), each.unit, each.meaning] for each in listed])
