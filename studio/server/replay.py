"""The playback of a run that is over: where everybody was at any time, from what was recorded.

Vehicles that were not recorded are not there; whoever asks is told who. Between two samples everybody is on the way from one to the other.
Lights follow their programmes and the script, and what the script brings is where its line says, as long as its entry acted.
"""

from dataclasses import dataclass
from functools import cached_property
from math import nan
from pathlib import Path

import numpy as np

from studio import job
from studio.errors import Problem, UnknownError
from studio.execution.brought import Brought, acting_since, turns_of
from studio.execution.cast import Cast
from studio.execution.happening import Happening
from studio.execution.record import SAME_TIME, Body, Record
from studio.road.ways.floor import GROUND, Tread
from studio.road.ways.relief import Relief, height_at, relief_of
from studio.scene import pose
from studio.server import answer
from studio.server.frame import Frame, blend, lifted
from studio.server.layer import Layers, missing
from studio.store import trace
from studio.store.runs import Row, Runs
from studio.world.deed import SHOWN
from studio.world.effect import Lights
from studio.world.passes import traffic
from studio.world.setting import Setting
from studio.world.thing import names, things

PLACE = ("x", "y", "heading")  # without these nobody can be shown
POSED = {"x": pose.X, "y": pose.Y, "heading": pose.YAW, "roll": pose.ROLL, "pitch": pose.PITCH, "steering": pose.STEER}
ROLLING = ("speed", "station")  # wheels turn by the speed; the slope of the road is that at the station
LAYERS = ("gaps", "sensors", "messages", "paths", "trails", "speed", "lamps", "notices")
MOST_READ = 1 << 27  # [bytes] of a compressed recording: of a longer one the layers are not drawn
MOST = 1 << 28  # [bytes] of all poses: of a longer recording every n-th sample is taken
OTHER = "The map, or a vehicle, is another than it was in this run: what stands around the vehicles may not be what they saw."


@dataclass(frozen=True)
class Replay:
    """A run: its number, setting, and where its recorded vehicles were, float32[POSE_ROWS, vehicle, sample]."""

    run: int
    setting: Setting
    time: np.ndarray
    poses: np.ndarray
    columns: np.ndarray  # of the recorded vehicles among all
    happenings: tuple[Happening, ...]
    brought: dict[str, Brought]
    notes: tuple[str, ...]
    record: Record | None = None  # all that was kept; none of a recording that is too long for the memory
    kept: frozenset[str] = frozenset()  # channels that were recorded

    def frame(self, time: float) -> Frame:
        """The picture at a time [s]; before the first and after the last sample that of this."""
        t = float(np.clip(time, self.time[0], self.time[-1]))
        return Frame(self.seen(t), self.lights(t), *self.objects(t))

    def layers(self, time: float) -> answer.Layers | None:
        """What can be drawn over the picture at a time [s]: what the last sample before it says."""
        if self.record is None:
            return None
        last = int(np.searchsorted(self.record.time, time + SAME_TIME, side="right")) - 1
        return self.over.at(self.record, max(last, 0))

    @cached_property
    def over(self) -> Layers:
        """The layers of its setting."""
        return Layers(self.setting, self.record.bodies if self.record else {})

    @cached_property
    def missing(self) -> dict[str, str]:
        """Which layers cannot be drawn, and why."""
        return missing(self.record, self.kept) if self.record else dict.fromkeys(LAYERS, "the recording is too long")

    def seen(self, t: float) -> np.ndarray:
        """Poses of all vehicles."""
        i = min(max(int(np.searchsorted(self.time, t, side="right")) - 1, 0), self.time.size - 1)
        j = min(i + 1, self.time.size - 1)
        whole = np.zeros((pose.POSE_ROWS, len(self.setting.cars)), np.float32)
        share = (t - self.time[i]) / (self.time[j] - self.time[i]) if j > i else 1.0
        before, after = self.poses[:, :, i], self.poses[:, :, j]
        whole[:, self.columns] = blend(before, after, share)
        whole[pose.VISIBLE, self.columns] = before[pose.VISIBLE] if share < 1.0 else after[pose.VISIBLE]
        gone = whole[pose.VISIBLE] == 0.0
        whole[:, gone] = 0.0
        return whole

    def lights(self, t: float) -> np.ndarray:
        """int8[link]: by programme, or as the script had them."""
        signals, start = self.setting.network.signals, self.setting.scenario.map.signal_start
        forced, shown = np.full((2, len(signals)), -1)
        for entry, links, state in self.forced:
            if acting_since(self.turns.get(entry, ()), t) is not None:
                forced[links] = state
        times = np.array([signals.cycle, signals.offset - start])
        traffic.lights(times, signals.first, signals.count, signals.phase_end, signals.phase_state, forced, shown, t)
        return shown.astype(np.int8)

    @cached_property
    def turns(self) -> dict[str, list[Happening]]:
        """When every entry of the script has begun and ended."""
        return turns_of(self.happenings)

    @cached_property
    def forced(self) -> list[tuple[str, np.ndarray, int]]:
        """The lights that the script had under its hand: by which entry, which, and what they showed."""
        network = self.setting.network
        road = np.array([network.lanes[lane].road for lane in network.signals.link_lane])
        return [
            (site.name, np.flatnonzero(road == each.road), SHOWN[each.shows])
            for site in self.setting.sites
            for each in site.effects
            if isinstance(each, Lights)
        ]

    def objects(self, t: float) -> tuple[np.ndarray, np.ndarray]:
        """Which objects stand, int8[object], and where they are, float32[x, y, heading and lift, object]."""
        found = [self.place(name, each, t) for name, each in self.brought.items()]
        standing = np.array([each is not None for each in found], np.int8)
        return standing, np.array([each or (nan, nan, nan, nan) for each in found], np.float32).reshape(-1, 4).T

    def place(self, name: str, each: Brought, t: float) -> tuple[float, float, float, float] | None:
        """Where something was that the script brought; None while it was not there."""
        since = acting_since(self.turns.get(each.entry, ()), t)
        at = None if since is None else each.after(t - since)
        return None if since is None or at is None else (*at, self.treads[name].at(each.speed * (t - since)).lift)

    @cached_property
    def treads(self) -> dict[str, Tread]:
        """What is under all that the script brings, by name."""
        found = list(things(self.setting.sites))
        known = dict(zip(names(self.setting.sites, found), (each.tread for each in found), strict=True))
        return {name: known.get(name, GROUND) for name in self.brought}


