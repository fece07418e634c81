"""The lights at the end of a road show a colour. All lanes of a road show the same."""

from typing import Literal

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, SignalName

KIND = "condition"
TITLE = "A light shows a colour"


class Settings(Part):
    """Which light, and what it shows."""

    road: SignalName = Field(..., title="Road", description="with the lights at its end")
    shows: Literal["red", "red_amber", "green", "amber"] = Field("red", title="Shows")


@compiled
def holds(view, settings):
    """What it has shown since the tick before; the colours count as in the programmes of signals."""
    return view.shown[int(settings.road)] == int(settings.shows)
