"""The catalogue: vehicles and tyres as data, every value with its unit and where it comes from.

A vehicle file holds `parameters`, each with value, unit, origin (published, measured or estimated) and source.
A tyre is a property file of MF-Tyre 5.2.
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import yaml

from studio.errors import Problem, ScenarioError, UnknownError, nearest

FOLDER = Path(__file__).parent
ORIGINS = ("published", "measured", "estimated")


@dataclass(frozen=True)
class Value:
    """One value of a vehicle with its provenance."""

    value: float
    unit: str
    origin: str
    source: str


@dataclass(frozen=True)
class VehicleModel:
    """A vehicle of the catalogue."""

    name: str
    title: str
    licence: str
    tyre: str
    parameters: dict[str, Value]


def vehicle_names() -> list[str]:
    """Names of the vehicles."""
    return sorted(path.stem for path in (FOLDER / "vehicles").glob("*.yaml"))


@cache
def find_vehicle(name: str) -> VehicleModel:
    """A vehicle; raises UnknownError that names the nearest."""
    if name not in vehicle_names():
        raise UnknownError(f"There is no vehicle {name!r} in the catalogue; {nearest(name, vehicle_names())}")
    data = yaml.safe_load((FOLDER / "vehicles" / f"{name}.yaml").read_text(encoding="utf-8"))
    values = {key: Value(**value) for key, value in data.pop("parameters").items()}
    return VehicleModel(name=name, parameters=values, **data)


@cache
def find_tyre(name: str) -> dict[str, float]:
    """Coefficients of a tyre of the catalogue by name."""
    return read_tyre(FOLDER / "tyres" / f"{name}.tir")


def read_tyre(path: Path) -> dict[str, float]:
    """Numbers of a tyre property file: `NAME = value $ comment`; sections and texts are passed over."""
    found = {}
    for line_number, line in enumerate(path.read_text(encoding="latin-1").splitlines(), start=1):
        text = line.partition("$")[0].strip()
        name, equals, value = (part.strip() for part in text.partition("="))
        if equals and not value.startswith("'"):
            found[name] = tyre_number(value, f"{path.name}, line {line_number}, {name}")
    return found


def tyre_number(text: str, where: str) -> float:
    """A coefficient; raises ScenarioError that names the place."""
    try:
        return float(text)
    except ValueError:
        raise ScenarioError(
            "A tyre property file cannot be read.", [Problem(where, "is not a number", text, "a number")]
        ) from None


def tyre_coefficients(name: str, wanted: tuple[str, ...]) -> list[float]:
    """The wanted coefficients in order; scaling factors that are not given are 1, others are required."""
    given = find_tyre(name)
    missing = [key for key in wanted if key not in given and not key.startswith("L")]
    if missing:
        raise ScenarioError(
            f"The tyre {name!r} lacks coefficients.",
            [Problem(f"{name}.tir", f"has no {key}", remedy="add it to the file") for key in missing],
        )
    return [given.get(key, 1.0) for key in wanted]
