"""Orders of a garage to the cars that are handed over to it: where each is, which space it has, how far it may drive; and who walks about.

A garage that localises and directs the cars in it (types 2 and 3 of ISO 23374-1). Of each car the same place in every list; a car knows
itself by the ticket that it has told when it came. The plan of the deck goes along. A head of 60 bytes with signature and plan, 20 a car
and 8 a person are estimated.
"""

from typing import Annotated, NamedTuple

from studio.compiled import compiled

KIND = "message"
TITLE = "Orders of a garage"
MOST, PERSONS = 12, 4
HEAD, CAR, PERSON = 60, 20, 8  # [bytes]
SIZE = HEAD + MOST * CAR + PERSONS * PERSON
NONE = (0.0,) * MOST
Twelve = tuple[float, float, float, float, float, float, float, float, float, float, float, float]
Four = tuple[float, float, float, float]
STAY, DRIVE_IN, COME_BACK = 0.0, 1.0, 2.0  # orders


class Payload(NamedTuple):
    """All cars, and the persons that the cameras see."""

    count: Annotated[float, "1", "cars that it tells of"] = 0.0
    age: Annotated[float, "s", "since the cameras have looked"] = 0.0
    ticket: Annotated[Twelve, "1", "of each car"] = NONE
    x: Annotated[Twelve, "m", "east, of the middle of its outline on the map"] = NONE
    y: Annotated[Twelve, "m", "north, likewise"] = NONE
    heading: Annotated[Twelve, "rad", "counter-clockwise from east"] = NONE
    is_seen: Annotated[Twelve, "1", "1 where the cameras have found it"] = NONE
    order: Annotated[Twelve, "1", "0 stay, 1 drive in, 2 come back"] = NONE
    space: Annotated[Twelve, "1", "number of its space"] = NONE
    permit: Annotated[Twelve, "m", "station on the deck that its front may reach"] = NONE
    persons: Annotated[float, "1", "how many are told of"] = 0.0
    person_x: Annotated[Four, "m", "east"] = (0.0, 0.0, 0.0, 0.0)
    person_y: Annotated[Four, "m", "north"] = (0.0, 0.0, 0.0, 0.0)
    groups: Annotated[float, "1", "of spaces in each row of the deck; 0 before anything was told"] = 0.0
    together: Annotated[float, "1", "spaces of a group"] = 0.0
    space_length: Annotated[float, "m", "of a space"] = 0.0
    space_width: Annotated[float, "m", "of a space"] = 0.0
    aisle: Annotated[float, "m", "width of the aisles"] = 0.0


@compiled
def size(payload):
    """Bytes, by whom it tells of."""
    return int(HEAD + CAR * payload.count + PERSON * payload.persons)
