"""What the routes work with: where scenarios, maps and runs are, the live runs, the imports, the stages."""

import threading
from collections.abc import Iterable, Mapping
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from studio import job, sample
from studio.errors import ConflictError, Problem, ServerError, StoreError, StudioError, UnknownError, nearest, short
from studio.execution.loop import FASTEST, SLOWEST
from studio.job import Loaded
from studio.road.library import place
from studio.server.answer import Pace
from studio.server.documents import Documents, check_inside
from studio.server.editing import Editing
from studio.server.editing.history import History
from studio.server.edition import Editions
from studio.server.frame import Frame
from studio.server.ghost import haunting
from studio.server.live import MOST_LIVE, LiveRun, Lives
from studio.server.maps import Maps
from studio.server.maps.job import MapJobs
from studio.server.replay import Replay, replay
from studio.server.scenarios import Scenarios
from studio.server.stages import Stages
from studio.server.validation import Projects
from studio.server.validation.job import ProjectJobs
from studio.server.worker import Order, pace_factor
from studio.store import queue
from studio.store.backup import edits_of
from studio.store.runs import Row, Runs, reopen_runs
from studio.warmup import Warmup


@dataclass
class Desk:
    """One server's work: paths, live runs, maps and their imports, stages."""

    db: Path
    scenarios: Path
    kinds: tuple[Path, ...]
    at_once: int = MOST_LIVE

    def __post_init__(self) -> None:
        first = next(iter(self.files().values()), None)
        self.lives = Lives(db=self.db, first=first, kinds=self.kinds, most=self.at_once, on_frame=self.on_frame)
        self.editions = Editions(self.kinds, self.lives)
        self.documents = Documents(self.scenarios)
        self.scenario_files = Scenarios(self.documents)
        self.editing = Editing(self.documents, History(edits_of(self.db)))
        self.maps = Maps(self.scenarios)
        self.map_jobs = MapJobs(self.maps)
        self.warmup = Warmup()
        self.projects = Projects(self.scenarios)
        self.project_jobs = ProjectJobs(self.db, lambda: self.warmup.is_over, self.kinds)
        self.stages = Stages()
        self._lock = threading.Lock()

    def compiling(self) -> dict[str, Any] | None:
        """How far the warm-up is, while it goes on."""
        return None if self.warmup.is_over else asdict(self.warmup.progress())

    def settle(self) -> None:
        """Before something is written: the samples of an installed package are copied to ./scenarios, and from now on that is the folder.

        Raises ServerError when it cannot be written.
        """
        with self._lock:
            if self.scenarios != sample.PACKAGED:
                return
            own = Path("scenarios").resolve()
            try:
                sample.copy_to(own)
            except OSError as error:
                problem = Problem(
                    "scenarios",
                    error.strerror or str(error),
                    str(own),
                    remedy="start the studio in a folder of your own, or name one with --scenarios",
                )
                raise ServerError("The samples cannot be copied to a folder of your own.", [problem]) from None
            self.scenarios = self.documents.folder = own
            self.maps = self.map_jobs.maps = Maps(own)
            self.projects = Projects(own)

    def on_frame(self, live: LiveRun, frame: Frame) -> None:
        """Frames go to the stages."""
        self.stages.on_frame(live, frame)

    def files(self) -> dict[str, Path]:
        """Scenario files by id, the one that a newcomer sees first in front."""
        return {path.stem: path for path in sorted(self.scenarios.glob("*.yaml"), key=lambda path: (path.stem != sample.FIRST, path.stem))}

    def file(self, scenario: str) -> Path:
        """The file of a scenario; raises UnknownError."""
        files = self.files()
        if scenario not in files:
            raise UnknownError(f"There is no scenario {short(scenario)}.", [self.gone(scenario, files)])
        return files[scenario]

    def gone(self, scenario: str, files: Iterable[str]) -> Problem:
        """Why there is no such scenario: it never was, or somebody has deleted it."""
        for each in self.scenario_files.trash.entries():
            if each.scenario == scenario:
                return Problem("scenario", "was deleted", short(scenario), remedy=f"bring it back from the trash, where it is {each.id}")
        return Problem("scenario", "does not exist", short(scenario), remedy=nearest(scenario, files))

    def load(self, scenario: str, changes: dict[str, Any] | None = None) -> Loaded:
        """A scenario with changes, which may name files of its folder only; raises UnknownError or ScenarioError."""
        found = job.load(self.file(scenario), changes)
        if changes:
            check_inside(found, found.source)
        return found

    def row(self, scenario: str, runs: Mapping[str, int] | None = None) -> dict[str, Any]:
        """A scenario for the list, with the number of its runs; one that cannot be read says why."""
        row = {"id": scenario, "title": scenario, "description": "", "map": "", "vehicles": 0, "duration_s": 0.0}
        row |= self.scenario_files.told(self.file(scenario)) | {"runs": None if runs is None else runs.get(scenario, 0)}
        try:
            loaded = self.load(scenario)
            found = loaded.scenario
            attribution = place.attribution(loaded.path.parent / found.map.file)
        except StudioError as error:
            return row | {"attribution": "", "problem": str(error)}
        return row | {
            "title": found.title,
            "description": found.description.strip(),
            "map": found.map.file,
            "vehicles": len(found.vehicles) + found.traffic.count,
            "duration_s": found.clock.duration,
            "attribution": attribution,
            "problem": None,
        }

    def runs(self) -> Runs:
        """The run database, for one request."""
        return reopen_runs(self.db)

    def runs_by_scenario(self) -> dict[str, int] | None:
        """How many runs each scenario has; None when the database cannot be read."""
        try:
            with closing(self.runs()) as kept:
                return kept.by_scenario()
        except StoreError:
            return None

    def rename(self, scenario: str, name: str, title: str | None, expected: str | None) -> Path:
        """Gives a scenario another name, and its runs with it. Raises UnknownError, ConflictError, SealedError or ScenarioError."""
        path = self.file(scenario)
        with closing(self.runs()) as kept:
            if name != scenario:
                check_at_rest(kept, scenario)
            renamed = self.scenario_files.rename(path, name, title, expected)
            if renamed.stem != scenario:
                kept.rename_scenario(scenario, renamed.stem)
                self.editing.rename(scenario, renamed.stem)
        return renamed

    def replay(self, runs: Runs, run: int) -> Replay:
        """A run that is over, for the scene. Raises UnknownError, StudioError for what its map or models do not give any more."""
        return replay(runs, run, self.scenarios / f"{runs.find(run).scenario}.yaml")

    def play(self, runs: Runs, stage: int, run: int, others: tuple[int, ...] = (), align: str = "") -> dict[str, Any]:
        """Shows a run that is over, and others as its ghosts, on a stage; raises what `replay` raises, and UnknownError for unfit ones."""
        played = self.replay(runs, run)
        ghosts = haunting(played, [self.replay(runs, other) for other in others], align)
        return self.stages[stage].play(played, ghosts=ghosts)

    def start(self, scenario: str, *, changes: dict[str, Any], seed: int | None, parent: int | None,
              pace: Pace, paused: bool) -> LiveRun:  # fmt: skip
        """Starts a run in a process of its own, or lets it wait for its turn; what is wrong with it is told before."""
        self.editions.notice()
        loaded = job.seeded(self.load(scenario, changes), seed)
        check_pace(pace)
        order = Order(loaded.path, loaded.source.text, loaded.changes, seed, parent, pace_factor(pace), paused, self.db)
        return self.lives.start(order, scenario, loaded)

    def cancel(self, run: int) -> Row:
        """Takes a run out of the queue, or ends it, whoever has begun it; returns its row. Raises UnknownError or ServerError."""
        runs = self.runs()
        if run in self.lives.runs:
            self.lives.stop(run)
        else:
            queue.cancel(runs, run)
        return runs.find(run)


def check_at_rest(runs: Runs, scenario: str) -> None:
    """Raises ConflictError while runs of a scenario go on or wait: they would come to their end under the old name."""
    if busy := [each.run for each in queue.queue(runs) if each.scenario == scenario]:
        problems = [Problem(f"run {run}", "is not over", remedy="wait for it, or cancel it") for run in busy]
        raise ConflictError(f"{scenario} cannot be renamed while runs of it go on.", problems)


def check_pace(pace: Pace) -> None:
    """Raises ServerError for a pace that nobody can watch."""
    if pace != "fast" and not SLOWEST <= pace <= FASTEST:
        raise ServerError(
            "The pace is out of range.",
            [Problem("pace", "is out of range", short(pace), f'{SLOWEST} to {FASTEST} times real time, or "fast"')],
        )
