"""The process of one live run: it simulates, paces itself, and tells the server what happens.

Orders come in and news go out over one pipe, as tuples that begin with a word:

    in    start, pause, resume, step, pace, stop
    out   ready, begun | refused, channels, frame, samples, layers, event, state, end

The process is started before it is needed, so that everything is imported and compiled when somebody clicks on run.
It runs one run and ends; whatever goes wrong in it ends that run and nothing else.
"""

import time
import traceback
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np

from studio import job
from studio.assess.danger import Lookout
from studio.errors import StoreError, StudioError
from studio.execution.loop import Pace
from studio.execution.message import lately
from studio.execution.simulation import Case, Simulation, simulation
from studio.kind.registry import load_folder
from studio.kind.renewal import stand_in, without_bytecode
from studio.road.ways.relief import relief_of
from studio.scenario import file
from studio.server import answer
from studio.server.frame import blend, frame, poses
from studio.server.layer import SHOWN, TRAIL, TRAIL_STEP, Layers
from studio.store.runs import Runs, open_runs
from studio.world.channel import catalogue

FRAME_PERIOD = 0.02  # [s] of real time between two frames for the eye
NEWS_PERIOD = 0.1  # [s] of real time between two reports of state and samples
SAMPLE_PERIOD = 0.1  # [s] of simulated time between two samples of the live charts
BATCH = 0.015  # [s] of real time that is simulated before orders are looked at again
IDLE = 0.5  # [s] between two looks for orders while paused
SERVER_ENDED = "The server ended before the run did."
LIVE_CHANNELS = ("speed", "gap", "acceleration", "time_gap")


@dataclass(frozen=True)
class Order:
    """What to run: scenario file with its text, changes by path, seed, parent, pace, where to keep it, and as which run if it waited."""

    path: Path
    text: str
    changes: dict[str, Any]
    seed: int | None
    parent: int | None
    pace: float
    paused: bool
    db: Path
    run: int | None = None


@dataclass
class Live:
    """A run that somebody watches."""

    simulation: Simulation
    pipe: Connection
    pace: Pace
    paused: bool
    told: int = 0
    sampled: int = 0
    last_frame: float = 0.0
    last_news: float = 0.0
    measured_since: tuple[float, float] = (0.0, 0.0)
    factor: float = 0.0
    before: np.ndarray = field(default_factory=lambda: np.zeros(0))
    after: np.ndarray = field(default_factory=lambda: np.zeros(0))
    advanced: float = 0.0

    def __post_init__(self) -> None:
        self.lookout = Lookout(self.simulation)
        self.relief = relief_of(self.case.setting.network)

    @property
    def case(self) -> Case:
        """The only world."""
        return self.simulation.cases[0]

    def run(self) -> None:
        """Until the run is over."""
        self.before = self.after = poses(self.simulation.world.vehicles, self.relief)
        self.pace.restart(self.simulation.time)
        self.pipe.send(("channels", self.channels()))
        self.news(force=True)
        while not self.simulation.is_over:
            self.orders()
            if not self.paused:
                self.work()
            self.simulation.heed()
            self.show()
            self.news()
        self.show(force=True)
        self.news(force=True)

    def orders(self) -> None:
        """Takes the orders that have come; waits for one while there is nothing to do."""
        is_resting, began = self.paused, time.perf_counter()
        wait = IDLE if is_resting else min(self.pace.wait(self.due), FRAME_PERIOD)
        while self.pipe.poll(wait):
            self.obey(*self.pipe.recv())
            wait = 0.0
        if is_resting:
            self.simulation.rested += time.perf_counter() - began

    @property
    def due(self) -> float:
        """Simulated time of the next tick."""
        return self.simulation.time + self.simulation.world.clock.tick

    def obey(self, order: str, *values: Any) -> None:
        """One order."""
        if order == "stop":
            self.simulation.stop()
        elif order == "pause":
            self.paused = True
        elif order == "resume":
            self.paused = False
        elif order == "step":
            self.paused = True
            if not self.simulation.is_over:
                self.tick()
        elif order == "pace":
            self.pace.factor = values[0]
        self.pace.restart(self.simulation.time)
        self.news(force=True)

    def work(self) -> None:
        """Ticks that are due, for a little while."""
        until = time.perf_counter() + BATCH
        while not self.simulation.is_over and self.pace.wait(self.due) <= 0.0 and time.perf_counter() < until:
            self.tick()

    def tick(self) -> None:
        """One tick; remembers the poses before and after it."""
        self.simulation.advance()
        self.before, self.after = self.after, poses(self.simulation.world.vehicles, self.relief)
        self.advanced = time.perf_counter()

    def show(self, force: bool = False) -> None:
        """A frame for the eye; between two ticks when the pace is slower than real time."""
        now = time.perf_counter()
        if not force and (now - self.last_frame < 0.9 * FRAME_PERIOD or (self.paused and self.last_frame > self.advanced)):
            return
        share = 1.0
        if not self.paused and self.pace.factor < 1.0:
            share = min((now - self.advanced) * self.pace.factor / self.simulation.world.clock.tick, 1.0)
        seen = blend(self.before, self.after, share) if share < 1.0 else self.after
        self.pipe.send(("frame", self.simulation.time, frame(self.simulation.world, seen)))
        self.last_frame = now

    def news(self, force: bool = False) -> None:
        """State, new samples and new events."""
        now = time.perf_counter()
        if not force and now - self.last_news < NEWS_PERIOD:
            return
        self.send_events()
        self.send_samples()
        self.send_layers()
        self.pipe.send(("state", self.status, self.simulation.time, self.pace.factor, self.real_time_factor(now)))
        self.last_news = now

    @property
    def status(self) -> str:
        """What the run is doing."""
        if self.simulation.is_over:
            return self.case.status
        return "paused" if self.paused else "running"

    def real_time_factor(self, now: float) -> float:
        """Simulated over real seconds, measured anew when enough of them have passed since the last time."""
        real, simulated = self.measured_since
        if now - real >= 0.9 * NEWS_PERIOD:
            self.factor = (self.simulation.time - simulated) / (now - real) if real else 0.0
            self.measured_since = (now, self.simulation.time)
        return self.factor

    def send_events(self) -> None:
        """Happenings that have not been told, and dangers that are over."""
        happenings = self.case.happenings
        for each in [*happenings[self.told :], *self.lookout.look()]:
            self.pipe.send(("event", answer.event(each).model_dump()))
        self.told = len(happenings)

    def send_layers(self) -> None:
        """What can be drawn over the picture now: by the last sample, and some before it for the trails."""
        recorder = self.simulation.recorder
        if recorder.count:
            step = max(round(TRAIL_STEP / (recorder.every * self.simulation.world.clock.tick)), 1)
            samples = sorted(range(recorder.count - 1, -1, -step)[: round(TRAIL / TRAIL_STEP)])
            record = replace(
                self.simulation.record_of(samples),
                called=self.called,
                messages=lately(self.simulation.world, self.simulation.time - 2 * SHOWN),
            )
            self.pipe.send(("layers", self.layers.at(record, len(samples) - 1).model_dump()))

    @cached_property
    def layers(self) -> Layers:
        """Of its world."""
        return Layers(self.case.setting, self.simulation.bodies(0))

    @cached_property
    def called(self) -> dict[int, str]:
        """The names of who is ahead, by number."""
        return self.simulation.called(0)

    def channels(self) -> list[tuple[str, str, str]]:
        """Name, unit and label of what the live charts may show: some channels, and what sensors and applications give."""
        some = [(f"{vehicle}.{name}", catalogue()[name]) for vehicle in self.simulation.recorded() for name in LIVE_CHANNELS]
        probes = self.simulation.recorder.trail.reader.probes[self.simulation.recorder.probe_share[0]]
        return [(name, each.unit, each.label) for name, each in (*some, *((probe.name, probe) for probe in probes))]

    def send_samples(self) -> None:
        """Samples of the live channels that have not been sent, at the charts' period; single steps and the end too."""
        recorder = self.simulation.recorder
        thin = max(round(SAMPLE_PERIOD / (recorder.every * self.simulation.world.clock.tick)), 1)
        last = recorder.count - 1
        whole = self.paused or self.simulation.is_over
        fresh = [i for i in range(self.sampled, last + 1) if i % thin == 0 or (whole and i == last)]
        self.sampled = last + 1
        if fresh:
            record = self.simulation.record_of(fresh)
            self.pipe.send(("samples", record.time, {name: record.trace(name) for name, _, _ in self.channels()}))


