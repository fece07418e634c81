"""Settings: what may be set, with unit, range and meaning. The parts of a scenario are made of these, and so is every kind."""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field


def number(default: Any, *, unit: str, title: str, description: str = "", **bounds: Any) -> Any:
    """A field with a unit."""
    return Field(default, title=title, description=description, json_schema_extra={"unit": unit}, **bounds)


class Part(BaseModel):
    """Base of all parts: unknown fields are refused, numbers must be finite."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, str_strip_whitespace=True)