def replay(runs: Runs, run: int, path: Path) -> Replay:
    """Of a run that is over; `path` is where its scenario stands. Raises UnknownError where too little was recorded, or ScenarioError."""
    row = runs.find(run)
    loaded = job.loaded_again(runs, row, path)
    setting, parquet = job.prepare(loaded), runs.parquet(run)
    record = runs.record(run) if len(parquet) < MOST_READ else None
    with runs.intact(run, "traces"):
        about, names = trace.about_of(parquet), {each["name"] for each in trace.channels(parquet)}
        vehicles = checked(row, about["vehicles"], names)
        wanted = [f"{vehicle}.{quantity}" for vehicle in vehicles for quantity in (*POSED, *ROLLING)]
        columns = trace.read(parquet, [name for name in wanted if name in names])
    number = {car.name: i for i, car in enumerate(setting.cars)}
    known = [name for name in vehicles if name in number]
    notes = [OTHER] if job.scenario_hash(loaded, setting) != row.scenario_hash else []
    if missing := len(setting.cars) - len(known):
        notes.append(f"{missing} of {len(setting.cars)} vehicles were not recorded and are not shown: set recording.traffic.")
    time = columns["time"]
    stride = max(4 * pose.POSE_ROWS * len(known) * time.size // MOST + 1, 1)
    return Replay(
        run=run,
        setting=setting,
        time=time[::stride],
        poses=poses(time, columns, known, about["cast"], about["bodies"], stride, setting),
        columns=np.array([number[name] for name in known], dtype=np.int64),
        happenings=tuple(runs.events(run)),
        brought=about["brought"],
        notes=tuple(notes),
        record=record,
        kept=frozenset(names),
    )


def checked(row: Row, vehicles: tuple[str, ...], names: set[str]) -> list[str]:
    """The vehicles of whom is known where they were; raises UnknownError when there is none."""
    found = [each for each in vehicles if all(f"{each}.{quantity}" in names for quantity in PLACE)]
    if not found:
        problem = Problem(
            "recording.channels", "leaves out where the vehicles were", allowed="with x, y and heading", remedy="run it again"
        )
        raise UnknownError(f"Run {row.run} cannot be played back.", [problem])
    return found


def poses(time: np.ndarray, columns: dict[str, np.ndarray], vehicles: list[str], cast: Cast, bodies: dict[str, Body],
          stride: int, setting: Setting) -> np.ndarray:  # fmt: skip
    """float32[POSE_ROWS, vehicle, sample] of every n-th sample."""
    relief, paths = relief_of(setting.network), {car.name: car.path for car in setting.cars}
    made, none = np.zeros((pose.POSE_ROWS, len(vehicles), time[::stride].size), np.float32), np.zeros(time.size)
    for v, name in enumerate(vehicles):
        own = {quantity: columns.get(f"{name}.{quantity}", none) for quantity in (*POSED, *ROLLING)}
        for quantity, row in POSED.items():
            made[row, v] = own[quantity][::stride]
        made[pose.PITCH, v] += slope(own["station"], name, cast)[::stride]
        made[pose.WHEEL_ANGLE, v] = turned(time, own["speed"], bodies[name].radius)[::stride]
        made[pose.VISIBLE, v] = np.isfinite(columns[f"{name}.x"])[::stride]
        if relief is not None and name in paths:
            lay(made, v, relief, height_at(paths[name], own["station"][::stride]))
    return made


def lay(made: np.ndarray, v: int, relief: Relief, height: np.ndarray) -> None:
    """Puts a vehicle where its road is drawn, at the samples at which it is there."""
    there = np.flatnonzero(made[pose.VISIBLE, v])
    made[:, v, there] = lifted(made[:, v, there], relief, height[there])


def slope(station: np.ndarray, name: str, cast: Cast) -> np.ndarray:
    """Angle of the road [rad] under a vehicle, sample by sample: the picture is flat, and the body stands in it as on the road."""
    slopes = np.array(cast.ways[cast.manned[name].way].slopes or [0.0])
    return np.arctan(slopes[np.clip(np.nan_to_num(station), 0, slopes.size - 1).astype(np.int64)])


def turned(time: np.ndarray, speed: np.ndarray, radius: float) -> np.ndarray:
    """Angle [rad] by which wheels that do not slip have turned since the start."""
    return np.cumsum(np.nan_to_num(speed) * np.diff(time, prepend=time[0])) / radius
