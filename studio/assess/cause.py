"""Cause: why something happened, told in order from the record.

    explain(record)   →  [Explanation]     of every collision, near miss and hard brake

What was known about the other, from which sensor or message and how old; which message was lost and why; which sensor the script had
harmed; who commanded; which tyre was at its limit. Everything was recorded: nothing is simulated anew, and what was not recorded is said.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import Any

import numpy as np

from studio.assess.adhesion import CHANNELS, WHEELS, light_among, nothing_known, sliding, used
from studio.assess.danger import HARD, stretches
from studio.assess.known import PLACES, Known, known
from studio.execution.happening import Happening
from studio.execution.record import Record
from studio.world.commander import PARTS
from studio.world.table.event import EVENTS, HARD_BRAKE, HIT, NEAR_MISS

EXPLAINED = tuple(EVENTS[each].name for each in (HIT, NEAR_MISS, HARD_BRAKE))
LIMIT = 0.95  # [1] of the adhesion, from which on a tyre is at its limit
BEFORE = 1.0  # [s] before the event in which a tyre may have been


@dataclass(frozen=True)
class Wheel:
    """A tyre at its limit: whose, which, how much of its adhesion it used at most [1], and whether it slid past its peak of slip."""

    unit: str
    wheel: str
    use: float
    slides: bool = False

    @property
    def text(self) -> str:
        """All of it in a sentence."""
        how = "slid past its peak of slip, with up to" if self.slides else "was at its limit,"
        return f"{self.unit}: the {self.wheel.replace('_', ' ')} tyre {how} {self.use:.0%} of its adhesion"


@dataclass(frozen=True)
class Harmed:
    """A sensor that the script harmed at that time: whose, which, "" for all, by which entry and since when [s]; how noisy, or failed."""

    unit: str
    sensor: str
    entry: str
    since: float
    fails: bool
    noise: float

    @property
    def text(self) -> str:
        """All of it in a sentence."""
        which = f"{self.sensor} of {self.unit}" if self.sensor else f"all sensors of {self.unit}"
        return f"{which} gave {'nothing' if self.fails else f'noise times {self.noise:g}'}, by {self.entry} since {self.since:.2f} s"


@dataclass(frozen=True)
class Explanation:
    """Why an event happened: what was known by whom, who commanded each vehicle, and which tyres were at their limits.

    `not_recorded` are the channels that this would need and the run has not kept, "sensors" among them when it lacks their readings;
    `unknown` are units of the event of which nothing was recorded, `without_tyres` those that are light vehicles.
    """

    event: Happening
    known: tuple[Known, ...]
    commanded_by: dict[str, dict[str, str]]
    tyre_at_limit: tuple[Wheel, ...]
    faults: tuple[Harmed, ...] = ()
    not_recorded: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()
    without_tyres: tuple[str, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """Plain data, as scripts read it."""
        return {
            "event": self.event.kind,
            "time": self.event.time,
            "text": self.event.text,
            "units": list(self.event.units),
            "known": [each.as_json() for each in self.known],
            "commanded_by": self.commanded_by,
            "tyre_at_limit": [vars(each) for each in self.tyre_at_limit],
            "faults": [vars(each) for each in self.faults],
            "not_recorded": list(self.not_recorded),
            "unknown": list(self.unknown),
            "without_tyres": list(self.without_tyres),
        }

    @property
    def lines(self) -> list[str]:
        """All of it in sentences, in order."""
        return [*self.of_knowledge(), *(each.text for each in self.faults), *self.of_command(), *self.of_tyres()]

    def of_knowledge(self) -> Iterator[str]:
        """What was known, and who knew nothing of whom."""
        for one, other in permutations(self.event.units, 2):
            if one in self.commanded_by:
                yield from self.of_pair(one, other)

    def of_pair(self, one: str, other: str) -> Iterator[str]:
        """What one knew of the other."""
        found = [each.text for each in self.known if (each.unit, each.about) == (one, other)]
        yield from found
        if other in self.unknown:
            yield f"{other} was not recorded, nor who knew it"
        elif {"sensors", *PLACES} & set(self.not_recorded):
            yield f"what {one} knew of {other} by sensors was not recorded"
        elif not found:
            yield f"{one} knew nothing of {other}"

    def of_command(self) -> Iterator[str]:
        """Who commanded."""
        for unit, parts in self.commanded_by.items():
            by = {who: [part for part, each in parts.items() if each == who] for who in parts.values()}
            told = "; ".join(f"{who} had {' and '.join(part)}" for who, part in by.items())
            yield f"{unit}: {told}" if told else f"{unit}: who commanded was not recorded"

    def of_tyres(self) -> Iterator[str]:
        """Which tyres were at their limits."""
        yield from (each.text for each in self.tyre_at_limit)
        yield from (f"{each} is a light vehicle, without tyres" for each in self.without_tyres)
        if self.without_tyres and set(self.event.units) <= set(self.without_tyres):
            return
        if set(CHANNELS) & set(self.not_recorded):
            yield "how much of its adhesion every tyre used was not recorded"
        elif not self.tyre_at_limit:
            yield "no tyre was at its limit"


def explain(record: Record, events: Sequence[str] = EXPLAINED) -> list[Explanation]:
    """Everything of these kinds that happened, in the order of time."""
    return [explained(record, event) for event in record.happenings if event.kind in events]


def explained(record: Record, event: Happening) -> Explanation:
    """One event: what was so at the last sample before it."""
    sample = max(int(np.searchsorted(record.time, event.time + 1e-6)) - 1, 0)
    vehicles = [each for each in event.units if each in record.vehicles]
    pairs = [(one, other) for one, other in permutations(event.units, 2) if one in vehicles]
    return Explanation(
        event=event,
        known=tuple(each for one, other in pairs for each in known(record, one, other, sample)),
        commanded_by={each: commanded(record, each, sample) for each in vehicles},
        tyre_at_limit=tuple(each for vehicle in vehicles for each in at_limit(record, vehicle, sample, last_of(record, event, sample))),
        faults=tuple(each for vehicle in vehicles for each in harmed(record, vehicle, event.time)),
        not_recorded=lacking(record),
        unknown=tuple(each for each in event.units if each not in (*record.vehicles, *record.brought)),
        without_tyres=tuple(each for each in light_among(record) if each in event.units),
    )


def lacking(record: Record) -> tuple[str, ...]:
    """What a run has not kept that would have to be known: channels, and "sensors" when their readings are not there."""
    channels = (*PLACES, *(f"commands_{part}" for part in PARTS), *(() if nothing_known(record) else CHANNELS)) if record.time.size else ()
    found = [name for name in channels if np.isnan(record.channel(name)).all()]
    is_blind = any(f"{sensor}.measured" not in record.probes for sensor in record.mounts)
    return (*found, *(["sensors"] if is_blind else []))


def harmed(record: Record, unit: str, time: float) -> Iterator[Harmed]:
    """Sensors of a unit that the script harms at a time [s]."""
    for each in record.faults:
        since = record.acting_since(each.entry, time)
        if each.unit == unit and since is not None:
            yield Harmed(unit, each.sensor, each.entry, since, each.fails, each.noise)


def commanded(record: Record, vehicle: str, sample: int) -> dict[str, str]:
    """Who had wheel, brake, drive and gear of a vehicle; what was not recorded is left out."""
    row, found = record.vehicles.index(vehicle), {}
    for part in PARTS:
        number = record.channel(f"commands_{part}")[row, sample]
        if np.isfinite(number) and 0 <= number < len(record.commanders):
            found[part] = record.commanders[int(number)]
    return found


def last_of(record: Record, event: Happening, sample: int) -> int:
    """The last sample of what an event tells: a hard brake is told when it begins, with its strongest deceleration."""
    if event.kind != EVENTS[HARD_BRAKE].name or event.vehicle not in record.vehicles:
        return sample
    hard = -record.channel("acceleration")[record.vehicles.index(event.vehicle)] > HARD
    return next((part.stop - 1 for part in stretches(hard, record.time) if part.start <= sample < part.stop), sample)


def at_limit(record: Record, vehicle: str, sample: int, last: int) -> Iterator[Wheel]:
    """Wheels of a vehicle whose tyres were at their limits, or past their peaks of slip.

    That is from a second before a sample up to the last one of the event.
    """
    row = record.vehicles.index(vehicle)
    while_it_was = slice(int(np.searchsorted(record.time, record.time[sample] - BEFORE)), last + 1)
    most = np.nan_to_num(used(record)[:, row, while_it_was]).max(axis=1, initial=0.0)
    slid = sliding(record)[:, row, while_it_was].max(axis=1, initial=False)
    for wheel, use, slides in zip(WHEELS, most, slid, strict=True):
        if use >= LIMIT or slides:
            yield Wheel(vehicle, wheel, round(float(use), 4), bool(slides))
