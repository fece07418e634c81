"""The kinds: a page for every sort, with the contract that its files keep and all kinds that come with the studio."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docs.reference.field import fields
from docs.reference.table import code, filled, table
from studio.application import contract
from studio.kind import registry
from studio.kind.preset import presets
from studio.kind.quantity import Quantity, quantities
from studio.kind.registry import Kind
from studio.kind.settings import Nested, marks
from studio.kind.sort import SORTS, Sort

HEAD = """# Kinds

Whatever a developer may replace is a *kind*: one file that says of what sort it is. Those that come with the studio keep the same
contracts as your own, and enter by the same door. [A kind of your own](../../how/kind.md) shows how one is made; `studio kinds` lists
all that are known, with where they come from.

A file holds `KIND` with the name of its sort, a docstring that says what it does and where its figures come from, and the parts
of its sort. The file's name is the kind's name.
"""
PARTS = ("part", "what it is", "how it is written")
SET = ("Settings", "Parameters")  # what is set, as a scenario has it
GIVEN = ("Reading", "Payload", "Memory")  # numbers with units
GIVES = {  # modules that say what functions of a kind are given and give back
    "sensor": ("studio.kind.sensor", "studio.world.view"),
    "radio": ("studio.world.view",),
    "message": ("studio.application.contract",),
    "driver": ("studio.kind.driver",),
    "condition": ("studio.world.condition",),
    "action": ("studio.world.maneuver", "studio.world.effect"),
    "metric": ("studio.kind.metric", "studio.execution.record"),
    "channel": ("studio.execution.record",),
    "logformat": ("studio.kind.log",),
}


def pages() -> dict[str, str]:
    """A page about all sorts, and one for each."""
    overview = table(("sort", "what it does", "built in"), [row(sort) for sort in SORTS.values()])
    first = {"reference/kinds/index.md": "\n".join([HEAD, overview, *map(parts, SORTS.values())])}
    return first | {f"reference/kinds/{sort.name}.md": page(sort) for sort in SORTS.values()}


def built_in(sort: Sort) -> list[Kind]:
    """The kinds of a sort that come with the studio; others are documented by who wrote them."""
    return [kind for kind in registry.known(sort.name).values() if kind.is_built_in]


def row(sort: Sort) -> list[str]:
    """A sort in the overview."""
    return [f"[{sort.name}]({sort.name}.md)", sort.does, ", ".join(code(kind.name) for kind in built_in(sort))]


def parts(sort: Sort) -> str:
    """What a file of a sort holds."""
    return f"## {sort.name.capitalize()}\n\n{sort.does.capitalize()}.\n\n{needs(sort)}"


def needs(sort: Sort) -> str:
    """The parts of a contract as a table."""
    rows = [[code(each.name), each.meaning + (" (may be left out)" if each.optional else ""), code(each.example)] for each in sort.needs]
    return table(PARTS, rows)


def page(sort: Sort) -> str:
    """A sort with its contract and its kinds."""
    head = f"# {sort.name.capitalize()}\n\n{sort.does.capitalize()}.\n\n## The contract\n\n{needs(sort)}"
    return "\n\n".join([head, *contract_of(sort), *shared(sort), *map(section, built_in(sort))])


def shared(sort: Sort) -> Iterator[str]:
    """What is set of every kind of a sort, and the parts of it."""
    if sort.usual:
        node = sort.usual.model_json_schema()
        yield f"## Settings of all\n\n{filled(sort.usual.__doc__)}\n\n{fields(node).rstrip()}"
        for name, each in node.get("$defs", {}).items():
            yield f"### {name}\n\n{filled(each.get('description', ''))}\n\n{fields(each).rstrip()}"


def own(node: dict[str, Any], sort: Sort) -> dict[str, Any]:
    """The schema of settings without what all of the sort have."""
    usual = sort.usual.model_fields if sort.usual else {}
    return node | {"properties": {name: each for name, each in node.get("properties", {}).items() if name not in usual}}


def contract_of(sort: Sort) -> Iterator[str]:
    """Where what a kind is given is told; the contract of applications has a file of its own, which is shown."""
    if sort.name in GIVES:
        named = ", ".join(f"[`{name}`](../modules/{name.split('.')[1]}.md#{name})" for name in GIVES[sort.name])
        yield f"What it is given, and what it gives back, stands in {named}.\n"
    if sort.name == "application":
        text = Path(str(contract.__file__)).read_text(encoding="utf-8").strip()
        yield f"`studio/application/contract.py`, as it stands:\n\n```python\n{text}\n```\n"


def section(kind: Kind) -> str:
    """One kind: what its docstring says, what it is measured in, what may be set, what it gives."""
    sort = SORTS[kind.sort]
    tables = [text for name in (*SET, *GIVEN) if (text := described(name, getattr(kind.module, name, None), sort))]
    return "\n\n".join([f"## {kind.name}", f"**{kind.title}**{measured(kind)}", kind.explanation, *tables, *presets_of(kind)])


def presets_of(kind: Kind) -> Iterator[str]:
    """Its named sets of settings, with their sources."""
    rows = [[code(name), each.title, told(each.values), each.source] for name, each in presets(kind.module).items()]
    if rows:
        yield f"Presets:\n\n{table(('preset', 'what it is', 'values', 'source'), rows).rstrip()}"


def told(values: dict[str, Any]) -> str:
    """The values of a preset in a line."""
    return ", ".join(f"{name} {value}" for name, value in values.items())


def measured(kind: Kind) -> str:
    """Unit, and which values are better, of a metric or channel."""
    unit, better = getattr(kind.module, "UNIT", ""), getattr(kind.module, "BETTER", None)
    return f", in {unit}" * bool(unit) + f", {better} is better" * bool(better)


def described(name: str, part: Any, sort: Sort) -> str:
    """The fields of a part of a kind; "" when it has none."""
    if part is None:
        return ""
    node = nested(part, own(part.model_json_schema(), sort)) if name in SET else {}
    listed = fields(node) if name in SET else numbers(part)
    more = "".join(f"\n\n### {title}\n\n{filled(each.get('description', ''))}\n\n{fields(each).rstrip()}" for title, each in parts_of(node))
    return f"`{name}`: {filled(part.__doc__)}\n\n{listed.rstrip()}{more}" if listed else ""


def nested(part: Any, node: dict[str, Any]) -> dict[str, Any]:
    """The schema of settings in which kinds stand: these are told by their sort, and not all of them again."""
    properties = dict(node.get("properties", {}))
    for name, field in part.model_fields.items():
        for mark in marks(field, Nested):
            one = {"type": f"any {mark.sort}"}
            is_list = properties[name].get("type") == "array"
            kept = {key: each for key, each in properties[name].items() if key in ("title", "description", "minItems", "maxItems")}
            properties[name] = kept | ({"type": "array", "items": one} if is_list else one)
    return node | {"properties": properties}


def parts_of(node: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """The parts that fields of a schema refer to, by name."""
    for each in node.get("properties", {}).values():
        if "$ref" in each:
            name = each["$ref"].rpartition("/")[2]
            yield name, node["$defs"][name]


def numbers(part: Any) -> str:
    """The fields of a NamedTuple of numbers; "" for one that holds other things."""
    try:
        found = quantities(part)
    except TypeError:
        return ""
    rows = [[code(each.name), each.unit, sort_of(each), each.meaning] for each in found]
    return table(("field", "unit", "kind", "meaning"), rows) if rows else ""


def sort_of(each: Quantity) -> str:
    """What a field holds."""
    return "yes or no" if each.is_flag else f"{each.size} numbers" if each.size > 1 else "number"
