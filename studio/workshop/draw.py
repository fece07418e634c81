"""Drawn inputs: settings within their bounds, numbers as their units have them, and records of drives that nobody has driven."""

import math
from contextlib import suppress
from dataclasses import replace
from types import ModuleType
from typing import Any, get_origin

import numpy as np
from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from studio.execution.record import Body, Chain, Record
from studio.kind.area import Area
from studio.kind.number import AREA, POINTS, numbers, plain, shapes, tuple_of
from studio.kind.quantity import Quantity, quantities
from studio.kind.settings import Nested, Pooled, marks, named
from studio.world.channel import CHANNELS

WIDE = 10.0  # times its first value, how far a number without an upper bound is drawn
UNBOUND = 300.0  # how far one is drawn that has no first value either
TRIES = 500
NAMES = tuple("abcdefghijklmnopqrstuvwxyz")  # of drawn cars
STAGE: dict[str, Any] = {
    "vehicle": "own", "unit": "own", "route": "along", "entry": "first", "road": "motorway", "body": "ahead", "value": "own.speed",
    "message": "awareness",
}  # fmt: skip
OTHERS = {"body": "behind", "unit": "far"}  # where settings name two of a sort
POOL = np.array([np.arange(0.0, 40.0), np.linspace(10.0, 30.0, 40)])  # of pairs, where settings are told apart from their lists
USUAL = {  # range of a quantity by its unit, wider than any that is met
    "m": (-10.0, 300.0), "m/s": (-10.0, 60.0), "m/s²": (-10.0, 6.0), "rad": (-0.6, 0.6), "rad/s": (-1.0, 1.0), "1/m": (-0.1, 0.1),
    "s": (0.0, 100.0), "rad s²/m": (0.0, 0.01),
}  # fmt: skip


def settings(model: type[BaseModel], draw: np.random.Generator) -> BaseModel:
    """Drawn settings; raises ValidationError when no drawn ones fit together."""
    for _ in range(TRIES):
        with suppress(ValidationError):
            return model.model_validate(given(model, draw))
    return model.model_validate(given(model, draw))


def given(model: type[BaseModel], draw: np.random.Generator) -> dict[str, Any]:
    """A drawn value for every field, each for itself; names are those of the stage."""
    schema, met = model.model_json_schema()["properties"], set()
    found = {}
    for name, field in model.model_fields.items():
        what = named(field)
        found[name] = staged(what, schema[name], what in met) or whole(field, draw) or value(schema[name], draw, name)
        met.add(what)
    return found


def whole(field: FieldInfo, draw: np.random.Generator) -> Any:
    """What is more than a number: conditions, areas and lists of pairs; None for another field."""
    kind = plain(field.annotation)
    if marks(field, Nested):
        found = [{"kind": "time", "at": float(draw.uniform(0.0, 5.0))} for _ in range(2)]
        return found if get_origin(kind) is list else found[0]
    if kind is Area:
        return {"x": float(draw.uniform(200.0, 500.0)), "y": 0.0, "radius": float(draw.uniform(1.0, 200.0))}
    return [(10.0 * i, float(draw.uniform(0.0, 30.0))) for i in range(4)] if marks(field, Pooled) else None


def staged(what: str, node: dict[str, Any], is_second: bool) -> Any:
    """The name of the stage for a field that names something, another one for a second; a list of names stays as it is at first."""
    return None if node.get("type") == "array" else (OTHERS.get(what) if is_second else None) or STAGE.get(what)


def settings_tuple(module: ModuleType, settings: BaseModel) -> Any:
    """Settings as compiled code gets them."""
    rows = iter(numbers(settings, lambda what, name: DRAWN.get(what, 0.0)))
    sizes = [each.size for each in shapes(type(settings))]
    return tuple_of(module, type(settings))(*[next(rows) if size == 1 else tuple(next(rows) for _ in range(size)) for size in sizes])


DRAWN = {POINTS: (0.0, 4.0), AREA: (300.0, 0.0, 50.0, 0.0, 0.0)}  # as pairs of the pool, as a circle


