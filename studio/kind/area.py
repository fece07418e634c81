"""Areas: a part of the map, as a circle, a polygon, or a stretch of a lane from edge to edge."""

from typing import Annotated

from pydantic import Field, model_validator

from studio.kind.settings import Part, number, without

Corner = Annotated[tuple[float, float], Field(json_schema_extra={"unit": "m"})]


class Area(Part):
    """Where: `x`, `y` and `radius`; or `corners`; or `road` with `lane`, `start` and `end`."""

    x: float | None = Field(None, title="Middle, east", json_schema_extra={"unit": "m"})
    y: float | None = Field(None, title="Middle, north", json_schema_extra={"unit": "m"})
    radius: float | None = Field(None, gt=0, le=100_000, title="Radius", json_schema_extra={"unit": "m"})
    corners: list[Corner] = Field([], max_length=64, title="Corners", description="of a polygon, east and north, in either direction")
    road: str | None = Field(None, max_length=100, title="Road")
    lane: int = Field(0, ge=0, le=9, title="Lane", description="of the road; 0 is the lane at the kerb")
    start: float = number(0.0, unit="m", title="From station", description="of the road", ge=0)
    end: float | None = Field(None, gt=0, title="To station", description="left out: to its end", json_schema_extra={"unit": "m"})

    @model_validator(mode="after")
    def is_somewhere(self):
        circle = [self.x is not None, self.y is not None, self.radius is not None]
        if [any(circle), bool(self.corners), self.road is not None].count(True) != 1 or any(circle) != all(circle):
            raise ValueError("give either `x`, `y` and `radius`, or `corners`, or `road`")
        if self.road is None:
            without(self, "lane", "start", "end", beside="x" if any(circle) else "corners")
        if crosses_itself(self.corners):
            raise ValueError("the outline crosses itself: give its corners in the order in which one goes around it")
        if self.corners and extent(self.corners) <= 0.0:
            raise ValueError("the area has no extent: give at least three corners that do not lie on one line")
        if self.end is not None and self.end <= self.start:
            raise ValueError(f"the area has no extent: it must end ({self.end} m) behind its start ({self.start} m)")
        return self


def crosses_itself(corners: list[tuple[float, float]]) -> bool:
    """Whether two sides of a polygon that do not follow each other cross."""
    sides = list(zip(corners, corners[1:] + corners[:1], strict=True))
    return any(cross(*sides[i], *sides[j]) for i in range(len(sides)) for j in range(i + 2, len(sides)) if (i, j) != (0, len(sides) - 1))


def cross(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], d: tuple[float, float]) -> bool:
    """Whether the ways from a to b and from c to d cross, not only touch."""
    return side(a, b, c) * side(a, b, d) < 0.0 and side(c, d, a) * side(c, d, b) < 0.0


def side(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    """On which side of the line from a to b another place is: left positive."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def extent(corners: list[tuple[float, float]]) -> float:
    """Content [m²] of a polygon."""
    pairs = zip(corners, corners[1:] + corners[:1], strict=True)
    return 0.5 * abs(sum(x * b - a * y for (x, y), (a, b) in pairs))
