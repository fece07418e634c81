"""REST, from its OpenAPI description."""

from typing import Any

from docs.reference.field import allowed, fields, kind, meaning
from docs.reference.table import code, filled, table
from studio.server.app import description

HEAD = """# REST

The server describes itself at `/openapi.json`; this page is made from the same description. Every refusal (a status of 400 or
more) is a [Refusal](#refusal) that says where, what, which value, what is allowed, and the remedy.
"""
TOLD = ("1XX", "200", "201", "202", "204")


def page() -> str:
    """Every route, then every object that goes over the wire."""
    api = description()
    routes = [route(path, method, each) for path, methods in api["paths"].items() for method, each in methods.items()]
    objects = api["components"]["schemas"]
    parts = [f"### {name}\n\n{filled(node.get('description', ''))}\n\n{held(node, objects)}" for name, node in objects.items()]
    return "\n".join([HEAD, "## Routes\n", *routes, "## Objects\n", *parts])


def held(node: dict[str, Any], objects: dict[str, Any]) -> str:
    """What an object holds: its fields, or for one of several kinds, which."""
    return fields(node, objects) if "properties" in node else f"One of: {kind(node)}.\n"


def route(path: str, method: str, described: dict[str, Any]) -> str:
    """One route."""
    answers = [f"{status}: {body(each)}" for status, each in described["responses"].items() if status in TOLD]
    lines = [f"### {method.upper()} {path}\n", filled(described.get("description", "")), ""]
    if parameters := described.get("parameters"):
        lines.append(table(["parameter", "in", "kind", "range", "meaning"], map(parameter, parameters)))
    if asked := described.get("requestBody"):
        lines.append(f"Body: {body(asked)}\n")
    return "\n".join([*lines, "Answer " + ", ".join(answers) + "\n"])


def parameter(each: dict[str, Any]) -> list[str]:
    """A parameter of a route."""
    schema = each["schema"]
    return [code(each["name"]), each["in"], kind(schema), allowed(schema), each.get("description") or meaning(schema)]


def body(described: dict[str, Any]) -> str:
    """What a body holds."""
    contents = described.get("content", {})
    told = (kind(each.get("schema", {})) if form == "application/json" else code(form) for form, each in contents.items())
    return ", ".join(told) or "nothing"
