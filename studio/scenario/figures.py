"""Figures that follow from a vehicle's values, by which an engineer sees whether it is plausible."""

from collections.abc import Iterator
from math import pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from studio.conventions import AIR_DENSITY, GRAVITY
from studio.model.engine import TAPER
from studio.scenario.vehicle import Engine, Vehicle

RESERVE = 0.92  # [1] of the wheels' lock that a line may ask for
FASTEST = 120.0  # [m/s] that is looked at


class Figure(NamedTuple):
    """One figure: its name, what it is, value and unit."""

    name: str
    title: str
    value: float
    unit: str


def figures(values: Vehicle) -> Iterator[Figure]:
    """All figures of a vehicle; the stall speed only of one with a converter."""
    power, speed = peak_power(values.engine)
    yield Figure("power", "Greatest power", power, "W")
    yield Figure("power_speed", "Engine speed at the greatest power", speed, "rad/s")
    yield Figure("top_speed", "Top speed in the flat", top_speed(values), "m/s")
    if values.coupling.kind == "converter":
        yield Figure("stall_speed", "Engine speed at full load, the car held", stall_speed(values), "rad/s")
    for axle, (frequency, damping) in ride(values).items():
        yield Figure(f"body_frequency_{axle}", f"Natural frequency of the body on its springs, {axle}", frequency, "Hz")
        yield Figure(f"body_damping_{axle}", f"Damping ratio of the body on its springs, {axle}", damping, "1")
    yield Figure("roll_gradient", "Roll over lateral acceleration", roll_gradient(values), "rad s²/m")


def drive(values: Vehicle) -> str:
    """Which wheels are driven: front, rear or all."""
    return {0.0: "rear", 1.0: "front"}.get(values.gearbox.front_share, "all")


def peak_power(engine: Engine) -> tuple[float, float]:
    """Greatest power [W] on the full-load curve below the rev limit, and its speed [rad/s]."""
    w = np.linspace(0.0, min(engine.speeds[-1], engine.limit_speed), 2001)
    P = w * np.interp(w, engine.speeds, engine.torques)
    best = int(np.argmax(P))
    return float(P[best]), float(w[best])


def top_speed(values: Vehicle) -> float:
    """Greatest speed [m/s] at which some gear still gives what air and rolling resistance take, coupling closed; the gearbox may be slow to
    choose it. T_full i (1 - s_loss)/R >= rho c_d A v²/2 + c_roll m g, with T_full less what the gearbox takes without load."""
    engine, box, R = values.engine, values.gearbox, values.wheels.radius
    v = np.linspace(0.0, FASTEST, 12_001)
    resistance = 0.5 * AIR_DENSITY * values.air.drag_coefficient * values.air.frontal_area * v * v
    resistance += values.wheels.rolling_resistance * values.body.mass * GRAVITY
    i = np.array(box.ratios)[:, None] * box.final_ratio
    T = full_load(engine, i * v / R) * (1.0 - box.loss_share) - box.loss_torque
    return float(v[np.flatnonzero((T * i / R >= resistance).any(axis=0))[-1:]].sum())


def full_load(engine: Engine, w: np.ndarray) -> np.ndarray:
    """Greatest torque [Nm] at speeds [rad/s]: the curve, faded to the drag at the rev limit."""
    T_drag = -(engine.drag_torque + engine.drag_slope * w)
    share = np.clip((engine.limit_speed - w) / (TAPER * engine.limit_speed), 0.0, 1.0)
    return T_drag + (np.interp(w, engine.speeds, engine.torques) - T_drag) * share


def stall_speed(values: Vehicle) -> float:
    """Speed [rad/s] at which a converter with standing turbine takes all of the engine's full-load torque; 0 without one."""
    if values.coupling.kind != "converter":
        return 0.0
    w = np.linspace(0.0, values.engine.limit_speed, 20001)
    surplus = np.interp(w, values.engine.speeds, values.engine.torques) - values.coupling.pump[0] * w * w
    return float(w[np.flatnonzero(surplus > 0.0)[-1]])


def ride(values: Vehicle) -> dict[str, tuple[float, float]]:
    """Natural frequency [Hz] and damping ratio [1] of the body on its springs, front and rear: D = d/(2 sqrt(k m))."""
    body, springs = values.body, values.suspension
    m_front, m_rear = axle_loads(values)
    m_f, m_r = 0.5 * (m_front - body.unsprung_mass_front), 0.5 * (m_rear - body.unsprung_mass_rear)
    return {
        "front": oscillation(m_f, springs.stiffness_front, springs.damping_front),
        "rear": oscillation(m_r, springs.stiffness_rear, springs.damping_rear),
    }


def oscillation(m: float, k: float, d: float) -> tuple[float, float]:
    """Natural frequency [Hz] and damping ratio [1] of a mass [kg] on a spring [N/m] and a damper [N s/m]."""
    return sqrt(k / m) / (2.0 * pi), d / (2.0 * sqrt(k * m))


def axle_loads(values: Vehicle) -> tuple[float, float]:
    """Masses [kg] that stand on the front and on the rear axle."""
    rear = values.body.mass * values.body.front_distance / values.body.wheelbase
    return values.body.mass - rear, rear


def lock(values: Vehicle) -> float:
    """The sharpest curve [1/m] that the middle of the front axle is driven along, by sin delta/L, with a reserve to steer with."""
    return RESERVE * sin(min(values.steering.angle_max, 0.5 * pi)) / values.body.wheelbase


def roll_gradient(values: Vehicle) -> float:
    """Body roll over lateral acceleration [rad s²/m], steady state, springs and tyres in series."""
    body, springs, wheels = values.body, values.suspension, values.wheels
    front = series(springs.stiffness_front, springs.anti_roll_front, wheels.stiffness_front, body.front_track)
    rear = series(springs.stiffness_rear, springs.anti_roll_rear, wheels.stiffness_rear, body.rear_track)
    share = body.front_distance / body.wheelbase
    axis = (1.0 - share) * springs.roll_centre_front + share * springs.roll_centre_rear
    unsprung = body.unsprung_mass_front + body.unsprung_mass_rear
    sprung = body.mass - unsprung
    arm = (body.mass * body.gravity_height - unsprung * wheels.radius) / sprung - axis
    return sprung * arm / (front + rear - sprung * GRAVITY * arm)


def series(k: float, bar: float, tyre: float, track: float) -> float:
    """Roll stiffness [Nm/rad] of an axle: springs and bar, in series with the tyres."""
    suspension, tyres = 0.5 * k * track**2 + bar, 0.5 * tyre * track**2
    return suspension * tyres / (suspension + tyres)
