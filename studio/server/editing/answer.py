"""What REST takes and gives of an edited scenario."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, RootModel

from studio.kind.settings import Name
from studio.scenario.text.patch import Operation
from studio.server.answer import ChangesByPath, Problem, Refusal

Point = tuple[float, float]
Group = Literal["vehicle", "person", "object", "friction", "area", "radio", "station", "event", "route"]


class Handle(BaseModel):
    """A road that a route names, and a point to hold it by."""

    road: str
    x: float = Field(description="east [m]")
    y: float = Field(description="north [m]")


class Figure(BaseModel):
    """Something to be drawn: a body, a point, a line, a patch of road or an area."""

    path: str = Field(description="of what it shows, in the document")
    shape: Literal["body", "point", "line", "patch", "area"]
    looks: str = Field("", description="of a body: pedestrian, box, tree …; empty: a vehicle")
    x: float = Field(0.0, description="middle of a body, or the point: east [m]")
    y: float = Field(0.0, description="north [m]")
    heading: float = Field(0.0, description="of its length [rad]")
    length: float = Field(0.0, description="of a body [m]")
    width: float = Field(0.0, description="of a body [m]")
    height: float = Field(0.0, description="of a body [m]")
    lift: float = Field(0.0, description="how high above the land its road is drawn [m]")
    anchor: Point | None = Field(None, description="the place that the document gives: of a vehicle its centre of gravity [m]")
    line: list[Point] = Field([], description="outline of a patch or area; way of a body, a route [m]")
    colour: str = Field("", description="of a vehicle")
    handles: list[Handle] = Field([], description="of a route")


class Item(BaseModel):
    """Something of the scenario that can be chosen."""

    path: str = Field(description="in the document")
    group: Group
    name: str
    told: str = Field(description="what it is, in words")
    figures: list[Figure]
    vehicles: list[str] = Field([], description="that an entry of the script is about")
    route: str | None = Field(None, description="of a vehicle")
    road: str | None = Field(None, description="on which a vehicle starts")
    lane: int | None = Field(None, description="of that road")
    offset: float | None = Field(None, description="from the start of that lane [m]")
    along: float | None = Field(None, description="its route [m], where the file says so")
    station: float | None = Field(None, description="of a vehicle, on the line of its figure [m]")


class Step(BaseModel):
    """A change of the file that can be undone, or done again."""

    revision: int
    name: str
    who: str = Field(description="which browser, or another program")
    time: str = Field(description="ISO 8601, UTC")


class Turn(BaseModel):
    """When an entry of the script is expected to begin."""

    entry: str
    told: str = Field(description="what it does, in words")
    begins: float | None = Field(description="[s]; null: it depends on what happens")
    ends: float | None = Field(description="[s]; null: with the run, or it depends")
    is_exact: bool = Field(description="whether the file says the time itself; else it is reckoned with free roads")
    why: str = Field(description="what it waits for, in words")
    never: str = Field(description="why it can never begin; empty when it may")


class Editing(BaseModel):
    """A scenario that is edited: the document, where everything lies, and what can be undone."""

    scenario: str
    title: str
    revision: int = Field(description="grows with every change, also with undo")
    digest: str = Field(description="of the file's text, as in its ETag")
    sealed: str = Field(description="why it cannot be changed; empty when it can")
    document: dict[str, Any] = Field(description="with all defaults")
    given: dict[str, Any] = Field(description="as it stands in the file")
    duration: float = Field(description="of the run [s]")
    items: list[Item]
    turns: list[Turn]
    done: list[Step] = Field(description="what can be undone, the next one last")
    undone: list[Step] = Field(description="what can be done again, the next one last")


Pathname = Annotated[str, Field(min_length=1, max_length=300)]


class NewEdit(BaseModel):
    """An edit by name: what is set by path, then a JSON patch, new names, and what is taken out with all that is about it."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(min_length=1, max_length=120, examples=["Move leader"])
    base: int = Field(ge=0, description="the revision that it was made to")
    who: str = Field("", max_length=80)
    set: ChangesByPath = {}
    patch: list[Operation] = Field([], max_length=1000)
    rename: dict[Pathname, Name] = Field(
        {}, max_length=100, description="new names by path, such as vehicles.leader; who names it does so anew"
    )
    remove: list[Pathname] = Field([], max_length=1000, description="paths such as vehicles.leader")


class NewTurn(BaseModel):
    """Who undoes or does again, and what he has seen last."""

    model_config = ConfigDict(extra="forbid")

    base: int = Field(ge=0, description="the revision at which the step stood last")
    who: str = Field("", max_length=80)


class NewWay(BaseModel):
    """Points on roads, in the order in which they are driven."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    points: list[Point] = Field(min_length=1, max_length=100, description="[m] of the map")
    onwards: bool = Field(False, description="go on straight behind the last point, as far as a car drives in half a minute or so")
    roads: list[str] = Field([], max_length=200, description="roads that come before the points")
    vehicles: list[str] = Field(
        [], max_length=200, description="vehicles of the scenario that are to drive there: the way has no turn too narrow for them"
    )


class Way(BaseModel):
    """A way along the roads, or why none leads there."""

    problem: Refusal | None = Field(None, description="why there is no way; then the rest is empty")
    roads: list[str] = Field(description="as a route names them")
    line: list[Point] = Field(description="[m]")
    length: float = Field(description="[m]")
    handles: list[Handle]


TOLD = ConfigDict(json_schema_serialization_defaults_required=True)  # the kind is always sent


class Revised(BaseModel):
    """News: the scenario has been changed."""

    model_config = TOLD

    type: Literal["revised"] = "revised"
    revision: int
    name: str = Field(description="of the last change")
    who: str


class Gone(BaseModel):
    """News: there is no such scenario any more, or it cannot be read."""

    model_config = TOLD

    type: Literal["gone"] = "gone"
    message: str
    problems: list[Problem]


class EditingNews(RootModel[Annotated[Revised | Gone, Field(discriminator="type")]]):
    """One message of the socket of a scenario that is edited."""
