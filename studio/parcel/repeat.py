"""Repeats a packed run, and tells whether the bits are the same, or what differs."""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from studio import job
from studio.errors import Problem, StoreError
from studio.kind import registry
from studio.parcel.pack import KINDS, RUN, SCENARIO
from studio.provenance import used as kinds_of
from studio.provenance import version_with, versions


@dataclass(frozen=True)
class Repeated:
    """Whether the state at the end has the same bits; what of the environment differs, by name (then, now); metrics that differ."""

    is_same: bool
    expected: str
    found: str
    environment: dict[str, tuple[str, str]]
    metrics: dict[str, tuple[float | None, float | None]]

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


def repeat(folder: Path, progress: Callable[[float], None] = lambda share: None) -> Repeated:
    """Runs what lies in a folder that `pack` has made, with its own kinds.

    Raises StoreError for a folder that is none, and what a run raises.
    """
    told = told_by(folder)
    if (folder / KINDS).is_dir():
        registry.load_folder(folder / KINDS)
    loaded = job.load(folder / SCENARIO)
    run = job.run(loaded, seed=told["seed"], progress=progress)
    now = {name: each.value for name, each in run.metrics.items()}
    then = {name: each["value"] for name, each in told["metrics"].items()}
    return Repeated(
        is_same=run.state_hash == told["state_hash"],
        expected=told["state_hash"],
        found=run.state_hash,
        environment=differing({"studio": told["code_version"]} | told["versions"], {"studio": version_now(loaded)} | versions()),
        metrics=differing(then, now),
    )


def told_by(folder: Path) -> dict[str, Any]:
    """What a parcel says of its run; raises StoreError."""
    try:
        told = json.loads((folder / RUN).read_text(encoding="utf-8"))
        if {"seed", "state_hash", "code_version", "versions", "metrics"} <= told.keys():
            return told
        what = "does not say what a run is"
    except (OSError, ValueError, AttributeError) as error:
        what = f"cannot be read: {error}"
    raise StoreError(
        f"{folder} holds no packed run.", [Problem(str(folder / RUN), what, remedy="name a folder that `studio pack` has made")]
    )


def version_now(loaded: job.Loaded) -> str:
    """The version of all code that runs a scenario here."""
    return version_with(tuple(kinds_of(loaded.scenario)))


def differing(then: dict[str, Any], now: dict[str, Any]) -> dict[str, tuple[Any, Any]]:
    """What is not the same, by name: what it was, what it is."""
    return {name: (then.get(name), now.get(name)) for name in {**then, **now} if then.get(name) != now.get(name)}
