"""Settings as numbers: what compiled code gets of a pydantic model, and how it is spelled in a loop that is written for it.

A number is itself, yes and no are 1 and 0, a choice is its place in the list, a fixed-size array stays one, points (list[tuple[float,
float]] with a max_length) stand one after another, a name (VehicleName and its like) is the column or number of what it names, and what is
left empty is not a number. Pairs that are pooled are where they begin in the pool of the script and how many they are; an area is x, y and
radius of its circle, then the same of its corners. Kinds within kinds are no numbers of the outer one.

    numbers(settings)                  →  [60.0, 1.0, 2.0]
    tuple_of(module, Settings)         →  a NamedTuple with the same fields, which belongs to the module
    spelled([1, 1], "settings")        →  "settings[0, j], settings[1, j]"
"""

from collections import namedtuple
from collections.abc import Callable
from math import nan
from types import ModuleType, NoneType, UnionType
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin

import numpy as np
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from studio.kind.area import Area
from studio.kind.preset import FIELD
from studio.kind.settings import Nested, Pooled, StationOf, marks, named

Find = Callable[[str, Any], Any]  # what is named, and its name, as a number; of pairs and areas as many as they have
POINTS, AREA = "points", "area"
WIDE = {POINTS: 2, AREA: 5}  # numbers that stand for one


def nothing(what: str, name: str) -> float:
    """Of settings that name nothing."""
    raise TypeError(f"nobody knows a {what} {name!r} here")


class Shape(NamedTuple):
    """A field: how many numbers it holds, 1 for a plain one, its choices where it is one, and what it names where it does."""

    name: str
    size: int
    choices: tuple[Any, ...] = ()
    names: str = ""


def shapes(model: type[BaseModel]) -> list[Shape]:
    """The fields of a model; raises TypeError for one that is no number."""
    fields = {name: field for name, field in model.model_fields.items() if name not in ("kind", FIELD) and not marks(field, Nested)}
    return [
        Shape(name, WIDE[POINTS], names=POINTS) if marks(field, Pooled) else shape(name, field.annotation, named(field), longest(field))
        for name, field in fields.items()
    ]


def sizes(model: type[BaseModel]) -> list[int]:
    """How many numbers each field of a model holds."""
    return [each.size for each in shapes(model)]


def longest(field: FieldInfo) -> int:
    """How many entries a list holds at most; 0 where nothing is said."""
    return next((each.max_length for each in field.metadata if hasattr(each, "max_length")), 0)


def shape(name: str, kind: Any, names: str, most: int = 0) -> Shape:
    """One field, which holds so many entries at most where it is a list."""
    kind = plain(kind)
    if names and kind is str:
        return Shape(name, 1, names=names)
    if get_origin(kind) is Literal:
        return Shape(name, 1, get_args(kind))
    if get_origin(kind) is tuple and set(get_args(kind)) <= {float, int} and Ellipsis not in get_args(kind):
        return Shape(name, len(get_args(kind)))
    if kind in (float, int, bool):
        return Shape(name, 1)
    if kind is Area:
        return Shape(name, WIDE[AREA], names=AREA)
    if get_origin(kind) is list and plain(get_args(kind)[0]) == tuple[float, float] and most:
        return Shape(name, 2 * most)
    allowed = "float, int, bool, Literal[...], tuple[float, float], list[tuple[float, float]] with max_length, names such as VehicleName"
    raise TypeError(f"{name} is {getattr(kind, '__name__', kind)}; allowed: {allowed}")


def plain(kind: Any) -> Any:
    """A type without what is said about it, and without the possibility that nothing is there."""
    if get_origin(kind) is Annotated:
        return plain(get_args(kind)[0])
    if get_origin(kind) in (Union, UnionType) and NoneType in get_args(kind) and len(get_args(kind)) == 2:
        return plain(next(each for each in get_args(kind) if each is not NoneType))
    return kind


def unplain(model: type[BaseModel]) -> str:
    """What of some settings is no number; "" when all is."""
    try:
        shapes(model)
    except TypeError as error:
        return str(error)
    return ""


def numbers(settings: BaseModel, find: Find = nothing) -> list[float]:
    """The values, one after another; `find` knows what is named."""
    return [value for each in shapes(type(settings)) for value in values(each, getattr(settings, each.name), find)]


def values(of: Shape, value: Any, find: Find = nothing) -> list[float]:
    """Those of one field."""
    if value is None:
        return [nan] * of.size
    if of.names:
        return list(find(of.names, value)) if of.names in WIDE else [find(of.names, value)]
    if of.choices:
        return [float(of.choices.index(value))]
    given = [float(each) for each in np.ravel(value)]
    return given + [nan] * (of.size - len(given))


def stations(model: type[BaseModel]) -> list[tuple[str, str]]:
    """Which fields are stations on the route of which vehicle: their names."""
    return [(name, mark.field) for name, field in model.model_fields.items() for mark in marks(field, StationOf)]


def row_of(model: type[BaseModel], name: str) -> int:
    """The place of a field's first number among all of them."""
    before = shapes(model)
    return sum(each.size for each in before[: [each.name for each in before].index(name)])


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
