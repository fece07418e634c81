"""Folders of kinds: their files are loaded as modules of a package of their own, so that they can import each other.

A file may say `from .intent import Payload` or, as in a script, `from intent import Payload`: both name the same module. No folder is put
onto the path of imports, so that a file named like a library stands in nobody's way.
"""

import hashlib
import sys
from collections.abc import Iterable
from importlib import import_module, invalidate_caches
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import module_from_spec
from pathlib import Path
from types import ModuleType

PREFIX = "studio_folder_"


def package_of(folder: Path) -> str:
    """The name of a folder's package."""
    return PREFIX + hashlib.sha256(str(folder).encode()).hexdigest()[:8]


def load(path: Path) -> ModuleType:
    """The module in a file; raises whatever it raises. No bytecode is kept: its date is in whole seconds, and somebody is writing."""
    package = made(path.parent.resolve())
    kept, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        return import_module(f"{package}.{path.stem}")
    finally:
        sys.dont_write_bytecode = kept


def made(folder: Path) -> str:
    """The package of a folder, which is made when there is none yet."""
    package = package_of(folder)
    if package not in sys.modules:
        spec = ModuleSpec(package, None, is_package=True)
        spec.submodule_search_locations = [str(folder)]
        sys.modules[package] = module_from_spec(spec)
    if not any(isinstance(each, Beside) and each.folder == folder for each in sys.meta_path):
        sys.meta_path.append(Beside(folder))
    return package


def stand_in(folder: Path, kept: Path) -> None:
    """From now on the files that lie in `kept` are loaded in place of those with the same names in a folder."""
    sys.modules[made(folder)].__path__.insert(0, str(kept))


def forget(folder: Path, names: Iterable[str]) -> dict[str, ModuleType]:
    """Forgets modules of a folder, so that they are loaded anew; returned is what `sys.modules` had of them."""
    package = made(folder)
    modules = {id(sys.modules.get(f"{package}.{name}")) for name in names} - {id(None)}
    found = {key: module for key, module in sys.modules.items() if id(module) in modules}
    for key in found:
        del sys.modules[key]
    invalidate_caches()
    return found


class Beside(MetaPathFinder, Loader):
    """Finds the files of a folder under their plain names, after everything else has been looked for."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def find_spec(self, fullname: str, path=None, target=None) -> ModuleSpec | None:
        """A file of this folder."""
        is_here = "." not in fullname and (self.folder / f"{fullname}.py").is_file()
        return ModuleSpec(fullname, self) if is_here else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """The module that the package has."""
        return import_module(f"{package_of(self.folder)}.{spec.name}")

    def exec_module(self, module: ModuleType) -> None:
        """It has been executed."""
