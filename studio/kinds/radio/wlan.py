"""Wireless LAN between cars, IEEE 802.11p (ETSI ITS-G5): signals that weaken, fade, hit shadows and lorries, and share a channel.

A message of P dBm, weakened on its way by L (studio/model/radio/propagation.py), by the buildings A in between, and by the shadow S of
both places (shadowing.py, normal in dB, alike for neighbours), stands above the noise N by

    P - L - A + S - N   [dB]

times the fading g of this message (fading.py). Of that follows the probability that it is understood (packet.py). While something, a
lorry say, stands in between, it lacks `blockage` more: a link is clear and blocked by turns (burst.py, Gilbert & Elliott, in time). That,
and the shadow, which changes by metres and not by messages, is why losses come in runs.

A busy channel is waited for, and messages are spoilt by others (channel.py); congestion control makes units send less (congestion.py).

**Presets** "motorway", "suburban" and "urban" are fitted to the delivery over distance that was measured on such roads, from 100 m to
1000 m (CAM-VAM data set, University of Modena and Reggio Emilia, 2021 and 2022; which radio it was it does not say), and to the runs of its
losses. Exponent, standard deviation of the shadow, blockage and its share of the time: least squares, with the fading given, at 23 dBm,
6 Mbit/s and 350 bytes in a free channel. Fading, times of blockage and distance of the shadows: round ones with mean runs above three where
six to eight of ten messages arrive (cars at 32, 20.6 and 8.2 m/s that send every 0.2, 0.2 and 0.4 s; 9.7 was measured where 0.70 arrive).
What houses took is part of what was measured, so these presets have `buildings` off. Shortest delay and mean rest meet the measured 5 % and
50 %. `hearing` is about where half arrive, an estimate. How well all that fits is told in the documentation, "Radio".

First values: two slopes and a shadow as L. Cheng et al., IEEE JSAC 25, 2007, measured; fading of the simulator Veins (1.5 up to 80 m, 0.75
beyond); about 4 ms in line of sight as in field tests; noise of 10 MHz with a receiver of 6 dB.
"""

from math import floor, inf, log10
from typing import Any, Literal

import numpy as np
from pydantic import Field

from studio.compiled import compiled, inlined
from studio.kind.preset import Preset
from studio.kind.settings import Part, number
from studio.model.radio import arrival, burst, channel, congestion, fading, packet, propagation, shadowing
from studio.model.radio.congestion import Control as Control
from studio.model.radio.shadowing import Around as Around
from studio.world.table.cause import BUILDING, BURST, BUSY, DECK, FADING, RECEIVED, TOO_WEAK
from studio.world.view import Transmission, chances, chances_of_message, pair_of

KIND = "radio"
TITLE = "Wireless LAN between cars (802.11p)"
FREE_SPACE, ONE_SLOPE, TWO_SLOPES, THREE_SLOPES, TWO_RAY = 0.0, 1.0, 2.0, 3.0, 4.0
NO_CONTROL = 0.0
LARGEST = 2304  # [bytes] of a frame's body
STEP = 0.25  # [s] after which a link may be blocked or cleared
FARTHEST_SHADOW = 4.0  # standard deviations; no shadow is deeper or brighter
ROUNDING = 1e-9  # [dB]
BLOCKED, SHADOW = 1, 2  # streams of a pair of units
WAIT = 15  # draws of a message that all its receivers share
SURVIVES, FADES, SPOILT, LATE = range(4)  # those of one receiver
# Of the table: loss [dB] of free space, share of delays that is not cut, a distance [m], the loss there and the exponent, wear of a packet,
# powers of fading nearby and far away.
AT_ONE_METRE, NOT_CUT, DOUBTFUL, LOSS_THERE, EXPONENT, WORN = range(6)
NEAR = WORN + packet.POINTS
FAR = NEAR + fading.POINTS

