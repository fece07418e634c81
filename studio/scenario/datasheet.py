"""Reading a vehicle file (YAML): its values, where each comes from, and everything that is wrong, with its line.

    text → source (plain values and their places) → leaves: value in the schema's unit, and origin → Vehicle

A quantity of the schema stands in a file as a leaf, complete with its provenance, or as a plain number:

    mass: {value: 860, unit: kg, origin: published, source: "Massow & Radusch 2018, Table 4", range: [800, 900]}
    mass: 860

A plain number counts in the schema's unit, as estimated, its source as not given. A leaf's unit must be the schema's; for
rad/s and rad, revolutions per minute (1/min or rpm) and degrees (deg) are read as well and converted, and the source says so.
"""

import math
import reprlib
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, get_args

from pydantic import ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from studio.errors import Problem, ScenarioError, nearest
from studio.errors import short as of_value
from studio.scenario import file, finding
from studio.scenario.text.source import Source
from studio.scenario.vehicle import ORIGINS, RPM, Origin, Part, Vehicle

SIZE_LIMIT = 1_000_000  # [B] of a vehicle file; those of the catalogue have some 15 kB
READ_AS_WELL = {"rad/s": {"1/min": RPM, "rpm": RPM}, "rad": {"deg": math.pi / 180}}  # factors to the schema's unit
LEAF = ("value", "unit", "origin", "source", "range")
NEEDED = LEAF[:4]
ASSUMED = "not given"  # source of a plain number
FIRST = "left out: as the property file of the tyre has it"  # source of a value that a file need not give
FIRST_RANGE = (0.5, 1.5)  # of such a scale on a car
SHORT = reprlib.Repr()
SHORT.maxlevel = 2  # aliases can nest a few bytes into gigabytes


@dataclass(frozen=True)
class Quantity:
    """A field of the schema that has a unit: its title, what is allowed, and how many numbers it takes when it is a list."""

    unit: str
    title: str
    allowed: str
    count: str


@cache
def quantities() -> dict[str, Quantity]:
    """All quantities of a vehicle by path, in the schema's order."""
    return {
        f"{section}.{name}": quantity(field)
        for section, part in sections().items()
        for name, field in part.model_fields.items()
        if unit_of(field)
    }


def sections() -> dict[str, type[Part]]:
    """Parts of a vehicle by name."""
    fields = Vehicle.model_fields.items()
    return {name: part for name, field in fields if isinstance(part := field.annotation, type) and issubclass(part, Part)}


def quantity(field: FieldInfo) -> Quantity:
    """A field of the schema as a quantity."""
    is_list = field.annotation is not float
    limits = get_args(field.annotation)[0].__metadata__[0].metadata if is_list else field.metadata
    unit = unit_of(field)
    allowed = " and ".join(bound(each) for each in limits) + with_unit(unit)
    return Quantity(unit, field.title or "", allowed, "" if not is_list else counted(field))


def unit_of(field: FieldInfo) -> str:
    """The unit that stands beside a field in the schema."""
    extra = field.json_schema_extra
    return str(extra["unit"]) if isinstance(extra, dict) else ""


def bound(constraint: Any) -> str:
    """A bound of the schema as text."""
    name, sign = next(pair for pair in (("ge", "≥"), ("gt", ">"), ("le", "≤"), ("lt", "<")) if hasattr(constraint, pair[0]))
    return f"{sign} {getattr(constraint, name):g}"


def counted(field: FieldInfo) -> str:
    """How many numbers a list may hold, as text."""
    least, most = (next(getattr(each, name) for each in field.metadata if hasattr(each, name)) for name in ("min_length", "max_length"))
    return f"{least} numbers" if least == most else f"{least} to {most} numbers"


def with_unit(unit: str) -> str:
    """A unit behind a number; nothing for 1."""
    return "" if unit == "1" else f" {unit}"


@dataclass(frozen=True)
class Datasheet:
    """What a vehicle file says."""

    values: Vehicle
    origins: dict[str, Origin]


def read(path: Path) -> Datasheet:
    """The vehicle in a file; raises ScenarioError with everything that is wrong."""
    return parse(file.content(path, "vehicle", SIZE_LIMIT), str(path))


def parse(data: bytes, where: str) -> Datasheet:
    """The vehicle in a YAML text; raises ScenarioError with everything that is wrong."""
    sheet = Leaves(file.mapping(data, where, "vehicle"))
    plain = sheet.taken(sheet.source.value)
    values = validated(plain, sheet)
    if values is None or sheet.problems:
        found = sorted(sheet.problems, key=lambda each: each[0])
        raise ScenarioError(f"{where} is not a valid vehicle.", [problem for _, problem in found])
    return Datasheet(values, left_out(sheet.origins))


