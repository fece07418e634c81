"""How the hot code is compiled, and where the machine code is kept.

`compiled` is numba's `njit` with the options of the house:

* no fast-math at all: where the compiler may fuse or reorder, the bits of a function depend on what it was compiled into,
  and a run of freshly compiled code ends with others than one of kept code. Multiply-adds that pay are written out
  (`fma` in model/elementary.py);
* division by zero gives infinity, as in numpy, instead of a hidden branch;
* machine code is cached on disk.

`inlined` puts a function into its caller, so that the loop around both can use vector registers.

numba notices a change of the file that a function stands in, not of the functions that it calls. So the cache folder is
named by a digest of all sources that hold compiled code: a changed tyre can never run with the old physics.
"""

import hashlib
import os
import shutil
import sys
from functools import partial
from pathlib import Path

import numba
import platformdirs

PACKAGE = Path(__file__).parent
COMPILED_ROOMS = ("model", "road", "application", "world", "assess", "rig")
KEPT_CACHES = 4


def sources() -> list[Path]:
    """The files that may hold compiled code, in a fixed order."""
    files = [PACKAGE / "compiled.py", PACKAGE / "conventions.py"]
    for room in COMPILED_ROOMS:
        files += (PACKAGE / room).glob("*.py")
    return sorted(files)


def source_digest() -> str:
    """Digest of those files, of numba's and of Python's version."""
    digest = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    for path in sources():
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def cache_root() -> Path:
    """Folder for everything that can be made again: machine code, imported maps."""
    return Path(os.environ.get("STUDIO_CACHE") or platformdirs.user_cache_dir("cooperative-adas-studio"))


def forget_old(folder: Path, *, keep: int) -> None:
    """Removes all but the newest caches beside `folder`; another program may be doing the same."""
    siblings = sorted(folder.parent.iterdir(), key=lambda path: path.stat().st_mtime, reverse=True)
    for stale in siblings[keep:]:
        shutil.rmtree(stale, ignore_errors=True)


DIGEST = source_digest()
CACHE = cache_root() / "compiled" / DIGEST
CACHE.mkdir(parents=True, exist_ok=True)
os.utime(CACHE)
forget_old(CACHE, keep=KEPT_CACHES)
numba.config.CACHE_DIR = str(CACHE)

compiled = partial(numba.njit, cache=True, error_model="numpy", nogil=True)
inlined = compiled(forceinline=True)


def is_warm() -> bool:
    """Whether this source has been compiled on this machine before."""
    return any(CACHE.rglob("*.nbi"))