MEASURED = "fitted to delivery, runs of losses and latency of the CAM-VAM data set (University of Modena and Reggio Emilia)"
FITTED: dict[str, Any] = {
    "path_loss": "one_slope", "transmit_power": 23.0, "rate": "6 Mbit/s", "noise": -98.0, "buildings": False,
    "delay": 0.0098, "delay_rest": 0.00857, "delay_longest": 0.1,
}  # fmt: skip
PRESETS = {
    "motorway": Preset("Motorway", MEASURED, FITTED | {
        "exponent": 2.15, "shadowing": 3.5, "shadowing_distance": 100.0, "m_near": 10.0, "m_far": 10.0,
        "blockage": 6.0, "blocked_time": 5.0, "clear_time": 12.0, "range": 2500.0, "hearing": 1000.0,
    }),
    "suburban": Preset("Suburban road", MEASURED, FITTED | {
        "exponent": 2.42, "shadowing": 4.1, "shadowing_distance": 50.0, "m_near": 8.0, "m_far": 8.0,
        "blockage": 7.0, "blocked_time": 3.0, "clear_time": 12.0, "range": 2000.0, "hearing": 530.0,
    }),
    "urban": Preset("Town", MEASURED, FITTED | {
        "exponent": 2.5, "shadowing": 2.2, "shadowing_distance": 25.0, "m_near": 10.0, "m_far": 10.0,
        "blockage": 7.2, "blocked_time": 3.0, "clear_time": 12.0, "range": 1500.0, "hearing": 430.0,
    }),
}  # fmt: skip


class Settings(Part):
    """The transceivers that all units have alike, and what lies between them."""

    transmit_power: float = number(23.0, unit="dBm", title="Transmit power", description="with the gains of both antennas", ge=-20, le=50)
    rate: Literal["3 Mbit/s", "4.5 Mbit/s", "6 Mbit/s", "9 Mbit/s", "12 Mbit/s", "18 Mbit/s", "24 Mbit/s", "27 Mbit/s"] = Field(
        "6 Mbit/s", title="Bit rate"
    )
    frequency: float = number(5.9e9, unit="Hz", title="Frequency", ge=1e8, le=1e11)
    noise: float = number(-98.0, unit="dBm", title="Noise", description="of 10 MHz and the receiver", ge=-130, le=-50)
    path_loss: Literal["free_space", "one_slope", "two_slopes", "three_slopes", "two_ray"] = Field(
        "two_slopes", title="Loss over distance", description="two_ray takes the heights of the antennas"
    )
    exponent: float = number(2.1, unit="1", title="Path loss exponent", description="of the first slope", ge=1, le=8)
    first_break: float = number(100.0, unit="m", title="First break", description="where the second slope begins", ge=1, le=5000)
    second_exponent: float = number(3.8, unit="1", title="Second exponent", ge=1, le=8)
    second_break: float = number(
        500.0, unit="m", title="Second break", description="where the third slope begins, beyond the first", ge=1, le=5000
    )
    third_exponent: float = number(3.8, unit="1", title="Third exponent", ge=1, le=8)
    permittivity: float = number(1.02, unit="1", title="Permittivity of the ground", description="relative, for two_ray", ge=1, le=100)
    buildings: bool = Field(True, title="Weakened by buildings", description="9 dB a wall and 0.4 dB a metre inside")
    deck_loss: float = number(
        20.0,
        unit="dB",
        title="Weakened by a bridge",
        description="where a road lies between two levels: past its edge, 1 m in its shadow (ITU-R P.526, one knife edge); estimated",
        ge=0,
        le=100,
    )
    shadowing: float = number(4.0, unit="dB", title="Shadowing", description="standard deviation; 0: none", ge=0, le=20)
    shadowing_distance: float = number(
        25.0, unit="m", title="Correlation distance of shadows", description="within which places are alike", ge=1, le=1000
    )
    fading: bool = Field(True, title="Fading", description="Nakagami's, for every message anew")
    m_near: float = number(1.5, unit="1", title="m nearby", description="of the fading; 1: Rayleigh, larger: steadier", ge=0.5, le=50)
    m_far: float = number(0.75, unit="1", title="m far away", ge=0.5, le=50)
    m_change: float = number(80.0, unit="m", title="From near to far", ge=0, le=5000)
    blockage: float = number(0.0, unit="dB", title="Blockage", description="what a link lacks while it is blocked; 0: never", ge=0, le=100)
    blocked_time: float = number(3.0, unit="s", title="Mean time blocked", ge=STEP, le=600)
    clear_time: float = number(12.0, unit="s", title="Mean time clear", ge=STEP, le=6000)
    delay: float = number(
        0.003, unit="s", title="Shortest delay", description="in both units, besides waiting and time on the air", ge=0, le=1
    )
    delay_rest: float = number(0.001, unit="s", title="Mean rest of the delay", description="exponential, beyond the shortest", ge=0, le=1)
    delay_longest: float = number(0.1, unit="s", title="Longest delay", description="where the rest is cut", ge=0, le=2)
    contention: bool = Field(True, title="Contention", description="a busy channel is waited for, and messages are spoilt by others")
    hearing: float = number(
        500.0, unit="m", title="Carrier sense", description="within which a message makes the channel busy for others", ge=1, le=10_000
    )
    congestion_control: Literal["none", "oscar", "vanetza"] = Field(
        "none", title="Congestion control", description="reactive, by the table of this stack (studio/model/radio/congestion.py)"
    )
    range: float = number(1500.0, unit="m", title="Range", description="beyond it nothing is heard, which saves work", gt=0, le=10_000)


