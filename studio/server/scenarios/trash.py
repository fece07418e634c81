"""The trash: where deleted scenario files lie, each under its name and the time when it was deleted, until somebody wants them back.

It is a plain folder, `trash`, beside the files: what lies there outlives a restart, and can be moved back by hand too.
"""

import re
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from studio.errors import Problem, SealedError, UnknownError, nearest, short
from studio.scenario import file

CALLED = "trash"
ENTRY = re.compile(r"(.+)\.(\d{8}T\d{12})Z\.yaml")
STAMP = "%Y%m%dT%H%M%S%f"


@dataclass(frozen=True)
class Deleted:
    """A file that was deleted: what it was called, and when."""

    path: Path
    scenario: str
    when: datetime

    @property
    def id(self) -> str:
        """Its name in the trash."""
        return self.path.stem


@dataclass(frozen=True)
class Trash:
    """The trash of a folder of scenarios."""

    scenarios: Path

    @property
    def folder(self) -> Path:
        """Where deleted files lie."""
        return self.scenarios / CALLED

    def entries(self) -> list[Deleted]:
        """What was deleted, the latest first; nothing of a trash that is none."""
        if self.folder.is_symlink() or not self.folder.is_dir():
            return []
        found = [entry(path) for path in self.folder.iterdir() if path.is_file() and not path.is_symlink()]
        return sorted((each for each in found if each), key=lambda each: each.when, reverse=True)

    def find(self, name: str) -> Deleted:
        """A deleted file; raises UnknownError."""
        known = {each.id: each for each in self.entries()}
        if name not in known:
            problem = Problem("trash", "holds no such file", short(name), remedy=nearest(name, known))
            raise UnknownError(f"There is no deleted scenario {short(name)}.", [problem])
        return known[name]

    def put(self, path: Path) -> Deleted:
        """Moves a file here. Raises SealedError when this is no folder of its own, ScenarioError when it cannot be written."""
        if self.folder.is_symlink():
            problem = Problem(CALLED, "is a link", str(self.folder), "a folder", "remove the link")
            raise SealedError("Nothing can be deleted here.", [problem])
        try:
            self.folder.mkdir(exist_ok=True)
        except OSError as error:
            raise file.unwritten(self.folder, error) from None
        when = datetime.now(UTC)
        target = self.folder / f"{path.stem}.{when:{STAMP}}Z{path.suffix}"
        file.move_new(path, target)
        return Deleted(target, path.stem, when)


def entry(path: Path) -> Deleted | None:
    """A file of the trash; None for one that somebody else has put there."""
    found = ENTRY.fullmatch(path.name)
    try:
        return Deleted(path, found[1], datetime.strptime(found[2], STAMP).replace(tzinfo=UTC)) if found else None
    except ValueError:
        return None
