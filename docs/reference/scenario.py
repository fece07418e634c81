"""The reference of scenario files, from their schema."""

from docs.reference.field import fields
from docs.reference.table import filled
from studio.scenario.schema import Scenario

HEAD = """# Scenario files

A scenario is a YAML file. These are all its fields; what is not listed is refused. `studio schema` prints the same as JSON
schema, `studio check FILE` tells what is wrong in a file.
"""


def page() -> str:
    """Every part of a scenario with its fields."""
    schema = Scenario.model_json_schema()
    parts = {"Scenario": schema, **schema["$defs"]}
    sections = [f"## {name}\n\n{filled(node.get('description', ''))}\n\n{fields(node, parts)}" for name, node in parts.items()]
    return "\n".join([HEAD, *sections])
