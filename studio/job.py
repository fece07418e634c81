"""A job: one run from a scenario file to its row in runs.db.

The command line, Python, REST and live runs all go through these functions; there is no second way to run.

    load(path, changes)  →  Loaded                  a valid scenario and what was changed
    prepare(loaded)      →  Setting                 its map and cars
    begin, finish                                   the row at the start, and all of it at the end
    run(loaded)          →  Run                     everything at once
"""

import hashlib
import json
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from studio.assess.assessment import assessed
from studio.assess.metric import Measured
from studio.errors import Problem, ScenarioError, StoreError, StudioError, UnknownError, nearest, short
from studio.execution.loop import as_fast_as_possible
from studio.execution.record import Record
from studio.execution.salvage import lay_down
from studio.execution.simulation import Simulation, simulation
from studio.kind import registry
from studio.provenance import provenance
from studio.scenario import file, setup
from studio.scenario.schema import Scenario
from studio.scenario.text.migration import migrated
from studio.scenario.text.source import Source
from studio.store.recording import MOST
from studio.store.runs import Row, Runs
from studio.vehicle.fleet import rows_of
from studio.world.channel import CHANNELS
from studio.world.setting import Setting, check_names, setting
from studio.world.table.event import EVENTS

LARGEST_SEED = 2**63 - 1
TIMES = 4  # as much room as its samples have a run needs on the disk: as they come, by channels, in a file and in the database


@dataclass(frozen=True)
class Loaded:
    """A scenario that was read: the file, what was changed by path, the valid result, what stands in the file, and what of it is old."""

    path: Path
    changes: dict[str, Any]
    scenario: Scenario
    source: Source
    migrated: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Its name in lists: the file's name without ending."""
        return self.path.stem

    @property
    def given(self) -> dict[str, Any]:
        """What stands in the file, in the present version of the format: without defaults."""
        return migrated(self.source)[0].value

    @property
    def document(self) -> dict[str, Any]:
        """The full document as plain data."""
        return self.scenario.model_dump(mode="json")

    def changed(self, changes: dict[str, Any]) -> "Loaded":
        """The same with further changes; raises ScenarioError."""
        return load(self.path, self.changes | changes)


@dataclass(frozen=True)
class Run:
    """A run that is over: its record, metrics, and its row when it was saved. `error` tells why it failed, and which kinds raised."""

    record: Record
    metrics: dict[str, Measured]
    unmet: list[str]
    channels: tuple[str, ...]
    status: str
    error: str | None
    state_hash: str
    sim_time_s: float
    wall_time_s: float
    row: Row | None = None

    @property
    def time(self) -> np.ndarray:
        """Times of the samples [s]."""
        return self.record.time

    def trace(self, name: str) -> np.ndarray:
        """`vehicle.quantity` over time; raises UnknownError with the nearest name."""
        return self.record.trace(name)


def load(path: str | Path, changes: dict[str, Any] | None = None) -> Loaded:
    """Reads a scenario file and applies changes {path: value}. Raises ScenarioError with all problems."""
    return loaded(file.opened(Path(path)), Path(path), changes)


def loaded(source: Source, path: Path, changes: dict[str, Any] | None = None) -> Loaded:
    """The same from what stands, or would stand, in the file."""
    changes = dict(changes or {})
    now, told = migrated(source)
    with file.placed(source, path.name, changes=changes, told=told):
        document = now.value
        if changes:
            setup.complete(document, path.name)  # what is wrong in the file is told before what is wrong in the changes
            document = setup.change(document, changes, path.name)
        found = Loaded(path, changes, setup.complete(document, path.name), source, tuple(told))
        check_goals(found)
    return found


def loaded_again(runs: Runs, row: Row, path: Path) -> Loaded:
    """The scenario of a run as it was run, at the place of the file that it stems from. Raises ScenarioError."""
    text = json.dumps(runs.document(row)).encode()
    return loaded(file.mapping(text, path.name, "scenario"), path)


