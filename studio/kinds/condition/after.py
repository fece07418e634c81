"""Some time has passed since another entry of the script began, or ended."""

from typing import Literal

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import EntryName, Part, number
from studio.world.condition import ROUNDING

KIND = "condition"
TITLE = "Some time after another entry"


class Settings(Part):
    """After which entry, and how long."""

    entry: EntryName = Field(..., title="Entry of the script")
    turn: Literal["begins", "ends"] = Field("begins", title="Counted from when it")
    delay: float = number(0.0, unit="s", title="Time after it", ge=0, le=3600)


@compiled
def holds(view, settings):
    """Not before the other has begun or ended: until then this is not a number."""
    return view.time >= view.turned[int(settings.turn), int(settings.entry)] + settings.delay - ROUNDING
