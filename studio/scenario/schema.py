"""What a scenario file may say: every field with its unit, its range and what it means.

Reading refuses what it does not know; nothing is repaired. Paths of fields (`applications.platoon.parameters.headway`)
are the names that `--set`, the page and the run database use.
"""

import re
from collections.abc import Sequence
from functools import cache
from typing import Annotated, Any, Literal, get_args

from pydantic import BaseModel, Field, model_validator

from studio.conventions import DEFAULT_STEP, DEFAULT_TICK
from studio.kind import registry
from studio.kind.settings import Name, Part, RouteName, UnitName, number, without
from studio.kind.slot import Every, Slot
from studio.scenario.traffic import MODELS, AnyDriver, CarType, Dynamics, Traffic, dynamics_field

LONGEST = 3600.0  # [s] a run
MOST_SENSORS = 16  # of one unit
Reason = Literal["collision", "red_light", "right_of_way"]
REASONS: tuple[Reason, ...] = get_args(Reason)  # why a driver may overrule an application
VERSION = 3  # of the format; scenario/text/migration.py reads older files


class Map(Part):
    """The place."""

    file: str = Field(
        ...,
        max_length=300,
        title="Map file",
        description="relative to the scenario: OpenStreetMap (.osm, .osm.gz, .osm.pbf, .json), OpenDRIVE (.xodr), or an import's folder",
    )
    radius: float | None = number(
        None, unit="m", title="Radius", ge=100, le=5000,
        description="what lies farther from the centre is cut off; left out: 800 m for a file, all of an import; OpenDRIVE is taken whole",
    )  # fmt: skip
    parking_aisles: bool = Field(
        False, title="Parking aisles", description="build the aisles of parking places and the driveways that lead to them"
    )
    signal_start: float = number(
        0.0, unit="s", title="Signals at the start", description="how far into their programmes the lights are", ge=0, le=600
    )


class Clock(Part):
    """Time: vehicles integrate with `step`, meet at `tick`."""

    step: float = number(DEFAULT_STEP, unit="s", title="Integration step", ge=0.0005, le=0.01)
    tick: float = number(DEFAULT_TICK, unit="s", title="Tick", ge=0.01, le=0.1)
    duration: float = number(60.0, unit="s", title="Duration", gt=0, le=LONGEST)

    @model_validator(mode="after")
    def whole_steps(self):
        ratio = self.tick / self.step
        if abs(ratio - round(ratio)) > 1e-6:
            raise ValueError(f"the tick must be a whole number of steps; {self.tick} s / {self.step} s = {ratio:g}")
        return self


class SpeedAnnotation(Part):
    """From this station on, this speed is wanted."""

    at: float = number(..., unit="m", title="From station", ge=0)
    speed: float = number(..., unit="m/s", title="Speed", gt=0, le=70)


class Route(Part):
    """A way along the roads of the map; between two named roads the quickest way is taken."""

    roads: list[str] = Field(..., min_length=1, title="Roads", description="ids of roads, in driving order")
    speeds: list[SpeedAnnotation] = Field([], title="Speed annotations")


class Place(Part):
    """Where a vehicle starts: `along` its route, or on a `road` and `lane` of it."""

    along: float | None = Field(None, ge=0, title="Along the route", json_schema_extra={"unit": "m"})
    road: str | None = Field(None, title="Road")
    lane: int | None = Field(None, ge=0, le=9, title="Lane", description="0 is the lane at the kerb")
    offset: float = number(0.0, unit="m", title="From the start of the road", ge=0)

    @model_validator(mode="after")
    def one_way_to_say_it(self):
        if (self.along is None) == (self.road is None):
            raise ValueError("give either `along`, or `road` with `lane` and `offset`")
        return self if self.along is None else without(self, "lane", "offset", beside="along")


class Intervention(Part):
    """When the driver overrules an application that has the pedals: never, unless reasons are named."""

    reasons: list[Reason] = Field([], max_length=len(REASONS), title="Reasons", description="for which he does; none: never")
    reaction_time: float = number(
        1.0, unit="s", title="Reaction time", description="that it has to be needed before the driver acts", ge=0, le=5
    )


