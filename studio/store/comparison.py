"""The comparison of two saved runs as plain data, for the command line and REST."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from studio.assess import compare as assess
from studio.kind import registry
from studio.scenario.schema import Scenario, unit_at
from studio.store.runs import Row, Runs


def compare(runs: Runs, a: int, b: int) -> dict[str, Any]:
    """Both rows, the parameters that differ with their units, every metric; raises UnknownError."""
    left, right = runs.find(a), runs.find(b)
    documents = [runs.document(left), runs.document(right)]
    differing = assess.parameters(*documents)
    early = [each for each in (left, right) if not each.is_whole]
    return {
        "a": left.as_json(),
        "b": right.as_json(),
        "alike": assess.ALIKE,
        "unranked": unranked(early),
        "parameters": [asdict(each) | {"unit": unit(each.path, documents)} for each in differing],
        "metrics": [asdict(each) for each in assess.metrics(left.metrics, right.metrics, is_ranked=not early)],
    }


def unranked(early: Sequence[Row]) -> str:
    """Why no metric is better in one of the runs: what did not come to its end was measured over less; empty when both did."""
    told = [f"run {each.run} is {each.status}" + ("" if each.sim_time_s is None else f" at {each.sim_time_s:g} s") for each in early]
    return f"Nothing is ranked: {' and '.join(dict.fromkeys(told))}, so it was measured over less than a whole run." if told else ""


def unit(path: str, documents: list[dict[str, Any]]) -> str:
    """Unit of a parameter; those of applications are told by the applications that the runs used."""
    parts = path.split(".")
    if parts[0] == "applications" and len(parts) == 4 and parts[2] == "parameters":
        used = [document["applications"].get(parts[1], {}).get("application") for document in documents]
        known = registry.known("application")
        models = [known[name].module.Parameters for name in used if name in known]
        return next((found for model in models if (found := unit_at(model, parts[3]))), "")
    return unit_at(Scenario, path)
