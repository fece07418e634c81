"""Refusals: what is wrong with a deed that names what is on board of a unit.

deed_problems(effect, scenario, at)   →  Problem, ...
"""

from collections.abc import Iterator

from studio.errors import Problem, nearest
from studio.kind import registry
from studio.scenario import finding
from studio.scenario.schema import Scenario
from studio.world.effect import Effect, SensorFault, Switch, Tune


def deed_problems(effect: Effect, scenario: Scenario, at: str) -> Iterator[Problem]:
    """Sensors, units and parameters that there are not; names of units and groups are looked at where all names are."""
    if isinstance(effect, SensorFault):
        yield from sensor_problem(effect, scenario, at)
    elif isinstance(effect, Switch | Tune) and effect.group in scenario.applications:
        yield from unit_problem(effect, scenario, at)
        if isinstance(effect, Tune):
            yield from parameter_problems(effect, scenario, at)


def sensor_problem(effect: SensorFault, scenario: Scenario, at: str) -> Iterator[Problem]:
    """A sensor that the unit does not have."""
    unit = {**scenario.vehicles, **scenario.stations}.get(effect.unit)
    if unit is not None and effect.sensor is not None and effect.sensor not in unit.sensors:
        remedy = nearest(effect.sensor, unit.sensors)
        yield Problem(f"{at}.sensor", f"names no sensor of {effect.unit!r}", repr(effect.sensor), remedy=remedy)


def unit_problem(effect: Switch | Tune, scenario: Scenario, at: str) -> Iterator[Problem]:
    """A unit that the group is not on."""
    units = scenario.applications[effect.group].units
    if effect.unit is not None and effect.unit not in units:
        yield Problem(f"{at}.unit", f"names no unit of {effect.group!r}", repr(effect.unit), remedy=nearest(effect.unit, units))


def parameter_problems(effect: Tune, scenario: Scenario, at: str) -> Iterator[Problem]:
    """Parameters that the application does not have, or out of their range."""
    group = scenario.applications[effect.group]
    model = registry.find("application", group.application).module.Parameters
    where, _, path = at.partition(": ")
    yield from finding.of_values(model, group.parameters | effect.parameters, where, f"{path}.parameters.")
    if not effect.parameters:
        yield Problem(f"{at}.parameters", "names no parameter", "{}", ", ".join(model.model_fields), "give those that are to change")