def longest(settings):
    """The longest delay [s]."""
    slowest = packet.airtime(LARGEST, 0.0)
    waiting = channel.longest_wait(slowest) if settings.contention else 0.0
    return max(settings.delay_longest, settings.delay) + slowest + waiting


def largest(settings):
    """The largest message [bytes]."""
    return LARGEST


def reach(settings):
    """The distance [m] beyond which nothing is heard."""
    return settings.range


def heard_within(settings):
    """The distance [m] within which a message makes the channel busy."""
    return settings.hearing


def minds_walls(settings):
    """Whether walls count."""
    return settings.buildings


@compiled
def airtime(settings, size):
    """How long [s] a message of `size` bytes makes the channel busy."""
    return packet.airtime(size, settings.rate)


@compiled
def control(settings, load, control):
    """The least time [s] from one message of a unit to the next."""
    if settings.congestion_control == NO_CONTROL:
        return 0.0, control
    table = settings.congestion_control - 1.0
    after = congestion.sampled(control, load, table)
    return congestion.interval(after.level, table), after


def table(settings):
    """What is worked out once."""
    closest = propagation.free_space(propagation.CLOSEST, propagation.wavelength(settings.frequency))
    rate = packet.RATES.index(float(settings.rate.split()[0]))
    share = arrival.not_cut(settings.delay, settings.delay_rest, settings.delay_longest)
    first = [closest, share, *doubtful(settings, closest, rate)]
    return np.concatenate([first, packet.worn(rate), fading.quantiles(settings.m_near), fading.quantiles(settings.m_far)])


def doubtful(settings, closest, rate):
    """A distance [m] over which a signal is about as weak as is hopeless, the loss [dB] there, the exponent; none with several slopes."""
    exponent = {"free_space": 2.0, "one_slope": settings.exponent}.get(settings.path_loss)
    if exponent is None:
        return inf, 0.0, 0.0
    left = settings.transmit_power - settings.noise - packet.HOPELESS[rate] - closest
    distance = 10.0 ** (max(left, 0.0) / (10.0 * exponent))
    return distance, propagation.slopes(distance, closest, exponent, exponent, exponent, inf, inf), exponent


@compiled
def place(settings, spot, around):
    """The field of the shadows at a place [1]."""
    if settings.shadowing == 0.0:
        return 0.0, around
    x, y = spot.x / settings.shadowing_distance, spot.y / settings.shadowing_distance
    return shadowing.field(spot.seed, spot.common + SHADOW, x, y, around)