class Gps(Part):
    """The satellite position, which messages carry: a slow error and white noise, to the east and to the north. Both 0: exact.

    Slow errors of 1.5 to 3 m with correlation times from 10 s to half an hour are usual with a plain receiver, 0.5 to 1 m with
    corrections, 0.02 m with RTK. How much larger they are between houses is estimated.
    """

    drift: float = number(1.5, unit="m", title="Slow error", description="standard deviation under an open sky", ge=0, le=100)
    correlation_time: float = number(60.0, unit="s", title="Correlation time", description="of the slow error", ge=0.1, le=100_000)
    noise: float = number(0.3, unit="m", title="White noise", description="standard deviation", ge=0, le=100)
    canyon_factor: float = number(
        5.0,
        unit="1",
        title="Factor without sky",
        description="by how much the slow error is larger where buildings hide the whole sky",
        ge=1,
        le=100,
    )


class Bus(Part):
    """White noise of what the car's own bus tells its applications; all 0: exact. Standard deviations, at every tick anew.

    Series sensors: speed 0.05 m/s, acceleration 0.1 m/s², yaw rate and steering 0.1 degrees (rounded).
    """

    speed_noise: float = number(0.0, unit="m/s", title="Noise of the speed", ge=0, le=5)
    acceleration_noise: float = number(0.0, unit="m/s²", title="Noise of the acceleration", ge=0, le=5)
    yaw_rate_noise: float = number(0.0, unit="rad/s", title="Noise of the yaw rate", ge=0, le=0.5)
    steering_noise: float = number(0.0, unit="rad", title="Noise of the steering", ge=0, le=0.5)


class UnitClock(Part):
    """The clock of a unit: what its applications and messages take for the time."""

    offset: float = number(0.0, unit="s", title="Offset", description="ahead of the true time at the start", ge=-10, le=10)
    drift: float = number(0.0, unit="1", title="Drift", description="seconds that it gains a second; quartz: 20e-6", ge=-1e-3, le=1e-3)


class Antenna(Part):
    """Where a unit sends from and hears."""

    height: float = number(
        1.5, unit="m", title="Height", description="above the road; houses that are lower weaken nothing", ge=0.2, le=100
    )


Sensors = Annotated[dict[Name, Annotated[Any, Slot("sensor")]], Field(max_length=MOST_SENSORS)]


def front_radar_only() -> dict[str, Any]:
    """What a vehicle has that says nothing about its sensors."""
    return {"front": {"kind": "front_radar"}}


class Vehicle(Part, defer_build=True):
    """One named car."""

    model: str = Field(
        "bmw_320i",
        max_length=300,
        title="Model",
        examples=MODELS,
        description="a name of the catalogue, or a vehicle file (YAML) relative to the scenario",
    )
    dynamics: Dynamics = dynamics_field("full")
    route: RouteName = Field(..., title="Route")
    position: Place = Field(..., title="Start")
    speed: float = number(..., unit="m/s", title="Initial speed", ge=0, le=70)
    driver: AnyDriver = Field(default_factory=dict, validate_default=True, title="Driver")
    lane_changes: bool = Field(
        False,
        title="Lane changes",
        description="whether the driver changes to a better lane where the route asks for none, and passes who stands",
    )
    intervention: Intervention = Field(default_factory=Intervention, title="Driver's intervention")
    sensors: Sensors = Field(
        default_factory=front_radar_only, validate_default=True, title="Sensors", description="by name, as applications ask for them"
    )
    gps: Gps = Field(default_factory=Gps, title="Satellite position")
    bus: Bus = Field(default_factory=Bus, title="Bus signals")
    clock: UnitClock = Field(default_factory=UnitClock, title="Clock of the unit")
    antenna: Antenna = Field(default_factory=Antenna, title="Antenna")
    colour: Annotated[str, Field(pattern=r"^#[0-9a-fA-F]{6}$")] = Field("#2f6fde", title="Colour")


