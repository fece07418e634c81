"""Greatest deceleration that a vehicle needed before what is ahead, which goes on to brake as it does until it stands.

studio/assess/following.py derives it. M. Brännström et al., Model-based threat assessment for avoiding arbitrary vehicle collisions, IEEE
Trans. Intelligent Transportation Systems 11 (2010) 658.
"""

from studio.assess.following import pairs, required_deceleration
from studio.assess.search import greatest_behind

KIND = "metric"
TITLE = "Greatest required deceleration"
UNIT = "m/s²"
BETTER = "lower"
ABOUT = "{0} behind {1}"


def measure(record):
    """Deceleration [m/s²]; nothing when nobody had somebody ahead."""
    return greatest_behind(record, required_deceleration(pairs(record)))
