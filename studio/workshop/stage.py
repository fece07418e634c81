"""A stage: a small world on the motorway that is drawn for it, where what cannot be tried alone is tried."""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from studio import job
from studio.conventions import DEFAULT_TICK
from studio.execution.simulation import Simulation, simulation
from studio.kind import registry
from studio.road.drawn.motorway import motorway
from studio.workshop import draw

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
    """A stage with a script of every condition and maneuver that comes with the studio, with drawn settings; a maneuver at every tick."""
    seed = np.random.default_rng(1)
    brake = {"kind": "brake", "vehicle": "far", "deceleration": 1.0, "duration": 0.1}
    script: dict[str, Any] = {"first": {"when": {"kind": "time", "at": 0.0}, "do": brake}}
    begun: list[str] = []
    for kind in [each for each in registry.every() if each.is_built_in and each.sort in ("condition", "action")]:
        chosen = {"kind": kind.name} | draw.settings(kind.module.Settings, seed).model_dump(mode="json")
        if kind.sort == "condition":
            script[kind.name] = {"when": chosen, "do": brake}
        elif hasattr(kind.module, "act"):
            script[kind.name] = {"when": {"kind": "time", "at": DEFAULT_TICK * len(begun)}, "do": chosen}
            begun.append(kind.name)
    return stage(script=script)


def vehicle(lane: int, along: float) -> dict[str, Any]:
    """A car on a lane of the motorway, at a station [m], without sensors."""
    return {"route": "along", "position": {"road": "motorway", "lane": lane, "offset": along}, "speed": 25.0, "sensors": {}}