class Spot(Part):
    """A place beside the roads: along a road of the map, or at coordinates of the map."""

    road: str | None = Field(None, max_length=100, title="Beside the road")
    along: float = number(0.0, unit="m", title="From the start of the road", ge=0)
    aside: float = number(5.0, unit="m", title="To the left of its kerb lane", description="negative: to the right", ge=-200, le=200)
    x: float | None = Field(None, title="East", json_schema_extra={"unit": "m"})
    y: float | None = Field(None, title="North", json_schema_extra={"unit": "m"})

    @model_validator(mode="after")
    def one_way_to_say_it(self):
        if (self.x is None) != (self.y is None) or (self.x is None) == (self.road is None):
            raise ValueError("give either `road` with `along` and `aside`, or `x` and `y`")
        return self if self.x is None else without(self, "along", "aside", beside="x")


class Station(Part, defer_build=True):
    """A unit that stands at a place: a road-side unit, a garage. It knows where it is."""

    position: Spot = Field(..., title="Place")
    heading: float = number(
        0.0, unit="rad", title="Heading", description="that its sensors look along; 0 is east, left positive", ge=-7, le=7
    )
    sensors: Sensors = Field({}, title="Sensors", description="by name, as applications ask for them")
    clock: UnitClock = Field(default_factory=UnitClock, title="Clock of the unit")
    antenna: Antenna = Field(default=Antenna(height=6.0), title="Antenna")


class Application(Part):
    """One application on one or several units; every unit has its own instance."""

    application: str = Field(..., title="Application", description="a registered name")
    units: list[UnitName] = Field(..., min_length=1, title="On these units", description="vehicles or stations")
    listens_to: list[UnitName | list[UnitName]] = Field(
        [], title="Listening to", description="whose messages each of them uses: a unit or a list of units for each; none: everybody's"
    )
    preset: str | None = Field(None, title="Preset", description="a set of parameters that the application has a name for")
    parameters: dict = Field(
        {}, title="Parameters", description="of the application; what is not given is the preset's, or has its default"
    )
    cycle: float | None = number(
        None, unit="s", title="Cycle", gt=0, le=0.1,
        description="how often it decides: a tick, or a whole part of one, for what talks faster than the world moves; left out: the tick",
    )  # fmt: skip
    keeps: float | None = number(
        None, unit="s", title="Keeps messages for", gt=0, le=LONGEST,
        description="older ones are forgotten; left out: the newest of each sender is kept to the end",
    )  # fmt: skip
    priority: int = Field(
        0, ge=-100, le=100, title="Priority", description="of several applications that command an actuator, the highest does"
    )

    @model_validator(mode="after")
    def one_sender_each(self):
        if self.listens_to and len(self.listens_to) != len(self.units):
            raise ValueError(f"{len(self.units)} units but {len(self.listens_to)} in `listens_to`: one for each")
        return self

    def senders(self, place: int) -> list[str]:
        """Whom the unit at a place of the list listens to; none named: everybody."""
        if not self.listens_to:
            return []
        given = self.listens_to[place]
        return [given] if isinstance(given, str) else given


class Entry(Part, defer_build=True):
    """One thing that happens: when it begins, when it ends, and what is done meanwhile."""

    when: Annotated[Any, Slot("condition")] = Field(
        {"kind": "time", "at": 0.0}, validate_default=True, title="When", description="left out: from the start"
    )
    until: Annotated[Any, Slot("condition")] | None = Field(
        None, title="Until", description="left out: as long as the action lasts, which for the road is to the end of the run"
    )
    do: Annotated[Any, Slot("action")] = Field(..., title="Do")
    again: bool = Field(
        False, title="Again", description="begins anew whenever `when` has not held and holds again, once the time before is over"
    )

    @model_validator(mode="after")
    def ends_after_its_start(self):
        begins, ends = moment_of(self.when), moment_of(self.until)
        if begins is not None and ends is not None and ends <= begins:
            raise ValueError(f"it must end ({ends:g} s) after its beginning ({begins:g} s)")
        return self


