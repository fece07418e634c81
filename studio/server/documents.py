"""The scenario files of the folder as documents: their text, and patches that are checked before they are written."""

import threading
from collections import OrderedDict
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath, PureWindowsPath

import studio
from studio import job
from studio.errors import Problem, ScenarioError, SealedError, StaleError, short
from studio.job import Loaded
from studio.scenario import edit, file
from studio.scenario.schema import VERSION
from studio.scenario.text.document import applied, digest
from studio.scenario.text.migration import version_of
from studio.scenario.text.patch import Operation
from studio.scenario.text.source import Source
from studio.world.setting import named_files

KEPT = 64  # texts that were given out lately, so that it can be told what has changed since
TOLD = 20  # differences that are told


@dataclass
class Documents:
    """Reads and changes scenario files, one change at a time."""

    folder: Path
    given: OrderedDict[str, Source] = field(default_factory=OrderedDict)
    lock: threading.Lock = field(default_factory=threading.Lock)

    def read(self, path: Path) -> Source:
        """A scenario file as it stands; raises ScenarioError."""
        found = file.opened(path)
        self.given[digest(found.text)] = found
        while len(self.given) > KEPT:
            self.given.popitem(last=False)
        return found

    def patch(self, path: Path, patch: list[Operation], expected: str | None) -> tuple[Source, list[Operation]]:
        """Changes a file if it is the expected one, given its digest, and what comes of it is valid; returns it with the inverse.

        Raises SealedError, StaleError, ConflictError for a test that fails, or ScenarioError, also for a file of an older version;
        then nothing was written.
        """
        with self.lock:
            self.check_open(path)
            before = self.read(path)
            check_version(before)
            if expected is not None and expected != digest(before.text):
                raise self.stale(path, before, expected)
            after, inverse = applied(before, patch)
            found = job.loaded(file.checked(after, "scenario"), path)
            check_inside(found, before)
            job.check(found)
            if after.text != before.text:
                file.write(path, after.text)
            return self.read(path), inverse

    def check_open(self, path: Path) -> None:
        """Only files that lie in the folder itself are written, no samples of the program, and none that is write-protected."""
        place, own = path.resolve(), Path(studio.__file__).resolve().parent
        if place.parent != self.folder.resolve() or own in place.parents or not place.stat().st_mode & 0o200:
            problem = Problem(str(path), "may be read only", remedy="copy it under another name, and change that")
            raise SealedError(f"{path.name} cannot be changed.", [problem])

    def stale(self, path: Path, now: Source, expected: str) -> StaleError:
        """A refusal that says what has changed since the expected text was given out, if that is still known."""
        before = self.given.get(expected)
        found = differences(before, now) if before else []
        problems = found or [Problem(path.name, "is not as it was when you read it", remedy="read it again, then change it")]
        return StaleError(f"{path.name} has changed meanwhile.", problems)


def check_inside(found: Loaded, before: Source) -> None:
    """What comes over REST names files of the scenario's own folder only: others are not even looked for. Raises ScenarioError.

    What stands in the file already was written by its owner, and stays.
    """
    outside = {path: name for path, name in named_files(found.scenario).items() if leads_out(name)}
    if outside:
        own = set(named_files(job.loaded(before, found.path).scenario).values())
        name = found.path.name
        problems = [Problem(f"{name}: {path}", OUTSIDE, short(each), INSIDE) for path, each in outside.items() if each not in own]
        if problems:
            raise ScenarioError(f"{name} would name files of other folders.", problems)


OUTSIDE, INSIDE = "leads out of the folder of this scenario", "a path within it, without .. and from no root"


def leads_out(name: str) -> bool:
    """Whether a path leads out of the folder that it starts from, of whatever system it is."""
    return any(each.is_absolute() or each.anchor or ".." in each.parts for each in (PurePosixPath(name), PureWindowsPath(name)))


def check_version(found: Source) -> None:
    """Only files of the present version are changed: the undo of an edit gives back the same bytes. Raises ScenarioError."""
    version = version_of(found)
    if version < VERSION:
        problem = Problem(found.where, "is of an older version of the format", str(version), str(VERSION), "studio migrate rewrites it")
        raise ScenarioError(f"{found.where} cannot be changed.", [problem])


def differences(before: Source, now: Source) -> list[Problem]:
    """Places that hold other values than before."""
    old, new = edit.flatten(before.value), edit.flatten(now.value)
    changed = [path for path in old | new if path not in old or path not in new or old[path] != new[path]]
    return [Problem(path, "has changed", told(new, path), f"{told(old, path)} before") for path in changed[:TOLD]]


def told(values: dict, path: str) -> str:
    """A value for a message."""
    return short(values[path]) if path in values else "nothing"
