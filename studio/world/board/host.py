"""Hosts: how applications see, decide and act at every tick.

A loop over all units of an application is written for it once, from its ports, into the cache of compiled code. That of a compiled
application is compiled; that of an ordinary one is the same text, and runs as Python. So a developer starts in Python and writes
@compiled above `decide` when the idea holds, and nothing else changes.

What an application returns is looked at before anything of it counts: a result that is not finite, out of range or not its to give is a
fault, and the run of that unit's world fails with it.
"""

import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from studio.application import port
from studio.application.port import ACTUATORS, Port
from studio.bound import bound
from studio.errors import ApplicationError, Problem
from studio.kind.quantity import quantities
from studio.kind.registry import Kind
from studio.rows import Moving

NOT_FINITE, OUT_OF_RANGE, NOT_ITS_OWN = 1, 2, 3
REASONS = {NOT_FINITE: "is not finite", OUT_OF_RANGE: "is out of range", NOT_ITS_OWN: "is not among its COMMANDS"}
REMEDIES = {
    NOT_FINITE: "look for a division by zero, or a root of something negative",
    OUT_OF_RANGE: "bound it before it is returned",
    NOT_ITS_OWN: "add the actuator to COMMANDS, or leave it out of the mask",
}


EARLY = 1e-6  # [ticks] by which rounding may make an instant too early


class Group(NamedTuple):
    """An application group of a world: its place among all groups, its name, and which of the hosted units are its."""

    world: int
    place: int
    name: str
    cars: slice


class Wiring(NamedTuple):
    """Where a port of every hosted unit is connected: fields of a sensor or post, and which columns of them, [slot, unit]."""

    port: Port
    owner: Any
    fields: tuple[str, ...]
    columns: tuple[np.ndarray, ...]

    @property
    def arrays(self) -> list[np.ndarray]:
        """All of it, as it is now."""
        return [getattr(self.owner, name) for name in self.fields] + list(self.columns)


@dataclass
class Hosted:
    """One application on its units: columns [unit], parameters and memory, [row, unit]. Several groups share one host if it is compiled."""

    application: Kind
    groups: list[Group]
    unit: np.ndarray
    names: tuple[str, ...]  # of the units
    column: np.ndarray  # of the unit's vehicle, -1 for a station
    rank: np.ndarray  # number of its group among those who may command, as world/commander.py has it
    stopped: np.ndarray  # 1 where the script has stopped it
    parameters: np.ndarray
    memory: Moving
    said: Moving  # what it logs, [row, unit]
    shown: Moving  # number of the notice to the driver
    fault: np.ndarray  # scratch: 0, or which field is wrong and why, or -1 while it decides
    wrong: np.ndarray  # scratch: the value of that field
    wiring: list[Wiring]
    run: Callable
    cycles: int = 1  # how often it decides within a tick
    checked: list[str] = field(default_factory=list)  # names of the fields, as faults count them
    ready: dict[str, Callable] = field(default_factory=dict)  # "run" with all arrays given, once it has been called

    @property
    def shows(self) -> bool:
        """Whether it shows notices to drivers."""
        return any(one.what == port.NOTICE for one in port.done(self.application.module))

    @property
    def log(self) -> list[Any]:
        """The quantities that it logs."""
        return [each for one in port.done(self.application.module) if one.what == port.LOG for each in quantities(one.type)]

    @property
    def is_compiled(self) -> bool:
        """Whether the loop is machine code."""
        return hasattr(self.run, "py_func")

    def given(self, tick: float) -> tuple:
        """What the loop is given besides the arrays of the world, with ticks of so many seconds."""
        return *self.arrays, tick / self.cycles

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """What the loop reads and writes of its own."""
        own = (self.unit, self.column, self.rank, self.stopped, self.parameters, self.memory, self.said, self.shown, self.fault, self.wrong)
        return (*own, *(array for each in self.wiring for array in each.arrays))

    def decide(self, time: float, tick: float, around: tuple[np.ndarray, ...]) -> Iterator["Fault"]:
        """All its units decide at a time [s]; their commands go to their vehicles' columns. Returns what went wrong.

        `around` are the arrays of the world: settings of units, what they know, commands. All arrays stay where they are.
        """
        try:
            if not self.ready:
                self.ready["run"] = bound(self.run, *around, *self.given(tick), then=(time,))
            faults = self.ready["run"](time)
        except (Exception, SystemExit) as error:
            return iter([self.raised(error)])
        return self.faults(time, tick) if faults else iter(())

    def faults(self, time: float, tick: float) -> Iterator["Fault"]:
        """What went wrong, unit by unit."""
        for j in np.flatnonzero(self.fault).tolist():
            number, reason = divmod(int(self.fault[j]), 4)
            name = self.checked[number]
            where = f"{self.application.name} on {self.names[j]}: {name}"
            problem = Problem(where, REASONS[reason], f"{self.wrong[j]:g}", allowed(name), REMEDIES[reason])
            when = f"at tick {int(time / tick + EARLY)} ({time:g} s)"
            who = f"The application {self.application.name!r} on {self.names[j]!r}"
            bounds = f" (allowed: {problem.allowed})" if problem.allowed else ""
            text = f"{who} gave {name} = {self.wrong[j]:g} {when}, which {REASONS[reason]}{bounds}; {problem.remedy}"
            yield Fault((self.group_of(j).world,), ApplicationError(text, [problem]))

    def raised(self, error: BaseException) -> "Fault":
        """An exception, with its traceback and the unit that was deciding."""
        at = np.flatnonzero(self.fault == -1)
        groups = [self.group_of(int(j)) for j in at] or self.groups
        who = f"on {self.names[int(at[0])]!r}" if at.size else "on " + ", ".join(repr(each.name) for each in self.groups)
        text = f"The application {self.application.name!r} {who} raised {type(error).__name__}: {error}\n{traceback.format_exc()}"
        return Fault(tuple(sorted({each.world for each in groups})), ApplicationError(text))

    def group_of(self, j: int) -> Group:
        """The group of a hosted unit."""
        return next(each for each in self.groups if each.cars.start <= j < each.cars.stop)


class Fault(NamedTuple):
    """Something that a kind did wrong: the worlds whose runs fail with it, and what it was."""

    worlds: tuple[int, ...]
    error: ApplicationError


def allowed(name: str) -> str:
    """The range of a field of a command."""
    found = next((each for each in ACTUATORS if name == f"command.{each.name}"), None)
    return f"{found.low:g} to {found.high:g} {found.unit}" if found else ""


def is_compiled(application: Kind) -> bool:
    """Whether `decide` is machine code; else it is called as Python."""
    return hasattr(application.module.decide, "py_func")