@compiled
def wait(settings, sent, draw):
    """Waiting for the channel, and time on the air [s]."""
    on_air = packet.airtime(sent.size, settings.rate)
    if settings.contention == 0.0:
        return on_air
    draws = chances_of_message(draw, WAIT)
    return on_air + channel.waiting(sent.load, on_air, draws[0], draws[1])


@inlined
def transmit(settings, way, draw):
    """What becomes of a message, and how long it takes.

    What is too weak with the brightest shadow and fading is too weak; nobody has to look which there are. Nor which shadow there is where
    the brightest is not enough, with this fading or without any. Mostly a loss that is not above the real one tells both.
    """
    taken = propagation.screened(way.walls, way.inside, way.decks, settings.buildings, settings.deck_loss)
    most = settings.transmit_power - least_loss(way) - settings.noise
    (darkest, lightest), hopeless = shadow_bounds(settings, way), packet.HOPELESS[int(settings.rate)]
    if most + lightest + brightest(settings, way) < hopeless:
        return Transmission(TOO_WEAK, 0.0)
    draws = chances(draw, 0)
    faintest, strongest = fade_bounds(settings, way, draws[FADES])
    if most + lightest + max(strongest, 0.0) < hopeless:
        return Transmission(TOO_WEAK, 0.0)
    clear = settings.transmit_power - path_loss(settings, way) - settings.noise
    if clear + lightest + max(strongest, 0.0) < hopeless:
        return Transmission(TOO_WEAK, 0.0)
    least, lost = clear - taken + darkest + faintest - settings.blockage, RECEIVED
    if least < packet.CERTAIN[int(settings.rate)]:
        lost = fate(settings, way, draw, clear + shadow(settings, way), taken, draws)
    if lost == RECEIVED and settings.contention > 0.0 and is_spoilt(settings, way, draws[SPOILT]):
        lost = BUSY
    return Transmission(lost, delay(settings, way, draws[LATE]) + way.wait if lost == RECEIVED else 0.0)


@compiled
def is_spoilt(settings, way, draw):
    """Whether another message spoils this one; what is above the bound is not looked at closely."""
    if draw >= channel.collision_bound(way.load, way.distance, settings.hearing):
        return False
    return draw < channel.collision(way.load, channel.hidden(way.distance, settings.hearing))


@compiled
def delay(settings, way, draw):
    """Processing in both units [s]."""
    longest = max(settings.delay_longest, settings.delay)
    return arrival.skewed_delay(settings.delay, settings.delay_rest, longest, way.table[NOT_CUT], draw)


@compiled
def fate(settings, way, draw, clear, taken, draws):
    """Why a message is not understood in a free channel, or that it is; `clear` is above the noise [dB] with its shadow.

    Mostly it is so for all powers between the bounds of fading; then nobody has to look how much it is.
    """
    mean, (least, greatest) = clear - taken, fade_bounds(settings, way, draws[FADES])
    if fails(settings, way, draws, mean + greatest):
        return weakness(settings, way, clear, taken, draws)
    if survives(settings, way, draws, mean + least - settings.blockage):
        return RECEIVED
    lacks = fails(settings, way, draws, mean + greatest - settings.blockage)
    if not (lacks and survives(settings, way, draws, mean + least)):
        faded = mean + fade(settings, way, draws[FADES])
        if not is_understood(settings, way, draws, faded):
            return weakness(settings, way, clear, taken, draws)
        lacks = not is_understood(settings, way, draws, faded - settings.blockage)
    return BURST if lacks and is_blocked(settings, way, draw) else RECEIVED


@compiled
def weakness(settings, way, clear, taken, draws):
    """Why a message is too weak: because of the distance, a bridge, the buildings, or a moment."""
    if not is_understood(settings, way, draws, clear):
        return TOO_WEAK
    if way.decks > 0.0 and not is_understood(settings, way, draws, clear - settings.deck_loss * way.decks):
        return DECK
    return FADING if taken == 0.0 or is_understood(settings, way, draws, clear - taken) else BUILDING


