"""Whether the studio is installed as it should be: packages, page, machine code."""

import importlib.util
import platform
from collections.abc import Iterable, Iterator
from importlib.metadata import PackageNotFoundError, requires, version
from types import ModuleType

from packaging.requirements import Requirement

from studio.doctor.finding import Finding, Patient, good
from studio.source import PACKAGE, code_version, compiled_functions

NAME = "cooperative-adas-studio"
BUNDLE = PACKAGE / "_web"
INSTALL = "install the studio again: uv sync, or pip install of its wheel"


def versions(_: Patient) -> Iterator[Finding]:
    """Packages that the studio stands on, each in the versions that it wants."""
    wanted = requires(NAME) or []
    if wrong := unmet(wanted):
        yield Finding("packages", False, f"not as the studio wants them: {', '.join(wrong)}", INSTALL)
    else:
        yield good("packages", f"as the studio wants them; Python {platform.python_version()}, studio {code_version()}")


def unmet(wanted: Iterable[str]) -> list[str]:
    """The requirements that this installation does not meet, with what there is; those of extras are nobody's."""
    own = [each for each in map(Requirement, wanted) if each.marker is None or each.marker.evaluate({"extra": ""})]
    return [f"{each} ({found or 'missing'})" for each in own if not (found := installed(each)) or found not in each.specifier]


def installed(wanted: Requirement) -> str:
    """The version of a package; "" when there is none."""
    try:
        return version(wanted.name)
    except PackageNotFoundError:
        return ""


def page(_: Patient) -> Iterator[Finding]:
    """The page: built, and in a checkout of the sources as they are."""
    bundle = builder()
    if not (BUNDLE / "index.html").is_file():
        yield Finding("page", False, "has not been built", f"{INSTALL}, without STUDIO_SKIP_WEB")
    elif bundle and not bundle.current():
        yield Finding("page", False, "was built of other sources than those in web/", "uv run studio builds it anew")
    else:
        yield good("page", "is built" + (" of the sources in web/" if bundle else ""))


def builder() -> ModuleType | None:
    """What builds the page in a checkout."""
    path = PACKAGE.parent / "web" / "bundle.py"
    spec = importlib.util.spec_from_file_location("studio_web_bundle", path) if path.is_file() else None
    if spec is None or spec.loader is None:
        return None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def code(_: Patient) -> Iterator[Finding]:
    """Machine code: what is not there is compiled when it is first needed, and nothing is wrong with that."""
    from studio.warmup import files, missing

    count, lacking = sum(len(compiled_functions(path)) for path in files()), len(missing())
    rest = "; the rest is compiled when it is needed, or by studio compile" if lacking else ""
    yield good("machine code", f"{count - lacking} of {count} functions are compiled{rest}")
