"""The maneuvers there are, by name: files of studio/validation/maneuver."""

import pkgutil
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from types import ModuleType

from studio.errors import Problem, ScenarioError, UnknownError, nearest
from studio.log.recording import Recording
from studio.validation import maneuver

# How a car answers; the other signals are what is done to it, or are held.
ANSWERS = ("lateral_speed", "acceleration", "lateral_acceleration", "yaw_rate", "roll_rate", "engine_speed")


@cache
def maneuvers() -> dict[str, ModuleType]:
    """All of them, in the order of the method's steps."""
    found = {each.name: import_module(f"{maneuver.__name__}.{each.name}") for each in pkgutil.iter_modules(maneuver.__path__)}
    return dict(sorted(found.items(), key=lambda each: each[1].STEP))


def find(name: str) -> ModuleType:
    """One maneuver; raises UnknownError that names the nearest."""
    if name not in maneuvers():
        raise UnknownError(f"There is no maneuver {name!r}; {nearest(name, maneuvers())}")
    return maneuvers()[name]


def has(recording: Recording, module: ModuleType) -> bool:
    """Whether everything was recorded that a maneuver is fed with and judged by."""
    return not missing(recording, module)


def missing(recording: Recording, module: ModuleType) -> list[str]:
    """Our signals that a maneuver needs and that are not there."""
    wanted = [*module.FED, *module.JUDGED]
    return [each for each in wanted if not any(name in recording.signals for name in each.split("|"))]


def unjudged(module: ModuleType, runs: Sequence[Recording]) -> list[str]:
    """What a maneuver does not judge: parts of its own signals, and signals that every run has and that it leaves aside."""
    recorded = [name for name in ANSWERS if name not in module.JUDGED and all(name in run.signals for run in runs)]
    return [*module.UNJUDGED, *(f"{name.replace('_', ' ')}, which was recorded" for name in recorded)]


def check(recording: Recording, module: ModuleType) -> None:
    """Raises ScenarioError that names what was not recorded."""
    lacks = missing(recording, module)
    if lacks:
        remedy = f"map {' or '.join(each.replace('|', ' or ') for each in lacks)} in the mapping, or leave the run out"
        found = [Problem(recording.name, f"has no {each.replace('|', ' and no ')}", remedy=remedy) for each in lacks]
        raise ScenarioError(f"{recording.name} lacks what a {module.TITLE} needs.", found)


def cuts(recording: Recording) -> list[tuple[str, float, float]]:
    """Every maneuver that is found in a long log: which, from when to when [s], in the order of time."""
    found = [(name, *span) for name, module in maneuvers().items() if has(recording, module) for span in module.find(recording)]
    return sorted(found, key=lambda each: each[1])
