"""Runs in the making: a batch of worlds that share a clock, their recorder, and the rules of when each of them ends."""

import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from math import inf

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.execution.brought import brought, faults
from studio.execution.cast import cast
from studio.execution.counted import counted
from studio.execution.event import Teller, chains, foreseen, watched
from studio.execution.happening import Happening, happening
from studio.execution.hearing import hearing
from studio.execution.message import messages
from studio.execution.record import Body, Mount, Record, Recorder, renumber
from studio.execution.shelf import NoRoom, Shelf
from studio.execution.trail import Trail
from studio.kind.sensor import Looking
from studio.scenario.schema import Scenario
from studio.vehicle import broken
from studio.world.board.host import Fault
from studio.world.board.log import Logged
from studio.world.build import build
from studio.world.commander import commanders
from studio.world.line import starts
from studio.world.passes import census, notice
from studio.world.passes.census import Census
from studio.world.passes.notice import Watch
from studio.world.probe import probes, reader
from studio.world.setting import Setting
from studio.world.table.event import FAILED, RUN_ENDED
from studio.world.tick import between, environment, gather, look, meet, part, sense, think
from studio.world.world import World

PUT_DOWN = 1.0  # [s] of real time between two looks at what is wanted, and at which messages are put on the shelf


@dataclass
class Case:
    """One world of a batch. `status` is running, done, stopped or failed; `error` says why it failed.

    Once it is over, `time` [s] is when, `samples` of the recorder are its own, and `state_hash` is that of its state.
    """

    setting: Setting
    happenings: list[Happening] = field(default_factory=list)
    status: str = "running"
    error: str | None = None
    time: float = 0.0
    samples: int = 0
    state_hash: str = ""
    unfinished: np.ndarray = field(default_factory=census.nothing)  # what still went on when it was over, as counted

    @property
    def is_over(self) -> bool:
        """Whether there is nothing left to do."""
        return self.status != "running"

    def happen(self, event: Happening) -> None:
        """Adds an event."""
        self.happenings.append(event)


