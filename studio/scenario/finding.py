"""What pydantic finds wrong, told as ours: the field's path, what is wrong, the value, what is allowed, the nearest name."""

from collections.abc import Mapping
from math import isfinite
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from studio.errors import Problem, nearest, short
from studio.kind.meant import mistakes
from studio.scenario.schema import json_schema, located

MOST_TOLD = 100  # problems of one document


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
        remedy = "write it without quotes" if is_quoted(finding["input"]) else ""
    return Problem(f"{where}: {path}", lower(what), value, allowed(finding), remedy)


def is_quoted(value: Any) -> bool:
    """Whether a text is what a number, or yes and no, would be without quotes."""
    return isinstance(value, str) and (value in ("true", "false") or isinstance(read_number(value), float))


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
    signs = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<", "pattern": "pattern", "expected": ""}
    context = finding.get("ctx", {})
    return " ".join(f"{sign} {context[key]}".strip() for key, sign in signs.items() if key in context)


def fields_at(model: type, path: tuple) -> list[str]:
    """Names of the fields that the schema has at a path."""
    return sorted(located(json_schema(model), path)[1].get("properties", {}))
