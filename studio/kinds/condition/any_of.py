"""At least one of several conditions holds."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part
from studio.kind.slot import AnyCondition

KIND = "condition"
TITLE = "Any of several"


class Settings(Part, defer_build=True):
    """Which."""

    of: list[AnyCondition] = Field(..., min_length=1, max_length=16, title="Any of these")


@compiled
def joins(settings, parts):
    """Whether there is one."""
    return parts.true > 0


def never(settings, place):
    """Not when none of them ever does."""
    return "; ".join(found) if all(found := [place.never(each) for each in settings.of]) else ""
