"""What pydantic finds wrong, told as ours: the field's path, what is wrong, the value, what is allowed, the nearest name."""

import re
from collections.abc import Mapping
from math import isfinite
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from studio.errors import Problem, nearest, short
from studio.kind.meant import mistakes
from studio.scenario.schema import json_schema, located

MOST_TOLD = 100  # problems of one document
NAME = "^[A-Za-z][A-Za-z0-9_]*$"  # as the schema has it
BEGUN = re.compile(r"\s*([-+]?\d+([.,]\d+)?([eE][-+]?\d+)?)")  # a number, whatever follows


def problems(error: ValidationError, where: str, model: type, *, under: str = "") -> list[Problem]:
    """Pydantic's findings as ours, the first of very many; `under` is the path of the model within its document, with a dot."""
    found = [problem(finding, where, model, under) for finding in error.errors(include_url=False)[:MOST_TOLD]]
    more = error.error_count() - MOST_TOLD
    return [*found, Problem(where, f"has {more} more problems", remedy="mend these first")] if more > 0 else found


def problem(finding: ErrorDetails, where: str, model: type, under: str) -> Problem:
    """One finding: the path of the field, what is wrong, what is allowed, the nearest right name."""
    path, node = located(json_schema(model), finding["loc"])
    path = under + path or "the scenario"
    if finding["type"] in ("unknown_kind", "union_tag_not_found"):
        return kind_problem(finding, f"{where}: {path}.kind", list(node["discriminator"]["mapping"]))
    what = finding["msg"].removeprefix("Value error, ")
    value, remedy = short(finding["input"]), ""
    if finding["type"] == "extra_forbidden":
        what, value = "is not a field that exists here", ""
        remedy = nearest(str(finding["loc"][-1]), fields_at(model, finding["loc"][:-1]))
    elif finding["type"] == "missing":
        what, value, remedy = "is missing", "", "add it"
    elif finding["type"] == "mistaken":
        remedy = meant(finding["input"], node.get("unit", ""))
    elif finding["type"] == "string_type":
        remedy = "write it in quotes" if isinstance(finding["input"], int | float) else ""
    elif finding["type"] in ("dict_type", "model_type"):
        what, remedy = "is no mapping", ""
        if finding["input"] is None:
            what, value, remedy = "is empty", "", "fill it, write {}, or leave it out"
    elif finding["type"] == "string_pattern_mismatch" and finding["ctx"]["pattern"] == NAME:
        what = "is no name"
    return Problem(f"{where}: {path}", lower(what), value, allowed(finding), remedy)


def meant(value: Any, unit: str) -> str:
    """How to write what a text seems to mean: the number in it, or a truth value."""
    if not isinstance(value, str):
        return ""
    if value in ("true", "false") or read_number(value) is not None:
        return "write it without quotes"
    begun = BEGUN.match(value)
    if begun is None:
        return ""
    plain, rest = begun[1].replace(",", "."), value[begun.end() :].strip()
    if not rest:
        return f"write {plain}, with a point" if "," in begun[1] else ""
    return f"write the number alone; its unit is {unit}" if unit and unit != "1" else "write the number alone"


def read_number(text: str) -> float | None:
    """The finite number that a text is, if it is one."""
    try:
        return number if isfinite(number := float(text)) else None
    except ValueError:
        return None


def of_values(model: type[BaseModel], values: Mapping[str, Any], where: str, under: str) -> list[Problem]:
    """What is wrong with values for a model, those of it too that it would read as what they are not."""
    found = mistakes(model, values)
    slips = [Problem(f"{where}: {under}{name}", f"is {given}", short(value), wanted) for name, value, given, wanted in found]
    try:
        model.model_validate(values)
    except ValidationError as error:
        told = {each.where for each in slips}
        return slips + [each for each in problems(error, where, model, under=under) if each.where not in told]
    return slips


def kind_problem(finding: ErrorDetails, where: str, known: list[str]) -> Problem:
    """A kind that cannot be had, or none at all."""
    if finding["type"] == "union_tag_not_found":
        return Problem(where, "is missing", allowed=", ".join(known), remedy="add it")
    return Problem(where, lower(finding["msg"]), repr(finding["input"].get("kind")), ", ".join(known))


def lower(text: str) -> str:
    """Pydantic's sentence as a clause."""
    return text[:1].lower() + text[1:]


def allowed(finding: ErrorDetails) -> str:
    """Bounds that a finding names."""
    if finding["type"] in ("dict_type", "model_type"):
        return "a mapping"
    if finding["type"] == "string_pattern_mismatch" and finding["ctx"]["pattern"] == NAME:
        return "a letter, then letters, digits and _"
    signs = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<", "pattern": "pattern", "expected": ""}
    context = finding.get("ctx", {})
    return " ".join(f"{sign} {context[key]}".strip() for key, sign in signs.items() if key in context)


def fields_at(model: type, path: tuple) -> list[str]:
    """Names of the fields that the schema has at a path."""
    return sorted(located(json_schema(model), path)[1].get("properties", {}))
