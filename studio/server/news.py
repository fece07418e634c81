"""What the socket of a live run tells, as pydantic models: OpenAPI and the page's types are made from them. `type` names the kind."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, RootModel

from studio.server.answer import Channel, Event, Layers, Live, Over, Refusal

TOLD = ConfigDict(json_schema_serialization_defaults_required=True)  # the kind is always sent


class StateNews(Live):
    """Where the run is: some times a second, and whenever that changes."""

    model_config = TOLD

    type: Literal["state"] = "state"
    real_time_factor: float = Field(description="simulated over real seconds, lately")


class ChannelsNews(BaseModel):
    """What the live charts may show: some channels of every vehicle, and what sensors and applications give."""

    model_config = TOLD

    type: Literal["channels"] = "channels"
    channels: list[Channel]


class SamplesNews(BaseModel):
    """New points of the live charts; null where a channel has no value."""

    model_config = TOLD

    type: Literal["samples"] = "samples"
    time: list[float] = Field(description="[s]")
    channels: dict[str, list[float | None]] = Field(description="by name, vehicle.channel; one value for every time")


class EventNews(Event):
    """Something happened."""

    model_config = TOLD

    type: Literal["event"] = "event"


class LayersNews(Layers):
    """What can be drawn over the scene now."""

    model_config = TOLD

    type: Literal["layers"] = "layers"


class EndNews(BaseModel):
    """The last message: the run is over and saved."""

    model_config = TOLD

    type: Literal["end"] = "end"
    run: int
    status: Over
    error: str | None


class RefusedNews(Refusal):
    """The only message where there is no such live run."""

    model_config = TOLD

    type: Literal["refused"] = "refused"


Kind = StateNews | ChannelsNews | SamplesNews | EventNews | LayersNews | EndNews | RefusedNews


class News(RootModel[Annotated[Kind, Field(discriminator="type")]]):
    """One message of the socket of a live run."""
