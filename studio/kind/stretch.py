"""Stretches: the part of a road that something is about, along a route or along a lane. Kinds add their own fields to them."""

from pydantic import Field, model_validator

from studio.kind.settings import Part, RouteName, number, without


class Stretch(Part):
    """A stretch along a route, or along a lane of a road."""

    route: RouteName | None = Field(None, title="Along the route")
    road: str | None = Field(None, max_length=100, title="Along the road")
    lane: int = Field(0, ge=0, le=9, title="Lane", description="of the road; 0 is the lane at the kerb")
    start: float = number(..., unit="m", title="From station", ge=0)
    end: float = number(..., unit="m", title="To station", gt=0)

    @model_validator(mode="after")
    def is_a_stretch(self):
        if (self.route is None) == (self.road is None):
            raise ValueError("give either `route`, or `road` with `lane`")
        return ordered(self if self.route is None else without(self, "lane", beside="route"))


class LaneStretch(Part):
    """A stretch of one lane of a road, with a taper before it and behind it on which cars go over."""

    road: str = Field(..., max_length=100, title="Road")
    lane: int = Field(0, ge=0, le=9, title="Lane", description="of the road; 0 is the lane at the kerb")
    start: float = number(..., unit="m", title="From station", description="of the road", ge=0)
    end: float = number(..., unit="m", title="To station", gt=0)
    taper: float = number(30.0, unit="m", title="Taper", description="before the start and behind the end", ge=10, le=200)

    @model_validator(mode="after")
    def is_a_stretch(self):
        return ordered(self)


def ordered(stretch):
    """A stretch that ends behind its start."""
    if stretch.end <= stretch.start:
        raise ValueError(f"the stretch must end ({stretch.end} m) behind its start ({stretch.start} m)")
    return stretch
