"""How long the logs of a project are, so that a cut beyond one is refused when it is saved.

A log is read in a process of its own, whatever it does to that; what was found is kept for as long as log and mapping are the same files.
Of a log that is missing, that cannot be read, or that takes too long, nothing is known here: whoever validates is told what is wrong.
"""

from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path

from studio.errors import StudioError
from studio.process import Child, Gone
from studio.server.errand import ServerGone, confine, tell

PATIENCE = 60.0  # [s] for a log to be read
MOST = 1000  # logs whose length is kept
Named = tuple[str, str | None]  # a log, and its mapping
Files = tuple[tuple[Path, int, int], ...]  # each with its time [ns] and its size [B]


@dataclass
class Lengths:
    """Of logs that were asked for before."""

    kept: dict[Files, float] = field(default_factory=dict)

    def of(self, folder: Path, logs: set[Named]) -> dict[Named, float]:
        """The lengths [s] of logs in a folder, as far as they are known."""
        states = {each: state(folder, each) for each in logs}
        unknown = [each for each, files in states.items() if files and files not in self.kept]
        if unknown:
            found = measured(folder, unknown)
            self.kept = dict([*self.kept.items(), *((states[each], length) for each, length in found.items())][-MOST:])
        return {each: self.kept[files] for each, files in states.items() if files in self.kept}


def state(folder: Path, named: Named) -> Files:
    """What a length depends on; nothing where a file is missing."""
    with suppress(OSError):
        paths = [folder / each for each in named if each]
        return tuple((each, each.stat().st_mtime_ns, each.stat().st_size) for each in paths)
    return ()


def measured(folder: Path, logs: list[Named]) -> dict[Named, float]:
    """The lengths [s] of logs, as far as a process finds them in time."""
    found: dict[Named, float] = {}
    try:
        child = Child.begin(measure, folder, logs, prepared=True)
    except OSError:
        return found
    with suppress(Gone):
        while child.hears_within(PATIENCE) and (news := child.hear()):
            found[news[0]] = news[1]
    child.end(0.0)
    return found


def measure(pipe: Connection, folder: Path, logs: list[Named]) -> None:
    """The process: reads the logs, tells how long each is."""
    from studio.log import mapping, recording

    confine()
    with suppress(ServerGone):
        for log, by in logs:
            with suppress(StudioError, MemoryError):
                made = recording.load(folder / log, mapping.read(folder / by) if by else None)
                tell(pipe, (log, by), float(made.time[-1]))
