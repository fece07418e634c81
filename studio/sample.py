"""The samples: scenarios that run as they are, with their maps.

In a checkout they are its folder `scenarios`; an installed package brings a copy of that folder.
"""

import shutil
from pathlib import Path

PACKAGED = Path(__file__).resolve().parent / "_scenarios"
TOWN = "urban_grid.osm"
FIRST = "grosser_stern_platoon"


def folder() -> Path:
    """The folder of the samples; of an installed package nobody writes there."""
    return PACKAGED if PACKAGED.is_dir() else PACKAGED.parent.parent / "scenarios"


def files() -> list[Path]:
    """The samples, the one that a newcomer sees first in front."""
    return sorted(folder().glob("*.yaml"), key=lambda path: (path.stem != FIRST, path.stem))


def copy_to(own: Path) -> None:
    """Copies the samples with their maps to a folder; what is there already stays as it is. Raises OSError."""
    shutil.copytree(folder(), own, dirs_exist_ok=True, copy_function=copy_new)


def copy_new(source: str, target: str) -> None:
    """Copies a file to where there is none."""
    if not Path(target).exists():
        shutil.copyfile(source, target)


def first() -> Path:
    """The sample that everything is shown with."""
    return folder() / f"{FIRST}.yaml"


def town() -> Path:
    """The map of a town."""
    return folder() / "maps" / TOWN
