"""A vehicle file of a model: what was calibrated says so with its uncertainty, and the validated span goes with the car."""

import os
from pathlib import Path
from typing import Any

import yaml

from studio.errors import Problem, ScenarioError
from studio.scenario import catalogue
from studio.scenario.catalogue import VehicleModel
from studio.scenario.datasheet import quantities, sections
from studio.scenario.vehicle import ORIGINS, Span
from studio.validation.calibration import Estimate


def write(model: VehicleModel, out: Path, *, title: str, estimates: dict[str, Estimate], span: Span | None) -> None:
    """Writes a vehicle file; raises ScenarioError when it cannot. `title` is the project that found the values."""
    document: dict[str, Any] = {"title": model.values.title, "description": model.values.description, "licence": model.values.licence}
    for section in sections():
        document[section] = part(model, section, out, title, estimates)
    if span is not None:
        document["validated"] = span.model_dump()
    text = yaml.safe_dump(document, sort_keys=False, allow_unicode=True, default_flow_style=None, width=140)
    beside = out.with_name(f".{out.name}.{os.getpid()}")
    try:
        beside.write_text(text, encoding="utf-8")
        os.replace(beside, out)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise ScenarioError(
            f"{out.name} cannot be written.", [Problem(str(out), f"cannot be written: {error.strerror or error}")]
        ) from None


def part(model: VehicleModel, section: str, out: Path, title: str, estimates: dict[str, Estimate]) -> dict[str, Any]:
    """A section with the provenance of its values."""
    given = getattr(model.values, section).model_dump()
    return {name: leaf(model, f"{section}.{name}", value, out, title, estimates) for name, value in given.items()}


def leaf(model: VehicleModel, path: str, value: Any, out: Path, title: str, estimates: dict[str, Estimate]) -> Any:
    """A value with unit, origin, source and range; texts as they are, but paths of tyres, which start from the file."""
    if path not in quantities():
        return tyre(model, path, value, out)
    origin = model.origins[path]
    if found := estimates.get(path):
        source = f"calibrated: {title}; {found.value:.6g} ± {2 * found.spread:.2g} {found.unit} (two standard deviations)"
        return {"value": value, "unit": found.unit, "origin": "measured", "source": source, "range": [found.low, found.high]}
    said = {
        "value": value,
        "unit": origin.unit,
        "origin": origin.origin if origin.origin in ORIGINS else "estimated",
        "source": origin.source,
    }
    holds = origin.range and all(origin.range[0] <= each <= origin.range[1] for each in (value if isinstance(value, list) else [value]))
    return said | ({"range": list(origin.range)} if origin.range and holds else {})


def tyre(model: VehicleModel, path: str, value: Any, out: Path) -> Any:
    """A tyre of the catalogue by its name, a file by its way from the new one."""
    if not path.startswith("tyres.") or not isinstance(value, str) or not catalogue.is_path(value, ".tir"):
        return value
    return Path(os.path.relpath((model.folder / value).resolve(), out.resolve().parent)).as_posix()
