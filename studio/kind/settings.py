"""Settings: what may be set, with unit, range and meaning. The parts of a scenario are made of these, and so is every kind.

A field that names something of the scenario says so by its type, and what follows from that follows for every kind: the name must
exist, and compiled code gets the column of what it names.

    vehicle: VehicleName = Field(..., title="Vehicle")
    along: Annotated[float, StationOf("vehicle")] = number(..., unit="m", title="Along its route")
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple, get_args

from pydantic import BaseModel, ConfigDict, Field, field_validator
from pydantic.fields import FieldInfo

from studio.kind import meant


def number(default: Any, *, unit: str, title: str, description: str = "", **bounds: Any) -> Any:
    """A field with a unit."""
    return Field(default, title=title, description=description, json_schema_extra={"unit": unit}, **bounds)


class Part(BaseModel):
    """Base of all parts: unknown fields are refused, numbers must be finite, and no texts or truth values."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, str_strip_whitespace=True)
    is_meant = field_validator("*", mode="before")(classmethod(meant.checked))


def without(part: BaseModel, *names: str, beside: str) -> Any:
    """A part that says where it is by `beside`; refuses what it sets of the other way to say it, which would count for nothing."""
    fields = type(part).model_fields
    idle = [name for name in names if name in part.model_fields_set and getattr(part, name) != fields[name].default]
    if idle:
        told = ", ".join(f"`{name}`" for name in idle)
        raise ValueError(f"{told} would count for nothing beside `{beside}`: leave it out, or say the place the other way")
    return part


# -- names ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Names:
    """Of a text: it names something of the scenario, a vehicle for instance. The JSON schema says so too: `names`."""

    what: str

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        return handler(schema) | {"names": self.what}


@dataclass(frozen=True)
class StationOf:
    """Of a number: it is a station [m] on the route of the vehicle that another field names."""

    field: str


@dataclass(frozen=True)
class Pooled:
    """Of a list of pairs: however long, it stands in the pool of the script, and not among the numbers of the settings."""


@dataclass(frozen=True)
class Nested:
    """Of a field: kinds of a sort stand in it, which have settings of their own."""

    sort: str


Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=40)]
VehicleName = Annotated[Name, Names("vehicle")]
UnitName = Annotated[Name, Names("unit")]
RouteName = Annotated[Name, Names("route")]
EntryName = Annotated[Name, Names("entry")]
BodyName = Annotated[Name, Names("body")]  # a vehicle, or a mover that an entry of the script brings
GroupName = Annotated[Name, Names("application")]
MessageName = Annotated[Name, Names("message")]
SignalName = Annotated[str, Field(max_length=100), Names("signal")]  # a road with lights at its end
ValueName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*(\.[A-Za-z0-9][A-Za-z0-9_]*)+$", max_length=120), Names("value")]


class Reference(NamedTuple):
    """A name in a document: where it stands, what it names, and the name."""

    path: str
    what: str
    name: str


def references(part: BaseModel, path: str = "") -> Iterator[Reference]:
    """Every name in a part and in the parts within it."""
    for name, field in type(part).model_fields.items():
        yield from within(getattr(part, name), named(field), f"{path}.{name}" if path else name)


def within(value: Any, what: str, path: str) -> Iterator[Reference]:
    """The names in a value, which stands in a field that names `what`."""
    if isinstance(value, BaseModel):
        yield from references(value, path)
    elif isinstance(value, dict | list | tuple):
        for key, each in value.items() if isinstance(value, dict) else enumerate(value):
            yield from within(each, what, f"{path}.{key}")
    elif what and isinstance(value, str):
        yield Reference(path, what, value)


def inner(part: BaseModel) -> Iterator[tuple[str, Any]]:
    """The kinds that stand in the fields of a part, each with the path to it."""
    for name, field in type(part).model_fields.items():
        if marks(field, Nested):
            value = getattr(part, name)
            yield from ((f"{name}.{i}", each) for i, each in enumerate(value)) if isinstance(value, list) else [(name, value)]


def named(field: FieldInfo) -> str:
    """What a field names; "" when nothing."""
    found = marks(field, Names)
    return found[0].what if found else ""


def marks(field: FieldInfo, kind: type) -> list[Any]:
    """What is said about a field by its type."""
    return [each for each in (*field.metadata, *nested(field.annotation)) if isinstance(each, kind)]


def nested(annotation: Any) -> Iterator[Any]:
    """What is said about the members of a union or the entries of a list."""
    for each in get_args(annotation):
        yield from getattr(each, "__metadata__", ())
        yield from nested(each)
