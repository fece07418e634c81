"""Two cars, one behind the other, and what the second hears of the first by a wlan: the radio's own function, in a compiled loop."""

from typing import Any, NamedTuple

import numpy as np

from studio.compiled import compiled
from studio.kinds.radio import wlan
from studio.model.radio.shadowing import Around
from studio.workshop import draw
from studio.world.table.cause import RECEIVED
from studio.world.view import Draw, Sent, Spot, Way

PAIRS, MESSAGES, SEED = 400, 500, 1
COMMON = 50_000  # first stream of the radio
APART = 10_000.0  # [m] from pair to pair
HEIGHT = 1.5  # [m]


class Journey(NamedTuple):
    """How pairs of cars drive and send: speed [m/s], time between messages [s], bytes, load of the channel [1]."""

    speed: float
    period: float
    size: float = 350.0
    load: float = 0.0


JOURNEYS = {"motorway": Journey(32.0, 0.2), "suburban": Journey(20.6, 0.2), "urban": Journey(8.2, 0.4)}


def settings(preset: str = "", **changes: Any) -> Any:
    """Of a preset, with some changed, as compiled code gets them."""
    values = wlan.PRESETS[preset].values if preset else {}
    return draw.settings_tuple(wlan, wlan.Settings(**(values | changes)))


def table(settings: Any) -> np.ndarray:
    """What the radio works out of settings as compiled code gets them."""
    known = wlan.Settings.model_json_schema()["properties"]
    named = {name: known[name]["enum"][int(getattr(settings, name))] for name in ("rate", "path_loss")}
    same = ("frequency", "transmit_power", "noise", "exponent", "m_near", "m_far", "delay", "delay_rest", "delay_longest")
    return wlan.table(wlan.Settings(**named).model_copy(update={name: getattr(settings, name) for name in same}))


def heard(settings: Any, distance: float, journey: Journey, pairs: int = PAIRS, messages: int = MESSAGES) -> tuple[np.ndarray, np.ndarray]:
    """Causes and delays [s] of all messages, [pair, message]."""
    causes, delays = np.zeros((pairs, messages), dtype=np.int8), np.zeros((pairs, messages))
    send(settings, table(settings), Around(), distance, *journey, SEED, causes, delays)
    return causes, delays


@compiled
def send(settings, table, nothing, distance, speed, period, size, load, seed, causes, delays):
    """Pairs drive along roads far apart; the first message of each is sent at 0 s."""
    for pair in range(causes.shape[0]):
        y = APART * pair
        for k in range(causes.shape[1]):
            time = period * k
            x = speed * time
            draw = Draw(seed, 2 * pair, 2 * pair + 1, 2000, k, COMMON)
            wait = wlan.wait(settings, Sent(time, x, y, size, load), draw)
            here, _ = wlan.place(settings, Spot(x, y, seed, COMMON), nothing)
            there, _ = wlan.place(settings, Spot(x - distance, y, seed, COMMON), nothing)
            way = Way(
                distance, 0.0, 0.0, size, speed, 0.0, time, x, y, HEIGHT, x - distance, y, HEIGHT, load, load, wait, here, there, table, 0.0
            )
            found = wlan.transmit(settings, way, draw)
            causes[pair, k], delays[pair, k] = found.lost, found.delay


def delivery(causes: np.ndarray) -> float:
    """The share of messages that arrive."""
    return float(np.mean(causes == RECEIVED))


def mean_run(causes: np.ndarray) -> float:
    """The mean number of losses in a row."""
    lost = causes != RECEIVED
    begun = np.count_nonzero(lost[:, 0]) + np.count_nonzero(lost[:, 1:] & ~lost[:, :-1])
    return float(lost.sum() / begun)
