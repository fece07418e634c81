"""The life of scenario files: made from a template, copied, taken in, renamed, deleted, brought back.

Nothing is overwritten and nothing is lost: a name that is taken is refused, what is deleted lies in the trash, and whoever has seen an
older file than the one that is there now, which a digest tells, changes nothing.
"""

from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from studio.errors import Problem, ScenarioError, SealedError, short
from studio.scenario import file, setup
from studio.scenario.text.migration import migrated
from studio.scenario.text.patch import Operation, operation
from studio.scenario.text.source import Source
from studio.server.documents import Documents, changed, check_text, check_version, digest_of
from studio.server.scenarios import name as names
from studio.server.scenarios.name import ENDING
from studio.server.scenarios.trash import Deleted, Trash


@dataclass(frozen=True)
class Scenarios:
    """The scenario files of the folder of documents; one change at a time."""

    documents: Documents

    @property
    def folder(self) -> Path:
        """Where the files are."""
        return self.documents.folder

    @property
    def trash(self) -> Trash:
        """Where deleted files are."""
        return Trash(self.folder)

    def taken(self) -> list[str]:
        """Names that are taken."""
        return [path.stem for path in self.folder.glob(f"*{ENDING}")]

    def free(self, name: str) -> Path:
        """The file that a name is of, which is not there yet. Raises ScenarioError or ConflictError."""
        good = names.checked(name)
        names.check_free(good, self.taken())
        return self.folder / f"{good}{ENDING}"

    def told(self, path: Path) -> dict[str, Any]:
        """What is told of a file that need not be a scenario: its name, when it was changed, its digest, whether it may be read only."""
        told = {"file": path.name, "changed": "", "digest": "", "sealed": True}
        with suppress(OSError, ScenarioError):
            told["changed"] = datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat(timespec="seconds")
            told["digest"] = digest_of(file.content(path, "scenario", file.SIZE_LIMIT))
            self.check_movable(path, None)
            told["sealed"] = False
        return told

    # -- a new one ---------------------------------------------------------------------------------

    def add(self, name: str, text: str) -> Path:
        """A new file, if the text is a scenario. Raises ConflictError, SizeError, or ScenarioError with the lines."""
        with self.documents.lock:
            path = self.free(name)
            check_text(text, path)
            file.write_new(path, text)
            return path

    def copy(self, path: Path, name: str, title: str | None, changes: dict[str, Any]) -> Path:
        """A new file like another one, with changes by path; one of an older version of the format becomes one of the present.

        One that is no scenario is copied as it is. Raises ConflictError or ScenarioError.
        """
        with self.documents.lock:
            target, text = self.free(name), self.documents.text(path)
            if title is not None or changes:
                now = migrated(self.documents.read(path))[0]
                text = changed(now, form_patch(now, changes, title), path)[0].text
            file.write_new(target, text)
            return target

    # -- the same one ------------------------------------------------------------------------------

    def save(self, path: Path, changes: dict[str, Any], expected: str | None) -> tuple[Source, list[Operation]]:
        """Writes changes by path into a file; returns it with the patch that takes them back. Raises as `Documents.patch` does."""
        before = self.documents.read(path)
        check_version(before)
        return self.documents.patch(path, form_patch(before, changes, None), expected)

    def rename(self, path: Path, name: str, title: str | None, expected: str | None) -> Path:
        """Gives a file another name, another title, or both; nothing changes unless all of it can be.

        Raises SealedError, StaleError, ConflictError or ScenarioError.
        """
        with self.documents.lock:
            self.check_movable(path, expected)
            good = names.checked(name)
            names.check_free(good, (each for each in self.taken() if each != path.stem))
            target = path.with_name(f"{good}{ENDING}")
            if title is not None:
                self.retitle(path, target, title)
            elif target != path:
                file.move_new(path, target)
            return target

    def retitle(self, path: Path, target: Path, title: str) -> None:
        """Another title in a file, which may get another name with it."""
        now = self.documents.read(path)
        check_version(now)
        text = changed(now, [titled(now, title)], path)[0].text
        if target == path:
            file.write(path, text)
            return
        file.write_new(target, text)
        path.unlink()

    def delete(self, path: Path, expected: str | None) -> Deleted:
        """Moves a file to the trash. Raises SealedError, StaleError or ScenarioError."""
        with self.documents.lock:
            self.check_movable(path, expected)
            return self.trash.put(path)

    def restore(self, entry: str, name: str | None) -> Path:
        """Brings a deleted file back, under another name if one is given. Raises UnknownError, ConflictError or ScenarioError."""
        with self.documents.lock:
            found = self.trash.find(entry)
            path = self.free(name or found.scenario)
            file.move_new(found.path, path)
            return path

    def check_movable(self, path: Path, expected: str | None) -> None:
        """Raises SealedError for a link and for what may be read only, StaleError when it is not the expected one."""
        if path.is_symlink():
            problem = Problem(path.name, "is a link to another file", short(str(path.readlink())), remedy="change the link by hand")
            raise SealedError(f"{path.name} is no file of this folder.", [problem])
        self.documents.check_open(path)
        if expected is not None:
            self.documents.check_expected(path, expected)


def form_patch(now: Source, changes: dict[str, Any], title: str | None) -> list[Operation]:
    """The patch of a file that a form's changes by path, and perhaps a title, come to. Raises ScenarioError."""
    patch = setup.patch_of(now.value, changes, now.where) if changes else []
    return patch if title is None else [*patch, titled(now, title)]


def titled(now: Source, title: str) -> Operation:
    """The operation that sets the title."""
    return operation("replace" if "title" in now.value else "add", ["title"], value=title)
