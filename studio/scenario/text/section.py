"""Sections of a scenario file, as migrations look at them."""

from typing import Any


def section(value: Any) -> Any:
    """A section of a file; one that was left empty holds nothing."""
    return {} if value is None else value


def free(name: str, taken: set[str]) -> str:
    """The name, with a number behind it when it is taken."""
    tried, number = name, 1
    while tried in taken:
        number += 1
        tried = f"{name}_{number}"
    return tried
