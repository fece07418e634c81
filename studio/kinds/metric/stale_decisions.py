"""Share of the moments at which an application decided on a message that was older than a limit; the worst link counts.

Over the links that applications use, at the samples of the record, while both ends take part.
"""

from studio.assess.freshness import share_older
from studio.assess.search import worst_link
from studio.kind.metric import Scope
from studio.kind.settings import number

KIND = "metric"
TITLE = "Share of decisions on stale data"
UNIT = "1"
BETTER = "lower"
ABOUT = "{0} heard by {1}"


class Settings(Scope):
    """What is stale."""

    limit: float = number(0.3, unit="s", title="Greatest age", description="of what is still fresh", gt=0, le=100)


def measure(record, settings):
    """Share [1]; nothing without a link."""
    return worst_link(record, share_older(record.ages, settings.limit))
