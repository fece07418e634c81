"""From a map file to an import's folder, in one go: for the command line, the page and every correction.

Corrections that an earlier import of the same folder has are kept and applied to the new map.
"""

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from studio.errors import MapError, Problem, nearest
from studio.road.formats import osm
from studio.road.formats.correction import Correction, Corrections, added
from studio.road.library import folder
from studio.road.library.place import load
from studio.road.network import Network


def take(
    source: Path,
    out: Path,
    *,
    bbox: str | None = None,
    parking_aisles: bool = False,
    progress: Callable[[str], None] = lambda text: None,
    commit: Callable[[], None] = lambda: None,
) -> Network:
    """Imports a map file into a folder; an earlier import there is replaced, its corrections are kept.

    Args:
        source: the map file.
        out: the folder.
        bbox: the part to keep, "west,south,east,north" [deg].
        parking_aisles: whether the aisles of parking places are built too.
        progress: is told what is being done.
        commit: is called just before the folder is written; what it raises leaves everything as it was.

    Raises:
        MapError: the map cannot be imported, or the folder cannot be written.
    """
    folder.refuse_foreign(out)
    corrections = folder.corrections(out)
    network = load(source, bbox=bbox, parking_aisles=parking_aisles, corrections=corrections, progress=progress)
    progress("writing the folder")
    commit()
    folder.write(network, source, out, bbox=bbox, parking_aisles=parking_aisles, corrections=corrections)
    return network


def fetch(
    place: str | osm.Box,
    out: Path,
    *,
    overpass: str | None = None,
    search: str | None = None,
    progress: Callable[[str], None] = lambda text: None,
    commit: Callable[[], None] = lambda: None,
) -> Network:
    """Downloads a place, a name or a box, and imports it into a folder, which keeps the answer as its map.

    Args:
        place: the name or the box.
        out: the folder.
        overpass: address of an Overpass server; left out, that of the environment's STUDIO_OVERPASS, or the public one.
        search: address of a Nominatim server; left out, that of STUDIO_NOMINATIM, or the public one.
        progress: is told what is being done.
        commit: as for `take`.

    Raises:
        MapError: nothing or several places have this name, a server does not answer, or as for `take`.
    """
    from studio.road.library import download

    folder.refuse_foreign(out)
    by = download.servers(overpass, search)
    with tempfile.TemporaryDirectory(prefix="studio-map-") as beside:
        source = Path(beside, f"{out.name}.json")
        box = place if isinstance(place, osm.Box) else download.find(place, by=by, target=source, progress=progress).box
        download.download(box, source, by=by, progress=progress)
        try:
            return take(source, out, bbox=download.text(box), progress=progress, commit=commit)
        except MapError as error:
            raise MapError(error.message.replace(str(source), source.name), error.problems) from None


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
    network = load(found.map, bbox=found.bbox, parking_aisles=found.parking_aisles, corrections=corrections, progress=progress)
    check(network)
    progress("writing the folder")
    commit()
    folder.write(network, found.map, out, bbox=found.bbox, parking_aisles=found.parking_aisles, corrections=corrections, made_of=found)
    return replace(network, name=found.name)
