"""The readers: every kind of map has one, a file of this room with

ENDINGS                            of its files
attribution(path), licence(path)   who made the map, and what others may do with it
read(path)                         the content of a file, checked
part(path, wish)                   the part that is asked for, by its value
plan(path, data, part, progress)   lanes, scenery and signals of that part
"""

from pathlib import Path
from typing import Any

from studio.errors import MapError
from studio.road.assembly import extract
from studio.road.opendrive import map as opendrive

READERS = (extract, opendrive)
ENDINGS = tuple(ending for reader in READERS for ending in reader.ENDINGS)


def ending_of(path: Path) -> str:
    """The ending that tells a map's kind.

    >>> ending_of(Path("some.place.osm.gz"))
    '.osm.gz'

    Raises:
        MapError: no kind of map ends so.
    """
    found = next((each for each in ENDINGS if path.name.lower().endswith(each)), None)
    if found is None:
        raise MapError(f"{path}: not a kind of map that can be read; allowed: {', '.join(ENDINGS)}")
    return found


def reader_of(path: Path) -> Any:
    """The reader of a map's kind; raises MapError, also for what is no file, like a pipe that nobody writes into."""
    if path.exists() and not path.is_file():
        raise MapError(f"{path}: the map file cannot be read (it is no file)")
    ending = ending_of(path)
    return next(reader for reader in READERS if ending in reader.ENDINGS)
