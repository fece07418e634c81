"""Renewal: a kind whose file has changed is loaded again, in place of the version before, or the version before is kept.

standing(path)        →  the kind of a file, as it was loaded
renew(path)           →  the kind of the file as it is now; the version before stays when that does not load
stand_in(folder, kept)   from now on what lies in `kept` is loaded in place of the files of the same names in a folder

It stands beside the registry and not in it, since all compiled code that knows of kinds would be compiled anew for a change of that.
"""

import sys
import traceback
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from importlib import invalidate_caches
from importlib.machinery import ModuleSpec
from importlib.util import module_from_spec
from pathlib import Path
from types import ModuleType

from studio import source
from studio.errors import KindError
from studio.kind import folder, registry
from studio.kind.registry import Kind
from studio.kind.sort import problems


def standing(path: Path) -> Kind | None:
    """The kind of a file, as it was loaded."""
    return next((each for each in registry.every() if each.file == path), None)


def renew(path: Path) -> Kind:
    """Loads a file and its helpers again; raises KindError, and the version before stays, when that fails."""
    before = standing(path)
    others = {each.file for each in registry.every()} - {path}
    names = [Path(name).stem for name in (before.texts if before else (path.name,)) if path.parent / name not in others]
    gone = forget(path.parent, names)
    forget_texts()
    try:
        with without_bytecode():
            kind = taken_in(path, folder.load(path), before)
    except KindError:
        sys.modules.update(gone)
        raise
    except (Exception, SystemExit) as error:
        sys.modules.update(gone)
        raise KindError(f"{path} does not load:\n{traceback.format_exc()}") from error
    return kind


def taken_in(path: Path, module: ModuleType, before: Kind | None) -> Kind:
    """A module that has been loaded becomes the kind of its file; raises KindError."""
    if before is None:
        registry._broken.pop(str(path), None)
        return registry.register(path.stem, module, str(path))
    sort = registry.sort_of(module)
    wrong = list(problems(module, sort))
    if wrong or sort.name != before.sort:
        raise KindError(f"The {before.sort} {before.name!r} does not keep the contract.", wrong)
    kind = Kind(before.sort, before.name, module, before.source, registry.texts(str(path)))
    registry._registered[before.sort, before.name] = kind
    registry.tell_listeners()
    return kind


def forget(place: Path, names: Iterable[str]) -> dict[str, ModuleType]:
    """Forgets modules of a folder, so that they are loaded anew; returned is what `sys.modules` had of them."""
    package = folder.package_of(place)
    modules = {id(sys.modules.get(f"{package}.{name}")) for name in names} - {id(None)}
    found = {key: module for key, module in sys.modules.items() if id(module) in modules}
    for key in found:
        del sys.modules[key]
    invalidate_caches()
    return found


def forget_texts() -> None:
    """Files have changed: what was found in them is looked for again."""
    source.imports.cache_clear()
    source.digest_of.cache_clear()


@contextmanager
def without_bytecode() -> Iterator[None]:
    """No bytecode is kept: it goes by dates in whole seconds, and somebody is writing."""
    kept, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        yield
    finally:
        sys.dont_write_bytecode = kept


def stand_in(place: Path, kept: Path) -> None:
    """Before a folder is loaded: the files that lie in `kept` stand in for those with the same names in it."""
    package = folder.package_of(place)
    spec = ModuleSpec(package, None, is_package=True)
    spec.submodule_search_locations = [str(kept), str(place)]
    sys.modules[package] = module_from_spec(spec)
    for path in sorted(kept.glob("[a-z]*.py")):
        if registry.is_kind(path) and not says_so(place / path.name):
            registry.attempt(path.stem, str(place / path.name), lambda name=path.name: registry.load_file(place / name))


def says_so(path: Path) -> bool:
    """Whether a file is there and means to be a kind, so that it is loaded with its folder."""
    return path.is_file() and registry.is_kind(path)
