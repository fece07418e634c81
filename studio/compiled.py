"""How the hot code is compiled, and where the machine code is kept.

`compiled` is numba's `njit` with the options of the house:

* no fast-math at all: where the compiler may fuse or reorder, the bits of a function depend on what it was compiled into,
  and a run of freshly compiled code ends with others than one of kept code. Multiply-adds that pay are written out
  (`fma` in model/elementary.py);
* division by zero gives infinity, as in numpy, instead of a hidden branch;
* machine code is cached on disk.

`lean` is for functions that take arrays and neither make nor return any. numba counts the references to an array wherever one
is handed on, with an instruction that locks a line of memory: in a loop over vehicles that took ten times as long as the work.
A lean function counts nothing; its caller holds the arrays. `inlined` is lean as well, and puts a function into its caller, so
that the loop around both can use vector registers.

numba notices a change of the file that a function stands in, not of the functions that it calls. So the machine code of a
file lies in a folder named by a digest of that file and of all files of ours that it imports, and those import, and so on: a
changed tyre can never run with the old physics, and a changed metric compiles nothing but itself.

Several processes may compile at once: whoever comes first compiles a function, the others wait for it and take it from the
cache. So they share the work, and nothing is compiled twice.

The cache is a help and no more: code that is damaged there, as after a loss of power, is compiled anew, and code for which the disk has no
room is compiled for this process alone.
"""

import hashlib
import uuid
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any, ParamSpec, Protocol, TypeVar, overload

import numba
from filelock import FileLock
from llvmlite.binding import get_host_cpu_name
from numba.core.caching import UserProvidedCacheLocator
from numba.core.compiler_lock import global_compiler_lock

from studio.cache import cache_root, forget_old, touch
from studio.source import PACKAGE, closure, digest_of

LOOK_AGAIN = 0.01  # [s] between two looks whether another process has finished a function
config: Any = numba.config  # its names are made from the environment while it is loaded
CPU = config.CPU_NAME or get_host_cpu_name()


def folder_of(path: Path) -> Path:
    """Where the machine code of a file is kept, for this machine's kind of processor.

    Users' modules are named by their folders, and their code names them: the same file in two folders has two places.
    """
    outside = "" if path.is_relative_to(PACKAGE) else f"{hashlib.sha256(str(path.parent).encode()).hexdigest()[:8]}-"
    return CACHE / f"{path.parent.name}.{path.stem}-{outside}{digest_of(*closure(path))}-{CPU}"


class Locator(UserProvidedCacheLocator):
    """Tells numba where the machine code of a function is kept."""

    def __init__(self, py_func, py_file):
        super().__init__(py_func, py_file)
        self._cache_path = str(folder_of(Path(py_file)))

    def ensure_cache_path(self):
        folder = Path(self._cache_path)
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            touch(folder)


CACHE = cache_root() / "compiled"
with suppress(OSError):
    CACHE.mkdir(parents=True, exist_ok=True)
    forget_old(CACHE)
config.CACHE_DIR = str(CACHE)
config.CACHE_LOCATOR_CLASSES = f"{__name__}.{Locator.__name__}"


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
    file._load_index = partial(readable, file._load_index)
    file._load_data = partial(loadable, file._load_data)
    file.save = partial(savable, file.save)
    file._data_name_pattern = file._data_name_pattern.replace("{number:d}", f"{{number:d}}-{uuid.uuid4().hex[:12]}")
    dispatcher.compile = partial(compile_alone, dispatcher.compile, f"{file._index_path}.lock")
    return dispatcher


lean = compiled(_nrt=False)
inlined = compiled(forceinline=True, _nrt=False)


def readable(load: Callable[[], dict]) -> dict:
    """What there is of a function; nothing when it is damaged, or some of it is for the types of a module that is not loaded now."""
    try:
        return load()
    except Exception:  # what is damaged can be anything
        return {}


def loadable(load: Callable[[str], Any], name: str) -> Any:
    """Kept machine code; as if there were none where it is damaged, or names a module that is not loaded now: a user's own.

    numba tells unions of types apart by their names alone, so what a user's own file has called `Does` may stand in the code of another.
    """
    try:
        return load(name)
    except Exception as error:
        raise OSError(f"{name} cannot be used: {error}") from error


def savable(save: Callable[[Any, Any], None], key: Any, data: Any) -> None:
    """Keeps machine code where there is room for it."""
    with suppress(OSError):
        save(key, data)


def compile_alone(compile, lock: str, signature):
    """Compiles a function, or takes it from the cache, while no other process compiles the same one."""
    with global_compiler_lock, alone(lock):
        return compile(signature)


@contextmanager
def alone(lock: str) -> Generator[None]:
    """Holds a lock among processes; goes without where the folder cannot be written.

    Callers hold theirs while they wait for those of the functions that they call. No function calls one that calls it, so
    nobody waits in a circle; and the compiler's own lock is always taken first, so that threads do not either.
    """
    held = FileLock(lock, poll_interval=LOOK_AGAIN)
    with suppress(OSError):
        held.acquire()
    try:
        yield
    finally:
        held.release()