def check_goals(loaded: Loaded) -> None:
    """Goals must be about measures that exist, and measures about events that do; raises ScenarioError."""
    wrong = [*unknown_goals(loaded.scenario), *misnamed(loaded.scenario), *unknown_events(loaded.scenario)]
    if wrong:
        where = loaded.path.name
        found = [replace(each, where=f"{where}: {each.where}") for each in wrong]
        raise ScenarioError(f"{where} is not a valid scenario.", found)


def unknown_goals(scenario: Scenario) -> Iterator[Problem]:
    """Goals about measures that are neither listed nor measured as usual."""
    for name in scenario.goals.keys() - scenario.measures.keys():
        try:
            registry.find("metric", name)
        except UnknownError as error:
            yield Problem(f"goals.{name}", error.message)


def misnamed(scenario: Scenario) -> Iterator[Problem]:
    """Measures with the name of another metric than theirs: nobody would know what the value is."""
    for name, each in scenario.measures.items():
        if name in registry.known("metric") and name != each.kind:
            yield Problem(f"measures.{name}", "is the name of another metric", each.kind, remedy="choose another name")


def unknown_events(scenario: Scenario) -> Iterator[Problem]:
    """Windows that begin or end with events that cannot be."""
    kinds = [each.name for each in EVENTS]
    for name, each in scenario.measures.items():
        for part in ("begin", "end"):
            event = getattr(getattr(each, part), "event", None)
            if event is not None and event not in kinds:
                yield Problem(f"measures.{name}.{part}.event", "is no kind of event", repr(event), ", ".join(kinds), nearest(event, kinds))


def check(loaded: Loaded) -> None:
    """All that can be checked without the map; raises ScenarioError."""
    with file.placed(loaded.source, loaded.path.name, changes=loaded.changes, told=loaded.migrated):
        check_names(loaded.scenario, loaded.path.name)


def seeded(loaded: Loaded, seed: int | None) -> Loaded:
    """With another seed; raises ScenarioError when it is none."""
    if seed is None:
        return loaded
    if not 0 <= seed <= LARGEST_SEED:
        raise ScenarioError("The seed is out of range.", [Problem("seed", "is out of range", short(seed), f"0 to {LARGEST_SEED}")])
    return replace(loaded, scenario=loaded.scenario.model_copy(update={"seed": seed}))


def prepare(loaded: Loaded) -> Setting:
    """Map, routes and cars. Raises ScenarioError, MapError or RouteError."""
    with file.placed(loaded.source, loaded.path.name, changes=loaded.changes, told=loaded.migrated):
        return setting(loaded.scenario, loaded.path.parent, loaded.path.name)


def check_recording(prepared: Setting, database: Path | None = None) -> None:
    """What a run will keep of its vehicles must have room; raises ScenarioError, before anything has begun."""
    scenario = prepared.scenario
    vehicles = len(prepared.cars) if scenario.recording.traffic else len(scenario.vehicles)
    size = 8.0 * len(CHANNELS) * vehicles * scenario.clock.duration / scenario.recording.period
    free = shutil.disk_usage(database.absolute().parent).free / TIMES if database else inf
    if size > min(MOST, free):
        what = f"would keep {told(size)}: {vehicles} vehicles for {scenario.clock.duration:g} s"
        allowed = f"at most {told(MOST)}" if size > MOST else f"at most {told(free)}, a {TIMES}th of what is free on the disk"
        remedy = "a longer recording.period, a shorter clock.duration, or recording.traffic: false"
        problem = Problem("recording", what, f"every {scenario.recording.period:g} s", allowed, remedy)
        raise ScenarioError("This run would record too much.", [problem])


def told(size: float) -> str:
    """A size for a message."""
    return f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{size / 1e6:.1f} MB"


def scenario_hash(loaded: Loaded, prepared: Setting) -> str:
    """Content hash of what is run: the document without its seed, the map, the vehicles with their tyres, and the route file if any."""
    parts = (prepared.network.digest, vehicles_digest(prepared), prepared.routes_digest)
    return file.digest(loaded.document, " ".join(filter(None, parts)))


