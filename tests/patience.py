"""How long tests wait for what must happen. Nothing is proven by it: a machine may be slow, busy, and compile for the first time."""

import time
from collections.abc import Callable
from typing import TypeVar

PATIENCE = 300.0  # [s]
PATIENCE_MS = 1000.0 * PATIENCE  # as browsers count
LOOK_PERIOD = 0.05  # [s] between two looks
Seen = TypeVar("Seen")


def until(look: Callable[[], Seen], what: str = "") -> Seen:
    """What a look gives as soon as it is true; AssertionError, with the last look, when it never is."""
    end = time.monotonic() + PATIENCE
    while not (seen := look()):
        if time.monotonic() > end:
            raise AssertionError(f"waited in vain for {what or look}: {seen!r}")
        time.sleep(LOOK_PERIOD)
    return seen
