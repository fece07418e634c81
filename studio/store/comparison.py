"""The comparison of two saved runs as plain data, for the command line and REST."""

from dataclasses import asdict
from typing import Any

from studio.assess import compare as assess
from studio.kind import registry
from studio.scenario.schema import Scenario, unit_at
from studio.store.runs import Runs


def compare(runs: Runs, a: int, b: int) -> dict[str, Any]:
    """Both rows, the parameters that differ with their units, every metric; raises UnknownError."""
    left, right = runs.find(a), runs.find(b)
    documents = [runs.document(left), runs.document(right)]
    differing = assess.parameters(*documents)
    return {
        "a": left.as_json(),
        "b": right.as_json(),
        "parameters": [asdict(each) | {"unit": unit(each.path, documents)} for each in differing],
        "metrics": [asdict(each) for each in assess.metrics(left.metrics, right.metrics)],
    }


def unit(path: str, documents: list[dict[str, Any]]) -> str:
    """Unit of a parameter; those of applications are told by the applications that the runs used."""
    parts = path.split(".")
    if parts[0] == "applications" and len(parts) == 4 and parts[2] == "parameters":
        used = [document["applications"].get(parts[1], {}).get("application") for document in documents]
        known = registry.known("application")
        models = [known[name].module.Parameters for name in used if name in known]
        return next((found for model in models if (found := unit_at(model, parts[3]))), "")
    return unit_at(Scenario, path)
