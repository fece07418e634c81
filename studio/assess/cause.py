"""Cause: why something happened, told in order from the record.

    explain(record)   →  [Explanation]     of every collision, near miss and hard brake

What was known about the other, from which sensor or message and how old; which message was lost and why; which sensor the script had
harmed; who commanded, and what he asked for; which tyre was at its limit. Everything was recorded: nothing is simulated anew, and what was
not recorded is said.

What was known is what was known when it began: of a collision before the bodies touched, for what sensors read of bodies within each other
is nothing that anybody could act upon; of a near miss when the time to collision became short; of a hard brake when it became hard.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations
from types import MappingProxyType
from typing import Any

import numpy as np

from studio.assess.adhesion import CHANNELS, WHEELS, light_among, nothing_known, sliding, used
from studio.assess.danger import HARD, NEAR_MISSES, stretches
from studio.assess.known import MEMORY, PLACES, Known, Overseer, known, overseers
from studio.execution.happening import Happening
from studio.execution.record import SAME_TIME, Record
from studio.world.commander import PARTS
from studio.world.table.event import EVENTS, HARD_BRAKE, HIT, NEAR_MISS

EXPLAINED = tuple(EVENTS[each].name for each in (HIT, NEAR_MISS, HARD_BRAKE))
LIMIT = 0.95  # [1] of the adhesion, or of the greatest deceleration, from which on a tyre, or who commands, is at its limit
NOTHING: Mapping[str, float] = MappingProxyType({})
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
class Asked:
    """What who had the brake of a vehicle asked for [m/s²], and the greatest deceleration [m/s²] that he may ask for, if it is known."""

    unit: str
    by: str
    acceleration: float
    greatest: float | None = None

    @property
    def text(self) -> str:
        """All of it in a sentence."""
        return f"{self.unit}: {self.by} asked for {round(self.acceleration, 2) + 0.0:.2f} m/s²{self.limit}"  # + 0.0: no -0.00

    @property
    def limit(self) -> str:
        """How far that is from the greatest deceleration; nothing of who does not brake."""
        if self.greatest is None or self.acceleration >= 0.0:
            return ""
        return f", {'at its limit of' if -self.acceleration >= LIMIT * self.greatest else 'of at most'} {-self.greatest:.4g} m/s²"


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

    `began` [s] is when it began, before which something must have been known. `not_recorded` are the channels that this would need and
    the run has not kept, "sensors" among them when it lacks their readings; `unknown` are units of the event of which nothing was recorded,
    `without_tyres` those that are light vehicles.
    """

    event: Happening
    began: float
    known: tuple[Known, ...]
    commanded_by: dict[str, dict[str, str]]
    tyre_at_limit: tuple[Wheel, ...]
    asked: tuple[Asked, ...] = ()
    faults: tuple[Harmed, ...] = ()
    not_recorded: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()
    without_tyres: tuple[str, ...] = ()
    overseers: tuple[Overseer, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """Plain data, as scripts read it."""
        return {
            "event": self.event.kind,
            "time": self.event.time,
            "began": self.began,
            "text": self.event.text,
            "units": list(self.event.units),
            "known": [each.as_json() for each in self.known],
            "commanded_by": self.commanded_by,
            "asked": [vars(each) for each in self.asked],
            "overseers": [{"told": each.told.as_json(), "knew": each.knew.as_json()} for each in self.overseers],
            "tyre_at_limit": [vars(each) for each in self.tyre_at_limit],
            "faults": [vars(each) for each in self.faults],
            "not_recorded": list(self.not_recorded),
            "unknown": list(self.unknown),
            "without_tyres": list(self.without_tyres),
        }

    @property
    def lines(self) -> list[str]:
        """All of it in sentences, in order."""
        return [*self.of_time(), *self.of_knowledge(), *(each.text for each in self.faults), *self.of_command(), *self.of_tyres()]

    def of_time(self) -> Iterator[str]:
        """When it began, where that is not when it is told."""
        if self.began < self.event.time:
            yield f"it began at {self.began:.2f} s"

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
            yield from (each.text for each in self.overseers if (each.told.unit, each.knew.about) == (one, other))
            yield f"{one} {'itself ' if self.is_guided(one, other) else ''}knew nothing of {other} in the {MEMORY:g} s before"

    def is_guided(self, one: str, other: str) -> bool:
        """Whether somebody beside the road knew the other one for it."""
        return any((each.told.unit, each.knew.about) == (one, other) for each in self.overseers)

    def of_command(self) -> Iterator[str]:
        """Who commanded."""
        for unit, parts in self.commanded_by.items():
            by = {who: [part for part, each in parts.items() if each == who] for who in parts.values()}
            told = "; ".join(f"{who} had {' and '.join(part)}" for who, part in by.items())
            yield f"{unit}: {told}" if told else f"{unit}: who commanded was not recorded"
            yield from (each.text for each in self.asked if each.unit == unit)

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


def explain(record: Record, events: Sequence[str] = EXPLAINED, greatest: Mapping[str, float] = NOTHING) -> list[Explanation]:
    """Everything of these kinds that happened, in the order of time; `greatest` are decelerations [m/s²] by who may ask for no more."""
    return [explained(record, event, greatest) for event in record.happenings if event.kind in events]


def explained(record: Record, event: Happening, greatest: Mapping[str, float]) -> Explanation:
    """One event: what was so when it began, and what was done at the last sample before it."""
    sample, first = sample_before(record, event), first_of(record, event)
    began = event.time if first is None else float(record.time[first])
    vehicles = [each for each in event.units if each in record.vehicles]
    pairs = [(one, other) for one, other in permutations(event.units, 2) if one in vehicles]
    return Explanation(
        event=event,
        began=round(began, 6),
        known=tuple(each for one, other in pairs for each in known(record, one, other, sample if first is None else first, began)),
        commanded_by={each: commanded(record, each, sample) for each in vehicles},
        tyre_at_limit=tuple(each for vehicle in vehicles for each in at_limit(record, vehicle, sample, last_of(record, event, sample))),
        asked=tuple(each for vehicle in vehicles for each in asked(record, vehicle, sample, greatest)),
        faults=tuple(each for vehicle in vehicles for each in harmed(record, vehicle, event.time)),
        not_recorded=lacking(record),
        unknown=tuple(each for each in event.units if each not in (*record.vehicles, *record.brought)),
        without_tyres=tuple(each for each in light_among(record) if each in event.units),
        overseers=tuple(each for one, other in pairs for each in overseers(record, one, other, began)),
    )


def sample_before(record: Record, event: Happening) -> int:
    """The last sample that an event has not changed: that at its time, but of a collision, in which bodies overlap by then, one before."""
    until = -SAME_TIME if event.kind == EVENTS[HIT].name else SAME_TIME
    return max(int(np.searchsorted(record.time, event.time + until)) - 1, 0)


def first_of(record: Record, event: Happening) -> int | None:
    """The sample at which a near miss began, which is told when it is nearest; None of all else, which is told when it begins."""
    if event.kind != EVENTS[NEAR_MISS].name or event.vehicle not in record.vehicles:
        return None
    sample = sample_before(record, event)
    holds = NEAR_MISSES.holds(NEAR_MISSES.values(record))[record.vehicles.index(event.vehicle)]
    return next((part.start for part in stretches(holds, record.time) if part.start <= sample < part.stop), None)


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


def asked(record: Record, vehicle: str, sample: int, greatest: Mapping[str, float]) -> Iterator[Asked]:
    """What who had the brake of a vehicle asked for; nothing where that was not recorded."""
    by = commanded(record, vehicle, sample).get("brake")
    u = record.channel("requested_acceleration")[record.vehicles.index(vehicle), sample]
    if by and np.isfinite(u):
        yield Asked(vehicle, by, round(float(u), 4), greatest.get(by))


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
