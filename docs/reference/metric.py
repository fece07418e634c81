"""The metrics of a run."""

from docs.reference.table import code, table
from studio.assess import measure  # noqa: F401 - it imports every built-in metric
from studio.assess.metric import registered

HEAD = """# Metrics

Every run is measured by all of these. A metric that finds nothing to measure (no platoon, nobody ahead) stays empty, and no goal
is met by it. `goals` of a scenario bound them by name.
"""


def page() -> str:
    """All metrics by name."""
    rows = [[code(name), each.unit, each.goal or "", f"{each.title}. {each.explanation}"] for name, each in registered().items()]
    return HEAD + "\n" + table(["metric", "unit", "better", "meaning"], rows)
