"""Editions: which version of a user's application is used, while its author writes on.

The file on the disk is the author's. When it has changed, it is tried in a process of its own first, so that whatever it does there
holds up nobody; if it loads, it takes the place of the version before, here and in the processes of the runs to come. If it does not,
the version before stays in use, and it is told why. What came through the network is never run: only files of the folders that were
named when the server was started are.
"""

import ast
import hashlib
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from studio.errors import KindError
from studio.kind import registry
from studio.kind.renewal import renew, standing, without_bytecode
from studio.process import Child, Gone
from studio.server.live import Lives
from studio.server.manuscript import slips
from studio.warmup import is_warm

PATIENCE = 120.0  # [s] for a file to load, on a busy machine


class Refusal(NamedTuple):
    """A version that is not used: its texts by name, and why."""

    texts: dict[str, str]
    what: str


class Editions:
    """Looks whether applications in the users' folders have changed, whenever somebody asks."""

    def __init__(self, folders: tuple[Path, ...], lives: Lives) -> None:
        self.folders, self.lives = folders, lives
        self.refusals: dict[Path, Refusal] = {}
        self.lock = threading.Lock()
        self.place = tempfile.TemporaryDirectory(prefix="studio_editions_")

    def close(self) -> None:
        """Nothing of it is left."""
        self.place.cleanup()

    def notice(self) -> None:
        """Takes in what has changed."""
        with self.lock:
            changed = [path for path in applications(self.folders) if self.look(path)]
            if changed:
                self.lives.use(self.kept())

    def refused(self, path: Path | None) -> str:
        """Why the version on the disk is not the one in use; "" when it is."""
        found = self.refusals.get(path) if path else None
        return found.what if found else ""

    def look(self, path: Path) -> bool:
        """Looks at one file; whether another version is to be used, or one that was used is to be kept."""
        kind = standing(path)
        texts = texts_now(path, kind)
        if kind and texts == kind.texts:
            return self.refusals.pop(path, None) is not None
        if path in self.refusals and self.refusals[path].texts == texts:
            return False
        if what := self.wrong(path, texts):
            self.refusals[path] = Refusal(texts, what)
            return kind is not None
        self.refusals.pop(path, None)
        return True

    def wrong(self, path: Path, texts: dict[str, str]) -> str:
        """Why a version cannot be used; "" when it is used from now on."""
        for name, text in texts.items():
            if found := slips(text):
                return f"{name}, line {found[0].line}: {found[0].what}"
        if what := tried(self.folders, path):
            return what
        try:
            renew(path)
        except KindError as error:
            return told(error)
        return ""

    def kept(self) -> tuple[tuple[Path, Path], ...]:
        """Folders with files that do not load, each with where the versions lie that did."""
        return tuple({path.parent: self.laid_down(path) for path in self.refusals if standing(path)}.items())

    def laid_down(self, path: Path) -> Path:
        """Where the version in use of a file lies, with what it imports beside it."""
        place = Path(self.place.name) / hashlib.sha256(str(path.parent).encode()).hexdigest()[:8]
        kind = standing(path)
        for name, text in (kind.texts if kind else {}).items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_text(text, encoding="utf-8")
        return place


def applications(folders: tuple[Path, ...]) -> Iterator[Path]:
    """The files of the folders that are applications, or were when they were loaded."""
    for folder in folders:
        for path in sorted(folder.glob("[a-z]*.py")):
            kind = standing(path.resolve())
            if kind.sort == registry.USUAL_SORT if kind else is_application(path):
                yield path.resolve()


def is_application(path: Path) -> bool:
    """Whether a new file means to be an application."""
    text = read(path)
    if path.name.startswith("test_") or slips(text):
        return False
    body = ast.parse(text).body
    said = [ast.unparse(each.value) for each in body if isinstance(each, ast.Assign) and ast.unparse(each.targets[0]) == "KIND"]
    if said:
        return said[-1] == repr(registry.USUAL_SORT)
    return any(isinstance(each, ast.FunctionDef) and each.name == "decide" for each in body)


def texts_now(path: Path, kind: registry.Kind | None) -> dict[str, str]:
    """A file and what it imports beside it, as they stand on the disk."""
    return {name: read(path.parent / name) for name in (kind.texts if kind else (path.name,))}


def read(path: Path) -> str:
    """The text of a file; "" when there is none."""
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def tried(folders: tuple[Path, ...], path: Path) -> str:
    """What is wrong with a file, found out in a process of its own; "" when it loads."""
    child = Child.begin(rehearse, folders, path, prepared=is_warm())
    try:
        if not child.hears_within(PATIENCE):
            return f"it has not loaded within {PATIENCE:g} s"
        return child.hear()[1]
    except Gone as gone:
        return f"the process that loaded it ended with code {gone.code}"
    finally:
        child.end(0.0)


def rehearse(pipe, folders: tuple[Path, ...], path: Path) -> None:
    """In that process: loads the folders, and tells what is wrong with one file."""
    with without_bytecode():
        for folder in folders:
            registry.load_folder(folder)
    failed = next((each for each in registry.broken() if each.file == str(path)), None)
    pipe.send(("tried", told(failed.error) if failed else ""))


def told(error: KindError) -> str:
    """What is wrong, with the line in the user's file where a traceback has one."""
    lines = error.message.strip().splitlines()
    if len(lines) == 1:
        return "; ".join([error.message, *map(str, error.problems)])
    places = [line.strip() for line in lines if line.strip().startswith("File ") and "/studio/" not in line and "importlib" not in line]
    return f"{lines[-1]} ({places[-1]})" if places else lines[-1]
