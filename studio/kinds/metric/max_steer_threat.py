"""Greatest steer threat number: the lateral acceleration that just carries a vehicle past what is ahead, over what its tyres give.

Past the nearer side, until it would be there: a_y = 2 (Δy - v_y TTC)/TTC², with v_y = 0 (M. Brännström et al., Model-based threat
assessment for avoiding arbitrary vehicle collisions, IEEE Trans. Intelligent Transportation Systems 11 (2010) 658). Above 1 steering does
not help any more. Of vehicles ahead that were recorded.
"""

from studio.assess.beside import way_aside
from studio.assess.following import lateral_acceleration_needed, ttc
from studio.assess.search import greatest_behind
from studio.kind.metric import Scope
from studio.kind.settings import number

KIND = "metric"
TITLE = "Greatest steer threat number"
UNIT = "1"
BETTER = "lower"
ABOUT = "{0} behind {1}"


class Settings(Scope):
    """What the tyres give."""

    lateral_acceleration: float = number(7.0, unit="m/s²", title="Greatest lateral acceleration", gt=0.1, le=20)


def measure(record, settings):
    """Threat [1]; nothing when nobody had a recorded vehicle ahead."""
    needed = lateral_acceleration_needed(way_aside(record), 0.0, ttc(record))
    return greatest_behind(record, needed / settings.lateral_acceleration)
