"""A message was sent, has come in, or was lost, since the tick before: of a kind, from one unit, to another, or of and between any.

A message is lost for a unit when it is sent and will not come in: by chance, behind a house, out of reach, or as the script has it.
"""

from typing import Literal

from pydantic import Field, model_validator

from studio.compiled import compiled
from studio.kind.settings import MessageName, Part, UnitName
from studio.world.mail import M_KIND, M_LOST, M_RECEIVED, M_RECEIVER, M_SENDER, M_SENT

KIND = "condition"
TITLE = "A message was sent, received or lost"
READS_MAIL = True


class Settings(Part):
    """What has happened to which message."""

    was: Literal["sent", "received", "lost"] = Field("received", title="Was")
    message: MessageName | None = Field(None, title="Kind of message", description="left out: any")
    sender: UnitName | None = Field(None, title="From", description="left out: anybody")
    receiver: UnitName | None = Field(None, title="To", description="left out: anybody; of a message that was sent nothing is asked")

    @model_validator(mode="after")
    def are_two(self):
        if self.sender is not None and self.sender == self.receiver and self.was != "sent":
            raise ValueError(f"`sender` and `receiver` are both {self.sender!r}: nobody hears himself; name two, or leave one out")
        return self


@compiled
def fits(wanted, given):
    """Whether something is what is wanted, or nothing is."""
    return wanted != wanted or wanted == given


@compiled
def holds(view, settings):
    """At the ticks at which there is one, and at no other."""
    row = M_SENT if settings.was == 0.0 else M_RECEIVED if settings.was == 1.0 else M_LOST
    for i in range(view.mail.shape[1]):
        if view.mail[row, i] == 0.0 or not fits(settings.message, view.mail[M_KIND, i]):
            continue
        if fits(settings.sender, view.mail[M_SENDER, i]) and (settings.was == 0.0 or fits(settings.receiver, view.mail[M_RECEIVER, i])):
            return True
    return False


def never(settings, place):
    """Not of a kind that nobody sends."""
    sends = place.sent()
    return f"nobody sends messages of the kind {settings.message!r}" if settings.message not in (None, *sends) else ""
