"""Values: the names of what is measured, logged or recorded in a run, as far as a scenario tells them.

values(scenario)   →  {"car.speed", "car.front.range", "car.platoon.spacing_error", ...}
"""

from collections.abc import Iterator, Sequence

from studio.application import port
from studio.kind import registry
from studio.kind.quantity import Quantity, quantities
from studio.scenario.schema import Scenario
from studio.vehicle.state import VEHICLE
from studio.world.table.mind import MIND


def values(scenario: Scenario) -> set[str]:
    """All of them."""
    of_vehicles = {f"{name}.{row.name}" for name in scenario.vehicles for table in (VEHICLE, MIND) for row in table if row.label}
    return of_vehicles | set(measured(scenario)) | set(logged(scenario))


def measured(scenario: Scenario) -> Iterator[str]:
    """What sensors give, target by target."""
    for unit, each in {**scenario.vehicles, **scenario.stations}.items():
        for name, sensor in each.sensors.items():
            module = registry.find("sensor", sensor.kind).module
            capacity = getattr(module, "CAPACITY", 1)
            yield from [f"{unit}.{name}.count"] if capacity > 1 else []
            for slot in range(capacity):
                at = f"{unit}.{name}" if slot == 0 else f"{unit}.{name}.{slot + 1}"
                yield from (f"{at}.{part}" for part in parts(quantities(module.Reading)))


def logged(scenario: Scenario) -> Iterator[str]:
    """What applications log and show, unit by unit."""
    known = registry.known("application")
    for group, each in scenario.applications.items():
        if each.application not in known:
            continue  # told where names are checked
        done = port.done(known[each.application].module)
        found = [part for one in done if one.what == port.LOG for part in parts(quantities(one.type))]
        found += ["notice"] if any(one.what == port.NOTICE for one in done) else []
        yield from (f"{unit}.{group}.{part}" for unit in each.units for part in found)


def parts(of: Sequence[Quantity]) -> Iterator[str]:
    """Every number of some quantities."""
    for each in of:
        yield from [each.name] if each.size == 1 else (f"{each.name}_{i}" for i in range(each.size))
