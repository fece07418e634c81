"""Locks: the sharpest curves that the vehicles of a scenario can drive, by which their ways are chosen and their lines are drawn."""

from dataclasses import dataclass

from studio.road.network.curve import LOCK
from studio.scenario import figures
from studio.scenario.catalogue import VehicleModel
from studio.scenario.schema import Scenario


@dataclass(frozen=True)
class Locks:
    """The locks [1/m] of a scenario's vehicles. Every turn of a map suits a car, so none needs to turn more sharply than one."""

    scenario: Scenario
    models: dict[str, VehicleModel]

    def of(self, model: str) -> float:
        """That of a model."""
        return min(LOCK, figures.lock(self.models[model].values))

    def of_routes(self) -> dict[str, float]:
        """The least of the named vehicles on each route."""
        found: dict[str, float] = {}
        for each in self.scenario.vehicles.values():
            found[each.route] = min(found.get(each.route, LOCK), self.of(each.model))
        return found

    def of_traffic(self, own: str | None = None) -> float:
        """The least of those that traffic of a model or type may have, or of all that are mixed."""
        traffic = self.scenario.traffic
        names = [own] if own else sorted(traffic.mix) or [traffic.model]
        return min(self.of(traffic.manned(name).model) for name in names)
