"""Commanders: who may have the wheel, the brake, the drive and the gear of a vehicle; small whole numbers, and their names.

    0  driver        1  script        2  driver's intervention        3  gearbox        4, 5, ...  the groups of applications, by name

Order of precedence on each of the four: a maneuver of the script; the driver where he overrules an application (passes/intervention.py);
the application of the highest priority that commands it; the driver. The gear is the gearbox's where no application commands it.
"""

from studio.scenario.schema import Scenario
from studio.world.table.mind import APPLICATION, COMMANDED

NAMES = ("driver", "script", "driver's intervention", "gearbox")
PARTS = tuple(name.removeprefix("commands_") for name in COMMANDED)  # wheel, brake, drive, gear


def commanders(scenario: Scenario) -> tuple[str, ...]:
    """The names of all numbers in a scenario."""
    return (*NAMES, *sorted(scenario.applications))


def number_of(group: str, scenario: Scenario) -> int:
    """The number of a group of applications."""
    return APPLICATION + sorted(scenario.applications).index(group)


def standing(number: int, scenario: Scenario) -> tuple[int, int]:
    """Which of two goes before the other: the higher."""
    group = number - APPLICATION
    if group >= 0:
        return 1, scenario.applications[commanders(scenario)[number]].priority
    return {"driver": 0, "gearbox": 0, "script": 2, "driver's intervention": 3}[NAMES[number]], 0
