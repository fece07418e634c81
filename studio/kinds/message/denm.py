"""Decentralised environmental notification message (DENM): a warning that an application sends when something has happened.

ETSI EN 302 637-3. The codes are those of its table of causes; 300 to 800 bytes are measured with certificate, 400 taken here. It is
sent once for every event and repeated as long as its sender likes: which event it is about stands in it, so that nobody counts one twice.
"""

from typing import Annotated, NamedTuple

KIND = "message"
TITLE = "Warning of an event (DENM)"
SIZE = 400
TRAFFIC, ACCIDENT, OBSTACLE, PERSON, STATIONARY, BRAKES_HARD, COLLISION_RISK = 1, 2, 10, 12, 94, 99, 97  # causes of the standard


class Payload(NamedTuple):
    """The event."""

    event: Annotated[float, "1", "number that the sender has given it"] = 0.0
    cause: Annotated[float, "1", "what it is, by the standard's code: 2 accident, 10 obstacle, 94 stationary vehicle, 99 braking"] = 0.0
    x: Annotated[float, "m", "east position of the event"] = 0.0
    y: Annotated[float, "m", "north position"] = 0.0
    speed: Annotated[float, "m/s", "of what it is about"] = 0.0
    detected: Annotated[float, "s", "when it was noticed, on the sender's clock"] = 0.0
    validity: Annotated[float, "s", "for how long from then on it counts; 0 takes it back"] = 0.0
