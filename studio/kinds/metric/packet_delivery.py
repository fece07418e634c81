"""Share of messages that arrived at those who were within a distance: received over sent, counted at every receiver in range of the radio.

With `nearest` and `farthest` it is the delivery in one bin of distance, as field trials tell it. A receiver that was out of the radio's
range is not counted at all, and where nobody was in range there is no share: the measure says so.
"""

from math import nan

from pydantic import model_validator

from studio.kind.metric import Found, Scope
from studio.kind.settings import number

KIND = "metric"
TITLE = "Share of messages delivered"
UNIT = "1"
BETTER = "higher"


class Settings(Scope):
    """The bin of distance."""

    nearest: float = number(0.0, unit="m", title="From a distance", ge=0, le=100_000)
    farthest: float = number(100_000.0, unit="m", title="To a distance", gt=0, le=100_000)

    @model_validator(mode="after")
    def is_a_bin(self):
        if self.farthest <= self.nearest:
            raise ValueError(f"it must reach farther ({self.farthest:g} m) than it begins ({self.nearest:g} m)")
        return self


def measure(record, settings):
    """Share [1]; nothing when nobody was there to receive anything."""
    sent = record.messages
    counts = (sent.distance >= settings.nearest) & (sent.distance < settings.farthest)
    return sent.is_received[counts].mean() if counts.any() else Found(nan, why=nothing(sent, settings))


def nothing(sent, settings):
    """Why there is no share, in words."""
    if not sent.time.size:
        return "no message was sent"
    return f"nobody was {settings.nearest:g} to {settings.farthest:g} m from a sender, and in range of its radio"
