"""Greatest brake threat number: the required deceleration over what the brakes give. Above 1 braking alone does not help any more.

M. Brännström et al., Model-based threat assessment for avoiding arbitrary vehicle collisions, IEEE Trans. Intelligent Transportation
Systems 11 (2010) 658.
"""

from studio.assess.following import pairs, required_deceleration
from studio.assess.search import greatest_behind
from studio.kind.metric import Scope
from studio.kind.settings import number

KIND = "metric"
TITLE = "Greatest brake threat number"
UNIT = "1"
BETTER = "lower"
ABOUT = "{0} behind {1}"


class Settings(Scope):
    """What the brakes give."""

    deceleration: float = number(8.0, unit="m/s²", title="Greatest deceleration", gt=0.1, le=20)


def measure(record, settings):
    """Threat [1]; nothing when nobody had somebody ahead."""
    return greatest_behind(record, required_deceleration(pairs(record)) / settings.deceleration)
