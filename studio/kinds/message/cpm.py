"""Collective perception message (CPM): what a unit sees, told to those who do not.

ETSI TS 103 324. Up to eight objects, in the sender's own frame; an application fills it from its sensors, and leaves out what has changed
so little that nobody must know (`is_told` of studio/model/generation.py). 200 to 1600 bytes are measured; a head of 150 bytes with
signature and 45 an object are taken here.
"""

from typing import Annotated, NamedTuple

from studio.compiled import compiled

KIND = "message"
TITLE = "Perceived objects (CPM)"
MOST = 8  # objects
HEAD, OBJECT = 150, 45  # [bytes]
SIZE = HEAD + MOST * OBJECT
NONE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
Eight = tuple[float, float, float, float, float, float, float, float]


class Payload(NamedTuple):
    """The sender, and the objects that it tells of; of each the same place in every list."""

    x: Annotated[float, "m", "east position of the sender by satellite, with its errors"] = 0.0
    y: Annotated[float, "m", "north position, likewise"] = 0.0
    speed: Annotated[float, "m/s", "of the sender"] = 0.0
    count: Annotated[float, "1", "how many objects it tells of"] = 0.0
    identity: Annotated[Eight, "1", "number that the sensor has given each object"] = NONE
    age: Annotated[Eight, "s", "since each was measured"] = NONE
    ahead: Annotated[Eight, "m", "place of each before the sender's position, along its heading"] = NONE
    left: Annotated[Eight, "m", "place of each to the left of it"] = NONE
    speed_ahead: Annotated[Eight, "m/s", "speed of each along the sender's heading"] = NONE


@compiled
def size(payload):
    """Bytes, by the number of objects."""
    return HEAD + OBJECT * min(max(int(payload.count), 0), MOST)