def moment_of(condition: Any) -> float | None:
    """The time [s] from which on a condition holds, where its settings alone tell it."""
    if condition is None:
        return None
    module = registry.find("condition", condition.kind).module
    return module.moment(condition) if hasattr(module, "moment") else None


class Weather(Part):
    """What is the same everywhere: how slippery the roads are, how far one sees."""

    friction: float = number(
        1.0, unit="1", title="Friction", description="over that of a dry test track: 1 dry, 0.7 wet, 0.3 snow, 0.1 ice", ge=0.02, le=1.5
    )
    visibility: float = number(
        10_000.0,
        unit="m",
        title="Visibility",
        description="drivers see nothing beyond, and drive so that they can stop within it; clear from 10 km on, fog below 1 km",
        ge=10,
        le=100_000,
    )


class Recording(Part):
    """What is kept of a run."""

    period: float = number(DEFAULT_TICK, unit="s", title="Sampling period", ge=0.01, le=10)
    traffic: bool = Field(False, title="Record the traffic too", description="else only the named vehicles")
    channels: list[str] = Field([], title="Channels", description="quantities whose traces are kept; none named: all")


class Goal(Part):
    """What a measure must keep for the run to pass."""

    least: float | None = Field(None, title="At least", allow_inf_nan=False)
    most: float | None = Field(None, title="At most", allow_inf_nan=False)

    @model_validator(mode="after")
    def can_be_met(self):
        if self.least is not None and self.most is not None and self.least > self.most:
            raise ValueError(f"no value is at least {self.least:g} and at most {self.most:g}: exchange them")
        return self


class Seeds(Part):
    """Seeds of single streams of chance; where none is given the scenario's counts. So one of them can be varied while the rest stays."""

    traffic: int | None = Field(
        None, ge=0, le=2**63 - 1, title="Seed of the traffic", description="its routes, places and styles; what chance does to drivers"
    )
    sensors: int | None = Field(None, ge=0, le=2**63 - 1, title="Seed of the sensors", description="of their errors")
    satellites: int | None = Field(None, ge=0, le=2**63 - 1, title="Seed of the satellites", description="errors of cars' positions")
    radio: int | None = Field(None, ge=0, le=2**63 - 1, title="Seed of the radio", description="of loss and delay of messages")


class Scenario(Part, defer_build=True):
    """A scenario: a place, who drives there, what they run on board, what happens, and what counts."""

    version: Literal[3] = Field(VERSION, title="Version of this format")
    title: str = Field(..., min_length=1, max_length=120, title="Title")
    description: str = Field("", max_length=2000, title="Description")
    map: Map = Field(..., title="Map")
    clock: Clock = Field(default_factory=Clock, title="Clock")
    seed: int = Field(1, ge=0, le=2**63 - 1, title="Seed", description="of every random number whose stream has none of its own")
    seeds: Seeds = Field(default_factory=Seeds, title="Seeds", description="of single streams")
    routes: dict[Name, Route] = Field(..., min_length=1, title="Routes")
    vehicles: dict[Name, Vehicle] = Field(..., min_length=1, title="Vehicles")
    stations: dict[Name, Station] = Field({}, title="Stations", description="units that stand at a place")
    applications: dict[Name, Application] = Field({}, title="Applications")
    traffic: Traffic = Field(default_factory=Traffic, title="Traffic")
    weather: Weather = Field(default_factory=Weather, title="Weather")
    script: dict[Name, Entry] = Field({}, title="Script", description="what happens, to vehicles and to the road")
    radio: Annotated[Any, Slot("radio", usual="ad_hoc")] = Field(default_factory=dict, validate_default=True, title="Radio")
    radios: dict[Name, Annotated[Any, Slot("radio")]] = Field(
        {}, title="Radios of messages", description="by the kind of message that goes over another radio, a cellular one for instance"
    )
    messages: Annotated[Any, Every("message")] = Field(
        default_factory=dict, validate_default=True, title="Messages", description="that units send by themselves"
    )
    recording: Recording = Field(default_factory=Recording, title="Recording")
    measures: dict[Name, Annotated[Any, Slot("metric")]] = Field(
        {}, title="Measures", description="metrics with settings of their own, by name; all others are measured as usual"
    )
    goals: dict[Name, Goal] = Field({}, title="Goals", description="per measure or metric")

    def seed_of(self, stream: Literal["traffic", "sensors", "satellites", "radio"]) -> int:
        """The seed of a stream: its own, or that of everything."""
        own = getattr(self.seeds, stream)
        return self.seed if own is None else own

    def radio_of(self, message: str) -> Any:
        """The radio that a kind of message goes over."""
        return self.radios.get(message, self.radio)


