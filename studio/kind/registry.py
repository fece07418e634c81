"""The registry: every kind that can be named in a scenario, by sort and name.

Built-ins and users' kinds come in by the same door: a module, or a package of modules, that an installed package offers under an
entry point of the group `cooperative_adas_studio.kinds`; or a file in a folder that is given to `load_folder`. A name can be given once
per sort. A file that does not load, or does not keep the contract of its sort, is kept with what is wrong about it; whoever
asks for its name is told, and nobody else is hurt.
"""

import hashlib
import json
import pkgutil
import threading
import traceback
import zlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from importlib.metadata import entry_points
from inspect import cleandoc
from pathlib import Path
from types import ModuleType
from typing import Any

from pydantic import BaseModel

from studio.errors import KindError, Problem, UnknownError, nearest
from studio.kind import folder
from studio.kind.sort import SORTS, Sort, problems, where_of
from studio.source import beside

GROUP = "cooperative_adas_studio.kinds"
USUAL_SORT = "application"  # of a file that does not say
BUILT_IN = "studio.kinds"


@dataclass(frozen=True, eq=False)
class Kind:
    """A registered kind: its sort, its name, the module that keeps the contract, and where it comes from.

    `texts` are its own file and the files beside it that it imports, by name, as they were when it was loaded.
    """

    sort: str
    name: str
    module: ModuleType
    source: str
    texts: dict[str, str]

    @property
    def title(self) -> str:
        """One line for people."""
        return self.module.TITLE

    @property
    def explanation(self) -> str:
        """What it does and where its figures come from, as its file says."""
        return cleandoc(self.module.__doc__ or "")

    @property
    def settings(self) -> type[BaseModel] | None:
        """What is set of it in a scenario; None when there is nothing to set."""
        return getattr(self.module, "Parameters" if self.sort == "application" else "Settings", SORTS[self.sort].usual)

    @property
    def is_built_in(self) -> bool:
        """Whether it comes with the studio."""
        return self.module.__name__.startswith(f"{BUILT_IN}.")

    @property
    def file(self) -> Path | None:
        """The file it stands in."""
        name = getattr(self.module, "__file__", None)
        return Path(name) if name else None

    @cached_property
    def stream(self) -> int:
        """Its random stream, by its name."""
        return stream(f"{self.sort}.{self.name}")

    @cached_property
    def digest(self) -> str:
        """Digest of its texts: what it is, whatever it is called and wherever it lies."""
        return hashlib.sha256(json.dumps(list(self.texts.items())).encode()).hexdigest()[:16]

    def as_json(self) -> dict[str, str]:
        """What a list of kinds says about it."""
        return {"kind": self.sort, "name": self.name, "title": self.title, "source": self.source}


@dataclass(frozen=True)
class Broken:
    """A file that gave no kind: its name, the file, and why."""

    name: str
    file: str
    error: KindError

    @property
    def what(self) -> str:
        """What is wrong in one line: the end of a traceback, or the first thing that does not fit."""
        text = self.error.message.strip().splitlines()
        return str(self.error.problems[0]) if self.error.problems and len(text) == 1 else text[-1]


_registered: dict[tuple[str, str], Kind] = {}
_broken: dict[str, Broken] = {}
_reserved: dict[tuple[str, str], str] = {}
_loading = threading.RLock()  # the page asks for several things at once
_loaded = False  # or being loaded: their files ask for what is there already
_listeners: list[Callable[[], None]] = []


def stream(name: str) -> int:
    """A random stream for a name; those of the studio's own draws are small numbers."""
    return 1000 + 16 * (zlib.crc32(name.encode()) % 100_000_000)


def listen(listener: Callable[[], None]) -> None:
    """Has a function called whenever a kind was added or taken away."""
    _listeners.append(listener)


def reserve(sort: str, names: Iterable[str], source: str) -> None:
    """Keeps names of a sort for what the studio has of it besides kinds."""
    _reserved.update({(sort, name): source for name in names})


def register(name: str, module: ModuleType, source: str = "") -> Kind:
    """Adds a kind; raises KindError when its name is taken or the contract of its sort is not kept."""
    sort = sort_of(module)
    if taken := taken_by(sort.name, name):
        problem = Problem(f"{sort.name} {name!r}", "is registered twice", where_of(module), remedy=f"rename one; the other is {taken}")
        raise KindError(f"The name of the {sort.name} {name!r} is taken.", [problem])
    wrong = list(problems(module, sort))
    if wrong:
        raise KindError(f"The {sort.name} {name!r} does not keep the contract.", wrong)
    file = getattr(module, "__file__", None)
    _registered[sort.name, name] = Kind(sort.name, name, module, source or str(file or module.__name__), texts(file))
    tell_listeners()
    return _registered[sort.name, name]


def texts(file: str | None) -> dict[str, str]:
    """A kind's own file first, then the files beside it that it imports, by their names from its folder."""
    files = beside(Path(file)) if file else []
    return {path.relative_to(files[0].parent).as_posix(): path.read_text(encoding="utf-8", errors="replace") for path in files}


