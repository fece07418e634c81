"""Settings as compiled code takes them: a NamedTuple of plain numbers.

A number stays one, yes and no are 1 and 0, a choice is its place in the list, a name is the column or number of what it names, and
what is left empty is not a number.
"""

from collections import namedtuple
from collections.abc import Callable
from math import nan
from types import ModuleType
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from studio.kind.settings import StationOf, marks, named

Find = Callable[[str, str], float]  # what is named, and its name, as a number


def settings_tuple(module: ModuleType) -> type:
    """The NamedTuple of a kind's settings. It belongs to the module: cached machine code finds it there by name."""
    if "SettingsTuple" not in vars(module):
        fields = list(module.Settings.model_fields)  # known at run time only, which the type checker does not expect
        made = namedtuple("SettingsTuple", fields, module=module.__name__)  # pyrefly: ignore[bad-class-definition, invalid-argument]
        vars(module)["SettingsTuple"] = made
    return vars(module)["SettingsTuple"]


def plain(settings: BaseModel, module: ModuleType, find: Find) -> list[float]:
    """The numbers of some settings of a kind, in the order of its fields."""
    return [as_number(getattr(settings, name), field, find) for name, field in module.Settings.model_fields.items()]


def as_number(value: Any, field: FieldInfo, find: Find) -> float:
    """The number for a value."""
    if value is None:
        return nan
    if isinstance(value, str):
        return find(named(field), value) if named(field) else float(choices(field.annotation).index(value))
    return float(value)


def unfit(model: type[BaseModel]) -> str:
    """What of some settings is no plain number; "" when all is."""
    return next((f"{name}: {what}" for name, field in model.model_fields.items() if (what := unfit_field(field))), "")


def unfit_field(field: FieldInfo) -> str:
    """What is wrong with one of them."""
    kinds = [each for each in members(field.annotation) if each is not type(None)]
    fits = named(field) or choices(field.annotation) or all(each in (float, int, bool) for each in kinds)
    return "" if fits else f"is {field.annotation}; compiled code takes numbers, yes or no, Literal choices, and names such as VehicleName"


def members(annotation: Any) -> list[Any]:
    """The alternatives of a type, without what is said about them."""
    if hasattr(annotation, "__metadata__"):
        return members(get_args(annotation)[0])
    if get_origin(annotation) is Literal or not get_args(annotation):
        return [annotation]
    return [inner for each in get_args(annotation) for inner in members(each)]


def choices(annotation: Any) -> list[str]:
    """The texts that a field may hold."""
    return [text for each in members(annotation) if get_origin(each) is Literal for text in get_args(each)]


def stations(module: ModuleType) -> list[tuple[int, int]]:
    """Which numbers are stations on the route of which vehicle, as places among the fields."""
    fields = module.Settings.model_fields
    order = list(fields)
    return [(order.index(name), order.index(mark.field)) for name, field in fields.items() for mark in marks(field, StationOf)]
