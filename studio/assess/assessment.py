"""Assessment: what a record is worth, once its run is over."""

from dataclasses import dataclass

from studio.assess.danger import with_dangers
from studio.assess.goal import unmet
from studio.assess.measure import measure_all
from studio.assess.metric import Measured
from studio.execution.record import Record
from studio.scenario.schema import Scenario


@dataclass(frozen=True)
class Assessment:
    """The record with its near misses and hard brakes, its metrics, the goals that are not met, and what raised meanwhile."""

    record: Record
    metrics: dict[str, Measured]
    unmet: list[str]
    raised: list[str]


def assessed(record: Record, scenario: Scenario) -> Assessment:
    """That of a record by the measures and goals of its scenario."""
    raised: list[str] = []
    record = with_dangers(record)
    record.derived.make(raised.append)
    metrics = measure_all(record, scenario.measures, raised.append)
    return Assessment(record, metrics, unmet(scenario.goals, metrics), raised)
