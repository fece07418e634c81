"""The applications that can be named in a scenario.

Built-ins and users' plug-ins come in by the same door: a module that keeps the contract, offered under an entry point of
the group `cooperative_adas_studio.applications`, or a file in a folder that is given to `load_folder`. A name can be
given once.
"""

import sys
import threading
import traceback
from collections import namedtuple
from dataclasses import dataclass
from functools import cache
from importlib.metadata import entry_points
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

from studio.compiled import closure, digest_of
from studio.errors import ApplicationError, Problem, UnknownError, nearest

GROUP = "cooperative_adas_studio.applications"
NEEDED = ("TITLE", "Parameters", "Memory", "decide")


@dataclass(frozen=True)
class Application:
    """A registered application: its name and the module that keeps the contract."""

    name: str
    module: ModuleType

    @property
    def title(self) -> str:
        """One line for people."""
        return self.module.TITLE

    @property
    def compiled(self) -> bool:
        """Whether `decide` is compiled; else it is called as Python."""
        return getattr(self.module, "COMPILED", False)

    @property
    def digest(self) -> str:
        """Digest of its file, and of the files of ours that it imports; the name of a module that stands in no file."""
        file = getattr(self.module, "__file__", None)
        return digest_of(*closure(Path(file))) if file else self.name

    def parameters(self, given: dict) -> dict:
        """The full set of parameters, checked; raises pydantic's ValidationError."""
        return self.module.Parameters.model_validate(given).model_dump()

    def as_json(self) -> dict:
        """What the page needs to know."""
        return {
            "name": self.name,
            "title": self.title,
            "description": (self.module.__doc__ or "").strip(),
            "parameters": self.module.Parameters.model_json_schema(),
        }


_registered: dict[str, Application] = {}
_loading = threading.RLock()  # the page asks for several things at once


def register(name: str, module: ModuleType) -> Application:
    """Adds an application; raises ApplicationError when the name is taken or the contract is not kept."""
    if name in _registered:
        raise ApplicationError(
            f"The application name {name!r} is taken.",
            [Problem(f"applications.{name}", "is registered twice", module.__name__, "", "choose another name")],
        )
    missing = [part for part in NEEDED if not hasattr(module, part)]
    if missing:
        raise ApplicationError(
            f"The application {name!r} does not keep the contract.",
            [Problem(module.__name__, f"has no {part}", "", ", ".join(NEEDED)) for part in missing],
        )
    broken = [problem for check in (check_values, check_compiled) if (problem := check(module))]
    if broken:
        raise ApplicationError(f"The application {name!r} does not keep the contract.", broken)
    vars(module)["ParameterTuple"] = parameter_tuple(module)
    _registered[name] = Application(name, module)
    return _registered[name]


def check_values(module: ModuleType) -> Problem | None:
    """Parameters and memory must be numbers, with first values."""
    try:
        values = [*module.Parameters().model_dump().values(), *module.Memory()]
        if all(isinstance(value, (bool, int, float)) for value in values):
            return None
        what = "has a default that is no number"
    except (TypeError, ValueError) as error:
        what = f"has no defaults: {error}"
    return Problem(f"{module.__name__}: Parameters, Memory", what, allowed="numbers, each with a default")


def check_compiled(module: ModuleType) -> Problem | None:
    """A compiled application's `decide` must be compiled."""
    if not getattr(module, "COMPILED", False) or hasattr(module.decide, "py_func"):
        return None
    where, remedy = f"{module.__name__}: decide", "write @compiled (from studio.compiled) above it, or COMPILED = False"
    return Problem(where, "is not compiled although COMPILED is True", remedy=remedy)


def parameter_tuple(module: ModuleType) -> type:
    """The parameters as a NamedTuple, for `decide`. It belongs to the module: cached machine code finds it there by name."""
    fields = list(module.Parameters.model_fields)  # known at run time only, which the type checker does not expect
    return namedtuple("ParameterTuple", fields, module=module.__name__)  # pyrefly: ignore[bad-class-definition, invalid-argument]


@cache
def load_all() -> None:
    """Registers everything that installed packages offer, this one first of all."""
    for offer in entry_points(group=GROUP):
        try:
            register(offer.name, offer.load())
        except ApplicationError:
            raise
        except Exception as error:
            raise ApplicationError(f"The plug-in {offer.name!r} ({offer.value}) does not load: {error!r}") from error


def load_file(path: Path) -> Application:
    """Registers the application in a Python file under the file's name; the same file twice is the same application."""
    known()
    present = _registered.get(path.stem)
    if present and getattr(present.module, "__file__", None) == str(path):
        return present
    spec = spec_from_file_location(f"studio_application_{path.stem}", path)
    assert spec and spec.loader, "a file whose name ends in .py has a loader"
    module = module_from_spec(spec)
    sys.modules[module.__name__] = module
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise ApplicationError(f"The application {path} does not load:\n{traceback.format_exc()}") from error
    return register(path.stem, module)


def load_folder(folder: Path) -> list[Application]:
    """Registers every application file of a folder; raises ApplicationError when it is none."""
    if not folder.is_dir():
        raise ApplicationError(
            f"There is no folder {folder} of applications.",
            [Problem("--applications", "is not a folder", str(folder), "a folder of Python files")],
        )
    return [load_file(path.resolve()) for path in sorted(folder.glob("[a-z]*.py"))]


def known() -> dict[str, Application]:
    """All applications by name."""
    with _loading:
        load_all()
    return dict(sorted(_registered.items()))


def find(name: str) -> Application:
    """One application; raises UnknownError that names the nearest."""
    applications = known()
    if name not in applications:
        raise UnknownError(f"There is no application {name!r}; {nearest(name, applications)}")
    return applications[name]
