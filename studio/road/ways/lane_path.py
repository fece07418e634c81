"""What is driven through a network, lane by lane."""

from dataclasses import dataclass

from studio.road.network import Network


@dataclass(frozen=True)
class LanePath:
    """Lane ids in the order they are driven, with the ways through junctions.

    Two neighbours of the same road in sequence are a lane change within that road.
    """

    lanes: tuple[int, ...]

    def roads(self, network: Network) -> tuple[str, ...]:
        """The roads that are passed, without junctions."""
        passed = [network.lanes[lane] for lane in self.lanes]
        names = [lane.road for lane in passed if not lane.internal]
        return tuple(name for i, name in enumerate(names) if i == 0 or names[i - 1] != name)
