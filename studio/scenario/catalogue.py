"""The catalogue: vehicles and tyres as data, every value with its unit and where it comes from.

    find_vehicle("smart_fortwo")                         a vehicle of the catalogue
    find_vehicle("mine.yaml", {"body.mass": 1500})       a file of one's own, with one value changed
    tyre_path(vehicle, "front")                          its tyres' property file (.tir)

How a vehicle file is written stands in scenario/vehicle.py, how it is read in scenario/datasheet.py.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from math import sqrt
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

from pydantic import ValidationError

from studio.errors import Problem, ScenarioError, UnknownError, nearest, short
from studio.scenario import datasheet, edit, tir
from studio.scenario.text.patch import patched
from studio.scenario.tir import PropertyFile
from studio.scenario.vehicle import Origin, Vehicle

VEHICLES = Path(__file__).parent / "vehicles"
TYRES = Path(__file__).parent / "tyres"
NO_CHANGES: Mapping[str, Any] = MappingProxyType({})
STABLE = 1.5  # largest product of step and highest natural frequency; 2 is where oscillations begin to grow

Axle = Literal["front", "rear"]


@dataclass(frozen=True)
class VehicleModel:
    """A vehicle: its values, where each quantity comes from (by path), and the folder that its tyres' paths start from."""

    name: str
    values: Vehicle
    origins: dict[str, Origin]
    folder: Path


# --- vehicles ------------------------------------------------------------------------------------------------------------


def vehicle_names() -> list[str]:
    """Names of the vehicles of the catalogue."""
    return sorted(path.stem for path in VEHICLES.glob("*.yaml"))


def find_vehicle(name: str, changes: Mapping[str, Any] = NO_CHANGES, *, folder: Path = Path()) -> VehicleModel:
    """A vehicle of the catalogue, or of a file, with some values changed by path.

    What ends in .yaml or .yml or has a separator in it is a path, relative to `folder`; so are paths of tyres in the changes.
    Raises UnknownError for a name that the catalogue does not have, ScenarioError for a file or a change that is wrong.
    """
    model = from_file(folder / name) if is_path(name, ".yaml", ".yml") else from_catalogue(name)
    return changed(model, with_tyres_from(folder, changes)) if changes else model


def is_path(name: str, *suffixes: str) -> bool:
    """Whether a name means a file and not an entry of the catalogue."""
    return name.lower().endswith(suffixes) or "/" in name or "\\" in name


