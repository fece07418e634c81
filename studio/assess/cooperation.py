"""Cooperation: how fresh the information was that vehicles acted on."""

from studio.assess.metric import metric
from studio.execution.record import Record


@metric("information_age", unit="s", goal="lower", title="Mean age of the newest message, worst link")
def information_age(record: Record) -> float:
    """Over the links that applications use."""
    return max(record.links.values(), default=float("nan"))
