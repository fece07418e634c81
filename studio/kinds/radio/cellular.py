"""Cellular radio: whoever is covered reaches whoever is covered, however far, through a network with a delay and a bandwidth.

Parameters as Massow & Radusch 2018, Table 3: a region, a circle or a polygon, or everywhere; delay with mean and variation; loss rate;
bandwidth in bytes per second, beyond which everything waits. All messages of a scenario go through the same link, once each, however many
hear them; one that would wait longer than `longest_wait` is thrown away. Who goes first of those that send at one instant is drawn by lot.
A source of information far away, a server for instance, is a station anywhere: in a network distance is nothing.

The presets are delays as surveys give them (arXiv 1802.08027): LTE there and back 20 to 60 ms, 5G less. Their bandwidths are estimates.
"""

from math import isnan
from typing import Annotated, Literal, NamedTuple

from pydantic import Field, model_validator

from studio.compiled import compiled
from studio.kind.area import crosses_itself, extent
from studio.kind.preset import Preset
from studio.kind.settings import Part, number
from studio.model.radio import arrival, cell
from studio.world.table.cause import BANDWIDTH, CHANCE, NO_COVERAGE, RECEIVED
from studio.world.view import Transmission, chances

KIND = "radio"
TITLE = "Cellular radio with coverage and bandwidth"
ANYWHERE = 1e7  # [m]
CORNERS = 16
EVERYWHERE, CIRCLE = 0.0, 1.0
PRESETS = {
    "LTE": Preset("LTE", "arXiv 1802.08027; bandwidth estimated", {"delay": 0.040, "delay_variation": 0.015, "bandwidth": 1e6}),
    "5G": Preset("5G", "arXiv 1802.08027; bandwidth estimated", {"delay": 0.015, "delay_variation": 0.005, "bandwidth": 1e7}),
}


class Settings(Part):
    """The network that all units share."""

    coverage: Literal["everywhere", "circle", "polygon"] = Field("everywhere", title="Coverage")
    x: float = number(0.0, unit="m", title="Middle of the circle, east", ge=-1e6, le=1e6)
    y: float = number(0.0, unit="m", title="Middle of the circle, north", ge=-1e6, le=1e6)
    radius: float = number(1000.0, unit="m", title="Radius of the circle", gt=0, le=1e5)
    corners: list[tuple[float, float]] = Field(
        [],
        title="Corners of the polygon",
        description="east and north, one after another",
        max_length=CORNERS,
        json_schema_extra={"unit": "m"},
    )
    delay: float = number(0.04, unit="s", title="Delay", description="mean, sender's to receiver's application", ge=0, le=2)
    delay_variation: float = number(0.015, unit="s", title="Variation of the delay", description="half width", ge=0, le=2)
    loss: float = number(0.001, unit="1", title="Loss rate", ge=0, le=1)
    bandwidth: float = number(1e6, unit="B/s", title="Bandwidth", description="what is sent beyond it waits", ge=100, le=1e9)
    longest_wait: float = number(
        2.0, unit="s", title="Longest wait", description="for the bandwidth; a message that would wait longer is lost", ge=0, le=30
    )
    largest: int = number(1400, unit="byte", title="Largest message", description="that the network takes", ge=50, le=65535)

    @model_validator(mode="after")
    def has_extent(self) -> "Settings":
        """A polygon covers something."""
        if self.coverage == "polygon" and crosses_itself(self.corners):
            raise ValueError("corners: the outline crosses itself: give its corners in the order in which one goes around it")
        if self.coverage == "polygon" and extent(self.corners) == 0.0:
            raise ValueError("corners: a polygon has at least three corners and an area, such as [[0, 0], [500, 0], [500, 300]]")
        return self


class Cell(NamedTuple):
    """What waits in the network."""

    queue: Annotated[float, "byte"] = 0.0
    time: Annotated[float, "s"] = 0.0  # at which it was so


def longest(settings):
    """The longest delay [s]."""
    return settings.delay + settings.delay_variation + settings.longest_wait


def largest(settings):
    """The largest message [bytes]."""
    return settings.largest


def reach(settings):
    """The distance [m] beyond which nothing is heard: none on Earth."""
    return ANYWHERE


def minds_walls(settings):
    """Whether walls count: not in a network."""
    return False


@compiled
def admit(settings, sent, cell_):
    """How long a message waits until it has gone through, and what waits then; one that would wait too long does not come in."""
    queue = cell.backlog(cell_.queue, max(sent.time - cell_.time, 0.0), settings.bandwidth)
    is_in = is_covered(settings, sent.x, sent.y)
    wait = cell.waiting(queue + sent.size, settings.bandwidth) if is_in else 0.0
    return wait, Cell(queue + sent.size if is_in and wait <= settings.longest_wait else queue, sent.time)


@compiled
def transmit(settings, way, draw):
    """One message to one receiver."""
    draws = chances(draw, 0)
    delay = arrival.delay(settings.delay, settings.delay_variation, draws[1]) + way.wait
    if not (is_covered(settings, way.from_x, way.from_y) and is_covered(settings, way.to_x, way.to_y)):
        return Transmission(NO_COVERAGE, delay)
    if way.wait > settings.longest_wait:
        return Transmission(BANDWIDTH, delay)
    return Transmission(CHANCE if draws[0] < settings.loss else RECEIVED, delay)


@compiled
def is_covered(settings, x, y):
    """Whether there is a network at a place."""
    if settings.coverage == EVERYWHERE:
        return True
    if settings.coverage == CIRCLE:
        return cell.in_circle(x, y, settings.x, settings.y, settings.radius)
    return is_within(settings.corners, x, y)


@compiled
def is_within(corners, x, y):
    """Whether a point lies in a polygon: corners x, y, x, y, ...; behind the last one there is none."""
    inside, last = False, 0
    while last < len(corners) and not isnan(corners[last]):
        last += 2
    for i in range(0, last, 2):
        before = i - 2 if i > 0 else last - 2
        if cell.crosses(x, y, corners[before], corners[before + 1], corners[i], corners[i + 1]):
            inside = not inside
    return inside