WITH_SLOTS = (Vehicle, Station, CarType, Traffic, Entry, Scenario)


def make_anew() -> None:
    """A kind has come in: what may stand in a slot is another. Before anybody has asked nothing is made."""
    if Scenario.__pydantic_complete__:
        around = [kind.module.Settings for kind in registry.known("condition").values() if hasattr(kind.module, "joins")]
        for model in (*around, *WITH_SLOTS):
            model.model_rebuild(force=True)


@cache
def json_schema(model: type[BaseModel]) -> dict[str, Any]:
    """The JSON schema of a model, made once as long as no kind comes in: it takes a while, and is asked for at every problem."""
    return model.model_json_schema()


registry.listen(make_anew)
registry.listen(json_schema.cache_clear)


def unit_at(model: type[BaseModel], path: str) -> str:
    """Unit of the field at a path, empty when it has none here (parameters of applications know their own)."""
    return node_at(json_schema(model), path.split(".")).get("unit", "")


def node_at(schema: dict, path: Sequence[str | int]) -> dict:
    """The node of a JSON schema at a path, references followed; of alternatives the first that has it, empty when none has."""
    nodes = [schema]
    for part in path:
        nodes = [found for node in nodes if (step := child(node, str(part))) for found in alternatives(schema, step)]
    return nodes[0] if nodes else {}


def sort_at(schema: dict, path: Sequence[str]) -> str:
    """Of which sort the kind is that is chosen at a path of a JSON schema; "" where none is."""
    step = child(node_at(schema, path[:-1]), path[-1])
    return next((each["sort"] for each in (step, *step.get("anyOf", [])) if "sort" in each), "")


def alternatives(schema: dict, node: dict) -> list[dict]:
    """A node with its reference followed; of a union every member, each with what the union says about all."""
    members = node.get("anyOf") or node.get("oneOf") or [node]
    shared = {key: node[key] for key in ("unit", "title", "description") if key in node}
    return [shared | (pointed(schema, each["$ref"]) if "$ref" in each else each) for each in members]


def pointed(schema: dict, reference: str) -> dict:
    """What a reference points to."""
    return schema["$defs"][reference.rpartition("/")[2]]


def located(schema: dict, place: Sequence[str | int]) -> tuple[str, dict]:
    """Path and node of a place in an error of pydantic, which names the alternative of a union as if it were a field."""
    node, path = schema, []
    for part in place:
        if part == "[key]":
            continue
        if "discriminator" in node:
            node = pointed(schema, node["discriminator"]["mapping"][part])
            continue
        path.append(str(part))
        step = child(node, str(part))
        node = step if "discriminator" in step else alternatives(schema, step)[0]
    return ".".join(path), node


def child(node: dict, part: str) -> dict:
    """One level down, references not followed."""
    if part in node.get("properties", {}):
        return node["properties"][part]
    for pattern, found in node.get("patternProperties", {}).items():
        if re.match(pattern, part):
            return found
    for found in node.get("patternProperties", {}).values():
        return found  # under a name that is wrong itself
    found = node.get("items") if part.isdigit() else node.get("additionalProperties")
    return found if isinstance(found, dict) else {}
