"""The scenario files of the folder as documents: their text, and patches that are checked before they are written."""

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath, PureWindowsPath

import studio
from studio import job
from studio.errors import Problem, ScenarioError, SealedError, SizeError, StaleError, nearest, short
from studio.job import Loaded
from studio.scenario import edit, file
from studio.scenario.schema import VERSION
from studio.scenario.text import source
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

    def text(self, path: Path) -> str:
        """The text of a scenario file, be it a scenario or not; raises ScenarioError when it is no text."""
        data = file.content(path, "scenario", file.SIZE_LIMIT)
        try:
            return self.read(path).text
        except ScenarioError:
            return source.decoded(data, path.name)

    def put(self, path: Path, text: str, expected: str | None) -> Source:
        """Writes a text in the place of a file if that is the expected one, given its digest, and the text is a scenario.

        Raises SealedError, StaleError, or ScenarioError with the lines; then nothing was written.
        """
        with self.lock:
            self.check_open(path)
            self.check_expected(path, expected)
            check_text(text, path, own=names_in(path))
            file.write(path, text)
            return self.read(path)

    def patch(self, path: Path, patch: list[Operation], expected: str | None) -> tuple[Source, list[Operation]]:
        """Changes a file if it is the expected one, given its digest, and what comes of it is valid; returns it with the inverse.

        Raises SealedError, StaleError, ConflictError for a test that fails, or ScenarioError, also for a file of an older version;
        then nothing was written.
        """
        with self.lock:
            self.check_open(path)
            before = self.read(path)
            check_version(before)
            self.check_expected(path, expected)
            after, inverse = changed(before, patch, path)
            if after.text != before.text:
                file.write(path, after.text)
            return self.read(path), inverse

    def check_open(self, path: Path) -> None:
        """Only files that lie in the folder itself are written, no samples of the program, and none that is write-protected."""
        place, own = path.resolve(), Path(studio.__file__).resolve().parent
        is_open = place.is_file() and place.stat().st_mode & 0o200
        if place.parent != self.folder.resolve() or own in place.parents or not is_open:
            problem = Problem(str(path), "may be read only", remedy="copy it under another name, and change that")
            raise SealedError(f"{path.name} cannot be changed.", [problem])

    def check_expected(self, path: Path, expected: str | None) -> None:
        """Raises StaleError when a file is not the expected one, given its digest; None is any."""
        data = file.content(path, "scenario", file.SIZE_LIMIT)
        if expected is not None and expected != digest_of(data):
            raise self.stale(path, expected)

    def stale(self, path: Path, expected: str) -> StaleError:
        """A refusal that says what has changed since the expected text was given out, if that is still known."""
        before, found = self.given.get(expected), []
        with suppress(ScenarioError):  # what stands there now may be no YAML
            found = differences(before, self.read(path)) if before else []
        problems = found or [Problem(path.name, "is not as it was when you read it", remedy="read it again, then change it")]
        return StaleError(f"{path.name} has changed meanwhile.", problems)


def changed(before: Source, patch: list[Operation], path: Path) -> tuple[Source, list[Operation]]:
    """A source with a patch that leaves it a valid scenario, and the inverse. Raises ConflictError or ScenarioError."""
    after, inverse = applied(before, patch)
    found = job.loaded(file.checked(after, "scenario"), path)
    check_inside(found, before)
    job.check(found)
    return after, inverse


def check_text(text: str, path: Path, *, own: Collection[str] = ()) -> Loaded:
    """What a text would be as that file, which need not be there; `own` are files that may be named, wherever they are.

    Raises ScenarioError with all that is wrong, line by line.
    """
    found = job.loaded(file.mapping(encoded(text, path.name), path.name, "scenario"), path)
    named = {place: name for place, name in named_files(found.scenario).items() if name not in own}
    with file.placed(found.source, path.name):
        if wrong := [missing(f"{path.name}: {place}", name, path.parent) for place, name in named.items() if is_missing(name, path.parent)]:
            raise ScenarioError(f"{path.name} names files that cannot be had.", wrong)
    job.check(found)
    return found


def names_in(path: Path) -> set[str]:
    """The files that a scenario file names already; none of one that is no scenario."""
    try:
        return set(named_files(job.load(path).scenario).values())
    except ScenarioError:
        return set()


def encoded(text: str, where: str) -> bytes:
    """The bytes of a text; raises ScenarioError when they are too many, or it is none."""
    try:
        data = text.encode()
    except UnicodeEncodeError as error:
        raise ScenarioError(f"{where} is not a text.", [Problem(where, error.reason, allowed="UTF-8")]) from None
    if len(data) > file.SIZE_LIMIT:
        raise too_large()
    return data


def too_large() -> SizeError:
    """The refusal of a scenario that is too large."""
    return SizeError("The file is too large.", [Problem("body", "is too large for a scenario", allowed=f"at most {file.SIZE_LIMIT} bytes")])


def is_missing(name: str, folder: Path) -> bool:
    """Whether a named file is outside of the folder, or not there."""
    return leads_out(name) or not (folder / name).exists()


def missing(where: str, name: str, folder: Path) -> Problem:
    """A named file that cannot be had. Of one outside of the folder it is not told whether it is there."""
    if leads_out(name):
        return Problem(where, OUTSIDE, short(name), INSIDE)
    beside = (folder / name).parent
    known = [each.name for each in beside.iterdir() if not each.name.startswith(".")] if beside.is_dir() else []
    return Problem(where, "does not exist", short(name), remedy=nearest(PurePosixPath(name).name, known))


def digest_of(data: bytes) -> str:
    """The digest of a file, as that of its text."""
    return hashlib.sha256(data).hexdigest()


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
