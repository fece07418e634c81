"""Happenings: what happened in a run, as events of the kinds that world/table/event.py declares.

This file imports neither the compiler nor the simulator, so that whoever lists events need not wait for them.
"""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

from studio.world.table.event import EVENTS


class Number(NamedTuple):
    """A number of an event, with its unit."""

    value: float
    unit: str


@dataclass(frozen=True)
class Happening:
    """An event: when [s], of which kind, which units it is about, where [m], its numbers and words; and all of it as a sentence.

    `vehicle` is the first of the units. `kind` is empty where a run was saved before events had kinds.
    """

    time: float
    text: str
    vehicle: str = ""
    kind: str = ""
    units: tuple[str, ...] = ()
    x: float | None = None
    y: float | None = None
    numbers: dict[str, Number] = field(default_factory=dict)
    words: dict[str, str] = field(default_factory=dict)

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return vars(self) | {"units": list(self.units), "numbers": {name: each._asdict() for name, each in self.numbers.items()}}


def happening(
    kind: int, when: float, units: tuple[str, ...] = (), *, place: tuple[float, float] | None = None, **values: float | str
) -> Happening:
    """An event of a kind (world/table/event.py), with its numbers and words."""
    about = EVENTS[kind]
    x, y = place or (None, None)
    return Happening(
        time=round(when, 6),
        text=about.sentence.format(*units, **values),
        vehicle=units[0] if units else "",
        kind=about.name,
        units=units,
        x=x,
        y=y,
        numbers={name: Number(float(values[name]), unit) for name, unit in about.numbers.items()},
        words={name: str(values[name]) for name in about.words},
    )
