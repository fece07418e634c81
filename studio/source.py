"""The studio's own sources: which files a file depends on, which functions are compiled, and digests of them.

Only text is read here and nothing is imported, so that the version of the simulator is known without the compiler.
"""

import hashlib
import re
import sys
import sysconfig
from functools import cache
from importlib.metadata import version
from pathlib import Path

PACKAGE = Path(__file__).parent
IMPORT = re.compile(r"^[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]*)|import[ \t]+([^\n]*))", re.MULTILINE)
COMMENT = re.compile(r"#.*")
TEXT = re.compile(r"'{3}.*?'{3}|\"{3}.*?\"{3}", re.DOTALL)
NAME = re.compile(r"(?:^|[,(])\s*([\w.]+|\*)")
COMPILED = re.compile(r"^@(?:compiled|inlined|lean)\b.*\n(?:@.*\n)*def (\w+)", re.MULTILINE)
OTHERS = tuple(Path(sysconfig.get_path(kind)) for kind in ("stdlib", "platstdlib", "purelib", "platlib"))


@cache
def imports(path: Path) -> frozenset[Path]:
    """The files of ours that a file imports."""
    found = set()
    for origin, names, plain in IMPORT.findall(COMMENT.sub("", path.read_text(encoding="utf-8"))):
        for name in NAME.findall(names or plain):
            inner = f"{origin}{name}" if origin.endswith(".") else f"{origin}.{name}"
            found.add(file_of(inner, path) or file_of(origin, path) if origin else file_of(name, path))
    return frozenset(file for file in found if file and file != path)


def file_of(module: str, importer: Path) -> Path | None:
    """The file of a module of this package, of one beside its importer, or of one that somebody loaded from his own folder."""
    if module.startswith("."):
        above = len(module) - len(module.lstrip("."))
        return file_below(importer.parents[above - 1], module.lstrip("."))
    if module.partition(".")[0] == PACKAGE.name:
        return file_below(PACKAGE.parent, module)
    if not importer.is_relative_to(PACKAGE) and (beside := file_below(importer.parent, module)):
        return beside
    file = getattr(sys.modules.get(module), "__file__", None)
    own = file is not None and file.endswith(".py") and not any(Path(file).is_relative_to(folder) for folder in OTHERS)
    return Path(file) if own else None


def file_below(folder: Path, module: str) -> Path | None:
    """The file of a module that is named from a folder."""
    base = folder.joinpath(*module.split(".")) if module else folder
    return next((file for file in (base.with_suffix(".py"), base / "__init__.py") if file.is_file()), None)


def closure(path: Path) -> list[Path]:
    """A file and all files of ours that it depends on, in a fixed order."""
    found, open_ends = {path}, [path]
    while open_ends:
        new = imports(open_ends.pop()) - found
        found |= new
        open_ends += new
    return sorted(found)


def beside(path: Path) -> list[Path]:
    """A file, then those of its folder that it depends on, in a fixed order."""
    return [path, *(each for each in closure(path) if each != path and each.is_relative_to(path.parent))]


@cache
def tools() -> str:
    """Versions of what compiles."""
    return f"{version('numba')} {version('llvmlite')} {sys.version}"


@cache
def digest_of(*files: Path) -> str:
    """Digest of files, and of the versions of what compiles them."""
    digest = hashlib.sha256(tools().encode())
    for path in files:
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def compiled_functions(path: Path) -> list[str]:
    """Names of the functions in a file that are compiled; not those of a text that is written to another file."""
    return COMPILED.findall(TEXT.sub("", path.read_text(encoding="utf-8")))


def source_digest() -> str:
    """Digest of every room with compiled functions, and of what they import: the version of the simulator."""
    rooms = {room for room in PACKAGE.iterdir() if any(compiled_functions(path) for path in room.rglob("*.py"))}
    files = {path for room in rooms for path in room.rglob("*.py")}
    return digest_of(*sorted(files.union(*map(imports, files))))


@cache
def code_version() -> str:
    """Version of the package and digest of the sources that compute."""
    return f"{version('cooperative-adas-studio')}+{source_digest()}"