def quantity_tuple(of: type, draw: np.random.Generator) -> Any:
    """A NamedTuple of quantities with drawn values; what is infinite at first is so now and then."""
    return of(*[quantity(each, draw) for each in quantities(of)])


def quantity(each: Quantity, draw: np.random.Generator) -> Any:
    """A drawn value of one."""
    if each.is_flag:
        return bool(draw.integers(2))
    if each.size > 1:
        return tuple(by_unit(each.unit, draw) for _ in range(each.size))
    return each.default if math.isinf(each.default) and draw.random() < 0.5 else by_unit(each.unit, draw)


def by_unit(unit: str, draw: np.random.Generator) -> float:
    """A number as a unit usually has it; zero now and then."""
    return float(draw.uniform(*USUAL.get(unit, (-1.0, 1.0)))) if draw.random() < 0.95 else 0.0


def value(node: dict[str, Any], draw: np.random.Generator, name: str) -> Any:
    """A value for a field of a schema: a number between its bounds, yes or no, one of several; else what it is at first."""
    if "enum" in node:
        return node["enum"][draw.integers(len(node["enum"]))]
    numbers_or_none = [each for each in node.get("anyOf", []) if each.get("type") == "number"]
    if numbers_or_none and draw.random() < 0.5:
        return value(numbers_or_none[0], draw, name)
    if node.get("type") == "boolean":
        return bool(draw.integers(2))
    if node.get("type") == "integer":
        least, most = bounds(node)
        return int(draw.integers(int(np.ceil(least)), int(most) + 1))
    if node.get("type") == "number":
        return float(draw.uniform(*bounds(node)))
    return node["default"] if "default" in node else STAGE.get(name, name)


def bounds(node: dict[str, Any]) -> tuple[float, float]:
    """Between which values a number is drawn."""
    far = WIDE * max(abs(node["default"] or 0.0), 1.0) if "default" in node else UNBOUND / 2.0
    least = node.get("minimum", node.get("exclusiveMinimum", -far))
    return least, node.get("maximum", node.get("exclusiveMaximum", least + 2.0 * far))


def record(period: float = 0.02, **channels: Any) -> Record:
    """A record of cars a, b, c ... for a test: channels by name, float64[vehicle, sample], the others zero; no gap means nobody ahead.

    >>> record(speed=[[20.0, 20.0], [19.0, 18.0]]).channel("speed").shape
    (2, 2)
    """
    vehicles, samples = np.broadcast_shapes((1, 1), *[np.shape(each) for each in channels.values()])
    values = np.zeros((len(CHANNELS), vehicles, samples))
    names = [each.name for each in CHANNELS]
    values[names.index("gap")], values[names.index("ahead")], values[names.index("minded")] = np.nan, -1.0, -1.0
    for name, each in channels.items():
        values[names.index(name)] = each
    cars: tuple[str, ...] = NAMES[:vehicles]
    bodies, called = dict.fromkeys(cars, Body(4.5, 1.8, 2.2, 1500.0, 0.3)), dict(enumerate(cars))
    return Record(period * np.arange(samples), values, cars, (), bodies=bodies, called=called)


def drive(draw: np.random.Generator, cars: int, samples: int) -> Record:
    """A record of a chain of cars that nobody has driven, in ranges that are usual; now and then nobody is ahead."""
    made: dict[str, Any] = {each.name: draw.normal(size=(cars, samples)) for each in CHANNELS}
    ahead = draw.random((cars, samples)) < 0.9
    made |= {"speed": draw.uniform(0.0, 40.0, (cars, samples)), "gap": np.where(ahead, draw.uniform(0.5, 100.0, (cars, samples)), np.nan)}
    made["ahead"] = np.where(ahead, np.arange(cars)[:, None] - 1.0, -1.0)
    ages = draw.uniform(0.0, 1.0, (1, samples))
    chain = Chain("chain", "", NAMES[:cars])
    return replace(record(**made), chains=(chain,), links=("a→b",), ages=ages)
