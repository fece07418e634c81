"""Intent: which lane a car is about to take, and the gap that it needs there.

As in the manoeuvre coordination messages that ETSI TR 103 578 describes: what somebody is about to do, not only where he is.
"""

from typing import Annotated, NamedTuple

KIND = "message"
TITLE = "Intent to change the lane"
SIZE = 120


class Payload(NamedTuple):
    """What is told."""

    side: Annotated[float, "1", "1 to the left, -1 to the right, 0 nothing is intended"] = 0.0
    gap: Annotated[float, "m", "that is needed, bumper to bumper"] = 0.0
    speed: Annotated[float, "m/s", "that the sender drives"] = 0.0
