"""Conformance: what a kind must keep, by trying it. Our own kinds are tested by the same suite.

conform(kind)   →  [Check]      one after another, each with what is wrong and what to do
"""

import json
import math
import re
from collections.abc import Iterator
from importlib import import_module
from typing import Any

import numpy as np
from pydantic import BaseModel, ValidationError

from studio.kind.quantity import quantities
from studio.kind.registry import Kind
from studio.kind.sort import SORTS, problems
from studio.workshop import draw
from studio.workshop.check import Check, tried

SET = ("Settings", "Parameters")  # what may be set of a kind
GIVEN = ("Reading", "Payload")  # what it gives to others


def conform(kind: Kind) -> list[Check]:
    """All checks of a kind: those of every sort, then those of its own."""
    suite = import_module(f"studio.workshop.suite.{kind.sort}")
    return [*common(kind), *suite.checks(kind)]


def common(kind: Kind) -> Iterator[Check]:
    """What every kind keeps."""
    wrong = "\n".join(str(each) for each in problems(kind.module, SORTS[kind.sort]))
    yield Check(f"has the parts of its contract: {', '.join(each.name for each in SORTS[kind.sort].needs)}", wrong)
    yield tried("its functions and classes say what they are", lambda: undocumented(kind))
    for name in GIVEN:
        if made := getattr(kind.module, name, None):
            yield tried(f"the numbers of a {name} say what they are", lambda made=made: unsaid(made))
    for name in SET:
        if model := getattr(kind.module, name, None):
            yield from of_settings(name, model)


def unsaid(made: type) -> str | None:
    """Numbers without a meaning."""
    found = [each.name for each in quantities(made) if not each.meaning]
    return f'{", ".join(found)}: write Annotated[float, "m", "what it is"] = 0.0' if found else None


def undocumented(kind: Kind) -> str | None:
    """What has no docstring of its own."""
    own = re.findall(r"^(?:def|class) ([A-Za-z]\w*)", next(iter(kind.texts.values()), ""), re.MULTILINE)
    without = [name for name in own if not said(getattr(kind.module, name))]
    return f"{', '.join(without)}: write a docstring, with units" if without else None


def said(part: Any) -> str:
    """The docstring of a function or class; what a NamedTuple or a model has by itself is none."""
    text = vars(part).get("__doc__") if isinstance(part, type) else part.__doc__
    return "" if text is None or text.startswith(f"{getattr(part, '__name__', '')}(") else text


def of_settings(name: str, model: type[BaseModel]) -> Iterator[Check]:
    """What is set: described, bounded, and refusing what does not fit."""
    yield tried(f"{name} are described: a title for each, a unit for each number", lambda: undescribed(model))
    yield tried(f"numbers of {name} have bounds, and their first values lie within", lambda: unbounded(model))
    yield tried(f"{name} refuse what they do not know, and numbers that are none", lambda: lenient(model))
    yield tried(f"any {name} within the bounds are taken", lambda: drawn(model))


def properties(model: type[BaseModel]) -> dict[str, Any]:
    """The fields as a JSON schema, as a form and other programs read them."""
    return json.loads(json.dumps(model.model_json_schema())).get("properties", {})


def is_number(node: dict[str, Any]) -> bool:
    """Whether a field is a plain number."""
    return node.get("type") in ("number", "integer") and "enum" not in node


def undescribed(model: type[BaseModel]) -> str | None:
    """Fields without title or unit."""
    found = [name for name, field in model.model_fields.items() if not field.title]  # pydantic would make one of the name
    units = [name for name, node in properties(model).items() if node.get("type") == "number" and not node.get("unit")]
    return f'{", ".join(found or units)}: write number(1.0, unit="m", title="...")' if found or units else None


def unbounded(model: type[BaseModel]) -> str | None:
    """Numbers without bounds, and first values that are refused when they are given. What must be given needs one bound only."""
    for name, node in properties(model).items():
        found = [pair for pair in ({"minimum", "exclusiveMinimum"}, {"maximum", "exclusiveMaximum"}) if pair & set(node)]
        if is_number(node) and len(found) < (2 if "default" in node else 1):
            return f"{name}: give a lower and an upper bound, ge=..., le=..."
    model.model_validate(usual(model))
    return None


def usual(model: type[BaseModel]) -> dict[str, Any]:
    """The values that count when nothing is set; drawn ones for what must be given."""
    first = {name: field.get_default(call_default_factory=True) for name, field in model.model_fields.items() if not field.is_required()}
    return draw.settings(model, np.random.default_rng(1)).model_dump() | {name: each for name, each in first.items() if each is not None}


def lenient(model: type[BaseModel]) -> str | None:
    """Whether it takes what no settings should."""
    numbers = [name for name, node in properties(model).items() if node.get("type") == "number"]
    for name, given in [("no_such_setting", 1), *((name, math.nan) for name in numbers)]:
        try:
            model.model_validate(usual(model) | {name: given})
        except ValidationError:
            continue
        return f"{name} = {given!r} was taken: derive it from Part (studio.kind.settings)"
    return None


def drawn(model: type[BaseModel]) -> None:
    """Raises ValidationError."""
    seed = np.random.default_rng(1)
    for _ in range(20):
        model.model_validate(draw.settings(model, seed).model_dump())