def vehicles_digest(prepared: Setting) -> str:
    """Digest of the numbers of all vehicle models of a setting, whatever files they come from."""
    models = {car.model.name: car.model for car in prepared.cars}
    digest = hashlib.sha256()
    for name in sorted(models):
        parameter, gears, tyres = rows_of(models[name])
        for part in (parameter, gears, np.array(tyres)):
            digest.update(part.tobytes())
    return digest.hexdigest()


def begin(loaded: Loaded, prepared: Setting, runs: Runs, parent: int | None, *, status: str = "running", run: int | None = None) -> int:
    """The row of a run that starts now, or that waits; or that of one which waited, and starts now."""
    return runs.begin(
        scenario=loaded.name,
        title=loaded.scenario.title,
        document=loaded.document,
        scenario_hash=scenario_hash(loaded, prepared),
        map_digest=prepared.network.digest,
        parent=parent,
        seed=loaded.scenario.seed,
        parameters=loaded.changes,
        provenance=provenance(loaded.scenario),
        status=status,
        run=run,
    )


def recorded(prepared: Setting, runs: Runs, number: int) -> Simulation:
    """The simulation of a run that has its row, which is recorded beside the database. Raises StoreError."""
    shelf = runs.shelf(number)
    made = simulation(prepared, shelf=shelf)
    lay_down(made, shelf)
    return made


def outcome(loaded: Loaded, finished: Simulation, number: int = 0) -> Run:
    """What a finished simulation brought for one of its worlds."""
    wall = time.perf_counter() - finished.started - finished.rested
    case, scenario = finished.cases[number], loaded.scenario
    with readable():
        record = finished.record(number)
    found = assessed(record, scenario)
    return Run(
        record=found.record,
        metrics=found.metrics,
        unmet=found.unmet,
        channels=tuple(scenario.recording.channels),
        status=case.status,
        error="\n".join([case.error, *found.raised] if case.error else found.raised) or None,
        state_hash=case.state_hash,
        sim_time_s=round(case.time, 9),
        wall_time_s=round(wall, 3),
    )


@contextmanager
def readable() -> Iterator[None]:
    """What was recorded and has gone since is told as it is. Raises StoreError."""
    try:
        yield
    except OSError as error:
        where = str(error.filename or "recording")
        raise StoreError(
            "What was recorded of this run cannot be read any more.", [Problem(where, error.strerror or str(error), remedy="run it again")]
        ) from None


def save(run: int, result: Run, runs: Runs) -> Row:
    """Writes a result to its row."""
    runs.finish(
        run,
        status=result.status,
        error=result.error,
        state_hash=result.state_hash,
        record=result.record,
        sim_time_s=result.sim_time_s,
        wall_time_s=result.wall_time_s,
        metrics=result.metrics,
        unmet=result.unmet,
        channels=result.channels,
    )
    return runs.find(run)


def run(
    loaded: Loaded,
    *,
    seed: int | None = None,
    runs: Runs | None = None,
    parent: int | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> Run:
    """Runs a scenario to its end, as fast as possible; with `runs` it has a row there from its first moment.

    Raises ScenarioError, MapError, RouteError before anything is written; a run that fails is returned as failed.
    """
    loaded = seeded(loaded, seed)
    prepared = prepare(loaded)
    check_recording(prepared, runs.path if runs else None)
    if runs is None:
        current = simulation(prepared)
        as_fast_as_possible(current, progress)
        return outcome(loaded, current)
    number = begin(loaded, prepared, runs, parent)
    try:
        current = recorded(prepared, runs, number)
        as_fast_as_possible(current, progress)
        result = outcome(loaded, current)
        return replace(result, row=save(number, result, runs))
    except BaseException as error:
        with suppress(StoreError):  # what went wrong first is told
            why = str(error) if isinstance(error, StudioError) else repr(error)
            runs.break_off(number, "stopped" if isinstance(error, KeyboardInterrupt) else "failed", why)
        raise
