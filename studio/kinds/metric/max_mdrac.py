"""Greatest deceleration that just avoids a collision after a reaction time: MDRAC = Δv/(2 (TTC - PRT)).

S. M. S. Mahmud et al., Application of proximal surrogate indicators for safety evaluation, IATSS Research 41 (2017) 153. Above 3.4 m/s² it
is a conflict. Where the time to collision is shorter than the reaction time no deceleration helps: such moments do not count here, but
in the least time to collision.
"""

from studio.assess.following import mdrac, pairs
from studio.assess.search import greatest_behind
from studio.kind.metric import Scope
from studio.kind.settings import number

KIND = "metric"
TITLE = "Deceleration to avoid it after a reaction"
UNIT = "m/s²"
BETTER = "lower"
ABOUT = "{0} behind {1}"


class Settings(Scope):
    """Who reacts."""

    reaction_time: float = number(1.0, unit="s", title="Reaction time", ge=0, le=5)


def measure(record, settings):
    """Deceleration [m/s²]; nothing when nobody had somebody ahead."""
    return greatest_behind(record, mdrac(pairs(record), settings.reaction_time))
