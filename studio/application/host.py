"""Hosts: how applications are called at every tick.

A compiled application runs in a loop over all its cars; the loop is written for it once, into the cache of compiled code,
because numba can keep machine code only of functions that stand in a file. An ordinary one is called car by car.
Both see the same observation and may return the same commands; so a developer starts in Python and sets COMPILED = True
when the idea holds.
"""

import hashlib
import os
import sys
import traceback
from collections import namedtuple
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import module_from_spec, spec_from_file_location
from math import nan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import literal_unroll

from studio.application.contract import Actuators, Clock, Command, Front, Message, Observation, Own
from studio.cache import touch
from studio.compiled import CACHE, compiled
from studio.errors import ApplicationError
from studio.kind.registry import Kind
from studio.rows import Moving

TEMPLATE = '''"""Calls {name} for all its cars."""

from studio.application.contract import Clock, Front, Message, Observation, Own
from studio.application.host import put
from studio.compiled import compiled
from {module} import Memory, ParameterTuple, decide


@compiled
def run(columns, parameters, memory, observed, commands):
    for j in range(columns.size):
        v = columns[j]
        observation = Observation(
            Clock({clock}),
            Own({own}),
            Front({front}),
            Message({message}),
        )
        remembered, command = decide(ParameterTuple({parameters}), Memory({memory}), observation)
{store}
        put(command, v, commands)
'''
FLAGS = ("detected", "received")


class Group(NamedTuple):
    """An application group of a world: its place among all groups, its name, and which of the hosted cars are its."""

    world: int
    place: int
    name: str
    cars: slice


@dataclass
class Hosted:
    """One application on its cars: columns [car], parameters, memory and observed, [row, car].

    A compiled application is hosted once for all its groups, an ordinary one group by group.
    """

    application: Kind
    groups: list[Group]
    columns: np.ndarray
    links: np.ndarray  # link that each car listens to, -1 when none
    parameters: np.ndarray
    memory: Moving
    observed: Moving
    run: Callable

    def decide(self, commands: np.ndarray) -> None:
        """All its cars decide; their commands go to their columns. Raises ApplicationError with the traceback."""
        try:
            self.run(self.columns, self.parameters, self.memory, self.observed, commands)
        except (Exception, SystemExit) as error:
            names = ", ".join(dict.fromkeys(repr(group.name) for group in self.groups))
            raise ApplicationError(
                f"The application {self.application.name!r} of group {names} raised:\n{traceback.format_exc()}"
            ) from error


def observation_rows() -> list[str]:
    """Names of the rows of `observed`: all fields of an observation, part by part."""
    return [f"{part.__name__.lower()}.{name}" for part in (Clock, Own, Front, Message) for name in part._fields]


def is_compiled(application: Kind) -> bool:
    """Whether `decide` is machine code; else it is called as Python."""
    return hasattr(application.module.decide, "py_func")


def parameter_tuple(application: Kind) -> type:
    """The parameters as a NamedTuple, for `decide`. It belongs to the module: cached machine code finds it there by name."""
    module = application.module
    if "ParameterTuple" not in vars(module):
        fields = list(module.Parameters.model_fields)  # known at run time only, which the type checker does not expect
        made = namedtuple("ParameterTuple", fields, module=module.__name__)  # pyrefly: ignore[bad-class-definition, invalid-argument]
        vars(module)["ParameterTuple"] = made
    return vars(module)["ParameterTuple"]


def first_memory(application: Kind) -> list[float]:
    """What an application remembers before its first tick."""
    return [float(value) for value in application.module.Memory()]


def python_loop(application: Kind) -> Callable:
    """Calls `decide` car by car."""
    module, Parameters = application.module, parameter_tuple(application)

    def run(columns, parameters, memory, observed, commands):
        for j, v in enumerate(columns):
            remembered, command = module.decide(
                Parameters(*parameters[:, j].tolist()),
                module.Memory(*memory[:, j].tolist()),
                observation_of(observed[:, j].tolist()),
            )
            memory[:, j] = memory_of(remembered, module.Memory)
            put.py_func(command_of(command), v, commands)

    return run


@compiled
def put(command, v, commands):
    """Writes a command, whose fields are the first of the actuators or all of them; the rest is left to the driver."""
    commands[:, v] = nan
    i = 0
    for value in literal_unroll(command):
        commands[i, v] = value
        i += 1  # noqa: SIM113 - numba unrolls no enumeration


def memory_of(remembered, kind: type) -> tuple[float, ...]:
    """The memory; raises TypeError when `decide` returned something else."""
    if not isinstance(remembered, kind):
        raise TypeError(f"decide() returned {remembered!r} as its memory, not a {kind.__name__}")
    return remembered


def command_of(command) -> Command | Actuators:
    """The command; raises TypeError when `decide` returned something else."""
    if not isinstance(command, (Command, Actuators)):
        raise TypeError(f"decide() returned {command!r} as its command, not a Command or Actuators")
    return command


def observation_of(values: list[float]) -> Observation:
    """An observation from its row of numbers."""
    parts, start = [], 0
    kinds: tuple[Any, ...] = (Clock, Own, Front, Message)
    for part in kinds:
        fields = dict(zip(part._fields, values[start : start + len(part._fields)], strict=True))
        parts.append(part(**{key: bool(value) if key in FLAGS else value for key, value in fields.items()}))
        start += len(part._fields)
    return Observation(*parts)


def compiled_loop(application: Kind) -> Callable:
    """The loop written for this application, loaded from its file."""
    parameter_tuple(application)
    source = loop_source(application)
    key = hashlib.sha256((source + Path(str(application.module.__file__)).read_text("utf-8")).encode()).hexdigest()[:16]
    path = CACHE / f"host_{application.name}_{key}.py"
    if not path.exists():
        draft = path.with_suffix(f".{os.getpid()}")
        draft.write_text(source, encoding="utf-8")
        draft.replace(path)
    touch(path)
    return load(path).run


def load(path: Path):
    """A module from a file."""
    spec = spec_from_file_location(path.stem, path)
    assert spec and spec.loader, "a file whose name ends in .py has a loader"
    module = module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


def loop_source(application: Kind) -> str:
    """The text of that loop."""
    rows = iter(range(len(observation_rows())))

    def part(fields) -> str:
        return ", ".join(value(name, next(rows)) for name in fields)

    def value(name: str, row: int) -> str:
        return f"observed[{row}, j] > 0.0" if name in FLAGS else f"observed[{row}, j]"

    memory = application.module.Memory._fields
    return TEMPLATE.format(
        name=application.name,
        module=application.module.__name__,
        clock=part(Clock._fields),
        own=part(Own._fields),
        front=part(Front._fields),
        message=part(Message._fields),
        parameters=", ".join(f"parameters[{i}, j]" for i in range(len(application.module.Parameters.model_fields))),
        memory=", ".join(f"memory[{i}, j]" for i in range(len(memory))),
        store="\n".join(f"        memory[{i}, j] = remembered.{name}" for i, name in enumerate(memory)),
    )
