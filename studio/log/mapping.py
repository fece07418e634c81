"""From recorded signals to ours: which is which, in what unit, with what sign, and what its sensor shows at rest. A YAML file.

    dbc: car.dbc                     # of a CAN trace, beside the mapping
    signals:
      yaw_rate: {from: YawRateSensor, unit: deg/s, sign: -1, offset: 0.4, delay: 0.02}
      road_wheel_angle: {from: [SteerAngleFL, SteerAngleFR], unit: rad}
      lateral_acceleration: {from: AccY, unit: g, at: [0.4, -0.3, 0.1]}
      speed: {from: ["velocity[0]", "velocity[1]", "velocity[2]"], unit: m/s, combine: norm}

Ours is sign · (recorded - offset), the offset in the recorded unit, brought to SI; of several recorded signals it is the mean, or as
`combine: norm` the length of the vector that they are. A signal that comes `delay` seconds late has its times moved back. Without
`unit` it is the one that the log gives. A speed or an acceleration of a sensor that sits `at` x, y, z [m] forward, left and up from the
centre of gravity is brought to that (studio/log/lever.py).
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from studio.errors import Problem, ScenarioError, nearest
from studio.kind.log import Log, Signal, signal
from studio.kind.settings import Part, number
from studio.log import lever, unit
from studio.log.quantity import QUANTITIES
from studio.scenario import file
from studio.scenario.text import source as text

SIZE_LIMIT = 1_000_000  # [B] of a mapping file
Metres = Annotated[float, Field(ge=-25, le=25, allow_inf_nan=False)]


class Source(Part):
    """Where one of our signals comes from."""

    recorded: str | list[str] = Field(..., alias="from", title="Recorded signal", description="or several, of which it is the mean")
    unit: str = Field("", title="Unit of the recorded signal", description="left out: as the log says")
    combine: Literal["mean", "norm"] = Field("mean", title="What several signals become")
    sign: Literal[1, -1] = Field(1, title="Sign", description="-1 where the log counts to the other side")
    offset: float = number(0.0, unit="1", title="What the sensor shows at rest, in its own unit")
    delay: float = number(0.0, unit="s", title="How late the signal comes", ge=-60, le=60)
    at: tuple[Metres, Metres, Metres] | None = Field(
        None, title="Where the sensor sits", description="x, y, z from the centre of gravity: forward, left, up; left out: there",
        json_schema_extra={"unit": "m"},
    )  # fmt: skip


class Mapping(Part):
    """All signals that are taken from a log."""

    dbc: str | None = Field(None, title="DBC of a CAN trace", description="relative to the mapping")
    signals: dict[str, Source] = Field(..., min_length=1, title="Our signals")

    @property
    def places(self) -> dict[str, lever.Place]:
        """Where sensors sit that are not at the centre of gravity [m], by our signal."""
        return {name: each.at for name, each in self.signals.items() if each.at is not None}


@dataclass(frozen=True)
class Known:
    """A mapping with the folder that its paths start from."""

    mapping: Mapping
    folder: Path = field(default_factory=Path)

    @property
    def dbc(self) -> Path | None:
        """The DBC, where it names one."""
        return self.folder / self.mapping.dbc if self.mapping.dbc else None


def read(path: Path) -> Known:
    """A mapping of a file; raises ScenarioError with everything that is wrong with it, line by line."""
    return Known(of_text(file.mapping(file.content(path, "mapping", SIZE_LIMIT), path.name, "mapping")), path.parent)


def of_text(found: text.Source) -> Mapping:
    """The mapping that stands in a text; raises ScenarioError."""
    made = file.model(found, Mapping, "mapping")
    strange = [name for name in made.signals if name not in QUANTITIES]
    with file.placed(found, found.where):
        problems = [
            Problem(f"{found.where}: signals.{name}", "is none of our signals", remedy=nearest(name, QUANTITIES)) for name in strange
        ]
        problems += [
            Problem(f"{found.where}: signals.{name}.at", "is the same wherever a sensor sits", name, ", ".join(lever.OFF), "leave it out")
            for name in made.places
            if name not in (*lever.OFF, *strange)
        ]
        if problems:
            raise refused(found.where, problems)
    return made


def refused(name: str, problems: list[Problem]) -> ScenarioError:
    """What is told of a mapping that is none."""
    return ScenarioError(f"{name} cannot be used as a mapping.", problems)


OURS = {each.column: name for name, each in QUANTITIES.items() if each.column} | {name: name for name in QUANTITIES}


def has_named(log: Log) -> bool:
    """Whether signals of a log have our names, or those of the rig's columns."""
    return any(name in OURS for name in log.signals)


