"""The door to recorded drives: `read(path)` finds the format that a file is of.

A format is a file in studio/log/format with SUFFIXES, which it takes, and `read(path, dbc) -> Log`. A new format is one new file there.
"""

import pkgutil
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType

from studio.errors import Problem, ScenarioError
from studio.log import format as formats
from studio.log.signal import Log

PACKED = ".gz"


@cache
def known() -> dict[str, ModuleType]:
    """Formats by the ending that they take."""
    modules = [import_module(f"{formats.__name__}.{each.name}") for each in pkgutil.iter_modules(formats.__path__)]
    return {suffix: module for module in modules for suffix in getattr(module, "SUFFIXES", ())}


def read(path: Path, dbc: Path | None = None) -> Log:
    """All signals of a log, or of a folder of them; raises ScenarioError that says what is wrong with it.

    `dbc` says what the frames of a CAN trace mean; other formats do not need it.
    """
    if not path.exists():
        raise ScenarioError(f"There is no log {path}.", [Problem(str(path), "does not exist", remedy="name the file of a recorded drive")])
    ending = suffix(path)
    if ending not in known():
        allowed = ", ".join(sorted(known()))
        raise ScenarioError(f"{path.name} is of no format that is read.", [Problem(str(path), "has an unknown ending", ending, allowed)])
    log = known()[ending].read(path, dbc)
    if not any(each.time.size for each in log.signals.values()):
        raise ScenarioError(f"{path.name} holds no samples.", [Problem(str(path), "is empty", remedy="record the drive again")])
    return log


def suffix(path: Path) -> str:
    """The ending that tells the format; that of a folder is that of the first file in it."""
    if path.is_dir():
        endings = [f"/{suffix(each)}" for each in sorted(path.iterdir()) if not each.is_dir()]
        return next((each for each in endings if each in known()), "/")
    name = path.name.lower().removesuffix(PACKED)
    return Path(name).suffix
