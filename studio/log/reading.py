"""The door to recorded drives: `read(path)` finds the format that a file is of, and reads it.

A format is a kind, `logformat`: a file with SUFFIXES, which it takes, and `read(path, dbc) -> Log`. One's own are asked before those that
come with the studio, so that a laboratory's own sort of .csv is read by its own file; of formats that take the same ending the first
whose `fits(path)` says so is taken, and one that has no `fits` takes all of them.
"""

from pathlib import Path
from types import ModuleType

from studio.errors import Problem, ScenarioError, StudioError
from studio.kind import registry
from studio.kind.log import Log
from studio.kind.registry import Kind

PACKED = ".gz"


def known() -> dict[str, list[Kind]]:
    """Formats by the ending that they take: one's own first, then by name."""
    found: dict[str, list[Kind]] = {}
    for kind in sorted(registry.known("logformat").values(), key=lambda each: (each.is_built_in, each.name)):
        for suffix in kind.module.SUFFIXES:
            found.setdefault(suffix, []).append(kind)
    return found


def read(path: Path, dbc: Path | None = None) -> Log:
    """All signals of a log, or of a folder of them; raises ScenarioError that says what is wrong with it.

    `dbc` says what the frames of a CAN trace mean; other formats do not need it.
    """
    if not path.exists():
        raise ScenarioError(f"There is no log {path}.", [Problem(str(path), "does not exist", remedy="name the file of a recorded drive")])
    kind = format_of(path)
    log = by(kind, path, dbc)
    if not any(each.time.size for each in log.signals.values()):
        raise ScenarioError(f"{path.name} holds no samples.", [Problem(str(path), "is empty", remedy="record the drive again")])
    return log


def format_of(path: Path) -> Kind:
    """The format that a file, or a folder, is of; raises ScenarioError when it is of none."""
    ending, formats = suffix(path), known()
    if ending not in formats:
        remedy = "write a format of your own: studio new logformat NAME"
        problem = Problem(str(path), "has an unknown ending", ending, ", ".join(sorted(formats)), remedy)
        raise ScenarioError(f"{path.name} is of no format that is read.", [problem])
    fitting = next((kind for kind in formats[ending] if fits(kind.module, path)), None)
    if fitting is None:
        asked = ", ".join(kind.name for kind in formats[ending])
        raise ScenarioError(f"{path.name} is of no format that is read.", [Problem(str(path), f"is nothing for {asked}", ending)])
    return fitting


def fits(module: ModuleType, path: Path) -> bool:
    """Whether a file of its ending is of a format; one whose `fits` fails says no."""
    try:
        return bool(module.fits(path)) if hasattr(module, "fits") else True
    except Exception:
        return False


def by(kind: Kind, path: Path, dbc: Path | None) -> Log:
    """A log, read by a format; whatever that raises is told with its name. Raises ScenarioError."""
    try:
        found = kind.module.read(path, dbc)
    except (StudioError, MemoryError):
        raise
    except Exception as error:
        what = f"the format {kind.name} failed: {type(error).__name__}: {error}"
        raise ScenarioError(f"{path.name} cannot be read.", [Problem(str(path), what, remedy=f"mend {kind.source}")]) from error
    if not isinstance(found, Log):
        problem = Problem(str(path), f"the format {kind.name} gave {type(found).__name__}, no Log", remedy=f"mend {kind.source}")
        raise ScenarioError(f"{path.name} cannot be read.", [problem])
    return found


def suffix(path: Path) -> str:
    """The ending that tells the format; that of a folder is that of the first file in it."""
    if path.is_dir():
        taken = known()
        endings = [f"/{suffix(each)}" for each in sorted(path.iterdir()) if not each.is_dir()]
        return next((each for each in endings if each in taken), "/")
    name = path.name.lower().removesuffix(PACKED)
    return Path(name).suffix
