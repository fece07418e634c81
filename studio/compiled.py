"""How the hot code is compiled, and where the machine code is kept.

`compiled` is numba's `njit` with the options of the house:

* no fast-math at all: where the compiler may fuse or reorder, the bits of a function depend on what it was compiled into,
  and a run of freshly compiled code ends with others than one of kept code. Multiply-adds that pay are written out
  (`fma` in model/elementary.py);
* division by zero gives infinity, as in numpy, instead of a hidden branch;
* machine code is cached on disk.

`inlined` puts a function into its caller, so that the loop around both can use vector registers.

numba notices a change of the file that a function stands in, not of the functions that it calls. So the machine code of a
file lies in a folder named by a digest of that file and of all files of ours that it imports, and those import, and so on: a
changed tyre can never run with the old physics, and a changed metric compiles nothing but itself. Several versions and
programs lie beside each other; what nobody has used for two months is removed.
"""

import hashlib
import os
import re
import shutil
import sys
import sysconfig
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache, partial
from pathlib import Path
from typing import Any, ParamSpec, Protocol, TypeVar, overload

import llvmlite
import numba
import platformdirs
from numba.core.caching import UserProvidedCacheLocator

PACKAGE = Path(__file__).parent
COMPILED_ROOMS = ("model", "road", "application", "world", "assess", "rig")
FORGOTTEN_AFTER = 60 * 86400.0  # [s]
TOOLS = f"{numba.__version__} {llvmlite.__version__} {sys.version}"
IMPORT = re.compile(r"^[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]*)|import[ \t]+([^\n]*))", re.MULTILINE)
COMMENT = re.compile(r"#.*")
NAME = re.compile(r"(?:^|[,(])\s*([\w.]+|\*)")
OTHERS = tuple(Path(sysconfig.get_path(kind)) for kind in ("stdlib", "platstdlib", "purelib", "platlib"))


# -- what a file depends on --------------------------------------------------------------------------


@cache
def imports(path: Path) -> frozenset[Path]:
    """The files of ours that a file imports."""
    found = set()
    for origin, names, plain in IMPORT.findall(COMMENT.sub("", path.read_text(encoding="utf-8"))):
        for name in NAME.findall(names or plain):
            found.add(file_of(f"{origin}.{name}") or file_of(origin) if origin else file_of(name))
    return frozenset(found - {None, path})


def file_of(module: str) -> Path | None:
    """The file of a module of this package, or of one that somebody else loaded from his own folder."""
    if module.partition(".")[0] == PACKAGE.name:
        base = PACKAGE.parent.joinpath(*module.split("."))
        return next((file for file in (base.with_suffix(".py"), base / "__init__.py") if file.is_file()), None)
    file = getattr(sys.modules.get(module), "__file__", None)
    own = file is not None and file.endswith(".py") and not any(Path(file).is_relative_to(folder) for folder in OTHERS)
    return Path(file) if own else None


def closure(path: Path) -> list[Path]:
    """A file and all files of ours that it depends on, in a fixed order."""
    found, open_ends = {path}, [path]
    while open_ends:
        new = imports(open_ends.pop()) - found
        found |= new
        open_ends += new
    return sorted(found)


@cache
def digest_of(*files: Path) -> str:
    """Digest of files, and of the versions of what compiles them."""
    digest = hashlib.sha256(TOOLS.encode())
    for path in files:
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def sources() -> Iterator[Path]:
    """The files that may hold compiled code."""
    yield from (PACKAGE / "compiled.py", PACKAGE / "conventions.py")
    for room in COMPILED_ROOMS:
        yield from (PACKAGE / room).rglob("*.py")


def source_digest() -> str:
    """Digest of all those files: the version of the simulator."""
    return digest_of(*sorted(sources()))


# -- where machine code is kept ----------------------------------------------------------------------


def cache_root() -> Path:
    """Folder for everything that can be made again: machine code, imported maps."""
    return Path(os.environ.get("STUDIO_CACHE") or platformdirs.user_cache_dir("cooperative-adas-studio"))


def folder_of(path: Path) -> Path:
    """Where the machine code of a file is kept."""
    return CACHE / f"{path.parent.name}.{path.stem}-{digest_of(*closure(path))}"


def touch(folder: Path) -> None:
    """Makes a folder, and notes once a day that it is in use."""
    folder.mkdir(parents=True, exist_ok=True)
    if time.time() - folder.stat().st_mtime > 86400.0:
        os.utime(folder)


def forget_old(folder: Path) -> None:
    """Removes what nobody has used for long; another program may be doing the same."""
    oldest = time.time() - FORGOTTEN_AFTER
    for stale in folder.iterdir():
        with suppress(FileNotFoundError):
            if stale.stat().st_mtime < oldest:
                shutil.rmtree(stale) if stale.is_dir() else stale.unlink()


class Locator(UserProvidedCacheLocator):
    """Tells numba where the machine code of a function is kept."""

    def __init__(self, py_func, py_file):
        super().__init__(py_func, py_file)
        self._cache_path = str(folder_of(Path(py_file)))

    def ensure_cache_path(self):
        touch(Path(self._cache_path))


CACHE = cache_root() / "compiled"
CACHE.mkdir(parents=True, exist_ok=True)
forget_old(CACHE)
numba.config.CACHE_DIR = str(CACHE)
numba.config.CACHE_LOCATOR_CLASSES = f"{__name__}.{Locator.__name__}"


Arguments = ParamSpec("Arguments")
Result = TypeVar("Result", covariant=True)


class Compiled(Protocol[Arguments, Result]):
    """A compiled function as the type checker sees it: called as it is written; `py_func` is the function itself."""

    @property
    def py_func(self) -> Callable[Arguments, Result]: ...

    def __call__(self, *args: Arguments.args, **kwargs: Arguments.kwargs) -> Result: ...


@overload
def compiled(function: Callable[Arguments, Result], **options: Any) -> Compiled[Arguments, Result]: ...
@overload
def compiled(function: None = None, **options: Any) -> Callable[[Callable[Arguments, Result]], Compiled[Arguments, Result]]: ...
def compiled(function: Any = None, **options: Any) -> Any:
    """`function` as machine code, with numba's `options` besides those of the house."""
    if function is None:
        return partial(compiled, **options)
    dispatcher = numba.njit(cache=True, error_model="numpy", nogil=True, **options)(function)
    # numba numbers the files of a function's machine code. Two processes that compile it for different types at the same
    # time would both write number 1, and one would be taken for the other; so every process has names of its own.
    file = dispatcher._cache._cache_file
    file._data_name_pattern = file._data_name_pattern.replace("{number:d}", f"{{number:d}}-{uuid.uuid4().hex[:12]}")
    return dispatcher


inlined = compiled(forceinline=True)


def is_warm() -> bool:
    """Whether the step of the vehicles has been compiled on this machine before."""
    return any(folder_of(PACKAGE / "world" / "motion.py").glob("*.nbi"))
