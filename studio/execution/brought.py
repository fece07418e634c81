"""Brought: what the script puts on the road, and which sensors it harms, as far as somebody has to know it when a run is over.

Nothing of this is sampled: what the script brings is where its line says, as long as its entry acts, and when that was is told by events.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import atan2, hypot
from typing import NamedTuple

from studio.execution.happening import Happening
from studio.world.effect import SensorFault
from studio.world.setting import Setting
from studio.world.table.event import EVENTS, SCRIPT_BEGUN, SCRIPT_CUT, SCRIPT_ENDED, SCRIPT_VAIN
from studio.world.thing import names, things

BEGUN, *OVER = (EVENTS[each].name for each in (SCRIPT_BEGUN, SCRIPT_ENDED, SCRIPT_CUT, SCRIPT_VAIN))
SAME = 1e-6  # [s] what begins at an instant acts at it


class Pose(NamedTuple):
    """Where the middle of something is [m], and its heading [rad]."""

    x: float
    y: float
    heading: float


class Brought(NamedTuple):
    """Something on the road: the entry that brings it, its line [m], heading at rest [rad], speed [m/s], whether it stays, its size [m]."""

    entry: str
    line: tuple[tuple[float, float], ...]
    heading: float
    speed: float
    stays: bool
    length: float
    width: float

    def after(self, elapsed: float) -> Pose | None:
        """Where it is some time [s] after it has come; None when it is gone."""
        left, heading = self.speed * elapsed, self.heading
        for (x, y), (to_x, to_y) in pairwise(self.line):
            way, heading = hypot(to_x - x, to_y - y), atan2(to_y - y, to_x - x)
            if left < way:
                return Pose(x + left / way * (to_x - x), y + left / way * (to_y - y), heading)
            left -= way
        is_gone = len(self.line) > 1 and not self.stays
        return None if is_gone else Pose(*self.line[-1], heading)


class Fault(NamedTuple):
    """A sensor that the script harms: by which entry, of which unit, which one, "" for all, whether it fails, the factor on its noise."""

    entry: str
    unit: str
    sensor: str
    fails: bool
    noise: float


def brought(setting: Setting) -> dict[str, Brought]:
    """All that the script of a scenario may bring, by name."""
    found = list(things(setting.sites))
    return {
        name: Brought(
            entry=setting.sites[each.entry].name,
            line=tuple((float(x), float(y)) for x, y in each.walk.line) if each.walk else ((float(each.x), float(each.y)),),
            heading=float(each.heading),
            speed=each.walk.speed if each.walk else 0.0,
            stays=each.walk is None or each.walk.stays,
            length=float(each.length),
            width=float(each.width),
        )
        for name, each in zip(names(setting.sites, found), found, strict=True)
    }


def faults(setting: Setting) -> tuple[Fault, ...]:
    """All sensors that the script of a scenario may harm."""
    return tuple(
        Fault(site.name, each.unit, each.sensor or "", each.fails, each.noise)
        for site in setting.sites
        for each in site.effects
        if isinstance(each, SensorFault)
    )


def turns_of(happenings: Iterable[Happening]) -> dict[str, list[Happening]]:
    """When every entry of the script has begun and ended."""
    found: dict[str, list[Happening]] = {}
    for each in happenings:
        if each.kind in (BEGUN, *OVER):
            found.setdefault(each.words["entry"], []).append(each)
    return found


def acting_since(turns: Sequence[Happening], time: float) -> float | None:
    """Since when [s] an entry with these turns acts at a time [s]; None when it does not."""
    so_far = [each for each in turns if each.time <= time + SAME]
    return so_far[-1].time if so_far and so_far[-1].kind == BEGUN else None
