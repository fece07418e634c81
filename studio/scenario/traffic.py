"""The part of a scenario that says who else is on the road: how many cars, of which types, from where to where, and when.

A type is a model with its drivers. Wherever the traffic names a model, a type of this scenario may be named instead. Drivers of one type
differ: `spread` has, by the name of a driver's setting, the distribution from which each of them has his own value.
"""

from math import erf, exp, inf, log, sqrt
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import Field, model_validator

from studio.kind.driver import Driver
from studio.kind.settings import Name, Part, RouteName, number
from studio.kind.slot import OneOf, Slot

MODELS = sorted(path.stem for path in (Path(__file__).parent / "vehicles").glob("*.yaml"))  # suggested; files may be named too
MOST_CARS = 3000  # that go round, or are about of all flows at once
Dynamics = Literal["full", "light"]
AnyDriver = Annotated[Any, Slot("driver", usual="attentive")]


def model_field(default: Any, description: str) -> Any:
    """A field that names a model, or a type."""
    return Field(default, max_length=300, title="Model", examples=MODELS, description=description)


def dynamics_field(default: Any, more: str = "") -> Any:
    """A field that says with which dynamics a car moves."""
    told = "full: the whole model; light: a single track with lags and a bound of adhesion, without engine speed, gears, tyres and springs"
    return Field(default, title="Dynamics", description=told + more)


# -- how drivers differ ----------------------------------------------------------------------------


class Bounded(Part):
    """A distribution between bounds."""

    least: float | None = Field(None, title="Least", description="nobody is below; left out: what the setting allows")
    most: float | None = Field(None, title="Most", description="nobody is above; left out: what the setting allows")

    @model_validator(mode="after")
    def has_room(self):
        if self.least is not None and self.most is not None and self.least >= self.most:
            raise ValueError(f"no value is above {self.least:g} and below {self.most:g}: exchange them")
        return self


class Normal(Bounded):
    """The normal distribution; what lies beyond the bounds is drawn anew."""

    kind: Literal["normal"] = Field("normal", title="Kind")
    mean: float = Field(..., title="Mean", description="in the unit of the setting, before the bounds cut")
    deviation: float = Field(..., gt=0, title="Standard deviation", description="likewise")

    def below(self, value: float) -> float:
        """The share of numbers below a value, before the bounds cut."""
        return gauss((value - self.mean) / self.deviation)


class Lognormal(Bounded):
    """The distribution whose logarithm is normal, as reaction times have it; what lies beyond the bounds is drawn anew."""

    kind: Literal["lognormal"] = Field("lognormal", title="Kind")
    mean: float = Field(..., gt=0, title="Mean", description="in the unit of the setting, of the number itself, before the bounds cut")
    deviation: float = Field(..., gt=0, title="Standard deviation", description="likewise")

    @property
    def sigma(self) -> float:
        """Standard deviation of the logarithm."""
        return sqrt(log(1.0 + (self.deviation / self.mean) ** 2))

    @property
    def median(self) -> float:
        """The number that half of all are below."""
        return self.mean * exp(-0.5 * self.sigma**2)

    def below(self, value: float) -> float:
        """The share of numbers below a value, before the bounds cut."""
        return gauss(log(value / self.median) / self.sigma) if value > 0.0 else 0.0


class Uniform(Part):
    """All between two bounds alike."""

    kind: Literal["uniform"] = Field("uniform", title="Kind")
    least: float = Field(..., title="Least", description="in the unit of the setting")
    most: float = Field(..., title="Most", description="likewise")

    @model_validator(mode="after")
    def has_room(self):
        if self.least >= self.most:
            raise ValueError(f"no value is above {self.least:g} and below {self.most:g}: exchange them")
        return self


def gauss(z: float) -> float:
    """The share of standard normal numbers below z."""
    return 0.5 * (1.0 + erf(z / sqrt(2.0))) if abs(z) < inf else float(z > 0.0)


Distribution = Normal | Lognormal | Uniform
Spread = dict[Name, Annotated[Any, OneOf((Normal, Lognormal, Uniform))]]


def spread_field() -> Any:
    """A field for the distributions of drivers' settings."""
    told = "by the name of a driver's setting; each driver has a value of his own, drawn by the seed of the traffic"
    return Field({}, title="Spread of the drivers", description=told)


class CarType(Part, defer_build=True):
    """A model with its drivers, under a name that stands wherever the traffic names a model."""

    model: str = model_field("ford_escort", "a name of the catalogue, or a vehicle file (YAML) relative to the scenario")
    dynamics: Dynamics | None = dynamics_field(None, "; left out: those of the traffic")
    driver: AnyDriver | None = Field(None, title="Drivers", description="left out: those of the traffic, with their spread")
    spread: Spread = spread_field()


class Manned(NamedTuple):
    """A model with its dynamics and drivers, whatever says so."""

    model: str
    dynamics: Dynamics
    driver: Driver
    spread: Spread


# -- from where to where, and when -----------------------------------------------------------------


