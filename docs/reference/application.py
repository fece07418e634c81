"""The built-in applications, and the contract as it stands in its file."""

from pathlib import Path

from docs.reference.field import fields
from docs.reference.table import filled
from studio.application import contract, registry

HEAD = """# Applications and the contract

## The contract

`studio/application/contract.py`, as it stands:

```python
{contract}
```
"""
OWN = "studio.application."  # others are installed by somebody else


def page() -> str:
    """The contract, then every application that comes with the studio."""
    source = Path(contract.__file__).read_text(encoding="utf-8").strip()
    built_in = [each for each in registry.known().values() if each.module.__name__.startswith(OWN)]
    return "\n".join([HEAD.replace("{contract}", source), *map(section, built_in)])


def section(application: registry.Application) -> str:
    """One application with its parameters."""
    parameters = fields(application.module.Parameters.model_json_schema())
    return f"## {application.name}\n\n{application.title}.\n\n{filled(application.module.__doc__)}\n\n{parameters}"
