"""A way for cars, as OpenStreetMap has it."""

from dataclasses import dataclass, replace

from studio.road.formats.identity import named
from studio.road.network.report import Spot


@dataclass(frozen=True)
class Way:
    """A car way: node ids, their positions (longitude, latitude) [deg], tags."""

    id: int
    nodes: list[int]
    points: list[tuple[float, float]]
    tags: dict[str, str]
    gaps: frozenset[int] = frozenset()  # after these nodes the file lacks some
    part_of: int = 0  # the id of the mapped way that this is a piece of

    @property
    def mapped(self) -> int:
        """The id that the way has in the map."""
        return self.part_of or self.id

    def with_tags(self, text: dict[str, str]) -> "Way":
        """The same way with other tags."""
        return replace(self, tags=text)


def is_one_way(way: Way) -> bool:
    """Whether a way is driven in its own direction only; roundabouts are by themselves."""
    default = way.tags.get("junction") in ("roundabout", "circular")
    return way.tags["oneway"] in ("yes", "true", "1") if "oneway" in way.tags else default


def spot_of(way: Way) -> Spot:
    """A way as something that one can point at, in its middle."""
    longitude, latitude = way.points[len(way.points) // 2]
    name = way.tags.get("name", "")
    element = named("way", way.mapped)
    return Spot(element + (f" ({name})" if name else ""), latitude, longitude, element)