def tell_listeners() -> None:
    """Something has been added, or taken away."""
    for listener in _listeners:
        listener()


def restore(kinds: Iterable[Kind]) -> None:
    """Goes back to these kinds, with nothing broken: as it was before a folder came in."""
    _registered.clear()
    _registered.update({(kind.sort, kind.name): kind for kind in kinds})
    _broken.clear()
    tell_listeners()


def taken_by(sort: str, name: str) -> str:
    """Who has a name already; "" when it is free."""
    present = _registered.get((sort, name))
    return present.source if present else _reserved.get((sort, name), "")


def sort_of(module: ModuleType) -> Sort:
    """Of what sort a module is; raises KindError."""
    name = getattr(module, "KIND", USUAL_SORT)
    if name not in SORTS:
        problem = Problem(f"{where_of(module)}: KIND", "is no sort of kinds", repr(name), ", ".join(SORTS), nearest(str(name), SORTS))
        raise KindError(f"{where_of(module)} is of no sort that exists.", [problem])
    return SORTS[name]


# -- loading -------------------------------------------------------------------------------------------


def load_all() -> None:
    """Registers everything that installed packages offer, this one first of all."""
    global _loaded
    with _loading:
        if not _loaded:
            _loaded = True
            for offer in sorted(entry_points(group=GROUP), key=lambda each: (each.value != BUILT_IN, each.name)):
                attempt(offer.name, offer.value, lambda offer=offer: offered(offer.value, offer.name))


def offered(value: str, name: str) -> None:
    """What an entry point names: a module, or a package with a module for every kind."""
    found = import_module(value)
    if not hasattr(found, "__path__"):
        register(name, found, f"entry point {name} ({value})")
        return
    for each in pkgutil.walk_packages(found.__path__, f"{value}."):
        if not each.ispkg:
            attempt(each.name.rpartition(".")[2], each.name, lambda each=each: admit(each.name, value))


def admit(module: str, package: str) -> None:
    """A module of a package."""
    found = import_module(module)
    if hasattr(found, "KIND"):
        register(module.rpartition(".")[2], found, "built in" if package == BUILT_IN else f"package {package}")


def attempt(name: str, file: str, action: Callable[[], Any]) -> Any:
    """Does it; what does not work is kept with its traceback."""
    try:
        return action()
    except KindError as error:
        _broken[file] = Broken(name, file, error)
    except (Exception, SystemExit):
        problem = Problem(file, "does not load", remedy="mend it, then start again")
        _broken[file] = Broken(name, file, KindError(f"{file} does not load:\n{traceback.format_exc()}", [problem]))
    return None


def load_file(path: Path) -> Kind:
    """Registers the kind in a Python file under the file's name; the same file twice is the same kind. Raises KindError."""
    load_all()
    with _loading:
        path = path.resolve()
        present = next((each for each in _registered.values() if each.file == path), None)
        if present:
            return present
        try:
            module = folder.load(path)
        except (Exception, SystemExit) as error:
            raise KindError(f"The kind {path} does not load:\n{traceback.format_exc()}") from error
        return register(path.stem, module, str(path))


def load_folder(place: Path) -> list[Kind]:
    """Registers every kind of a folder; raises KindError when it is none. Broken files are kept as `broken` tells.

    A file without KIND is a helper that others import; of one without KIND that has `decide` it is assumed that it is an application.
    """
    if not place.is_dir():
        raise KindError(
            f"There is no folder {place} of kinds.", [Problem("--kinds", "is not a folder", str(place), "a folder of Python files")]
        )
    files = [path.resolve() for path in sorted(place.glob("[a-z]*.py")) if is_kind(path)]
    return [kind for path in files if (kind := attempt(path.stem, str(path), lambda path=path: load_file(path)))]


def is_kind(path: Path) -> bool:
    """Whether a file means to be a kind, and is no test or helper."""
    text = path.read_text(encoding="utf-8", errors="replace")
    return not path.name.startswith("test_") and ("\nKIND" in text or "\ndef decide(" in text or text.startswith("KIND"))


# -- asking --------------------------------------------------------------------------------------------


def known(sort: str) -> dict[str, Kind]:
    """All kinds of a sort by name."""
    load_all()
    return {kind.name: kind for kind in every() if kind.sort == sort}


def every() -> Iterator[Kind]:
    """All kinds, sort by sort in the order of `SORTS`, by name."""
    load_all()
    order = list(SORTS)
    yield from sorted(_registered.values(), key=lambda kind: (order.index(kind.sort), kind.name))


def broken() -> list[Broken]:
    """The files that gave no kind."""
    load_all()
    return list(_broken.values())


def find(sort: str, name: str) -> Kind:
    """One kind; raises UnknownError that names the nearest, or tells why its file did not load."""
    found = known(sort)
    if name not in found:
        failed = next((each for each in _broken.values() if each.name == name), None)
        if failed:
            raise UnknownError(f"The {sort} {name!r} in {failed.file} cannot be used: {failed.error}")
        raise UnknownError(f"There is no {sort} {name!r}; {nearest(name, found)}")
    return found[name]
