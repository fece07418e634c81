"""Two cars side by side on a straight road, and an obstacle that is suddenly there: the situation of CELC, with any of its figures.

situation(speed=..., distance=..., latency=...)     →  a scenario
survived(record)                                    →  whether nobody has touched anybody
formula(speed, latency)                             →  the least distance that theory has for it [m]
way_aside(record)                                   →  what A has driven until it is as far aside as the formula wants [m]
least([{...}, ...])                                 →  the least distances at which nobody does, of many situations at once [m]
"""

from typing import Any

import numpy as np

from docs.figures.convoy import run
from studio.execution.record import Record
from studio.model import evasion

WIDTH = 3.75  # [m] of a lane of the motorway
LENGTH, FRONT = 4.261, 2.27  # [m] of the car, and from its reference point to its front bumper
AHEAD = 2.1  # [m] by which A is ahead of B: half a car
APPEARS = 1.0  # [s]
START = 150.0  # [m] station of the last car, or of A
CLEAR = 2.0  # [m] half of two cars' widths and the margin
SIDE_MARGIN = 0.2  # [m] that is kept to each side of the obstacle: it is made wider by that
SURPRISED = {
    "kind": "attentive",
    "surprised_reaction": 1.25,
    "expected_reaction": 0.75,
}  # [s] M. Green, Transportation Human Factors 2 (2000)
AROUND = {"kind": "blind_spot", "forward": -2.0, "left": 0.0, "yaw": 0.0, "opening_angle": 6.28, "range": 60.0, "visible": 0.05,
          "noise": 0.05, "rate_noise": 0.05, "length_noise": 0.05}  # fmt: skip
SENSORS = {
    "front": {"kind": "object_sensor", "range": 150.0, "opening_angle": 1.0, "visible": 0.05},
    "around": AROUND,
    "lane": {"kind": "lane_markings", "noise": 0.01, "heading_noise": 0.001},
    "road": {"kind": "digital_map"},
    "condition": {"kind": "road_condition"},
}


def car(lane: int, along: float, speed: float) -> dict[str, Any]:
    """A car with all that the application wants."""
    place = {"road": "motorway", "lane": lane, "offset": along}
    return {
        "route": "along",
        "model": "electric_compact",
        "position": place,
        "speed": speed,
        "sensors": SENSORS,
        "gps": {"drift": 0.0, "noise": 0.0},
    }


def situation(
    *,
    speed: float,
    distance: float,
    latency: float = 0.02,
    loss: float = 0.0,
    parameters: dict[str, Any] | None = None,
    others: int = 0,
    width: float = 1.8,
    friction: float = 1.0,
    application: bool = True,
    duration: float = 6.0,
    seed: int = 1,
    gap: float = 0.8,
) -> dict[str, Any]:
    """A in the left lane, B beside it, both at `speed` [m/s]; at 1 s an obstacle `width` [m] wide is `distance` [m] before A's bumper.

    `others`: so many followers behind each, `gap` [s] of driving apart; all hear A, or B. The radio needs `latency` [s] from application
    to application.
    """  # fmt: skip
    start = START + others * (LENGTH + gap * speed)
    near = start + FRONT + speed * APPEARS + distance
    vehicles = {"A": car(1, start, speed), "B": car(0, start - AHEAD, speed)}
    for i in range(1, others + 1):
        back = i * (LENGTH + gap * speed)
        vehicles |= {f"behind_A_{i}": car(1, start - back, speed), f"behind_B_{i}": car(0, start - AHEAD - back, speed)}
    if not application:
        vehicles = {name: each | {"driver": SURPRISED} for name, each in vehicles.items()}
    hears = {"A": ["B"], "B": ["A"]} | {name: [name.split("_")[1]] for name in vehicles if "_" in name}
    group = {
        "application": "celc", "units": list(vehicles), "listens_to": [hears[each] for each in vehicles], "cycle": 0.005,
        "parameters": {"width": WIDTH, "recognition": 0.0, "confidence": 0.0} | (parameters or {}),
    }  # fmt: skip
    box = {"kind": "mover", "who": "box", "line": [[near + 0.5, WIDTH]], "route": "along", "length": 1.0, "width": width + 2 * SIDE_MARGIN}
    return {
        "version": 3, "title": "Situation", "map": {"file": "motorway.xodr"}, "clock": {"duration": duration}, "seed": seed,
        "routes": {"along": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": speed}]}},
        "vehicles": vehicles, "applications": {"evasion": group} if application else {},
        "script": {"obstacle": {"when": {"kind": "time", "at": APPEARS}, "do": box}},
        "radio": {"kind": "ad_hoc", "delay": latency, "delay_variation": 0.0, "loss": loss, "bit_rate": 1e8, "buildings": False},
        "weather": {"friction": friction},
    }  # fmt: skip


def survived(record: Record) -> bool:
    """Whether nobody has touched anybody or anything."""
    return not any(each.kind == "collision" for each in record.happenings)


def way_aside(record: Record) -> float:
    """Way [m] that A drives from the moment at which the obstacle is visible until its middle is CLEAR aside, as the formula counts."""
    aside = -record.trace("A.lateral_offset")
    if not np.any(aside >= CLEAR):
        return float("nan")
    k = int(np.argmax(aside >= CLEAR))
    at = np.interp(CLEAR, aside[k - 1 : k + 1], record.time[k - 1 : k + 1])
    station = record.trace("A.station")
    return float(np.interp(at, record.time, station) - np.interp(APPEARS, record.time, station))


def formula(speed: float, latency: float, *, a_y: float = 6.0, b_B: float = 6.0) -> float:
    """Least distance [m] from A's front bumper to the obstacle's near edge, from the moment at which it is visible and recognised."""
    return evasion.cooperative_distance(speed, latency, WIDTH, WIDTH, AHEAD, LENGTH, 1.809, 1.8, a_y, b_B)


def least(cases: list[dict[str, Any]], *, low: float = 0.8, high: float = 1.5, steps: int = 6) -> np.ndarray:
    """By bisection between two multiples of the formula's distance, to (high - low)/2^steps of it; all cases side by side."""
    theory = np.array([formula(each["speed"], each["latency"]) for each in cases])
    below, above = np.full(len(cases), low), np.full(len(cases), high)
    for _ in range(steps):
        middle = 0.5 * (below + above)
        records = run([situation(**each, distance=float(d)) for each, d in zip(cases, middle * theory, strict=True)])
        fine = np.array([survived(record) for record in records])
        below, above = np.where(fine, below, middle), np.where(fine, middle, above)
    return above * theory
