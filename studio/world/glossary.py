"""The glossary of the simulation: every row of every table, for people who read arrays, records or this code.

glossary()   →  Entry, Entry, ...     table by table
markdown()   →  str                   the same as a page
"""

from collections.abc import Iterator
from typing import NamedTuple

from studio.rows import Row, Table
from studio.vehicle.adhesion import ADHESION
from studio.vehicle.command import COMMAND
from studio.vehicle.contact import CONTACT, GROUND
from studio.vehicle.light import LIGHT
from studio.vehicle.parameter import GEARBOX, PARAMETER
from studio.vehicle.state import VEHICLE, WHEEL
from studio.world.mail import MAIL
from studio.world.passes.census import CENSUS, PAIR
from studio.world.passes.neighbour import PLACE
from studio.world.passes.notice import NOTICE
from studio.world.passes.sight import SIGHT
from studio.world.table.chart import CHART
from studio.world.table.lane import GATE
from studio.world.table.mind import DRIVER, MIND, SCRIPT
from studio.world.table.street import COLLISION, LINE, OBSTACLE, PIECE, SWEEP, ZEBRA
from studio.world.table.unit import GPS_SET, HEARD, LOGGED, OUTPUT, SATELLITE, SENSOR, SENT, TROUBLE, UNIT, UNIT_SET

TABLES = (
    VEHICLE, WHEEL, COMMAND, PARAMETER, GEARBOX, GROUND, CONTACT, ADHESION, LIGHT,
    MIND, SCRIPT, DRIVER, UNIT, UNIT_SET, TROUBLE, SATELLITE, GPS_SET, SENSOR, OUTPUT, SENT, HEARD, LOGGED,
    LINE, GATE, PIECE, OBSTACLE, SWEEP, ZEBRA, COLLISION, NOTICE, CENSUS, PAIR, PLACE, MAIL, SIGHT, CHART,
)  # fmt: skip
HEAD = "| Row | Unit | Role | Recorded as | Meaning |\n| --- | --- | --- | --- | --- |"


class Entry(NamedTuple):
    """One row, and the table that it stands in."""

    table: Table
    row: Row


def glossary() -> Iterator[Entry]:
    """All rows."""
    return (Entry(table, row) for table in TABLES for row in table)


def markdown() -> str:
    """All tables, one after the other."""
    return "\n".join(section(table) for table in TABLES)


def section(table: Table) -> str:
    """One table with its heading."""
    lines = [f"| `{row.name}` | {row.unit} | {row.role} | {row.label} | {row.meaning} |" for row in table]
    return "\n".join([f"## {table.name.replace('_', ' ').capitalize()}\n", f"One column per {table.per}.\n", HEAD, *lines, ""])
