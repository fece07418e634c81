"""Cooperative ADAS Studio: set up, run, assess and tune cooperative driver assistance.

>>> import studio
>>> scenario = studio.load("scenarios/grosser_stern_platoon.yaml")
>>> run = studio.run(scenario, seed=1)
>>> run.metrics["min_ttc"].value, run.trace("follower_1.speed"), run.time
>>> drive = studio.drive("bmw_320i", {"time_s": [0, 10], "throttle": [1, 1]})
>>> drive["vx_mps"].max()
"""

from typing import Any

NAMES = {
    "load": "studio.job",
    "run": "studio.job",
    "drive": "studio.rig.drive",
    "open_runs": "studio.store.runs",
    "connect": "studio.remote",
    "StudioError": "studio.errors",
}

__all__ = ["StudioError", "connect", "drive", "load", "open_runs", "run"]


def __getattr__(name: str) -> Any:
    """The public names, imported when first used: `studio --help` need not wait for the compiler."""
    if name not in NAMES:
        raise AttributeError(f"module 'studio' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(NAMES[name]), name)
