"""A moment is marked: nothing is done, but the event stands in the list, with its words."""

from pydantic import Field

from studio.kind.settings import Part

KIND = "action"
TITLE = "Mark the moment"
MOMENTARY = True


class Settings(Part):
    """What is said."""

    text: str = Field("", max_length=200, title="Text", description="for the list of events")


def effects(settings, place):
    """None."""
    return []


def told(settings):
    """In words."""
    return settings.text or "marked"
