"""Seats: how drivers are asked. All vehicles with one kind of driver are asked in one loop, which is written for that kind.

seats([driver, ...])   →  Seats, Seats, ...     one for each kind
"""

import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from pydantic import BaseModel

from studio.errors import KindError
from studio.kind import loop, registry
from studio.kind.number import numbers, shapes, spelled, tuple_of
from studio.kind.registry import Kind

TEMPLATE = '''"""Asks the driver {name} of every vehicle that has one."""

from studio.compiled import lean
from studio.vehicle.state import ACTIVE
from studio.world.passes.traffic import put, sees
from {module} import SettingsTuple, decide


@lean
def run(columns, settings, state, parameter, mind):
    """What all of them want; how many of the wishes are no numbers."""
    unfit = 0
    for j in range(columns.size):
        v = columns[j]
        if state[ACTIVE, v] != 0.0:
            wish = decide(SettingsTuple({settings}), sees(v, state, parameter, mind))
            unfit += put(v, wish.acceleration, wish.steering, mind)
    return unfit
'''


@dataclass
class Seats:
    """The vehicles with one kind of driver: their columns, and its settings [row, vehicle of these]."""

    kind: Kind
    columns: np.ndarray
    settings: np.ndarray
    run: Callable[..., int]

    def raised(self) -> KindError:
        """What is said of one that raises, with the traceback."""
        return KindError(f"The driver {self.kind.name!r} cannot be asked:\n{traceback.format_exc()}")


def seats(drivers: Sequence[BaseModel]) -> list[Seats]:
    """The drivers of all vehicles, column by column, kind by kind in the order in which they come."""
    columns: dict[str, list[int]] = {}
    for column, each in enumerate(drivers):
        columns.setdefault(each.kind, []).append(column)  # pyrefly: ignore[missing-attribute]
    return [seated(registry.find("driver", name), found, drivers) for name, found in columns.items()]


def seated(kind: Kind, columns: list[int], drivers: Sequence[BaseModel]) -> Seats:
    """Those of one kind."""
    settings = np.array([numbers(drivers[column]) for column in columns]).T.copy()
    return Seats(kind, np.array(columns), settings, written_for(kind).run)


def written_for(kind: Kind) -> ModuleType:
    """The module with the loop of a kind."""
    tuple_of(kind.module, kind.module.Settings)
    arguments = spelled([each.size for each in shapes(kind.module.Settings)], "settings")
    return loop.written(f"driver_{kind.name}", TEMPLATE.format(name=kind.name, module=kind.module.__name__, settings=arguments), kind)
