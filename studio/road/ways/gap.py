"""Critical gaps: how much time a driver wants before the next of those who go first, at each way through a junction.

Base values for passenger cars: Transportation Research Board, Highway Capacity Manual 2000, exhibit 17-5; whoever enters a ring
meets one stream only, exhibit 17-37 (4.1 to 4.6 s). The left of the tables is the side on which one crosses oncoming traffic.
"""

from studio.road.network import Connection, Side

ACROSS_ONCOMING = 4.1  # [s] turning off a major road
FROM_MINOR = {"across": 7.1, "through": 6.5, "near": 6.2}  # [s]
EQUALS = 4.1  # [s] between equal roads, where all are slow
MAJOR = ("signal", "priority")


def critical_gap(connection: Connection, side: Side) -> float:
    """The critical gap of a way [s]."""
    if connection.right_of_way == "roundabout" or connection.right_of_way in MAJOR:
        return ACROSS_ONCOMING
    if connection.right_of_way in ("yield", "stop"):
        return FROM_MINOR[movement(connection.direction, side)]
    return EQUALS


def movement(direction: str, side: Side) -> str:
    """Whether a way turns across oncoming traffic, goes through, or turns to the near side."""
    far = "left" if side == "right" else "right"
    if direction == "straight":
        return "through"
    return "across" if direction.endswith(far) or direction == "turn" else "near"