def left_out(origins: dict[str, Origin]) -> dict[str, Origin]:
    """Origins of all quantities: what a file need not say has its first value."""
    return {path: origins.get(path, Origin(each.unit, "estimated", FIRST, FIRST_RANGE)) for path, each in quantities().items()}


@dataclass
class Leaves:
    """Takes the leaves of a document apart: plain values for the schema, origins, and what is wrong with the leaves.

    units    what a file's unit must be multiplied with, by path, where it is not the schema's
    spoilt   paths whose value could not be taken; they are told already
    """

    source: Source
    origins: dict[str, Origin] = field(default_factory=dict)
    units: dict[str, tuple[str, float]] = field(default_factory=dict)
    spoilt: set[str] = field(default_factory=set)
    problems: list[tuple[tuple[int, int], Problem]] = field(default_factory=list)

    def taken(self, document: dict[str, Any]) -> dict[str, Any]:
        """The document with plain values in place of leaves."""
        plain = dict(document)
        for section in sections():
            if isinstance(document.get(section), dict):
                plain[section] = self.section(section, document[section])
        return plain

    def section(self, section: str, fields: dict[str, Any]) -> dict[str, Any]:
        """A section with plain values; what is no quantity stays as it is."""
        plain = {}
        for name, given in fields.items():
            path = f"{section}.{name}"
            known = quantities().get(path)
            value = self.leaf(path, known, given) if known else given
            if path not in self.spoilt:
                plain[name] = value
        return plain

    def leaf(self, path: str, known: Quantity, given: Any) -> Any:
        """The value of a leaf in the schema's unit; notes its origin, or what is wrong with it."""
        if not isinstance(given, dict):
            self.origins[path] = Origin(known.unit, "estimated", ASSUMED)
            return given
        for key in given:
            if key not in LEAF:
                self.refuse(f"{path}.{key}", "is no part of a value", allowed=", ".join(LEAF), remedy=nearest(str(key), LEAF))
        for key in NEEDED:
            if key not in given:
                self.refuse(path, f"has no {key}", remedy=f"add {key}" + (f": {known.unit}" if key == "unit" else ""))
        factor = self.factor(path, known, given)
        if factor is None or "value" not in given:
            self.spoilt.add(path)
            return None
        self.provenance(path, known, given, factor)
        return scaled(given["value"], factor)

    def factor(self, path: str, known: Quantity, given: dict[str, Any]) -> float | None:
        """What turns the leaf's unit into the schema's; None when it cannot."""
        unit = given.get("unit", known.unit)
        factors = {known.unit: 1.0, **READ_AS_WELL.get(known.unit, {})}
        said = "1" if unit == 1 else unit  # the unit 1 is a number in YAML
        if not isinstance(said, str) or said not in factors:
            self.refuse(f"{path}.unit", "is not the unit of this value", short(unit), " or ".join(factors))
            return None
        if factors[said] != 1.0:
            self.units[path] = said, factors[said]
        return factors[said]

    def provenance(self, path: str, known: Quantity, given: dict[str, Any], factor: float) -> None:
        """Notes where a value comes from, and what is wrong with that."""
        origin, source = given.get("origin", "estimated"), given.get("source", ASSUMED)
        if origin not in ORIGINS:
            self.refuse(f"{path}.origin", "is not an origin", short(origin), ", ".join(ORIGINS))
        if not isinstance(source, str) or not source.strip():
            self.refuse(f"{path}.source", "is not a text", short(source), remedy="say where the value comes from")
            return
        limits = self.limits(path, given) if "range" in given else None
        if path in self.units:
            source += f" (given in {self.units[path][0]})"
        self.origins[path] = Origin(known.unit, origin, source, limits and tuple(scaled(list(limits), factor)))

    def limits(self, path: str, given: dict[str, Any]) -> tuple[float, float] | None:
        """The range that a leaf states, in the leaf's unit; it must hold its own value."""
        limits, value = given["range"], given["value"]
        if not (isinstance(limits, list) and len(limits) == 2 and all(is_number(each) for each in limits)):
            self.refuse(f"{path}.range", "is not a range", short(limits), "[lowest, highest], two finite numbers")
            return None
        low, high = limits
        if low > high:
            self.refuse(f"{path}.range", "is reversed", short(limits), remedy=f"write [{high}, {low}]")
            return None
        for each in value if isinstance(value, list) else [value]:
            if is_number(each) and not low <= each <= high:
                self.refuse(
                    path,
                    "lies outside its own range",
                    short(each),
                    f"{low} to {high}",
                    "correct the value or its range",
                )
        return float(low), float(high)

    def refuse(self, path: str, what: str, value: str = "", allowed: str = "", remedy: str = "") -> None:
        """Notes a problem."""
        self.note(path, path, what, value, allowed, remedy)

    def note(self, place: str, path: str, *told: str) -> None:
        """Notes a problem of a path, with the line and column of a place."""
        line, column = self.source.place(place.split("."))
        self.problems.append(((line, column), Problem(f"{self.source.where}, line {line}, column {column}: {path}", *told)))

    def in_leaf(self, path: str) -> str:
        """Where the value of a path stands: within its leaf when it is one."""
        parts = path.split(".")
        inner = [*parts[:2], "value", *parts[2:]]
        return ".".join(inner) if self.source.find(inner) else path