@dataclass
class Simulation:
    """Settings that are being run, one world each. A world that fails ends by itself; the others go on."""

    cases: list[Case]
    world: World
    recorder: Recorder
    watch: Watch
    teller: Teller
    census: Census
    ticks: int  # length of the whole run
    shelf: Shelf  # where it is kept what would be lost with the process
    put: int = 0  # events that have been put there
    heeded: float = field(default_factory=time.monotonic)  # [s] when it was last looked
    counts: list[np.ndarray] = field(default_factory=list)  # what was counted, [row, event]
    started: float = field(default_factory=time.perf_counter)
    rested: float = 0.0  # [s] of real time that it stood still because somebody wanted it to
    running: int = field(init=False)  # worlds that are not over
    may_end: bool = field(init=False)  # whether the script may end some world

    def __post_init__(self) -> None:
        self.running, self.may_end = len(self.cases), bool(self.world.script.ends.any())

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.world.clock.time

    @property
    def is_over(self) -> bool:
        """Whether no world is running any more."""
        return self.running == 0

    def advance(self, ticks: int = 1) -> None:
        """Some ticks, and what has happened in them. A failing application, or a state that is not finite, ends a world as failed."""
        with self.within_room():
            for _ in range(ticks):
                if not self.is_over:
                    self.tick()
                if self.watch.is_nearly_full or self.census.is_nearly_full:
                    self.tell()
            self.tell()
        self.heed()

    def heed(self) -> None:
        """Looks after what would be lost with the process, and whether somebody wants the run to end; to be called while it stands too."""
        with self.within_room():
            self.put_down()
            if time.monotonic() - self.heeded > PUT_DOWN:
                self.heeded = time.monotonic()
                for post in self.world.units.posts:
                    post.log.put_away()
                if self.shelf.is_to_end() and not self.is_over:
                    self.end("stopped")

    @contextmanager
    def within_room(self) -> Generator[None]:
        """When nothing more can be recorded, the runs end as failed, with what was recorded until then."""
        try:
            yield
        except NoRoom as full:
            for number in [i for i, case in enumerate(self.cases) if not case.is_over]:
                self.fail(number, full.message)

    def put_down(self) -> None:
        """What has happened in the first world goes to the shelf. Raises NoRoom."""
        fresh = self.cases[0].happenings[self.put :]
        if fresh:
            self.shelf.write("events", [each.as_json() for each in fresh])
            self.put += len(fresh)

    def tick(self) -> None:
        """One tick."""
        meet(self.world, self.refuse)
        if self.is_over:
            return
        self.recorder.take(self.world, self.world.clock.k)
        if self.may_end:
            self.end_by_script()
        if self.is_over:
            return
        between(self.world, self.refuse)
        part(self.world)
        self.check_wishes()
        self.check()
        notice.notice(self.world, self.watch)
        census.take(self.world, self.census)
        if self.world.clock.k >= self.ticks and not self.is_over:
            self.end("done")

    def end_by_script(self) -> None:
        """Ends the worlds whose script does so at this instant, at which everybody has looked around already."""
        s = self.world.script
        for entry in np.flatnonzero((s.ends != 0) & (s.turned[0] == self.time)).tolist():
            number = int(s.world[entry])
            if not self.cases[number].is_over:
                self.tell()
                self.cases[number].happen(happening(RUN_ENDED, self.time, entry=self.teller.sites[entry].name))
                self.close(number, "done")
                self.world.leave(number)

    def tell(self) -> None:
        """Makes events of what has been noticed; what happens in a world that is over is not told."""
        for world, event in self.teller.tell(self.watch):
            if not self.cases[world].is_over:
                self.cases[world].happen(event)
        self.counts.append(self.census.taken())

    def end(self, status: str) -> None:
        """The runs are over: everybody looks around once more, and a last sample is taken."""
        self.tell()
        environment(self.world)
        gather(self.world)
        look(self.world)
        think(self.world)
        sense(self.world, self.refuse)
        self.recorder.take(self.world, self.world.clock.k - 1)
        for number, case in enumerate(self.cases):
            if not case.is_over:
                self.close(number, status)

    def close(self, number: int, status: str) -> None:
        """A world is over: what is recorded from now on is not its own."""
        case = self.cases[number]
        self.running -= 1
        case.unfinished = census.unfinished(self.world, self.census)
        case.status, case.time, case.samples, case.state_hash = status, self.time, self.recorder.count, self.world.digest(number)

    def stop(self) -> None:
        """Ends the runs because somebody asked for it."""
        with self.within_room():
            if not self.is_over:
                self.end("stopped")

    def refuse(self, fault: Fault) -> None:
        """A kind has failed, and the runs of its worlds with it."""
        for number in fault.worlds:
            if not self.cases[number].is_over:
                self.fail(number, fault.error.message)

    def fail(self, number: int, reason: str) -> None:
        """Ends a world as failed; its vehicles leave the batch."""
        self.tell()
        self.cases[number].error = reason
        self.close(number, "failed")
        self.cases[number].happen(happening(FAILED, self.time, reason=reason.splitlines()[0]))
        self.world.leave(number)

    def check_wishes(self) -> None:
        """Ends the worlds in which a driver or a maneuver wants what is no number, and names it, vehicle and time."""
        for column, who in self.world.unfit_wishes() if self.world.unfit else []:
            number = int(self.world.worlds.of[column])
            if not self.cases[number].is_over:
                name, time = self.world.names[number][int(self.world.worlds.number[column])], self.time - self.world.clock.tick
                self.fail(number, f"the {who} of {name} wants an acceleration or steering that is not finite at {time:.3f} s")

    def check(self) -> None:
        """Ends the worlds with a state that is not finite any more, and names vehicle, time and the first quantity that broke."""
        vehicles, world, clock = self.world.vehicles, self.world, self.world.clock
        for column in broken.columns(vehicles).tolist() if np.count_nonzero(vehicles.broken) else []:
            number = int(world.worlds.of[column])
            if not self.cases[number].is_over:
                found = broken.first(vehicles, column, k=clock.k - 1, tick=clock.tick, step=clock.step)
                name = world.names[number][int(world.worlds.number[column])]
                self.fail(number, f"{found.quantity} of {name} is not finite any more at {clock.time - clock.tick + found.after:.3f} s")

    def record(self, number: int = 0) -> Record:
        """What has been recorded so far of one world."""
        case, recorder = self.cases[number], self.recorder
        count = case.samples if case.is_over else recorder.count
        links = self.links(number)
        return Record(
            time=recorder.times(count),
            values=renumber(recorder.values(number, count), self.numbers(number)),
            vehicles=self.recorded(number),
            happenings=tuple(case.happenings),
            chains=chains(case.setting),
            links=tuple(links.values()),
            ages=recorder.ages(list(links), count),
            probes=recorder.traced(number, range(count)),
            messages=messages(self.world, number),
            bodies=self.bodies(number),
            called=self.called(number),
            commanders=commanders(case.setting.scenario),
            mounts=mounts(case.setting.scenario),
            brought=brought(case.setting),
            faults=faults(case.setting),
            cast=cast(case.setting),
            counted=counted([*self.counts, case.unfinished], self.world, number, case.time if case.is_over else inf),
        )

    def recorded(self, number: int = 0) -> tuple[str, ...]:
        """Names of the recorded vehicles of one world."""
        share = self.recorder.vehicle_share[number]
        return self.world.names[number][: share.stop - share.start]

    def record_of(self, samples: list[int]) -> Record:
        """A record of some samples of the first world only, by their numbers."""
        time, values = self.recorder.samples(samples)
        shown = renumber(values[:, self.recorder.vehicle_share[0]], self.numbers(0))
        probes = self.recorder.traced(0, samples)
        return Record(time=time, values=shown, vehicles=self.recorded(), happenings=(), probes=probes)

    def links(self, number: int) -> dict[int, str]:
        """The links of one world, named sender→receiver, by their places among all."""
        units = self.world.units
        ends = [(s, r) for post in units.posts for s, r in zip(post.sender[post.link_sender], post.link_receiver, strict=True)]
        return {
            i: f"{units.name_of(sender)}→{units.name_of(receiver)}"
            for i, (sender, receiver) in enumerate(ends)
            if units.world[receiver] == number
        }

    def called(self, number: int) -> dict[int, str]:
        """Names of the vehicles and objects of one world by the numbers that the channel `ahead` has for them, in the order of names."""
        return {new: self.world.name_of(old, number) for old, new in self.numbers(number).items()}

    def numbers(self, number: int) -> dict[int, int]:
        """The numbers of vehicles and objects in a record, which go by their names, by those that they have in the file."""
        found = {}
        for olds in (range(len(self.world.names[number])), self.world.object_numbers(number)):
            by_name = sorted(olds, key=lambda old: self.world.name_of(old, number))
            found |= dict(zip(by_name, olds, strict=True))
        return found

    def bodies(self, number: int) -> dict[str, Body]:
        """The bodies of all vehicles of one world."""
        return {name: Body(*each) for name, each in zip(self.world.names[number], self.world.bodies(number).T.tolist(), strict=True)}


