"""All of several conditions hold at once."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part
from studio.kind.slot import AnyCondition

KIND = "condition"
TITLE = "All of several"


class Settings(Part, defer_build=True):
    """Which."""

    of: list[AnyCondition] = Field(..., min_length=1, max_length=16, title="All of these")


@compiled
def joins(settings, parts):
    """Whether none is missing."""
    return parts.true == parts.count


def never(settings, place):
    """Not when one of them never does."""
    return next(filter(None, map(place.never, settings.of)), "")
