"""What REST of maps takes and gives."""

from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from studio.scenario.text.patch import is_text
from studio.server.answer import ImportStatus, Refusal

Degrees = Annotated[float, Field(description="[deg]")]
Metres = Annotated[float, Field(description="[m]")]
Line = Annotated[list[tuple[float, float]], Field(description="points [m], x east and y north from the map's centre")]
Outline = Annotated[list[tuple[float, float]], Field(description="corners [m], the first not repeated")]
TagsByKey = Annotated[dict[str, str], AfterValidator(is_text)]


class MapRow(BaseModel):
    """A map in the folder of maps: an import's folder, or a plain map file; `problem` says why it cannot be used."""

    id: str = Field(description="name of its folder or file; a scenario names it as maps/<id>")
    title: str
    kind: Literal["import", "file"]
    source: str = Field(description="name of the file that it was made of")
    attribution: str
    licence: str
    drive_side: Literal["left", "right"] | None = Field(description="null for a file that has not been imported")
    lane_km: float | None = Field(description="length of all lanes [km]; null for a file that has not been imported")
    bytes: int = Field(description="size on disk [B]")
    problem: str | None


class MapGuess(BaseModel):
    """Something taken without being mapped; a tag `key` of `element` would settle it, "" where none does."""

    number: int = Field(description="unique among guesses, gaps and corrections for as long as this import stands")
    kind: str
    what: str
    where: str
    element: str = Field(description='"way 4711", "node 7", "relation 5"; "" where it is none')
    key: str
    latitude: Degrees
    longitude: Degrees
    x: Metres
    y: Metres
    source: str = Field(description="what it was taken from")
    sure: Literal["high", "medium", "low"]


class MapSkipped(BaseModel):
    """Something mapped that is not in the network, and why."""

    number: int = Field(description="unique among guesses, gaps and corrections for as long as this import stands")
    kind: str
    what: str
    where: str
    element: str
    latitude: Degrees
    longitude: Degrees
    x: Metres
    y: Metres
    reason: str


class MapCorrected(BaseModel):
    """A correction that was applied; `before` are the values of its keys in the map, "" for a tag that was not there."""

    number: int = Field(description="unique among guesses, gaps and corrections for as long as this import stands")
    element: str
    where: str
    tags: dict[str, str]
    removed: list[str]
    before: dict[str, str]
    latitude: Degrees
    longitude: Degrees
    x: Metres
    y: Metres


class SignalCount(BaseModel):
    """Signals on car roads: mapped, of these with a stop line near, programmes."""

    in_map: int
    placed: int
    groups: int


class TurnCount(BaseModel):
    """Lanes with turn:lanes where ways part, and how many lead just where the tag says."""

    tagged_lanes: int
    matching: int


class LimitCount(BaseModel):
    """Car ways with and without a limit that can be read, and lane kilometres by limit [km/h]."""

    mapped_ways: int
    guessed_ways: int
    lane_km: dict[str, float]


class BuildingCount(BaseModel):
    """Buildings in the part kept; of the mapped ones those whose height is mapped and guessed."""

    model_config = ConfigDict(extra="allow")

    placed: int
    height_mapped: int
    height_guessed: int


class ParkingCount(BaseModel):
    """Parking areas and single spaces."""

    model_config = ConfigDict(extra="allow")

    areas: int
    spaces: int


class MapReport(BaseModel):
    """What became of a map, as in its report.json; counts are of the part that was kept."""

    model_config = ConfigDict(extra="allow")

    drive_side: Literal["left", "right"]
    drive_side_why: str
    country: str
    lane_km: float = Field(description="length of all lanes [km]")
    junctions: int
    signals: SignalCount
    turn_lanes: TurnCount
    speed_limits: LimitCount
    buildings: BuildingCount
    parking: ParkingCount
    guesses: list[MapGuess]
    skipped: list[MapSkipped]
    corrected: list[MapCorrected]
    seconds: float = Field(description="time that the import took [s]")


class Place(BaseModel):
    """Where something of a report lies, whatever else is told of it."""

    model_config = ConfigDict(extra="allow", strict=True)

    latitude: float = Field(ge=-90.0, le=90.0)
    longitude: float = Field(ge=-180.0, le=180.0)


class ReportPlaces(BaseModel):
    """What a report.json says of places."""

    model_config = ConfigDict(extra="allow")

    origin: Place
    guesses: list[Place] = []
    skipped: list[Place] = []
    corrected: list[Place] = []


