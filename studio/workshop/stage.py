"""A stage: a small world on the motorway that is drawn for it, where what cannot be tried alone is tried."""

import tempfile
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from studio import job
from studio.conventions import DEFAULT_TICK
from studio.execution.simulation import Simulation, simulation
from studio.kind import registry
from studio.kind.registry import Kind
from studio.kind.settings import named
from studio.road.drawn.motorway import motorway
from studio.workshop import draw
from studio.workshop.chatter import chatter

CARS = {"own": (1, 300.0), "ahead": (1, 335.0), "beside": (0, 312.0), "other": (2, 322.0), "behind": (1, 265.0), "far": (1, 420.0)}
SCENARIO = {
    "version": 3,
    "title": "Stage",
    "map": {"file": "motorway.xodr"},
    "clock": {"duration": 60},
    "routes": {"along": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 25}]}},
}


def stage(**parts: Any) -> Simulation:
    """A run at its start: `own` and five cars around it. Parts of the scenario are put over it, and into its vehicles by name."""
    vehicles = {name: vehicle(lane, along) for name, (lane, along) in CARS.items()}
    for name, part in parts.pop("vehicles", {}).items():
        vehicles[name] |= part
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "motorway.xodr").write_text(motorway(), encoding="utf-8")
        path = Path(folder) / "stage.yaml"
        path.write_text(yaml.safe_dump(SCENARIO | {"vehicles": vehicles} | parts, allow_unicode=True), encoding="utf-8")
        return simulation(job.prepare(job.load(path)))


def everything() -> Simulation:
    """A stage with every condition, maneuver, sensor, message and radio that comes with the studio; a maneuver at every tick.

    The car behind is light.
    """
    seed = np.random.default_rng(1)
    brake = {"kind": "brake", "vehicle": "far", "deceleration": 1.0, "duration": 0.1}
    script: dict[str, Any] = {"first": {"when": {"kind": "time", "at": 0.0}, "do": brake}}
    begun: list[str] = []
    for kind in [each for each in registry.every() if each.sort in ("condition", "action") and has_place(each)]:
        chosen = {"kind": kind.name} | draw.settings(kind.module.Settings, seed).model_dump(mode="json")
        if kind.sort == "condition":
            script[kind.name] = {"when": chosen, "do": brake}
        elif hasattr(kind.module, "act"):
            script[kind.name] = {"when": {"kind": "time", "at": DEFAULT_TICK * len(begun)}, "do": chosen}
            begun.append(kind.name)
    with chatter() as name:
        talks = {"all": {"application": name, "units": ["own", "far"]}}
        vehicles = {"own": {"sensors": one_each("sensor")}, "behind": {"dynamics": "light"}}
        return stage(script=script, vehicles=vehicles, applications=talks, radios=in_turn())


def has_place(kind: Kind) -> bool:
    """Whether a kind comes with the studio, and needs no lights, of which the motorway has none."""
    return kind.is_built_in and all(named(field) != "signal" for field in kind.module.Settings.model_fields.values())


def one_each(sort: str) -> dict[str, Any]:
    """One of every kind that comes with the studio, by its name."""
    return {kind.name: {"kind": kind.name} for kind in registry.known(sort).values() if kind.is_built_in}


def in_turn() -> dict[str, Any]:
    """A radio for every kind of message, each of them in turn."""
    messages = [kind.name for kind in registry.known("message").values() if kind.is_built_in]
    return dict(zip(messages, cycle(one_each("radio").values()), strict=False))


def vehicle(lane: int, along: float) -> dict[str, Any]:
    """A car on a lane of the motorway, at a station [m], without sensors."""
    return {"route": "along", "position": {"road": "motorway", "lane": lane, "offset": along}, "speed": 25.0, "sensors": {}}
