"""Another entry of the script acts now: it has begun, and not ended."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import EntryName, Part

KIND = "condition"
TITLE = "Another entry acts"


class Settings(Part):
    """Which."""

    entry: EntryName = Field(..., title="Entry of the script")


@compiled
def holds(view, settings):
    """From its beginning to its end."""
    begun, ended = view.turned[0, int(settings.entry)], view.turned[1, int(settings.entry)]
    return begun == begun and not ended >= begun
