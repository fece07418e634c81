"""Loops over what a kind is asked for: written once per kind, into the cache of compiled code.

numba keeps machine code only of functions that stand in a file, so the loop that calls a kind's function stands in one.
"""

import hashlib
import os
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

from studio.cache import touch
from studio.compiled import CACHE
from studio.kind.registry import Kind


def written(kind: Kind, source: str) -> ModuleType:
    """The module with this text, which calls the functions of a kind."""
    key = hashlib.sha256(f"{source}{kind.digest}".encode()).hexdigest()[:16]
    path = CACHE / f"{kind.sort}_{kind.name}_{key}.py"
    if not path.exists():
        draft = path.with_suffix(f".{os.getpid()}")
        draft.write_text(source, encoding="utf-8")
        draft.replace(path)
    touch(path)
    return load(path)


def load(path: Path) -> ModuleType:
    """A module from a file, which has a name for itself."""
    if path.stem not in sys.modules:
        spec = spec_from_file_location(path.stem, path)
        assert spec and spec.loader, "a file whose name ends in .py has a loader"
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
        sys.modules[path.stem] = module
    return sys.modules[path.stem]


def fields(row: str, count: int) -> str:
    """Arguments that are rows of an array, at its column j.

    >>> fields("settings", 2)
    'settings[0, j], settings[1, j]'
    """
    return ", ".join(f"{row}[{i}, j]" for i in range(count))
