"""From a map file to an import's folder, in one go: for the command line, the page and every correction.

Corrections that an earlier import of the same folder has are kept and applied to the new map.
"""

from collections.abc import Callable
from pathlib import Path

from studio.errors import MapError, Problem, nearest
from studio.road import folder
from studio.road.correction import Correction, Corrections, added
from studio.road.network import Network
from studio.road.place import load


def take(
    source: Path,
    out: Path,
    *,
    bbox: str | None = None,
    progress: Callable[[str], None] = lambda text: None,
    commit: Callable[[], None] = lambda: None,
) -> Network:
    """Imports a map file into a folder; an earlier import there is replaced, its corrections are kept.

    Args:
        source: the map file.
        out: the folder.
        bbox: the part to keep, "west,south,east,north" [deg].
        progress: is told what is being done.
        commit: is called just before the folder is written; what it raises leaves everything as it was.

    Raises:
        MapError: the map cannot be imported, or the folder cannot be written.
    """
    folder.refuse_foreign(out)
    corrections = folder.corrections(out)
    network = load(source, bbox=bbox, corrections=corrections, progress=progress)
    progress("writing the folder")
    commit()
    folder.write(network, source, out, bbox=bbox, corrections=corrections)
    return network


def correct(
    out: Path, new: Correction, *, progress: Callable[[str], None] = lambda text: None, commit: Callable[[], None] = lambda: None
) -> Network:
    """Imports a folder's map again with one correction more; if that fails, all stays as it was. Raises MapError."""

    def met(network: Network) -> None:
        if new.element not in [each.element for each in network.report.corrected]:
            allowed = "an element of the map; a node without tags must lie on a road"
            problem = Problem("element", "is not in the map", new.element, allowed, "the report and the plan name elements")
            raise MapError(f"{out.name}: there is no {new.element!r}.", [problem])

    return again(out, added(folder.opened(out).corrections, new), progress, commit, met)


def undo(
    out: Path, element: str, *, progress: Callable[[str], None] = lambda text: None, commit: Callable[[], None] = lambda: None
) -> Network:
    """Imports a folder's map again without the corrections of an element. Raises MapError."""
    present = folder.opened(out).corrections
    check_corrected(out, element, present)
    return again(out, tuple(each for each in present if each.element != element), progress, commit, lambda network: None)


def check_corrected(out: Path, element: str, present: Corrections) -> None:
    """Raises MapError when nothing is corrected of an element."""
    names = [each.element for each in present]
    if element not in names:
        problem = Problem("element", "is not corrected", element, remedy=nearest(element, names))
        raise MapError(f"{out.name}: there is no correction of {element!r}.", [problem])


def again(
    out: Path,
    corrections: Corrections,
    progress: Callable[[str], None],
    commit: Callable[[], None],
    check: Callable[[Network], None],
) -> Network:
    """Imports a folder's map again with these corrections; `check` looks at the network before it is kept."""
    found = folder.opened(out)
    network = load(found.map, bbox=found.bbox, corrections=corrections, progress=progress)
    check(network)
    progress("writing the folder")
    commit()
    folder.write(network, found.map, out, bbox=found.bbox, corrections=corrections, made_of=found)
    return network
