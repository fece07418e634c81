"""The catalogue as tables: one row per vehicle, one row per value of a vehicle; as texts, and as JSON.

`list_rows` and `value_rows` are texts under the heads LIST_HEAD and VALUE_HEAD; `list_json` and `value_json` hold the same with
numbers in SI.
"""

from collections.abc import Iterable
from typing import Any

from studio.scenario import catalogue, edit
from studio.scenario.catalogue import VehicleModel
from studio.scenario.datasheet import quantities, sections
from studio.scenario.figures import drive, figures, peak_power
from studio.scenario.vehicle import Vehicle

LIST_HEAD = ("name", "title", "mass", "wheelbase", "drive", "power", "gears", "tyres")
VALUE_HEAD = ("path", "title", "value", "unit", "origin", "source", "range")
TEXTS = ("title", "description", "licence", "tyres.front", "tyres.rear", "engine.kind", "coupling.kind")


def list_rows() -> list[list[str]]:
    """The vehicles of the catalogue, under LIST_HEAD."""
    return [
        [
            each["name"], each["title"], f"{each['mass']:.0f} kg", f"{each['wheelbase']:.2f} m", each["drive"],
            f"{each['power'] / 1e3:.0f} kW", f"{each['gears']}, {each['coupling']}", ", ".join(each["tyres"]),
        ]
        for each in list_json()
    ]  # fmt: skip


def list_json() -> list[dict[str, Any]]:
    """The vehicles of the catalogue; mass [kg], wheelbase [m], power [W]."""
    return [overview(catalogue.find_vehicle(name)) for name in catalogue.vehicle_names()]


def overview(model: VehicleModel) -> dict[str, Any]:
    """A vehicle in a line."""
    values = model.values
    return {
        "name": model.name,
        "title": values.title,
        "mass": values.body.mass,
        "wheelbase": values.body.wheelbase,
        "drive": drive(values),
        "engine": values.engine.kind,
        "power": peak_power(values.engine)[0],
        "gears": len(values.gearbox.ratios),
        "coupling": values.coupling.kind,
        "tyres": list(dict.fromkeys((values.tyres.front, values.tyres.rear))),
    }


def value_rows(model: VehicleModel) -> list[list[str]]:
    """Every value of a vehicle, under VALUE_HEAD."""
    return [
        [
            each["path"], each["title"], shown(each["value"]), each["unit"], each["origin"], each["source"],
            " to ".join(shown(limit) for limit in each["range"] or ()),
        ]
        for each in value_json(model)
    ]  # fmt: skip


def value_json(model: VehicleModel) -> list[dict[str, Any]]:
    """Every value of a vehicle with its provenance; the range is None where none is given. Texts have no unit and no origin.

    At the end stand figures that follow from the values.
    """
    document = model.values.model_dump()
    texts = [row(path, text_title(path), edit.get(document, path)) for path in TEXTS]
    given = [quantity_row(model, path, edit.get(document, path)) for path in quantities()]
    return texts + given + [row(f"figures.{each.name}", each.title, each.value, each.unit, "computed") for each in figures(model.values)]


def quantity_row(model: VehicleModel, path: str, value: float | list[float]) -> dict[str, Any]:
    """A quantity with its provenance."""
    origin = model.origins[path]
    limits = list(origin.range) if origin.range else None
    return row(path, quantities()[path].title, value, origin.unit, origin.origin, origin.source, limits)


def row(path: str, title: str, value: Any, unit="", origin="", source="", limits: list[float] | None = None) -> dict[str, Any]:
    """A value under VALUE_HEAD."""
    return dict(zip(VALUE_HEAD, (path, title, value, unit, origin, source, limits), strict=True))


def text_title(path: str) -> str:
    """Title of a text of the schema."""
    part, _, name = path.rpartition(".")
    return (sections()[part] if part else Vehicle).model_fields[name].title or name.capitalize()


def shown(value: Any) -> str:
    """A text, a number or a list of numbers; numbers with five digits, large ones without exponent.

    >>> shown([0.0, 1225.8878, 189785.5]), shown(0.0034325)
    ('0, 1225.9, 189786', '0.0034325')
    """
    if isinstance(value, str):
        return value
    if isinstance(value, Iterable):
        return ", ".join(shown(each) for each in value)
    return f"{value:.0f}" if 1e5 <= abs(value) < 1e15 else f"{value:.5g}"
