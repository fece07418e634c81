"""Locks: the sharpest curves that the vehicles of a scenario can drive, by which their ways are chosen and their lines are drawn."""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from studio.errors import StudioError
from studio.road.network.curve import LOCK
from studio.scenario import catalogue, figures
from studio.scenario.catalogue import VehicleModel
from studio.scenario.schema import Scenario


def known_locks(scenario: Scenario, folder: Path) -> "Locks":
    """The locks of all vehicles of a scenario that there are; that one is not is told elsewhere."""
    models = {}
    for name in {*(each.model for each in scenario.vehicles.values()), *scenario.traffic.named_models().values(), *scenario.traffic.types}:
        with suppress(StudioError):
            manned = scenario.traffic.manned(name).model
            models[manned] = catalogue.find_vehicle(manned, folder=folder)
    return Locks(scenario, models)


@dataclass(frozen=True)
class Locks:
    """The locks [1/m] of a scenario's vehicles. Every turn of a map suits a car, so none needs to turn more sharply than one."""

    scenario: Scenario
    models: dict[str, VehicleModel]

    def of(self, model: str) -> float:
        """That of a model; of one that is not known that of a car."""
        return min(LOCK, figures.lock(self.models[model].values)) if model in self.models else LOCK

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
