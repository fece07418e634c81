"""The comparison of two saved runs as plain data, for the command line and REST."""

from dataclasses import asdict
from typing import Any

from studio.assess import compare as assess
from studio.scenario.schema import Scenario, unit_at
from studio.store.runs import Runs


def compare(runs: Runs, a: int, b: int) -> dict[str, Any]:
    """Both rows, the parameters that differ with their units, every metric; raises UnknownError."""
    left, right = runs.find(a), runs.find(b)
    differing = assess.parameters(runs.document(left), runs.document(right))
    return {
        "a": left.as_json(),
        "b": right.as_json(),
        "parameters": [asdict(each) | {"unit": unit_at(Scenario, each.path)} for each in differing],
        "metrics": [asdict(each) for each in assess.metrics(left.metrics, right.metrics)],
    }
