"""Folders of kinds: their files are loaded as modules of a package of their own, so that they can import each other.

A file may say `from .intent import Payload` or, as in a script, `from intent import Payload`: both name the same module. No folder is put
onto the path of imports, so that a file named like a library stands in nobody's way.
"""

import hashlib
import sys
from importlib import import_module
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
    """The module in a file; raises whatever it raises."""
    folder = path.parent.resolve()
    package = package_of(folder)
    if package not in sys.modules:
        spec = ModuleSpec(package, None, is_package=True)
        spec.submodule_search_locations = [str(folder)]
        sys.modules[package] = module_from_spec(spec)
    if not any(isinstance(each, Beside) and each.folder == folder for each in sys.meta_path):
        sys.meta_path.append(Beside(folder))
    return import_module(f"{package}.{path.stem}")


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
