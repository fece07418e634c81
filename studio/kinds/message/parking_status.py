"""Status of a car that parks by itself: what its garage must know of it.

80 bytes with signature are estimated.
"""

from typing import Annotated, NamedTuple

KIND = "message"
TITLE = "Status of a car in a garage"
SIZE = 80
OUTSIDE, DRIVING_IN, PARKED, COMING_BACK, GIVEN_BACK = 0.0, 1.0, 2.0, 3.0, 4.0  # phases


class Payload(NamedTuple):
    """The sender."""

    ticket: Annotated[float, "1", "number that it goes by"] = 0.0
    phase: Annotated[float, "1", "0 outside, 1 drives in, 2 parked, 3 comes back, 4 given back"] = 0.0
    x: Annotated[float, "m", "east, of the middle of its outline as it takes it; outside by satellite"] = 0.0
    y: Annotated[float, "m", "north, likewise"] = 0.0
    rear: Annotated[float, "m", "station on the deck of its rear end"] = -1e3
    wheelbase: Annotated[float, "m", "of the car"] = 0.0
    length: Annotated[float, "m", "of its outline"] = 0.0
    width: Annotated[float, "m", "likewise"] = 0.0
    front: Annotated[float, "m", "front overhang"] = 0.0
    radius: Annotated[float, "m", "that its rear axle turns with"] = 0.0
