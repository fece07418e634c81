"""One run in the making: a world, its recorder, and the rules of when it ends."""

import time
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from studio.errors import ApplicationError
from studio.execution.record import Chain, Happening, Record, Recorder
from studio.vehicle import broken
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import ACTIVE, ROLL, V_X
from studio.world.build import build
from studio.world.mind import AHEAD, RED_STATION, STATION
from studio.world.setting import Setting
from studio.world.street import HIT_FIRST, HIT_SECOND, HIT_SPEED, HIT_TIME
from studio.world.tick import environment, look, meet, part
from studio.world.world import World

AT_THE_LINE = 8.0  # [m] before the stop line and nearer, a car that stands is the one that waits
STANDING = 0.1  # [m/s]
ROLLED = 1.0  # [rad] a vehicle that leans farther has rolled over


@dataclass
class Simulation:
    """A setting that is being run. `status` is running, done, stopped or failed; `error` says why it failed."""

    setting: Setting
    world: World
    recorder: Recorder
    happenings: list[Happening] = field(default_factory=list)
    status: str = "running"
    error: str | None = None
    started: float = field(default_factory=time.perf_counter)
    reported: set[tuple[str, str]] = field(default_factory=set)
    between: dict[str, str] = field(default_factory=dict)
    waiting: dict[str, bool] = field(default_factory=dict)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.world.clock.time

    @cached_property
    def chains(self) -> tuple[Chain, ...]:
        """Who follows whom by radio."""
        return chains(self.setting)

    @property
    def ticks(self) -> int:
        """Length of the whole run in ticks."""
        clock = self.setting.scenario.clock
        return round(clock.duration / clock.tick)

    @property
    def is_over(self) -> bool:
        """Whether there is nothing left to do."""
        return self.status != "running"

    def advance(self) -> None:
        """One tick. A failing application, or a state that is not finite, ends the run as failed."""
        world = self.world
        try:
            meet(world)
        except ApplicationError as error:
            self.fail(error.message)
            return
        self.recorder.take(world, world.clock.k)
        before = world.vehicles.state.copy(), world.vehicles.wheels.copy()
        part(world)
        self.check(*before)
        if not self.is_over:
            self.report()
        if world.clock.k >= self.ticks and not self.is_over:
            self.end("done")

    def end(self, status: str) -> None:
        """The run is over: drivers look around once more, and a last sample is taken."""
        self.status = status
        environment(self.world)
        look(self.world)
        self.recorder.take(self.world, self.world.clock.k - 1)

    def fail(self, reason: str) -> None:
        """Ends the run as failed."""
        self.status, self.error = "failed", reason
        self.happen(self.time, f"failed: {reason.splitlines()[0]}", "")

    def stop(self) -> None:
        """Ends the run because somebody asked for it."""
        if not self.is_over:
            self.end("stopped")

    def check(self, state: np.ndarray, wheels: np.ndarray) -> None:
        """Ends the run when a state is not finite any more, and names vehicle, time and the first quantity that broke.

        state and wheels are those before the tick.
        """
        vehicles, clock = self.world.vehicles, self.world.clock
        columns = broken.columns(vehicles)
        if columns.size:
            found = broken.first(vehicles, state, wheels, int(columns[0]), k=clock.k - 1, tick=clock.tick, step=clock.step)
            name = self.setting.names[int(columns[0])]
            self.fail(f"{found.quantity} of {name} is not finite any more at {clock.time - clock.tick + found.after:.3f} s")

    def happen(self, when: float, text: str, vehicle: str) -> None:
        """Adds an event."""
        self.happenings.append(Happening(round(when, 6), text, vehicle))

    def report(self) -> None:
        """Turns what the tick found into events."""
        self.report_triggers()
        self.report_changes()
        self.report_hits()
        self.report_rollovers()
        self.report_arrivals()
        self.report_company()
        self.report_waiting()

    def is_new(self, kind: str, name: str) -> bool:
        """Whether this has not been reported; from now on it has."""
        if (kind, name) in self.reported:
            return False
        self.reported.add((kind, name))
        return True

    def report_triggers(self) -> None:
        """Scripted maneuvers that have begun."""
        for i, (name, trigger) in enumerate(self.setting.scenario.triggers.items()):
            if self.world.events.fired[i] and self.is_new("trigger", name):
                text = f"{name}: {trigger.do.maneuver} with {trigger.do.deceleration:g} m/s²"
                self.happen(trigger.time, text, trigger.vehicle)

    def report_changes(self) -> None:
        """Changes of the road that have begun or ended."""
        for i, site in enumerate(self.setting.sites):
            for turn, word in enumerate(("begins", "ends")):
                if self.world.changes.phase[i] > turn and self.is_new(word, site.name):
                    text = f"{site.name} {word}: {site.text}" if turn == 0 else f"{site.name} {word}"
                    self.happen(float(self.world.changes.turned[turn, i]), text, (site.begins, site.ends)[turn].vehicle)

    def report_hits(self) -> None:
        """Collisions."""
        hits = self.world.events.hits_of(0)
        for i in range(hits.shape[1]):
            if self.is_new("hit", str(i)):
                first, second = (self.world.name_of(int(hits[row, i])) for row in (HIT_FIRST, HIT_SECOND))
                text = f"collision of {first} and {second} at {hits[HIT_SPEED, i]:.1f} m/s"
                self.happen(float(hits[HIT_TIME, i]), text, first)

    def report_rollovers(self) -> None:
        """Vehicles that have rolled over: what they do after it is not claimed."""
        for column in np.flatnonzero(np.abs(self.world.vehicles.state[ROLL]) > ROLLED):
            name = self.setting.names[column]
            if self.is_new("rollover", name):
                self.happen(self.time, "rolled over; what it does after this is not claimed", name)

    def report_arrivals(self) -> None:
        """Named vehicles that have reached the end of their route."""
        for column, name in enumerate(self.setting.scenario.vehicles):
            if self.world.vehicles.state[ACTIVE, column] == 0.0 and self.is_new("arrival", name):
                self.happen(self.time, "arrived at the end of its route", name)

    def report_company(self) -> None:
        """Somebody has come between a follower and the car that it listens to, or has gone again."""
        mind, names = self.world.vehicles.mind, self.setting.names
        for chain in self.chains:
            for ahead, follower in zip(chain.vehicles, chain.vehicles[1:], strict=False):
                seen = int(mind[AHEAD, names.index(follower)])
                between = names[seen] if seen >= 0 and names[seen] not in chain.vehicles else ""
                if between != self.between.get(follower, ""):
                    self.between[follower] = between
                    text = f"{between} is between it and {ahead}" if between else f"nobody is between it and {ahead} any more"
                    self.happen(self.time, text, follower)

    def report_waiting(self) -> None:
        """Named vehicles that have come to a stand at a red light."""
        v = self.world.vehicles
        for column, name in enumerate(self.setting.scenario.vehicles):
            distance = v.mind[RED_STATION, column] - v.mind[STATION, column] - v.parameter[FRONT, column]
            waits = bool(distance < AT_THE_LINE and v.state[V_X, column] < STANDING)
            if waits and not self.waiting.get(name, False):
                self.happen(self.time, "waits at a red light", name)
            self.waiting[name] = waits

    def record(self) -> Record:
        """What has been recorded so far."""
        return Record(
            time=np.array(self.recorder.times),
            values=self.recorder.values(),
            vehicles=tuple(self.setting.names[column] for column in self.recorder.columns),
            happenings=tuple(self.happenings),
            chains=self.chains,
            links=link_ages(self),
        )

    def record_of(self, samples: list[int]) -> Record:
        """A record of some samples only, by their numbers."""
        return Record(
            time=np.array([self.recorder.times[i] for i in samples]),
            values=np.moveaxis(np.array([self.recorder.samples[i] for i in samples]), 0, -1),
            vehicles=tuple(self.setting.names[column] for column in self.recorder.columns),
            happenings=(),
        )


def chains(setting: Setting) -> tuple[Chain, ...]:
    """Groups in which everybody listens to the vehicle ahead of it in the list."""
    found = []
    for name, group in setting.scenario.applications.items():
        order = [*group.listens_to[:1], *group.vehicles]
        if group.listens_to and group.listens_to == order[:-1]:
            found.append(Chain(name, group.application, tuple(order)))
    return tuple(found)


def link_ages(simulation: Simulation) -> dict[str, float]:
    """Mean age [s] of the newest message on each link, named sender→receiver."""
    units, names = simulation.world.units, simulation.setting.names
    if not simulation.recorder.ages:
        return {}
    means = simulation.recorder.mean_ages()
    return {
        f"{names[sender]}→{names[receiver]}": float(mean)
        for sender, receiver, mean in zip(units.link_sender, units.link_receiver, means, strict=True)
        if np.isfinite(mean)
    }


def simulation(setting: Setting) -> Simulation:
    """A run at its start."""
    scenario = setting.scenario
    recorded = len(setting.cars) if scenario.recording.traffic else len(scenario.vehicles)
    every = round(scenario.recording.period / scenario.clock.tick)
    return Simulation(setting, build([setting]), Recorder(np.arange(recorded), every))