class Departures(Part):
    """When cars come in, and of what model."""

    headways: Literal["random", "even"] = Field(
        "random", title="Headways", description="random: independent of each other, as in free traffic (Poisson); even: one like the other"
    )
    begin: float = number(0.0, unit="s", title="From", ge=0, le=100_000)
    end: float | None = Field(
        None, gt=0, le=100_000, title="To", json_schema_extra={"unit": "s"}, description="left out: to the end of the run"
    )
    model: str | None = model_field(None, "or a type; left out: as in the traffic")

    @model_validator(mode="after")
    def ends_after_its_beginning(self):
        if self.end is not None and self.end <= self.begin:
            raise ValueError(f"it must end ({self.end:g} s) after its beginning ({self.begin:g} s)")
        return self


class Flow(Departures):
    """Cars that come in where a route begins and leave where it ends: so many an hour, for a while."""

    route: RouteName = Field(..., title="Route")
    rate: float = number(..., unit="1/h", title="Cars an hour", gt=0, le=20_000)
    lane: int | None = Field(
        None,
        ge=0,
        le=9,
        title="Lane",
        description="of the first road, 0 at the kerb; left out: all from which the route can be driven, in turn",
    )


class Trip(Part):
    """From a road of the map to another, so many times an hour."""

    origin: str = Field(..., max_length=100, title="From road", description="an id; cars come in where it begins")
    destination: str = Field(..., max_length=100, title="To road", description="an id; cars leave where it ends")
    rate: float = number(..., unit="1/h", title="Cars an hour", gt=0, le=20_000)


class Matrix(Departures):
    """Trips between origins and destinations in an interval of time, each by the quickest way."""

    trips: list[Trip] = Field(..., min_length=1, max_length=5000, title="Trips")


class Count(Part):
    """How many cars an hour were counted on a road, over all lanes: flows and trips that lead over it become as many."""

    road: str = Field(..., max_length=100, title="Road", description="an id of the map")
    rate: float = number(..., unit="1/h", title="Cars an hour", ge=0, le=20_000)
    begin: float = number(0.0, unit="s", title="From", ge=0, le=100_000, description="for cars that depart from then on")
    end: float | None = Field(
        None, gt=0, le=100_000, title="To", json_schema_extra={"unit": "s"}, description="left out: to the end of the run"
    )

    @model_validator(mode="after")
    def ends_after_its_beginning(self):
        if self.end is not None and self.end <= self.begin:
            raise ValueError(f"it must end ({self.end:g} s) after its beginning ({self.begin:g} s)")
        return self


class Traffic(Part, defer_build=True):
    """Cars that fill the map: so many on the ways from any arm to any other, and those that come in and leave."""

    count: int = Field(
        0, ge=0, le=MOST_CARS, title="Number of cars", json_schema_extra={"unit": "1"},
        description="who has arrived comes in again where his way begins; for whom there is no room at the start waits outside",
    )  # fmt: skip
    density: float | None = number(
        None, unit="1/km", title="Density", gt=0, le=150, description="cars per kilometre of lane, instead of their number"
    )
    flows: dict[Name, Flow] = Field({}, title="Flows")
    matrices: dict[Name, Matrix] = Field({}, title="Matrices", description="trips between origins and destinations")
    counts: dict[Name, Count] = Field(
        {}, title="Counts", description="of cars at places of the road; flows and trips become as many, those of a route file do not"
    )
    routes: str | None = Field(
        None, min_length=1, max_length=300, title="Route file",
        description="of SUMO, relative to the scenario (.rou.xml, .rou.xml.gz): its types, vehicles, trips and flows",
    )  # fmt: skip
    types: dict[Name, CarType] = Field({}, title="Types", description="models with drivers of their own")
    model: str = model_field(
        "ford_escort", "a name of the catalogue, a vehicle file (YAML) relative to the scenario, or a type; not used where there is a mix"
    )
    mix: dict[str, Annotated[float, Field(gt=0, le=1e6)]] = Field(
        {}, title="Mix", description="several models or types with their shares instead of one", max_length=30
    )
    dynamics: Dynamics = dynamics_field("full")
    speed: float = number(10.0, unit="m/s", title="Initial speed", description="of cars that are about from the start", ge=0, le=40)
    spacing: float = number(20.0, unit="m", title="Least distance at the start", ge=8, le=200)
    driver: AnyDriver = Field(default_factory=dict, validate_default=True, title="Drivers")
    spread: Spread = spread_field()
    lane_changes: bool = Field(
        False, title="Lane changes", description="whether drivers change to better lanes where their way asks for none, and pass who stands"
    )

    @model_validator(mode="after")
    def one_number(self):
        if self.count and self.density is not None:
            raise ValueError("give either `count` or `density`")
        return self

    @property
    def is_there(self) -> bool:
        """Whether anybody is asked for."""
        return bool(self.count or self.density or self.flows or self.matrices or self.routes)

    def manned(self, name: str) -> Manned:
        """The type of this name, or else the model, with its dynamics and drivers."""
        found = self.types.get(name)
        if found is None:
            return Manned(name, self.dynamics, self.driver, self.spread)
        dynamics = found.dynamics or self.dynamics
        if found.driver is None:
            return Manned(found.model, dynamics, self.driver, self.spread | found.spread)
        return Manned(found.model, dynamics, found.driver, found.spread)

    def named_models(self) -> dict[str, str]:
        """The models and types that are named, by path."""
        named = {"model": self.model} | {f"mix.{name}": name for name in self.mix}
        for part, each in (("flows", self.flows), ("matrices", self.matrices)):
            named |= {f"{part}.{name}.model": one.model for name, one in each.items() if one.model}
        return named