def main(pipe: Connection, first: Path | None, kinds: tuple[Path, ...], kept: tuple[tuple[Path, Path], ...] = ()) -> None:
    """The process: gets ready, waits for its order, runs it. `kept` are folders, and where versions of their files lie that load."""
    np.random.seed()  # noqa: NPY002 - a user's code may draw from it; split off, every process would draw the same
    try:
        for folder, place in kept:
            stand_in(folder, place)
        with without_bytecode():
            for folder in kinds:
                load_folder(folder)
        warm(first)
        pipe.send(("ready",))
        order, *values = pipe.recv()
        if order == "start":
            start(pipe, *values)
    except (EOFError, OSError):
        return  # the server is gone


def take_in(pipe: Connection, db: Path, kinds: tuple[Path, ...]) -> None:
    """A process that takes in what was recorded of runs whose processes have gone."""
    for folder in kinds:
        load_folder(folder)
    open_runs(db).close()


def warm(path: Path | None) -> None:
    """Goes through everything once: map, machine code. What is wrong with the scenario is told when it is started."""
    if path is None:
        return
    try:
        simulation(job.prepare(job.load(path))).advance()
    except StudioError:
        return


def start(pipe: Connection, order: Order) -> None:
    """Loads, runs and saves. Input that is refused leaves no row."""
    try:
        text = file.mapping(order.text.encode(), str(order.path), "scenario")
        loaded = job.seeded(job.loaded(text, order.path, order.changes), order.seed)
        prepared = job.prepare(loaded)
        job.check_recording(prepared, order.db)
        runs = open_runs(order.db)
        number = job.begin(loaded, prepared, runs, order.parent, run=order.run)
    except StudioError as error:
        pipe.send(("refused", error))
        return
    pipe.send(("begun", number, loaded.document["clock"]["duration"]))
    try:
        current = job.recorded(prepared, runs, number)
        Live(current, pipe, Pace(order.pace), order.paused).run()
        row = job.save(number, job.outcome(loaded, current), runs)
        pipe.send(("end", row.status, row.error))
    except (EOFError, ConnectionError):
        ended(runs, number, "killed", SERVER_ENDED)
    except (StudioError, OSError) as error:  # there is no room, or what was recorded has gone
        pipe.send(("end", ended(runs, number, "failed", str(error)), str(error)))
    except BaseException:  # a user's code may raise anything, an interrupt too
        pipe.send(("end", ended(runs, number, "failed", traceback.format_exc()), traceback.format_exc()))


def ended(runs: Runs, number: int, status: str, why: str) -> str:
    """Puts down how a run ended that brought no result, with what was recorded of it, if the database takes it; returns how."""
    with suppress(StoreError):
        runs.break_off(number, status, why)
    return status


def pace_factor(pace: float | str) -> float:
    """Simulated over real seconds; "fast" is without limit."""
    return inf if pace == "fast" else float(pace)
