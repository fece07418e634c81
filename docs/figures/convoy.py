"""A leader whose speed swings, and cars that follow it on a straight motorway: gains from car to car, on whole vehicles.

run([convoy(...), ...])        →  Record, ...       side by side
gain(record, frequency)        →  complex[hop]      A_i/A_{i-1} at the frequency that was driven
"""

import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from studio import job
from studio.execution.loop import as_fast_as_possible
from studio.execution.record import Record
from studio.execution.simulation import simulation
from studio.road.drawn.motorway import motorway

SPEED = 22.0  # [m/s] mean of the leader
SWING, WIDEST = 1.0, 3.0  # [m/s²] amplitude of its acceleration, [m/s] of its speed at most
DURATION = 110.0  # [s]; what is measured are the whole periods in its second half
EXACT = {"kind": "front_radar", "range_noise": 0.0, "rate_noise": 0.0}
SATELLITES = {"drift": 0.0, "noise": 0.0}
LINK = {"kind": "ad_hoc", "delay": 0.0, "delay_variation": 0.0, "loss": 0.0, "bit_rate": 1e10}
MODEL, LENGTH = "electric_compact", 4.261  # [m]


def swing(frequency: float) -> list[list[float]]:
    """Speeds of the leader [s, m/s]: a sine of a frequency [Hz]."""
    time, omega = np.arange(0.0, DURATION + 0.01, 0.05), 2.0 * np.pi * frequency
    return np.round(np.column_stack([time, SPEED + min(SWING / omega, WIDEST) * np.sin(omega * time)]), 6).tolist()


def convoy(
    application: str,
    points: list[list[float]],
    *,
    gap: float,
    cars: int = 2,
    parameters: dict[str, Any] | None = None,
    listens: list[Any] | None = None,
    radio: dict[str, Any] | None = None,
    period: float = 0.02,
    noisy: bool = False,
    script: dict[str, Any] | None = None,
    seed: int = 1,
) -> dict[str, Any]:
    """A scenario: cars `gap` [m] apart behind a leader that drives the points [s, m/s]; messages every `period` [s]."""
    names = [f"car_{i}" for i in range(cars)]
    one = {"route": "along", "model": MODEL, "speed": points[0][1]} | ({} if noisy else {"sensors": {"front": EXACT}, "gps": SATELLITES})
    places = {name: {"road": "motorway", "lane": 0, "offset": 100.0 + (cars - 1 - i) * (gap + LENGTH)} for i, name in enumerate(names)}
    group = {"application": application, "units": names[1:], "listens_to": listens or names[:-1], "parameters": parameters or {}}
    leader = {"do": {"kind": "speed_profile", "vehicle": "car_0", "points": points}}
    return {
        "version": 3,
        "title": "Convoy",
        "map": {"file": "motorway.xodr"},
        "clock": {"duration": round(points[-1][0] // 0.1 * 0.1, 6)},
        "seed": seed,
        "routes": {"along": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 40}]}},
        "vehicles": {name: one | {"position": places[name]} for name in names},
        "applications": {"platoon": group},
        "script": {"leader": leader} | (script or {}),
        "radio": LINK | (radio or {}),
        "messages": {"awareness": {"period": period}},
    }


def heard(application: str, cars: int) -> list[Any]:
    """Whom each follower listens to, as its law wants it."""
    names = [f"car_{i}" for i in range(cars)]
    if application == "cacc_leader":
        return [names[0], *([names[i - 1], names[0]] for i in range(2, cars))]
    if application == "cacc_consensus":
        return [names[max(i - 3, 0) : i][::-1] + ([names[0]] if i > 3 else []) for i in range(1, cars)]
    return names[:-1]


def way(document: dict[str, Any]) -> float:
    """How far [m] on the road the first car will come, at the mean speed of most of these scenarios."""
    first = max(each["position"]["offset"] for each in document["vehicles"].values())
    return first + SPEED * document["clock"]["duration"]


def run(documents: list[dict[str, Any]], *, lanes: int = 2) -> list[Record]:
    """The records of scenarios that are run side by side, on a road with so many lanes each way."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        longest = float(max(map(way, documents)))
        (folder / "motorway.xodr").write_text(motorway(length=longest + 2500.0, lanes=lanes, radius=20_000.0), encoding="utf-8")
        prepared = []
        for i, document in enumerate(documents):
            (folder / f"{i}.yaml").write_text(json.dumps(document, default=float), encoding="utf-8")
            prepared.append(job.prepare(job.load(folder / f"{i}.yaml")))
        running = simulation(*prepared)
        as_fast_as_possible(running)
    for case in running.cases:
        assert case.status == "done", case.error
    return [running.record(i) for i in range(len(documents))]


def settled(time: np.ndarray, frequency: float) -> np.ndarray:
    """Which times [s] are measured."""
    return time > time[-1] - int(0.5 * DURATION * frequency) / frequency - 1e-9


def lines(record: Record, channel: str, frequency: float) -> np.ndarray:
    """Complex amplitude of a channel of every vehicle at a frequency [Hz], over the last whole periods."""
    kept = settled(record.time, frequency)
    turning = np.exp(-2j * np.pi * frequency * record.time[kept])
    return np.array([2.0 * np.mean(record.trace(f"{name}.{channel}")[kept] * turning) for name in record.vehicles])


def gain(record: Record, frequency: float) -> np.ndarray:
    """From car to car."""
    speed = lines(record, "speed", frequency)
    return speed[1:] / speed[:-1]
