"""Soak: live runs begun and ended one after another, and what the server holds while they come and go.

It is looked when the process of the next run stands ready and no other is left: how soon that is depends on how busy the machine is, and
so would what is held at any other moment.

Growth is the slope of a straight line through what was held after each run, with the uncertainty of that slope. Neighbouring values
depend on each other, so the uncertainty is that of the means of blocks, which do not.
"""

import random
import time
from collections.abc import Iterator
from math import sqrt
from typing import NamedTuple

import numpy as np

from tests.campaign.station import NEXT_RUN, Held, Station
from tests.campaign.table import Row
from tests.patience import until

BLOCKS = 10  # means that the line goes through
WARMING = 0.2  # share of the runs before anything is measured: caches fill
SURE = 3.0  # standard deviations of a slope that is growth
MOST_OVER = 16  # runs that a server remembers, and a little more: those grow at first
OFTEN = 50  # runs after which it is told how it goes
LEAST = Held(memory=5.0, descriptors=1.0, threads=1.0, processes=1.0)  # over all runs: less is none


class Slope(NamedTuple):
    """How something grows with each run."""

    value: float
    deviation: float

    def __str__(self) -> str:
        return f"{self.value:+.4f} ± {self.deviation:.4f}"


def slope(values: list[float]) -> Slope:
    """Of a straight line through the means of blocks of values, per value."""
    blocks = [float(np.mean(each)) for each in np.array_split(np.array(values), min(BLOCKS, len(values)))]
    at = np.arange(len(blocks), dtype=float) * len(values) / len(blocks)
    x, y = at - at.mean(), np.array(blocks) - np.mean(blocks)
    value = float((x * y).sum() / (x * x).sum())
    rest = y - value * x
    return Slope(value, sqrt(float((rest * rest).sum()) / max(len(blocks) - 2, 1) / float((x * x).sum())))


def once(station: Station, chance: random.Random) -> None:
    """A live run that is begun, perhaps paused, stepped, looked at, and ended."""
    run = station.live(set={"clock.duration": chance.choice((0.2, 2, 60))}, pace=chance.choice(("fast", 5.0)), paused=chance.random() < 0.3)
    for order in chance.sample(("pause", "step", "resume", "step"), chance.randrange(4)):
        station.client.post(f"/api/live/{run}/{order}")
    station.client.post(f"/api/live/{run}/stop")
    # one that had to be ended looks killed until it is put down that it was stopped
    until(lambda: station.status(run) in ("done", "stopped"), f"run {run} to be stopped")
    station.client.get(f"/api/runs/{run}").raise_for_status()


def campaign(station: Station, *, seed: int, count: int, seconds: float | None = None) -> Iterator[list[Row]]:
    """So many runs, spread evenly over the time there is, or one after another; now and then, and at the end, what came of them."""
    runs, held, began = Row("soak", "live runs", seed), [], time.monotonic()
    chance = random.Random(f"{seed}/soak")
    for number in range(1, count + 1):
        with runs.trying("ended as they should"):
            once(station, chance)
        until(lambda: len(station.of_runs()) == NEXT_RUN, "the process of the next run, and no other")
        held.append(station.held())
        spent = time.monotonic() - began
        if number == count or (seconds and spent > seconds):
            break
        if number % OFTEN == 0:
            yield judged(runs, held, seed)
        time.sleep(max(0.0, (seconds or 0.0) * number / count - spent))
    yield judged(runs, held, seed)


def judged(runs: Row, held: list[Held], seed: int) -> list[Row]:
    """A row for the runs, and one for each thing that is held."""
    return [runs, *(growth(name, [getattr(each, name) for each in held], seed) for name in Held._fields)]


def growth(name: str, values: list[float], seed: int) -> Row:
    """Whether something grows."""
    row = Row("soak", f"{name} held", seed)
    steady = values[min(int(WARMING * len(values)) + MOST_OVER, len(values) // 2) :]
    if len(steady) < 3:
        row.blame(f"{len(values)} values are too few")
        return row
    found = slope(steady)
    row.tried = len(steady)
    row.came[f"{np.mean(steady[:5]):.1f} at first, {np.mean(steady[-5:]):.1f} at last, {found} a run"] = 1
    if found.value > SURE * found.deviation and found.value * len(steady) > getattr(LEAST, name):
        row.blame(f"grows by {found} a run")
    return row
