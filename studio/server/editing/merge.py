"""Edits that meet: one that was made to an older text is done to the present one, unless both have changed the same thing.

Two changes touch when a place of one lies at, within or around a place of the other. A list whose length has changed counts as one
place: its numbers mean other entries now.
"""

from collections.abc import Iterable
from typing import Any

from studio.errors import Problem, ScenarioError, short
from studio.scenario.text import pointer
from studio.scenario.text.patch import Operation

Place = tuple[str, ...]


def places_of(patch: Iterable[Operation]) -> set[Place]:
    """The places that a patch is about."""
    return {place for each in patch for place in (each.parts, *([each.origin] if each.from_ is not None else []))}


def changed_places(before: Any, now: Any, at: Place = ()) -> set[Place]:
    """The places, as deep as they go, at which two documents differ."""
    if isinstance(before, dict) and isinstance(now, dict):
        return {
            place
            for key in before.keys() | now.keys()
            for place in (changed_places(before[key], now[key], (*at, key)) if key in before and key in now else {(*at, key)})
        }
    if isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        pairs = enumerate(zip(before, now, strict=True))
        return {place for i, (one, other) in pairs for place in changed_places(one, other, (*at, str(i)))}
    return set() if before == now and type(before) is type(now) else {at}


def touch(one: Place, other: Place) -> bool:
    """Whether one place is at, within or around the other."""
    shared = min(len(one), len(other))
    return one[:shared] == other[:shared]


def conflicts(patch: Iterable[Operation], before: Any, now: Any) -> list[Problem]:
    """Where a patch of an older document is about what was changed since."""
    wanted, taken = places_of(patch), changed_places(before, now)
    return [conflict(place, before, now) for place in sorted(taken) if any(touch(place, each) for each in wanted)]


def conflict(place: Place, before: Any, now: Any) -> Problem:
    """One place that both have changed."""
    what = "has been changed by somebody else meanwhile"
    return Problem(".".join(place), what, told(now, place), f"{told(before, place)} before", "look at it, then do it again")


def told(document: Any, place: Place) -> str:
    """What stands at a place."""
    try:
        return short(pointer.get(document, place))
    except ScenarioError:  # whatever its parent has become, nothing stands there
        return "nothing"
