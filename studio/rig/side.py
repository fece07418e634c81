"""Vehicles driven side by side: many open-loop drives in one fleet, so that repetitions and variants cost about as much as one.

    drives = together([Order(model, inputs, speed=20.0), ...])

The inputs are those of `studio drive` (drive.py), as arrays; between two rows they are linear, a gear holds. Vehicles do not know of
each other, and every one of them moves as it would alone, bit by bit.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import ceil

import numpy as np

from studio.scenario.catalogue import VehicleModel
from studio.vehicle import broken, fleet
from studio.vehicle.command import RING, U_APPLIED, U_APPLIED_BRAKE, U_BRAKE, U_ENGINE, U_GEAR, U_PEDAL, U_STEER
from studio.vehicle.contact import SLOPE_X
from studio.vehicle.fleet import Fleet, Start
from studio.vehicle.parameter import BRAKE_MAX, DELAY_BRAKE, DELAY_DRIVE, IDLE, MASS, RADIUS, STEER_RATIO
from studio.vehicle.state import (
    A_X,
    A_Y,
    A_Z,
    ACCELERATOR,
    ALPHA,
    CLUTCH,
    DELTA,
    F_X,
    F_Y,
    F_Z,
    GEAR,
    J_GEAR,
    KAPPA,
    M_Z,
    NEXT_GEAR,
    NEXT_RATIO,
    OMEGA,
    OMEGA_E,
    PITCH,
    PITCH_RATE,
    PRESSURE_F,
    PRESSURE_R,
    PSI,
    RATIO,
    ROLL,
    ROLL_RATE,
    T_ENGINE,
    TORQUE_BRAKE,
    TORQUE_DRIVE,
    TRAVEL,
    V_X,
    V_Y,
    YAW_RATE,
    X,
    Y,
    Z,
)  # fmt: skip

USES_POWERTRAIN = ("throttle", "engine_torque_request_Nm", "gear")
# [1/s] of the difference of speed that is made up, and of its integral, so that no resistance, bend or ramp leaves any. The speed of a
# mass answers with s² + HELD s + HELD KEPT = 0: both poles at HELD/2, which comes back without a swing.
HELD, KEPT = 15.0, 15.0 / 4.0

BODY_COLUMNS = {
    "x_m": X, "y_m": Y, "z_m": Z, "yaw_rad": PSI, "roll_rad": ROLL, "pitch_rad": PITCH, "vx_mps": V_X, "vy_mps": V_Y,
    "yaw_rate_radps": YAW_RATE, "roll_rate_radps": ROLL_RATE, "pitch_rate_radps": PITCH_RATE, "ax_mps2": A_X, "ay_mps2": A_Y,
    "az_mps2": A_Z, "road_wheel_angle_rad": DELTA, "gear": GEAR, "clutch": CLUTCH, "accelerator": ACCELERATOR,
    "engine_speed_radps": OMEGA_E, "engine_torque_Nm": T_ENGINE, "drive_torque_Nm": TORQUE_DRIVE,
    "brake_torque_Nm": TORQUE_BRAKE, "brake_pressure_front_Pa": PRESSURE_F, "brake_pressure_rear_Pa": PRESSURE_R,
}  # fmt: skip
WHEEL_COLUMNS = {
    "Fz_N": F_Z, "Fx_N": F_X, "Fy_N": F_Y, "Mz_Nm": M_Z, "wheel_speed_radps": OMEGA, "slip_ratio": KAPPA,
    "slip_angle_rad": ALPHA, "suspension_travel_m": TRAVEL,
}  # fmt: skip
ROWS = {
    "throttle": U_PEDAL, "gear": U_GEAR, "engine_torque_request_Nm": U_ENGINE, "drive_torque_Nm": U_APPLIED,
    "brake_torque_Nm": U_APPLIED_BRAKE, "road_wheel_angle_rad": U_STEER, "steering_wheel_angle_rad": U_STEER, "brake": U_BRAKE,
}  # fmt: skip


@dataclass(frozen=True)
class Order:
    """One drive: the vehicle, its inputs over time by column, speed at the start [m/s], friction [1] and slope [1] of the road."""

    model: VehicleModel
    inputs: Mapping[str, np.ndarray]
    speed: float = 0.0
    road: Mapping[str, float] = field(default_factory=dict)


def of(orders: Sequence[Order]) -> Fleet:
    """The vehicles on their roads, heading east; in neutral where nobody uses the powertrain."""
    ground = np.concatenate([plane(each.road)[None] for each in orders]).transpose(1, 2, 0).reshape(-1, 4 * len(orders)).copy()
    rig = fleet.fleet([Start(each.model, 0.0, 0.0, 0.0, each.speed) for each in orders], ground=ground)
    for v, each in enumerate(orders):
        if not any(name in each.inputs for name in USES_POWERTRAIN):
            rig.commands[U_GEAR, v :: len(orders)] = 0.0
            rig.state[[GEAR, NEXT_GEAR, RATIO, NEXT_RATIO, J_GEAR], v] = 0.0
            rig.state[OMEGA_E, v] = rig.parameter[IDLE, v]
        elif "gear" in each.inputs:
            fleet.engage(rig, v, int(each.inputs["gear"][0]))
    return rig


def plane(road: Mapping[str, float]) -> np.ndarray:
    """The ground under the four wheels of one vehicle."""
    ground = fleet.level_ground(1, friction=road.get("road.friction", 1.0))
    ground[SLOPE_X] = road.get("road.slope", 0.0)
    return ground


# --- inputs --------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Feed:
    """One input: the columns of the vehicles that have it, what it is at every step [step, vehicle], and, of a speed, the distance [m] that
    each is behind by now."""

    name: str
    vehicles: np.ndarray
    values: np.ndarray
    behind: np.ndarray


def take_delays(rig: Fleet) -> dict[str, np.ndarray]:
    """Dead times [s] of the inputs; the rig looks them up in its table, exactly, so the ring need not hold them."""
    drive, brake = rig.parameter[DELAY_DRIVE].copy(), rig.parameter[DELAY_BRAKE].copy()
    rig.parameter[[DELAY_DRIVE, DELAY_BRAKE]] = 0.0
    return {"throttle": drive, "engine_torque_request_Nm": drive, "brake": brake}


def feeds(rig: Fleet, orders: Sequence[Order], steps: int, step: float) -> list[Feed]:
    """All inputs of all vehicles, step by step, in the units of the commands."""
    delays, time, none = take_delays(rig), np.arange(steps) * step, np.zeros(rig.size)
    found = []
    for name in dict.fromkeys(name for each in orders for name in each.inputs if name != "time_s"):
        vehicles = np.array([v for v, each in enumerate(orders) if name in each.inputs])
        late = delays.get(name, none)
        values = [scaled(rig, name, v, values_at(orders[v].inputs, name, time - late[v])) for v in vehicles.tolist()]
        found.append(Feed(name, vehicles, np.array(values).T.copy(), np.zeros(vehicles.size)))
    return found


def values_at(given: Mapping[str, np.ndarray], name: str, time: np.ndarray) -> np.ndarray:
    """An input at some times: linear between the rows, a gear holds."""
    if name == "gear":
        return given[name][np.maximum(np.searchsorted(given["time_s"], time + 1e-9, side="right") - 1, 0)]
    return np.interp(time, given["time_s"], given[name])


def scaled(rig: Fleet, name: str, v: int, values: np.ndarray) -> np.ndarray:
    """An input as the command that it gives."""
    if name == "steering_wheel_angle_rad":
        return values / rig.parameter[STEER_RATIO, v]
    return values * rig.parameter[BRAKE_MAX, v] if name == "brake" else values


def command(rig: Fleet, given: Sequence[Feed], k: int, step: float) -> None:
    """Writes the inputs that reach the actuators in step k, which takes `step` [s], into their slots of the ring."""
    slot = (k % RING) * rig.size
    for each in given:
        if each.name == "speed_mps":
            rig.commands[U_APPLIED, slot + each.vehicles] = holding(rig, each, k, step)
            continue
        rig.commands[ROWS[each.name], slot + each.vehicles] = each.values[k]
        if each.name == "road_wheel_angle_rad":
            rig.state[DELTA, each.vehicles] = each.values[k]


def holding(rig: Fleet, speed: Feed, k: int, step: float) -> np.ndarray:
    """Torques at the wheels [Nm] that hold a speed; none where nobody holds it, which is said by not a number."""
    v, is_held = speed.vehicles, np.isfinite(speed.values[k])
    slower = np.where(is_held, speed.values[k] - rig.state[V_X, v], 0.0)
    speed.behind[:] = np.where(is_held, speed.behind + slower * step, 0.0)
    return rig.parameter[MASS, v] * rig.parameter[RADIUS, v] * HELD * (slower + KEPT * speed.behind)


# --- the drive -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Outcome:
    """Columns of one drive by name, and the time [s] at which a state was not finite any more, if so, with the quantity."""

    columns: dict[str, np.ndarray]
    broke: float | None = None
    quantity: str = ""


def together(
    orders: Sequence[Order], *, step: float, period: float, progress: Callable[[float], None] = lambda share: None
) -> list[Outcome]:
    """Drives all of them from 0 to the last time of each one's inputs; one that breaks ends there and stops nobody else."""
    rig = of(orders)
    every, lasts = round(period / step), [ceil(each.inputs["time_s"][-1] / step - 1e-6) for each in orders]
    given = feeds(rig, orders, max(lasts), step)
    rows, broke = [sample(rig, 0.0)], {}
    for k in range(max(lasts)):
        command(rig, given, k, step)
        fleet.advance(rig, k, step, step)
        note_broken(rig, broke, k, step)
        if (k + 1) % every == 0:
            rows.append(sample(rig, (k + 1) * step))
            progress((k + 1) / max(lasts))
        if len(broke) == rig.size:
            break
    found = np.array(rows).transpose(2, 1, 0)
    return [outcome(found[v], lasts[v] // every, broke.get(v)) for v in range(rig.size)]


def note_broken(rig: Fleet, broke: dict[int, tuple[float, str]], k: int, step: float) -> None:
    """Keeps when a vehicle broke first, and by what."""
    for v in broken.columns(rig).tolist():
        if v not in broke:
            found = broken.first(rig, v, k=k, tick=step, step=step)
            broke[v] = (k * step + found.after, found.quantity)


def outcome(rows: np.ndarray, last: int, broke: tuple[float, str] | None) -> Outcome:
    """What became of one vehicle, until the end of its own inputs."""
    columns = dict(zip(column_names(), rows[:, : last + 1].copy(), strict=True))
    return Outcome(columns, broke[0], broke[1]) if broke else Outcome(columns)


def column_names() -> list[str]:
    """Columns of a drive."""
    wheels = [f"{name}_{corner}" for name in WHEEL_COLUMNS for corner in (1, 2, 3, 4)]
    return ["time_s", *BODY_COLUMNS, "steering_wheel_angle_rad", *wheels]


def sample(rig: Fleet, time: float) -> np.ndarray:
    """One row of every vehicle, [column, vehicle]."""
    wheels = rig.wheels.copy()
    wheels[ALPHA] = np.arctan(wheels[ALPHA])
    corners = wheels[list(WHEEL_COLUMNS.values())].reshape(-1, rig.size)
    handwheel = rig.state[DELTA] * rig.parameter[STEER_RATIO]
    return np.concatenate([np.full((1, rig.size), time), rig.state[list(BODY_COLUMNS.values())], handwheel[None], corners])
