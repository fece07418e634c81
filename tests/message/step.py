"""One step of a handshake that is tried: which of many, and which of its three messages."""

from typing import Annotated, NamedTuple

KIND = "message"
TITLE = "Step of a handshake"
SIZE = 120


class Payload(NamedTuple):
    """What is told."""

    round: Annotated[float, "1", "which handshake"] = -1.0
    stage: Annotated[float, "1", "1 request or acknowledgement, 2 commitment"] = 0.0
