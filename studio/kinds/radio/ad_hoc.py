"""Ad hoc radio: every message reaches every unit in range, after a delay, or is lost.

Parameters as Massow & Radusch 2018, Table 3: delay with mean, variation and weight of the distance; loss rate, loss growing with distance;
range. How buildings weaken a signal stands in studio/model/radio/propagation.py, how losses come in runs in studio/model/radio/burst.py.
Bit rate and largest message are those of ETSI ITS-G5 (EN 302 663: 6 Mbit/s; TS 102 636-4-1: 1398 bytes).

The presets are delays as field tests and surveys give them: 802.11p about 4 ms in line of sight; LTE there and back 20 to 60 ms in the
network alone (arXiv 1802.08027), 5G less; cars that speak to each other by LTE (PC5, mode 4) reserve the channel for 20 to 100 ms ahead.
"""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.preset import Preset
from studio.kind.settings import Part, number
from studio.model.radio import arrival, burst, propagation
from studio.world.table.cause import BUILDING, BURST, CHANCE, DECK, OUT_OF_RANGE, RECEIVED
from studio.world.view import PAIR, Transmission, chances

KIND = "radio"
TITLE = "Ad hoc radio with constant delay and loss"
NETWORK = {"range": 5000.0, "buildings": False, "deck_loss": 0.0, "bit_rate": 5e7}
PRESETS = {
    "802.11p": Preset("802.11p, line of sight", "field tests: about 4 ms; variation estimated", {"delay": 0.004, "delay_variation": 0.001}),
    "LTE": Preset("LTE with a server", "arXiv 1802.08027; variation estimated", {"delay": 0.040, "delay_variation": 0.015, **NETWORK}),
    "5G": Preset("5G with a server at the edge", "arXiv 1802.08027; estimated", {"delay": 0.015, "delay_variation": 0.005, **NETWORK}),
    "PC5 mode 4": Preset("LTE from car to car", "20 to 100 ms, the period of reservation", {"delay": 0.060, "delay_variation": 0.040}),
}


class Settings(Part):
    """The ad hoc radio that all units share."""

    delay: float = number(
        0.02, unit="s", title="Delay", description="mean, sender's to receiver's application, besides the time on the air", ge=0, le=1
    )
    delay_variation: float = number(0.005, unit="s", title="Variation of the delay", description="half width", ge=0, le=1)
    delay_per_metre: float = number(0.0, unit="s/m", title="Delay per distance", ge=0, le=1e-3)
    loss: float = number(0.01, unit="1", title="Loss rate", ge=0, le=1)
    loss_per_metre: float = number(0.0, unit="1/m", title="Loss per distance", ge=0, le=0.1)
    loss_run: float = number(
        1.0,
        unit="1",
        title="Mean run of losses",
        description="messages in a row (Gilbert & Elliott); up to 1/(1 - loss rate) each is lost by itself",
        ge=1,
        le=1000,
    )
    range: float = number(300.0, unit="m", title="Range", gt=0, le=5000)
    buildings: bool = Field(
        True,
        title="Shadowed by buildings",
        description="9 dB a wall and 0.4 dB a metre inside (Sommer et al., WONS 2011) count as distance",
    )
    deck_loss: float = number(
        20.0,
        unit="dB",
        title="Weakened by a bridge",
        description="where a road lies between two levels: past its edge, 1 m in its shadow (ITU-R P.526, one knife edge); estimated",
        ge=0,
        le=100,
    )
    path_loss_exponent: float = number(
        2.0,
        unit="1",
        title="Path loss exponent",
        description="how fast power falls with distance, which makes the shadow a distance: 2 in free space, 2.7 to 3 in cities",
        ge=1.5,
        le=6,
    )
    bit_rate: float = number(
        6e6, unit="bit/s", title="Bit rate", description="a message is on the air for as long as its size needs", ge=1e5, le=1e10
    )
    largest: int = number(1400, unit="byte", title="Largest message", description="that the radio takes", ge=50, le=2304)


def longest(settings):
    """The longest delay [s]."""
    far = settings.delay_per_metre * settings.range
    return settings.delay + settings.delay_variation + far + 8.0 * settings.largest / settings.bit_rate


def largest(settings):
    """The largest message [bytes]."""
    return settings.largest


def reach(settings):
    """The distance [m] beyond which nothing is heard."""
    return settings.range


def minds_walls(settings):
    """Whether walls count."""
    return settings.buildings


@compiled
def transmit(settings, way, draw):
    """Whether a message is lost on its way, and how long it takes."""
    draws = chances(draw, 0)
    varied = arrival.delay(settings.delay, settings.delay_variation, draws[1])
    delay = varied + settings.delay_per_metre * way.distance + 8.0 * way.size / settings.bit_rate
    return Transmission(fate(settings, way, draw, draws[0]), delay)


@compiled
def fate(settings, way, draw, chance):
    """Why a message is lost, or that it is not."""
    weakened = propagation.screened(way.walls, way.inside, way.decks, settings.buildings, settings.deck_loss)
    distance = propagation.felt_distance(way.distance, weakened, settings.path_loss_exponent)
    if distance > settings.range:
        under = propagation.felt_distance(way.distance, settings.deck_loss * way.decks, settings.path_loss_exponent)
        return OUT_OF_RANGE if way.distance > settings.range else DECK if under > settings.range else BUILDING
    loss = min(settings.loss + settings.loss_per_metre * distance, 1.0)
    if settings.loss_run * (1.0 - loss) <= 1.0:
        return CHANCE if arrival.is_lost(distance, settings.range, loss, 0.0, chance) else RECEIVED
    to_bad, to_good = burst.of_loss(loss, settings.loss_run)
    is_bad = burst.is_bad(draw.seed, draw.receiver * PAIR + draw.sender, draw.stream + 2, draw.number, to_bad, to_good)
    return BURST if is_bad else RECEIVED