class ReportFile(MapReport):
    """All of a report.json that is told."""

    model_config = ConfigDict(extra="allow", allow_inf_nan=False)

    source: str
    attribution: str
    licence: str
    bbox: str | None
    bounds_m: tuple[float, float, float, float]
    digest: str


class MapCorrection(BaseModel):
    """A change of the tags of a map element: `tags` are set, `removed` are taken away."""

    element: str = Field(description='"way 4711", "node 7" or "relation 5"')
    tags: dict[str, str]
    removed: list[str]


class NewCorrection(BaseModel):
    """A correction to make; added to what is corrected of this element already."""

    model_config = ConfigDict(extra="forbid")

    element: str = Field(description='"way 4711", "node 7" or "relation 5"', examples=["way 4711"])
    tags: TagsByKey = Field({}, description="tags to set", examples=[{"lanes": "2", "maxspeed": "30"}])
    remove: list[str] = Field([], description="keys of tags to take away")


class MapDetail(MapRow):
    """A map with the report of its import and its corrections."""

    bbox: str | None = Field(description="the part that was kept, west,south,east,north [deg]; null: the mapped place")
    origin: tuple[float, float] = Field(description="latitude and longitude of x = y = 0 [deg]")
    bounds_m: tuple[float, float, float, float] = Field(description="x0, y0, x1, y1 of the part that was kept [m]")
    digest: str
    report: MapReport
    corrections: list[MapCorrection]


class PlanStretch(BaseModel):
    """A part of a lane that lies off the land: on a bridge, in a tunnel, on the ramp to one."""

    lift: float = Field(description="how high above the land it lies where that is most, negative: how deep below it [m]")
    centre: Line


class PlanLane(BaseModel):
    """A lane, or a way through a junction (`internal`)."""

    id: int
    road: str
    index: int = Field(description="0 is the lane at the kerb")
    width: Metres
    speed: float = Field(description="allowed [m/s]")
    internal: bool
    open: bool = Field(description="to cars")
    centre: Line
    land: list[Line] | None = Field(None, description="the parts that lie on the land; null: all of it")
    aloft: list[PlanStretch] | None = Field(None, description="the parts that do not; null: none")


class PlanRoad(BaseModel):
    """Parallel lanes in one direction between two junctions, and the OpenStreetMap ways that it is made of."""

    id: str
    name: str
    lanes: list[int]
    ways: list[int]


class PlanSolid(BaseModel):
    """A building from above."""

    outline: Outline
    holes: list[Outline]
    height: Metres


class PlanArea(BaseModel):
    """A patch of ground."""

    kind: str = Field(description="green, water, …")
    outline: Outline
    holes: list[Outline]


class PlanSignal(BaseModel):
    """The stop line of one lane."""

    x: Metres
    y: Metres
    heading: float = Field(description="of the traffic that it stops, counter-clockwise from x [rad]")
    lane: int
    programme: int


class PlanMark(BaseModel):
    """Where a guess, a gap or a correction of the report lies."""

    number: int
    kind: str
    x: Metres
    y: Metres


class MapPlan(BaseModel):
    """A map from above; lengths in metres from its centre, x east, y north."""

    bounds_m: tuple[float, float, float, float] = Field(description="x0, y0, x1, y1 [m]")
    drive_side: Literal["left", "right"]
    attribution: str
    lanes: list[PlanLane]
    roads: list[PlanRoad]
    junctions: list[Outline]
    buildings: list[PlanSolid]
    areas: list[PlanArea]
    signals: list[PlanSignal]
    guesses: list[PlanMark]
    skipped: list[PlanMark]
    corrected: list[PlanMark]


class NewDownload(BaseModel):
    """A place to download: its name, or a box [deg]."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    place: str | None = Field(None, min_length=1, max_length=200, examples=["Großer Stern, Berlin"])
    bbox: tuple[float, float, float, float] | None = Field(None, description="west, south, east, north [deg]")
    name: str | None = Field(None, min_length=1, max_length=200, description="of the map to make; left out, the place's")
    replace: bool = Field(False, description="replace the import of that name; its corrections are kept")


class MapJob(BaseModel):
    """An import that is going on or over, in a process of its own."""

    id: int
    map: str = Field(description="id of the map that it makes")
    status: ImportStatus
    stage: str = Field(description="what is being done; may be waiting for others")
    share: float | None = Field(description="of the work that is done, 0 to 1; null where nobody knows")
    seconds: float = Field(description="since it was asked for, until its end [s]")
    problem: Refusal | None


class Driven(BaseModel):
    """The scenario that was written."""

    scenario: str