@compiled
def survives(settings, way, draws, ratio):
    """Whether a message is known to be understood at a signal to noise ratio [dB]."""
    return packet.surely_survives(ratio, settings.rate, 8.0 * way.size + packet.AROUND, draws[SURVIVES], way.table, WORN)


@compiled
def fails(settings, way, draws, ratio):
    """Whether it is known not to be."""
    return packet.surely_fails(ratio, settings.rate, 8.0 * way.size + packet.AROUND, draws[SURVIVES], way.table, WORN)


@compiled
def is_understood(settings, way, draws, ratio):
    """Whether it is."""
    return packet.survives(ratio, settings.rate, 8.0 * way.size + packet.AROUND, draws[SURVIVES], way.table, WORN)


@compiled
def path_loss(settings, way):
    """What distance and ground take [dB]."""
    which, closest = settings.path_loss, way.table[AT_ONE_METRE]
    if which == FREE_SPACE:
        return propagation.slopes(way.distance, closest, 2.0, 2.0, 2.0, inf, inf)
    if which == TWO_RAY:
        lambda_ = propagation.wavelength(settings.frequency)
        return propagation.two_ray(way.distance, lambda_, way.from_height, way.to_height, settings.permittivity)
    first = inf if which == ONE_SLOPE else settings.first_break
    second = max(settings.first_break, settings.second_break) if which == THREE_SLOPES else inf
    return propagation.slopes(way.distance, closest, settings.exponent, settings.second_exponent, settings.third_exponent, first, second)


@inlined
def least_loss(way):
    """A loss [dB] that is not above what distance and ground take, without a logarithm: ln x is not below 2 (x - 1)/(x + 1) from 1 on."""
    doubtful = way.table[DOUBTFUL]
    if way.distance <= doubtful:
        return -inf
    beyond = 2.0 * (way.distance - doubtful) / (way.distance + doubtful)
    return way.table[LOSS_THERE] + propagation.DECIBEL * way.table[EXPONENT] * beyond - ROUNDING


@compiled
def shadow(settings, way):
    """What the shadows of both places add [dB]."""
    if settings.shadowing == 0.0:
        return 0.0
    s = shadowing.of_both(way.from_place, way.to_place, way.distance, settings.shadowing_distance)
    return settings.shadowing * min(max(s, -FARTHEST_SHADOW), FARTHEST_SHADOW)


@compiled
def shadow_bounds(settings, way):
    """Between which values that is; quickly found."""
    low, high = shadowing.bounds(way.from_place, way.to_place)
    low, high = min(max(low, -FARTHEST_SHADOW), FARTHEST_SHADOW), min(max(high, -FARTHEST_SHADOW), FARTHEST_SHADOW)
    return settings.shadowing * low - ROUNDING, settings.shadowing * high + ROUNDING


@compiled
def fade(settings, way, draw):
    """What fading adds to this message [dB]."""
    m = fading.m_of(way.distance, settings.m_near, settings.m_far, settings.m_change)
    return 10.0 * log10(fading.power(m, draw)) if settings.fading > 0.0 else 0.0


@compiled
def fade_bounds(settings, way, draw):
    """Between which values that is."""
    return fading.bounds(way.table, powers_at(settings, way), draw) if settings.fading > 0.0 else (0.0, 0.0)


@compiled
def brightest(settings, way):
    """What it is not above for any message."""
    return way.table[powers_at(settings, way) + fading.ENTRIES] + fading.SLACK if settings.fading > 0.0 else 0.0


@compiled
def powers_at(settings, way):
    """Where the powers of this way's fading stand in the table."""
    return NEAR if way.distance < settings.m_change else FAR


@compiled
def is_blocked(settings, way, draw):
    """Whether something stands between both units now."""
    to_bad, to_good = burst.of_times(settings.clear_time, settings.blocked_time, STEP)
    return burst.is_bad(draw.seed, pair_of(draw), draw.common + BLOCKED, floor(way.time / STEP), to_bad, to_good)
