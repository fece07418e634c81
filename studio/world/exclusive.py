"""Exclusive actions: two maneuvers that begin at one time and take the same of one vehicle, so that neither can be meant.

Of two that begin at different times the later ends the earlier, which is told when it happens.
"""

from typing import NamedTuple

from studio.errors import Problem
from studio.kind import registry
from studio.scenario.schema import Scenario, moment_of
from studio.world.maneuver import PEDALS, WHEEL, takes

WORDS = {PEDALS: "pedals", WHEEL: "wheel", PEDALS | WHEEL: "pedals and wheel"}


class Taking(NamedTuple):
    """What an entry takes of a vehicle, and when [s]."""

    entry: str
    vehicle: str
    moment: float
    what: int


def exclusive(scenario: Scenario, where: str) -> list[Problem]:
    """Every pair of them, told at the later in the file."""
    found, before = [], list[Taking]()
    for each in takings(scenario):
        for other in before:
            both = each.what & other.what
            if both and (each.vehicle, each.moment) == (other.vehicle, other.moment):
                what = f"takes the {WORDS[both]} of {each.vehicle!r} at the same time as {other.entry!r}"
                remedy = "let one of them begin later, or about another vehicle"
                found.append(Problem(f"{where}: script.{each.entry}.do", what, f"{each.moment:g} s", remedy=remedy))
        before.append(each)
    return found


def takings(scenario: Scenario) -> list[Taking]:
    """The maneuvers whose time is known beforehand."""
    made = []
    for name, entry in scenario.script.items():
        module, moment = registry.find("action", entry.do.kind).module, moment_of(entry.when)
        if hasattr(module, "act") and moment is not None:
            made.append(Taking(name, entry.do.vehicle, moment, takes(module)))
    return made
