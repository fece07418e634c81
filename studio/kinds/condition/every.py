"""Again and again, with the same time between: for entries that begin again."""

from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.world.condition import ROUNDING

KIND = "condition"
TITLE = "Again and again"


class Settings(Part):
    """How often, and from when on."""

    period: float = number(..., unit="s", title="Period", gt=0.02, le=3600)
    first: float = number(0.0, unit="s", title="First at", ge=0, le=3600)


@compiled
def holds(view, settings):
    """At the first tick of every period, and at that only."""
    since = view.time - settings.first + ROUNDING
    return since >= 0.0 and since % settings.period < view.tick


def never(settings, place):
    """Not when the run is over before."""
    return f"the run ends at {place.duration:g} s" if settings.first >= place.duration else ""
