"""Loops that are written for a kind: numba keeps machine code only of functions that stand in a file, so they get one in the cache."""

import hashlib
import os
import sys
from importlib.util import module_from_spec, spec_from_file_location
from types import ModuleType

from studio.cache import touch
from studio.compiled import CACHE
from studio.kind.registry import Kind


def written(name: str, source: str, *kinds: Kind) -> ModuleType:
    """The module with this text, for these kinds; the same text for the same files is the same module."""
    key = hashlib.sha256("\n".join([source, *(kind.digest for kind in kinds)]).encode()).hexdigest()[:16]
    name = f"{name}_{key}"
    if name not in sys.modules:
        path = CACHE / f"{name}.py"
        if not path.exists():
            draft = path.with_suffix(f".{os.getpid()}")
            draft.write_text(source, encoding="utf-8")
            draft.replace(path)
        touch(path)
        load(name, str(path))
    return sys.modules[name]


def load(name: str, path: str) -> None:
    """Loads a file as a module of this name."""
    spec = spec_from_file_location(name, path)
    assert spec and spec.loader, "a file whose name ends in .py has a loader"
    sys.modules[name] = module_from_spec(spec)
    spec.loader.exec_module(sys.modules[name])