def mounts(scenario: Scenario) -> dict[str, Mount]:
    """Where the sensors of vehicles are that look around."""
    sensors = {f"{name}.{sensor}": each for name, vehicle in scenario.vehicles.items() for sensor, each in vehicle.sensors.items()}
    return {name: Mount(each.forward, each.left, each.yaw) for name, each in sensors.items() if isinstance(each, Looking)}


def simulation(*settings: Setting, shelf: Shelf | None = None) -> Simulation:
    """Runs at their start, side by side; what they record lies in memory, or on a shelf.

    Raises ScenarioError when they do not share clock and sampling period.
    """
    shelf = shelf or Shelf()
    check_clocks(settings)
    scenario = settings[0].scenario
    world = build(settings)
    for i, post in enumerate(world.units.posts):
        post.log.keep = partial(keep, shelf, f"log_{i}")
    return Simulation(
        cases=[Case(each, list(foreseen(each))) for each in settings],
        world=world,
        recorder=recorder(settings, world, shelf),
        shelf=shelf,
        watch=watched(settings, world),
        teller=Teller(settings, world),
        census=census.census(world),
        ticks=round(scenario.clock.duration / scenario.clock.tick),
    )


def keep(shelf: Shelf, name: str, part: Logged) -> Callable[[], Logged]:
    """Puts a part of a log of messages on a shelf."""
    read = shelf.append(name, *part)
    return lambda: Logged(*read())


def check_clocks(settings: tuple[Setting, ...]) -> None:
    """All worlds of a batch meet at the same instants and end together; raises ScenarioError."""
    first = settings[0].scenario
    wrong = [
        Problem(f"{name} of run {i + 1}", "differs from that of the first run", str(getattr(part, field)), str(getattr(own, field)))
        for i, each in enumerate(settings)
        for name, part, own in (("clock", each.scenario.clock, first.clock), ("recording", each.scenario.recording, first.recording))
        for field in ("tick", "step", "duration", "period")
        if getattr(part, field, None) != getattr(own, field, None)
    ]
    if wrong:
        raise ScenarioError("Runs with different clocks cannot be done side by side.", wrong)


def recorder(settings: tuple[Setting, ...], world: World, shelf: Shelf) -> Recorder:
    """Records the named vehicles of all worlds, and their traffic where it is wanted."""
    counts = [len(each.cars) if each.scenario.recording.traffic else len(each.scenario.vehicles) for each in settings]
    recording, clock = settings[0].scenario.recording, settings[0].scenario.clock
    found = probes(world)
    return Recorder(
        columns=np.concatenate([first + np.arange(count) for first, count in zip(world.worlds.first, counts, strict=True)]),
        every=round(recording.period / world.clock.tick),
        most=round(clock.duration / recording.period) + 2,
        vehicle_share=shares(counts),
        hearing=hearing(world.units.posts, shelf),
        trail=Trail(reader([probe for each in found for probe in each], world), shelf),
        probe_share=shares([len(each) for each in found]),
        shelf=shelf,
    )


def shares(counts: list[int]) -> list[slice]:
    """The places of several parts that stand one after another."""
    return [slice(int(first), int(first) + count) for first, count in zip(starts(np.array(counts)), counts, strict=True)]
