"""The reference of events, from their declarations."""

from docs.reference.table import code, table
from studio.world.table.event import EVENTS

HEAD = """# Events

What can happen in a run and is told. An event has a time [s], the units that it is about, a place [m], and numbers; its sentence names the
units by their places.
"""


def page() -> str:
    """Every kind of event."""
    rows = [[code(each.name), each.sentence, ", ".join(f"`{name}` [{unit}]" for name, unit in each.numbers.items())] for each in EVENTS]
    return "\n".join([HEAD, table(["event", "sentence", "numbers"], rows)])
