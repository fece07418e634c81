"""Maps: roads, signals, scenery, and the paths that vehicles drive on them."""

from typing import Any

NAMES = {"Network": "studio.road.network", "load": "studio.road.library.place"}

__all__ = ["Network", "load"]


def __getattr__(name: str) -> Any:
    """The public names, imported when first used: the files of this room import each other, not all of it."""
    if name not in NAMES:
        raise AttributeError(f"module 'studio.road' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(NAMES[name]), name)