def as_named(log: Log) -> Mapping:
    """The mapping of a log whose signals have our names already, or those of the rig's columns; raises ScenarioError when none has."""
    found = {OURS[name]: {"from": name} for name in log.signals if name in OURS}
    if not found:
        remedy = "write a mapping: signals: {yaw_rate: {from: …, unit: deg/s}}, and give it with --mapping"
        problem = Problem(log.name, "has no signal with a name of ours", ", ".join(list(log.signals)[:8]), ", ".join(QUANTITIES), remedy)
        raise ScenarioError(f"Nobody says what the signals of {log.name} are.", [problem])
    return Mapping.model_validate({"signals": found})


# -- applying it -----------------------------------------------------------------------------------------


def apply(mapping: Mapping, log: Log) -> dict[str, Signal]:
    """Our signals in SI, each on its own clock; raises ScenarioError for what the log lacks, and for values that cannot be right."""
    missing = [
        Problem(f"signals.{name}", f"{log.name} has no signal {each!r}", remedy=nearest(each, log.signals))
        for name, source in mapping.signals.items()
        for each in names(source)
        if each not in log.signals
    ]
    if missing:
        raise ScenarioError(f"{log.name} lacks what the mapping takes from it.", missing)
    made = {name: ours(name, source, log) for name, source in mapping.signals.items()}
    wrong = [problem for name, each in made.items() for problem in impossible(name, mapping.signals[name], each)]
    if wrong:
        raise ScenarioError(f"{log.name} holds values that no vehicle has.", wrong)
    return made


def names(source: Source) -> list[str]:
    """The recorded signals of one of ours."""
    return [source.recorded] if isinstance(source.recorded, str) else source.recorded


def ours(name: str, source: Source, log: Log) -> Signal:
    """One of our signals."""
    parts = [log[each] for each in names(source)]
    recorded = [source.unit or each.unit for each in parts]
    wanted = QUANTITIES[name].unit
    scaled = [source.sign * (each.values - source.offset) * unit.factor(given, wanted, f"signals.{name}.unit")
              for each, given in zip(parts, recorded, strict=True)]  # fmt: skip
    time = parts[0].time
    together = np.array([scaled[0], *(np.interp(time, part.time, each) for part, each in zip(parts[1:], scaled[1:], strict=True))])
    values = together.mean(axis=0) if source.combine == "mean" else np.linalg.norm(together, axis=0)
    return signal(name, wanted, time - source.delay, values)


def impossible(name: str, source: Source, found: Signal) -> list[Problem]:
    """Values that no vehicle has: a wrong unit, most likely."""
    known, quantity = found.values[found.is_number], QUANTITIES[name]
    if not known.size:
        return [Problem(f"signals.{name}", "has no samples", str(source.recorded), remedy="take another signal")]
    far = known[(known < quantity.low) | (known > quantity.high)]
    if not far.size:
        return []
    worst = far[np.argmax(np.abs(far))]
    what = f"cannot be right in {far.size} of {known.size} samples"
    remedy = f"is it recorded in another unit? Say so: unit: {' or '.join(list(unit.FACTORS[quantity.unit])[:5])}"
    return [Problem(f"signals.{name}", what, f"{worst:g} {quantity.unit}", f"{quantity.low:g} to {quantity.high:g}", remedy)]
