"""Maneuver message: two or more agree on what they are about to do, in six steps.

    REQUEST  →  ACCEPT or REJECT  →  COMMIT  →  DONE or ABORT

As the maneuver coordination of ETSI TR 103 578: who asks gives the maneuver a number and a deadline, after which it is off. 300 bytes
and more are usual.
"""

from typing import Annotated, NamedTuple

KIND = "message"
TITLE = "Maneuver: request, accept, reject, commit, done, abort"
SIZE = 300
REQUEST, ACCEPT, REJECT, COMMIT, DONE, ABORT = 1, 2, 3, 4, 5, 6  # steps


class Payload(NamedTuple):
    """One step."""

    step: Annotated[float, "1", "1 request, 2 accept, 3 reject, 4 commit, 5 done, 6 abort"] = 0.0
    identity: Annotated[float, "1", "number that who asks has given the maneuver"] = 0.0
    asking: Annotated[float, "1", "number of the unit that has asked"] = 0.0
    asked: Annotated[float, "1", "number of the unit that is asked; -1 for everybody"] = -1.0
    deadline: Annotated[float, "s", "on the clock of who asks: what is not done by then is off"] = 0.0
    side: Annotated[float, "1", "1 to the left, -1 to the right, 0 stays in its lane"] = 0.0
    gap: Annotated[float, "m", "that is needed, bumper to bumper"] = 0.0
    acceleration: Annotated[float, "m/s²", "that is offered or asked for"] = 0.0
    ahead: Annotated[float, "m", "where the sender sees whom it asks: its middle, ahead of the own front bumper"] = 0.0
    x: Annotated[float, "m", "east position of the sender by its satellite receiver, with its errors"] = 0.0
    y: Annotated[float, "m", "north position, likewise"] = 0.0
    heading: Annotated[float, "rad", "of the road at the sender, on its way, counter-clockwise from east"] = 0.0
    lanes_left: Annotated[float, "1", "lanes of its direction to the left of the sender's; -1 where it cannot tell"] = -1.0
    lanes_right: Annotated[float, "1", "lanes of its direction to the right of the sender's; -1 where it cannot tell"] = -1.0
