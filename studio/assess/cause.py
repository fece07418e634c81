"""Cause: why something happened, told in order from the record.

    explain(record)   →  [Explanation]     of every collision, near miss and hard brake

What was known about the other, from which sensor or message and how old; which message was lost and why; who commanded; which tyre was at
its limit. Everything was recorded: nothing is simulated anew.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import Any

import numpy as np

from studio.assess.adhesion import WHEELS, sliding, used
from studio.assess.danger import HARD, stretches
from studio.assess.known import Known, known
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
class Explanation:
    """Why an event happened: what was known by whom, who commanded each vehicle, and which tyres were at their limits."""

    event: Happening
    known: tuple[Known, ...]
    commanded_by: dict[str, dict[str, str]]
    tyre_at_limit: tuple[Wheel, ...]

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
        }

    @property
    def lines(self) -> list[str]:
        """All of it in sentences, in order."""
        return [*self.of_knowledge(), *self.of_command(), *self.of_tyres()]

    def of_knowledge(self) -> Iterator[str]:
        """What was known, and who knew nothing of whom."""
        for one, other in permutations(self.event.units, 2):
            found = [each.text for each in self.known if (each.unit, each.about) == (one, other)]
            if one in self.commanded_by:
                nothing = f"{one} knew nothing of {other}" if other in self.commanded_by else f"{other} was not recorded, nor who knew it"
                yield from found or [nothing]

    def of_command(self) -> Iterator[str]:
        """Who commanded."""
        for unit, parts in self.commanded_by.items():
            by = {who: [part for part, each in parts.items() if each == who] for who in parts.values()}
            told = "; ".join(f"{who} had {' and '.join(part)}" for who, part in by.items())
            yield f"{unit}: {told}" if told else f"{unit}: who commanded was not recorded"

    def of_tyres(self) -> Iterator[str]:
        """Which tyres were at their limits."""
        yield from (each.text for each in self.tyre_at_limit)
        if not self.tyre_at_limit:
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
    )


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
