"""The reference of vehicle files, from their schema."""

from docs.reference.table import code, filled, table
from studio.scenario.datasheet import quantities, sections
from studio.scenario.vehicle import ORIGINS, Vehicle

HEAD = """# Vehicle files

A vehicle is a YAML file. A value is a leaf with its provenance, or a plain number, which counts in the unit below, as
estimated, without a source:

```text
body:
  mass: {value: 860, unit: kg, origin: published, source: "a data sheet", range: [800, 900]}
  wheelbase: 1.87
```

`origin` is one of {origins}. The optional `range` is that within which the true value may lie. For rad/s, revolutions per minute
(`1/min`, `rpm`) are read as well, for rad degrees (`deg`). Nothing is repaired: what is physically impossible is refused with its
field, value and range. `studio vehicles FILE` shows how a file is understood.
"""


def page() -> str:
    """Every section of a vehicle with its values."""
    head = HEAD.replace("{origins}", ", ".join(map(code, ORIGINS)))
    return "\n".join([head, "## Vehicle\n", texts(Vehicle), *(section(name, part) for name, part in sections().items())])


def section(name: str, part: type) -> str:
    """One section."""
    rows = [
        [code(path.partition(".")[2]), each.unit, each.allowed, each.count, each.title]
        for path, each in quantities().items()
        if path.startswith(f"{name}.")
    ]
    listed = table(["value", "unit", "range", "how many", "meaning"], rows) if rows else ""
    return f"## {name}\n\n{filled(part.__doc__)}\n\n{texts(part)}\n{listed}"


def texts(part: type) -> str:
    """Fields of a part that are no quantities."""
    rows = [
        [code(name), words(field.annotation), "must be given" if field.is_required() else "may be left out", field.title or ""]
        for name, field in part.model_fields.items()
        if not field.json_schema_extra and name not in sections()
    ]
    return table(["field", "kind", "", "meaning"], rows) if rows else ""


def words(annotation) -> str:
    """A text, or the words that may stand there."""
    return ", ".join(map(code, getattr(annotation, "__args__", ()))) or "text"
