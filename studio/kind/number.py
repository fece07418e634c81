"""Settings as numbers: what compiled code gets of a pydantic model, and how it is spelled in a loop that is written for it.

A number is itself, yes and no are 1 and 0, a choice is its place in the list, a fixed-size array stays one.

    numbers(settings)                  →  [60.0, 1.0, 2.0]
    tuple_of(module, Settings)         →  a NamedTuple with the same fields, which belongs to the module
    spelled(Settings, "settings", 0)   →  "settings[0, j], settings[1, j], ..."
"""

from collections import namedtuple
from types import ModuleType
from typing import Annotated, Any, Literal, NamedTuple, get_args, get_origin

from pydantic import BaseModel


class Shape(NamedTuple):
    """A field: how many numbers it holds, 1 for a plain one, and its choices where it is one."""

    name: str
    size: int
    choices: tuple[Any, ...] = ()


def shapes(model: type[BaseModel]) -> list[Shape]:
    """The fields of a model; raises TypeError for one that is no number."""
    return [shape(name, field.annotation) for name, field in model.model_fields.items() if name != "kind"]


def shape(name: str, kind: Any) -> Shape:
    """One field."""
    if get_origin(kind) is Annotated:
        kind = get_args(kind)[0]
    if get_origin(kind) is Literal:
        return Shape(name, 1, get_args(kind))
    if get_origin(kind) is tuple and set(get_args(kind)) <= {float, int} and Ellipsis not in get_args(kind):
        return Shape(name, len(get_args(kind)))
    if kind in (float, int, bool):
        return Shape(name, 1)
    raise TypeError(f"{name} is {getattr(kind, '__name__', kind)}; allowed: float, int, bool, Literal[...], tuple[float, float]")


def numbers(settings: BaseModel) -> list[float]:
    """The values, one after another."""
    return [value for each in shapes(type(settings)) for value in values(each, getattr(settings, each.name))]


def values(of: Shape, value: Any) -> list[float]:
    """Those of one field."""
    if of.choices:
        return [float(of.choices.index(value))]
    return [float(each) for each in value] if of.size > 1 else [float(value)]


def tuple_of(module: ModuleType, model: type[BaseModel]) -> type:
    """The fields as a NamedTuple. It belongs to the module: cached machine code finds it there by name."""
    name = f"{model.__name__}Tuple"
    if name not in vars(module):
        fields = [each.name for each in shapes(model)]  # known at run time only, which the type checker does not expect
        vars(module)[name] = namedtuple(name, fields, module=module.__name__)  # pyrefly: ignore
    return vars(module)[name]


def spelled(sizes: list[int], array: str, column: str = "j", first: int = 0) -> str:
    """Arguments made of the rows of an array, a tuple for each field of several numbers."""
    parts, row = [], first
    for size in sizes:
        rows = [f"{array}[{row + i}, {column}]" for i in range(size)]
        parts.append(rows[0] if size == 1 else f"({', '.join(rows)})")
        row += size
    return ", ".join(parts)
