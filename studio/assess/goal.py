"""Goals: what is wanted of a measure, and whether a run meets it. Who only reads runs waits for nothing that measures them."""

from collections.abc import Mapping
from typing import Any, NamedTuple, Protocol

from studio.assess.metric import Measured


class Wanted(Protocol):
    """The least and the most that a measure may be, in its unit; None for no such end."""

    @property
    def least(self) -> float | None: ...

    @property
    def most(self) -> float | None: ...


class Ends(NamedTuple):
    """The same as it stands in the document of a run."""

    least: float | None = None
    most: float | None = None


def goals_of(document: Mapping[str, Any]) -> dict[str, Ends]:
    """The goals of a run's scenario, by metric."""
    return {name: Ends(goal.get("least"), goal.get("most")) for name, goal in document.get("goals", {}).items()}


def unmet(goals: Mapping[str, Wanted], metrics: Mapping[str, Measured]) -> list[str]:
    """Sentences about the goals that are not met."""
    return [text for name, goal in goals.items() if (text := failing(name, goal, metrics.get(name)))]


def asked(goal: Wanted) -> str:
    """What a goal wants, in words."""
    ends = (("at least", goal.least), ("at most", goal.most))
    return " and ".join(f"{word} {end:g}" for word, end in ends if end is not None) or "nothing"


def failing(name: str, goal: Wanted, found: Measured | None) -> str:
    """Why a goal is not met, or nothing."""
    if found is None or found.value is None:
        return f"{name} could not be measured" + (f": {found.about}" if found and found.about else "")
    about = f" ({found.about})" if found.about else ""
    if goal.least is not None and found.value < goal.least:
        return f"{name} is {found.value:.4g} {found.unit}{about}, at least {goal.least:g} is wanted"
    if goal.most is not None and found.value > goal.most:
        return f"{name} is {found.value:.4g} {found.unit}{about}, at most {goal.most:g} is wanted"
    return ""
