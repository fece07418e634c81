"""Tables of rows: what the arrays hold, every quantity declared once, in one line.

    BODY = Table("body", Role.STATE, per="vehicle")
    X = BODY.row("x", "m", "east position", label="East position")

An array of this table is float64[len(BODY), vehicles], and `X` is the number of its first row, a plain integer: compiled code
takes it as a constant. The name stands at the borders, with unit and meaning. A row with a label can be recorded.

A field that holds such an array is declared as `Moving` where the array changes during a run: it is part of every snapshot.
"""

from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import Annotated, NamedTuple, overload

import numpy as np

MOVES = "moves"
Moving = Annotated[np.ndarray, MOVES]


class Role(StrEnum):
    """What a quantity is to the simulation. The four kinds of data never mix."""

    STATE = "state"  # carried from step to step, or from tick to tick
    DERIVED = "derived"  # made anew from state, parameters and commands
    COMMAND = "command"  # asked for
    PARAMETER = "parameter"  # fixed during a run
    SCRATCH = "scratch"  # what one pass hands to the next
    RECORD = "record"  # what has been found, for whoever reads it


class Row(NamedTuple):
    """One quantity: its name at the borders, unit, meaning and role; its label where it can be recorded."""

    name: str
    unit: str
    meaning: str
    role: Role
    label: str = ""


class Table(Sequence[Row]):
    """The rows of one kind of array, and what its columns stand for."""

    def __init__(self, name: str, role: Role, *, per: str):
        self.name, self.role, self.per = name, role, per
        self.rows: list[Row] = []

    def row(self, name: str, unit: str, meaning: str, *, role: Role | None = None, label: str = "") -> int:
        """Declares the next row and returns its number. The role is the table's unless given. Raises ValueError."""
        if name in {row.name for row in self.rows}:
            raise ValueError(f"table {self.name!r} has a row {name!r} already")
        self.rows.append(Row(name, unit, meaning, role or self.role, label))
        return len(self.rows) - 1

    def block(self, name: str, count: int, unit: str, meaning: str) -> int:
        """Declares `count` rows of one kind, name_0 to name_{count - 1}, and returns the number of the first."""
        first, *_ = [self.row(f"{name}_{i}", unit, meaning) for i in range(count)]
        return first

    @overload
    def __getitem__(self, place: int) -> Row: ...
    @overload
    def __getitem__(self, place: slice) -> Sequence[Row]: ...
    def __getitem__(self, place):
        return self.rows[place]

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)
