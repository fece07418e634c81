"""The explanation of what happened in a saved run, for the command line and REST."""

from typing import Any

from studio.assess.cause import EXPLAINED, Explanation, explain
from studio.errors import UnknownError, nearest, short
from studio.store.runs import Runs

LONGEST = 9  # digits of the number of an event
GREATEST = "deceleration_max"  # [m/s²] what applications call the greatest deceleration that they ask for


def explanation(runs: Runs, run: int, event: str = "") -> list[Explanation]:
    """Why things happened in a run, in the order of time: all that can be told, those of one kind, or one by its number from 1 on.

    Raises UnknownError for a run without record, for a kind that is not explained, and for a number that there is not.
    """
    if event and not event.isdecimal() and event not in EXPLAINED:
        raise UnknownError(f"Events {short(event)} are not explained; {nearest(event, EXPLAINED)}")
    found = explain(runs.record(run), (event,) if event in EXPLAINED else EXPLAINED, decelerations(runs.document(runs.find(run))))
    if not event.isdecimal():
        return found
    if len(event) > LONGEST or not 1 <= int(event) <= len(found):
        count = f"1 to {len(found)}" if found else "none: no collision, near miss or hard brake"
        raise UnknownError(f"Run {run} has no event {event if len(event) <= LONGEST else short(event)} to explain; there is {count}.")
    return [found[int(event) - 1]]


def decelerations(document: dict[str, Any]) -> dict[str, float]:
    """The greatest deceleration [m/s²] by groups of applications, of those that have one; nothing of one whom the script tunes."""
    tuned = {each["do"].get("application") for each in document["script"].values() if GREATEST in each["do"].get("parameters", {})}
    groups = {name: each["parameters"] for name, each in document["applications"].items() if name not in tuned}
    return {name: float(each[GREATEST]) for name, each in groups.items() if isinstance(each.get(GREATEST), int | float)}