def is_number(value: Any) -> bool:
    """Whether a value of a file is a finite number."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def scaled(value: Any, factor: float) -> Any:
    """A number, or the numbers of a list, times a factor; what is no number stays, for the schema to refuse."""
    if isinstance(value, list):
        return [scaled(each, factor) for each in value]
    return value * factor if is_number(value) and factor != 1.0 else value


def short(value: Any) -> str:
    """A value that fits into a message, however nested it is."""
    return of_value(value) if isinstance(value, (str, int, float)) else SHORT.repr(value)


# --- the schema's findings as ours ---------------------------------------------------------------------------------------


def validated(plain: dict[str, Any], sheet: Leaves) -> Vehicle | None:
    """The vehicle; None after the sheet has noted what the schema finds wrong with it."""
    try:
        return Vehicle.model_validate(plain)
    except ValidationError as error:
        for each in error.errors(include_url=False):
            if (path := path_of(each)) not in sheet.spoilt:
                sheet.note(sheet.in_leaf(path), path or "the vehicle", *explained(each, path, sheet.units))
        return None


def path_of(finding: ErrorDetails) -> str:
    """Path of the field that a finding is about."""
    return ".".join(str(part) for part in finding["loc"] if part != "[key]")


def explained(found: ErrorDetails, path: str, units: dict[str, tuple[str, float]]) -> tuple[str, str, str, str]:
    """What is wrong, the value, what is allowed, the remedy."""
    kind, given, loc = found["type"], found["input"], found["loc"]
    quantity_path = ".".join(path.split(".")[:2])
    known = quantities().get(quantity_path)
    if kind == "extra_forbidden":
        return "is not a field that exists here", "", "", nearest(str(loc[-1]), names_at(loc[:-1]))
    if kind == "missing":
        return (
            "is missing",
            "",
            known.allowed if known else ", ".join(names_at(loc)),
            f"add it [{known.unit}]" if known else "add it",
        )
    if kind == "model_type":
        return "must hold fields, one a line", short(given), ", ".join(names_at(loc)), ""
    what = finding.lower(found["msg"].removeprefix("Value error, "))
    if kind == "value_error":
        return what, "", "", ""
    if kind in ("too_short", "too_long"):
        return f"holds {len(given)} numbers", short(given), known.count if known else "", ""
    if kind == "list_type":
        return what, short(given), "a list of numbers", f"write [{given:g}]" if is_number(given) else ""
    return (
        what,
        shown(given, units.get(quantity_path)),
        known.allowed if known else finding.allowed(found),
        rewritten(kind, given),
    )


def shown(given: Any, unit: tuple[str, float] | None) -> str:
    """A value as it stands in the file."""
    return f"{given / unit[1]:g} {unit[0]}, {given:g} in the schema's unit" if unit and is_number(given) else short(given)


def rewritten(kind: str, given: Any) -> str:
    """The remedy for a number that YAML took for a text: its exponent lacks the point or the sign, or it stands in quotes."""
    try:
        number = float(given) if kind == "float_type" and isinstance(given, str) else math.nan
    except ValueError:
        return ""
    return f"write it as {number!r}, without quotes" if math.isfinite(number) else ""


def names_at(path: tuple) -> list[str]:
    """Names of the fields at a path."""
    part = Vehicle if not path else sections().get(str(path[0]))
    return list(part.model_fields) if part else []
