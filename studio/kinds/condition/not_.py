"""Another condition does not hold."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part
from studio.kind.slot import AnyCondition

KIND = "condition"
TITLE = "Not"


class Settings(Part, defer_build=True):
    """Which."""

    of: AnyCondition = Field(..., title="Not this")


@compiled
def joins(settings, parts):
    """Whether it does not."""
    return parts.true == 0
