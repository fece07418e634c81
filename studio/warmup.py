"""The warm-up: everything is compiled before it is needed, by as many processes as there are cores.

No list says what there is to compile. The parts of a warm-up are what people do, done once and briefly: a vehicle on the rig,
a tyre on the bench, every sample. What those compile, and what their functions call, is compiled with the types that it is used
with. Processes that come to the same function share the work, as `compiled` says.

    missing()   →  what has no machine code yet, of all that this file imports
    Warmup      →  starts the processes, tells how far they are, ends them
"""

import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np

from studio import compiled, job, sample
from studio.compiled import CPU, folder_of
from studio.errors import RunError
from studio.kind import registry
from studio.model.tyre import Tyre
from studio.process import Child
from studio.rig import drive, tyre
from studio.scenario import catalogue, tir
from studio.source import PACKAGE, closure, compiled_functions, digest_of
from studio.workshop.stage import everything

MODEL, TYRE = "bmw_320i", "smart_175_55r15"
MOMENT = 0.2  # [s] that a part lasts
LOOK = 1.0  # [s] between two looks at how far it is
ON_THE_RIG, ON_THE_STAGE = "rig", "stage"


# -- what there is to do -----------------------------------------------------------------------------


def parts() -> list[str]:
    """What is done, the longest first: the rig compiles a whole vehicle, the first sample everything around it."""
    return [ON_THE_RIG, *map(str, sample.files()), ON_THE_STAGE]


def do(part: str) -> None:
    """One part, from its file to its metrics."""
    if part == ON_THE_RIG:
        drive.drive(MODEL, {"time_s": [0.0, MOMENT], "throttle": [1.0, 1.0]})
        tyre.sweep(Tyre(*tir.coefficients(catalogue.find_tyre(TYRE))), *np.ones((4, 2)))
    elif part == ON_THE_STAGE:
        everything().advance(10)
    else:
        job.run(job.load(part, {"clock.duration": MOMENT}))
    (sign,) = signs(part)
    sign.touch()


def signs(*of: str) -> list[Path]:
    """The signs that parts have been done with the files as they are."""
    digest = digest_of(*sorted(files()))
    return [compiled.CACHE / f"warm-{digest}-{CPU}.{Path(part).stem}" for part in of]


def is_warm() -> bool:
    """Whether all parts have been done. What has no machine code then is for kinds of the user's own, and compiled when one calls it."""
    return all(sign.exists() for sign in signs(*parts()))


def files() -> set[Path]:
    """The files of this package with compiled functions that this one, or a kind, depends on.

    Kinds of the user's own are compiled when they first run.
    """
    roots = [Path(__file__), *(each.file for each in registry.every() if each.file)]
    found = set().union(*map(closure, roots))
    return {path for path in found if path.is_relative_to(PACKAGE) and compiled_functions(path)}


def missing() -> list[str]:
    """The functions that have no machine code yet, as room.file.function."""
    return [] if is_warm() else [name for path in sorted(files()) for name in without_code(path)]


def without_code(path: Path) -> list[str]:
    """Those of one file."""
    kept = {name_of(index) for index in indices(path)}
    return [f"{path.parent.name}.{path.stem}.{name}" for name in compiled_functions(path) if name not in kept]


def latest() -> Path | None:
    """What numba keeps of the function that was compiled last; None when there is none."""
    return max((index for path in files() for index in indices(path)), key=lambda index: index.stat().st_mtime, default=None)


def said(index: Path | None) -> str:
    """The function that an index is about, as file.function; "" for none."""
    return index.name.partition("-")[0] if index else ""


def indices(path: Path) -> Iterator[Path]:
    """What numba keeps of the functions of a file: an index for each, file.function-line.python.nbi."""
    return folder_of(path).glob("*.nbi")


def name_of(index: Path) -> str:
    """The function that an index is about."""
    return index.name.partition("-")[0].rpartition(".")[2]


# -- doing it ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Progress:
    """How far it is: functions done, of how many, seconds since it began, the function that was compiled last, and seconds since that."""

    done: int
    of: int
    seconds: float
    latest: str
    since: float


@dataclass
class Warmup:
    """Processes that compile everything; none before it is started, or when nothing is missing."""

    lacked: int = 0
    began: float = field(default_factory=time.monotonic)
    processes: list[Child] = field(default_factory=list)

    def start(self) -> "Warmup":
        """Starts them; each takes every n-th part."""
        self.began, self.lacked = time.monotonic(), len(missing())
        count = min(os.cpu_count() or 1, len(parts())) if self.lacked else 0
        self.processes = [Child.begin(work, parts()[i::count]) for i in range(count)]
        return self

    @property
    def compiled(self) -> int:
        """How many functions were compiled since it began, by whomever."""
        return self.lacked - len(missing())

    @property
    def is_over(self) -> bool:
        """Whether they have ended."""
        return not any(process.is_alive() for process in self.processes)

    def progress(self) -> Progress:
        """How far all processes of this machine together are."""
        of = sum(len(compiled_functions(path)) for path in files())
        seconds, last = time.monotonic() - self.began, latest()
        age = max(time.time() - last.stat().st_mtime, 0.0) if last else seconds
        return Progress(of - len(missing()), of, seconds, said(last), min(seconds, age))

    def wait(self, tell: Callable[[Progress], None] = lambda progress: None) -> None:
        """Until it is over; raises RunError when a process has failed."""
        while not self.is_over:
            tell(self.progress())
            time.sleep(LOOK)
        tell(self.progress())
        failed = [f"warm-up {i}" for i, process in enumerate(self.processes, start=1) if process.exit_code()]
        if failed:
            raise RunError(
                f"The {' and the '.join(failed)} failed; what went wrong stands above. Runs compile what they need by themselves."
            )

    def close(self) -> None:
        """Ends them; what they have compiled is kept."""
        for process in self.processes:
            process.end(0.0)


def work(line: Connection, own: list[str]) -> None:
    """A process: its parts."""
    for part in own:
        do(part)
