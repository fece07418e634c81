"""Fields of a JSON schema as rows of a table: name, kind, unit, range, default, meaning."""

import json
import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from docs.reference.table import code, table

HEAD = ("field", "kind", "unit", "range", "default", "meaning")
BOUNDS = (("minimum", "≥"), ("exclusiveMinimum", ">"), ("maximum", "≤"), ("exclusiveMaximum", "<"))
LENGTHS = (
    ("minLength", "maxLength", "characters"),
    ("minItems", "maxItems", "entries"),
    ("minProperties", "maxProperties", "entries"),
)
NONE: Mapping[str, dict[str, Any]] = MappingProxyType({})
LONGEST_DEFAULT = 60  # characters; a longer default is told as "its defaults"


def fields(node: dict[str, Any], parts: Mapping[str, dict[str, Any]] = NONE) -> str:
    """The table of an object's fields; a field that is a part means what the part says of itself."""
    needed = node.get("required", ())
    return table(HEAD, [row(name, each, name in needed, parts) for name, each in node.get("properties", {}).items()])


def row(name: str, node: dict[str, Any], needed: bool, parts: Mapping[str, dict[str, Any]]) -> list[str]:
    """One field."""
    said = meaning(node) or meaning(parts.get(node.get("$ref", "").rpartition("/")[2], {}))
    return [code(name), kind(node), unit(node), allowed(node), "must be given" if needed else default(node), said]


def kind(node: dict[str, Any]) -> str:
    """What it is: a number, a text, a part with a section of its own, a list or a mapping of them."""
    if "$ref" in node:
        return part(node["$ref"])
    if members := members_of(node):
        return " or ".join(dict.fromkeys(kind(each) for each in members))
    if "enum" in node:
        return "one of " + ", ".join(code(each) for each in node["enum"])
    if "const" in node:
        return code(node["const"])
    if node.get("type") == "array":
        return f"list of {kind(node.get('items', {}))}"
    if node.get("type") == "object":
        return f"names, each with {kind(inner)}" if (inner := inside(node)) else "mapping"
    named = node.get("type", "anything")
    return {"integer": "whole number", "string": "text", "boolean": "true or false"}.get(named, named)


def members_of(node: dict[str, Any]) -> list[dict[str, Any]]:
    """The members of a union but for null, which only says that the field may be left out."""
    return [each for each in node.get("anyOf") or node.get("oneOf") or [] if each.get("type") != "null"]


def inside(node: dict[str, Any]) -> dict[str, Any]:
    """What stands under the names of a mapping; empty when nothing is said about it."""
    found = node.get("additionalProperties") or next(iter(node.get("patternProperties", {}).values()), {})
    return found if isinstance(found, dict) else {}


def part(reference: str) -> str:
    """A link to the section of a part."""
    name = reference.rpartition("/")[2]
    return f"[{name}](#{anchor(name)})"


def anchor(title: str) -> str:
    """The anchor that a heading gets."""
    return re.sub(r"[^\w]+", "-", title.lower()).strip("-")


def unit(node: dict[str, Any]) -> str:
    """Its unit; 1 and none are left out of the table."""
    return next((each["unit"] for each in (node, *members_of(node)) if "unit" in each), "")


def allowed(node: dict[str, Any]) -> str:
    """Bounds of a number, or of the length of a text or list."""
    for each in (node, *members_of(node)):
        bounds = [f"{sign} {plain(each[key])}" for key, sign in BOUNDS if key in each]
        lengths = [length(each.get(least), each.get(most), what) for least, most, what in LENGTHS if least in each or most in each]
        pattern = [code(each["pattern"])] if "pattern" in each else []
        if bounds or lengths or pattern:
            return " and ".join(bounds + lengths + pattern)
    return ""


def plain(number: float) -> str:
    """A whole number in full, any other with as many digits as it needs."""
    return str(number) if isinstance(number, int) else f"{number:g}"


def length(least: int | None, most: int | None, what: str) -> str:
    """Bounds of a length in words."""
    if least == most:
        return f"{least} {what}"
    return " and ".join(f"{word} {count}" for word, count in (("at least", least), ("at most", most)) if count is not None) + f" {what}"


def default(node: dict[str, Any]) -> str:
    """What counts when it is left out."""
    if "default" not in node:
        return "its defaults" if "$ref" in node else ""
    value = node["default"]
    text = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
    return "none" if value in (None, "", [], {}) else code(text) if len(text) <= LONGEST_DEFAULT else "its defaults"


def meaning(node: dict[str, Any]) -> str:
    """Title and description; of a part its description, whose first line is about what it is."""
    if "properties" in node:
        return node.get("description", "").partition("\n\n")[0]
    return ": ".join(each for each in (node.get("title", ""), node.get("description", "")) if each)