def with_tyres_from(folder: Path, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Changes in which paths of tyres do not depend on a folder any more."""
    return {
        path: str((folder / value).resolve()) if path.startswith("tyres.") and isinstance(value, str) and is_path(value, ".tir") else value
        for path, value in changes.items()
    }


@cache
def from_catalogue(name: str) -> VehicleModel:
    """A vehicle of the catalogue; raises UnknownError that names the nearest."""
    if name not in vehicle_names():
        remedy = nearest(name, vehicle_names())
        raise UnknownError(
            f"There is no vehicle {name!r} in the catalogue.",
            [
                Problem(
                    "model",
                    "is not a vehicle of the catalogue",
                    name,
                    "a name of the catalogue or the path of a .yaml file",
                    remedy,
                )
            ],
        )
    return from_file(VEHICLES / f"{name}.yaml")


def from_file(path: Path) -> VehicleModel:
    """A vehicle of a file, its tyres present; raises ScenarioError."""
    sheet = datasheet.read(path)
    model = VehicleModel(path.stem, sheet.values, sheet.origins, path.parent)
    has_tyres(model)
    return model


def changed(model: VehicleModel, changes: Mapping[str, Any]) -> VehicleModel:
    """A vehicle with other values at some paths; raises ScenarioError with everything that is wrong with them."""
    full = model.values.model_dump()
    problems = [unknown_path(model, full, path) for path in changes if not can_be_set(full, path)]
    if problems:
        raise ScenarioError(f"{model.name} has no such values to set.", problems)
    document = full
    for path, value in changes.items():
        document = patched(document, edit.assignment(document, full, path, value))
    other = replace(model, values=validated(document, model.name), origins=changed_origins(model, full, changes))
    has_tyres(other)
    return other


def can_be_set(full: dict[str, Any], path: str) -> bool:
    """Whether a path leads to a value, or to an entry of a list."""
    return edit.has(full, path) and not isinstance(edit.get(full, path), dict)


def unknown_path(model: VehicleModel, full: dict[str, Any], path: str) -> Problem:
    """A path that leads to no value."""
    if edit.has(full, path):
        return Problem(
            path,
            f"is a part of {model.name}, not a value",
            allowed=", ".join(edit.get(full, path)),
            remedy="set one of these",
        )
    return Problem(path, f"is not a value of {model.name}", remedy=edit.nearest_path(full, path))


def validated(document: dict[str, Any], name: str) -> Vehicle:
    """A changed vehicle; raises ScenarioError."""
    try:
        return Vehicle.model_validate(document)
    except ValidationError as error:
        raise ScenarioError(f"{name} cannot be changed so.", told(error, name)) from None


def told(error: ValidationError, name: str) -> list[Problem]:
    """The schema's findings about a changed vehicle."""
    found = [(datasheet.path_of(each), each) for each in error.errors(include_url=False)]
    return [Problem(f"{name}: {path}" if path else name, *datasheet.explained(each, path, {})) for path, each in found]


def changed_origins(model: VehicleModel, full: dict[str, Any], changes: Iterable[str]) -> dict[str, Origin]:
    """Origins in which changed quantities are `set`, with what the file says; the range stays that of the file."""
    origins = dict(model.origins)
    for path in changes:
        quantity = ".".join(path.split(".")[:2])
        if quantity in origins:
            given = short(edit.get(full, quantity))
            was = model.origins[quantity]
            origins[quantity] = replace(was, origin="set", source=f"in place of {given} ({was.origin}: {was.source})")
    return origins


# --- tyres ---------------------------------------------------------------------------------------------------------------


def tyre_names() -> list[str]:
    """Names of the tyres of the catalogue."""
    return sorted(path.stem for path in TYRES.glob("*.tir"))


def tyre_path(model: VehicleModel, axle: Axle) -> Path:
    """Property file of the tyres of an axle; raises ScenarioError that names what there is."""
    return tyre_file(getattr(model.values.tyres, axle), folder=model.folder)


def tyre_file(name: str, *, folder: Path = Path()) -> Path:
    """Property file of a tyre: what ends in .tir or has a separator in it is a path relative to `folder`, else of the catalogue."""
    own = is_path(name, ".tir")
    path = folder / name if own else TYRES / f"{name}.tir"
    if not path.is_file():
        beside = [each.name for each in path.parent.glob("*.tir")] if own and path.parent.is_dir() else tyre_names()
        problem = Problem(str(path) if own else "tyre", "does not exist", name, "a name of the catalogue or the path of a .tir file")
        raise ScenarioError(f"There is no tyre {name!r}.", [replace(problem, remedy=nearest(name, beside))])
    return path


def find_tyre(name: str, *, folder: Path = Path()) -> PropertyFile:
    """A tyre of the catalogue, or of a file relative to `folder`; raises ScenarioError."""
    return tir.read(tyre_file(name, folder=folder))


def has_tyres(model: VehicleModel) -> None:
    """Raises ScenarioError for each axle whose tyres' file does not exist."""
    problems = []
    for axle in ("front", "rear"):
        try:
            tyre_path(model, axle)
        except ScenarioError as error:
            problems += [replace(each, where=f"{model.name}: tyres.{axle}") for each in error.problems]
    if problems:
        raise ScenarioError(f"{model.name} has tyres that do not exist.", problems)


# --- numerics ------------------------------------------------------------------------------------------------------------


def step_limit(values: Vehicle) -> float:
    """The largest step [s] at which the vertical movement of the wheels is stable and not distorted by the integration.

    A wheel is the stiffest part: k = k_tyre + k_spring + the anti-roll bar when both wheels of an axle move in opposition,
    c = damper + tyre. With velocity first, then position, a step h is stable while (h ω)² + 2 h c/m < 4, ω² = k/m; half a
    unit is kept free: (h ω)² + 2 h c/m = 1.5², which without damping is h ω = 1.5.
    """
    body, springs, wheels = values.body, values.suspension, values.wheels
    bar_front = 2.0 * springs.anti_roll_front / body.front_track**2
    bar_rear = 2.0 * springs.anti_roll_rear / body.rear_track**2
    k_front = wheels.stiffness_front + springs.stiffness_front + bar_front
    k_rear = wheels.stiffness_rear + springs.stiffness_rear + bar_rear
    return min(
        wheel_step_limit(0.5 * body.unsprung_mass_front, k_front, springs.damping_front + wheels.damping),
        wheel_step_limit(0.5 * body.unsprung_mass_rear, k_rear, springs.damping_rear + wheels.damping),
    )


def wheel_step_limit(m: float, k: float, c: float) -> float:
    """The largest step [s] for a mass m [kg] on stiffness k [N/m] and damping c [N s/m]."""
    return (sqrt(c * c + STABLE**2 * k * m) - c) / k
