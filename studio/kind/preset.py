"""Presets: named sets of a kind's settings, each with its source. A kind lists them, and a scenario names one beside what it changes.

PRESETS = {"long_range": Preset("Long range radar", "3GPP TR 22.837", {"range": 250.0})}

sensors: {front: {kind: front_radar, preset: long_range, range: 200}}
applications: {pair: {application: acc, preset: series, parameters: {headway: 1.4}, units: [behind]}}
"""

from types import ModuleType
from typing import Any, Literal, NamedTuple

from pydantic import Field, ValidationError

FIELD = "preset"  # beside the settings of a kind, in a scenario


class Preset(NamedTuple):
    """Settings that belong together: one line for people, where they come from, and the values."""

    title: str
    source: str
    values: dict[str, Any]


def presets(module: ModuleType) -> dict[str, Preset]:
    """Those of a kind, by name."""
    return getattr(module, "PRESETS", {})


def fields(module: ModuleType) -> dict[str, Any]:
    """The field in which a scenario names one; none where there is nothing to name."""
    known = presets(module)
    if not known:
        return {}
    told = "; ".join(f"{name}: {each.title} ({each.source})" for name, each in known.items())
    chosen = Literal[tuple(known)] | None  # pyrefly: ignore[invalid-literal]
    return {FIELD: (chosen, Field(None, title="Preset", description=f"what is not given has its value. {told}"))}


def filled(module: ModuleType, given: dict[str, Any]) -> dict[str, Any]:
    """What is given, with the values of the preset that it names for the rest."""
    named = given.get(FIELD)
    known = presets(module)
    return known[named].values | given if isinstance(named, str) and named in known else given


def wrong(value: Any) -> str:
    """What is wrong with a kind's PRESETS by itself; "" when nothing is."""
    is_fine = isinstance(value, dict) and value and all(isinstance(each, Preset) and each.title and each.source for each in value.values())
    return "" if is_fine else f"is {value!r}, no presets by name: Preset(title, source, values)"


def unfit(module: ModuleType) -> str:
    """Which preset the Settings, or Parameters, of a kind do not take; "" when they take all."""
    taken = next((each for each in ("Settings", "Parameters") if hasattr(module, each)), "")
    if wrong(presets(module) or None) or not taken:
        return ""
    for name, each in presets(module).items():
        try:
            getattr(module, taken).model_validate(each.values)
        except ValidationError as error:
            first = error.errors()[0]
            return f"the preset {name!r} does not fit the {taken}: {'.'.join(map(str, first['loc']))}: {first['msg']}"
    return ""
