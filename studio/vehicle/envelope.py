"""What a light vehicle is, made of the same vehicle's full parameters: its drive, its adhesion, and how fast it takes up a bend.

Its drive has no gears. At every speed it gives what engine and gearbox would at full pedal: in the gear that the schedule has then, through
the losses, with a slipping clutch or a converter at low speeds, less what speeds up the engine itself. Where a clutch opens for a shift
the time without drive is spread over the speeds of the gear that comes in. Backwards it is that of the reverse gear.

    F(v) = (eta T - T_loss) i/R · m_light/m_full(gear) · t/(t + t_shift),      t = ∫ m/F dv over the gear
"""

from collections.abc import Iterator
from functools import cache

import numpy as np

from studio.model import adhesion, helm, tyre
from studio.model.tyre import Tyre
from studio.vehicle.light import (
    ACROSS,
    ALONG,
    BACKWARDS,
    EFFECTIVE_MASS,
    FORCE_0,
    KNOT_SPEED,
    KNOTS,
    LIGHT,
    REAR_SLIP,
    TRACTION,
    UNDERSTEER,
    YAW_TIME,
)  # fmt: skip
from studio.vehicle.parameter import (
    C_FRONT,
    C_REAR,
    CLUTCHED,
    CONVERTER,
    COUPLING,
    CURVE,
    CURVE_0,
    DRAG,
    DRAG_SLOPE,
    DRIVE_SHARE,
    FLUID_1,
    FLUID_2,
    FLUID_3,
    FLUID_RATIO,
    G_DISENGAGE,
    G_ENGAGE,
    G_INERTIA,
    G_OPEN,
    G_RATIO,
    G_UP_FULL,
    GEARS,
    IDLE,
    J_E,
    J_WF,
    J_WR,
    J_Z,
    KNOT,
    L_F,
    L_R,
    LAUNCH,
    LIMIT,
    LOCK_UP,
    LOSS_SHARE,
    LOSS_TORQUE,
    MASS,
    PUMP_1,
    PUMP_2,
    PUMP_3,
    RADIUS,
    REGEN,
    STATIC_F,
    STATIC_R,
    TURBINE_1,
    TURBINE_2,
    TURBINE_3,
)  # fmt: skip

FINE = 0.1  # [m/s] at which the drive is looked at
TURNING = (J_E, IDLE, DRAG, DRAG_SLOPE, REGEN)  # of an engine that a light vehicle has not
FIRST, REVERSE = 2, 0  # places of gears


def bare_rows(p: np.ndarray) -> np.ndarray:
    """float64[PARAMETER] of the same vehicle without an engine that turns, and with a clutch that never closes."""
    bare = p.copy()
    bare[list(TURNING)], bare[COUPLING] = 0.0, CLUTCHED
    return bare


def light_rows(p: np.ndarray, gears: np.ndarray, front: Tyre, rear: Tyre) -> np.ndarray:
    """float64[LIGHT] of a vehicle with these parameters and gears on these tyres."""
    made, L = np.zeros(len(LIGHT)), p[L_F] + p[L_R]
    box = gears.reshape(-1, GEARS)
    made[EFFECTIVE_MASS] = rolling_mass(p)
    made[REAR_SLIP] = helm.compliance(p[MASS], p[L_F], L, p[C_REAR])
    made[UNDERSTEER] = helm.compliance(p[MASS], p[L_R], L, p[C_FRONT]) - made[REAR_SLIP]
    made[YAW_TIME] = np.sqrt(p[MASS] * p[J_Z] / (p[C_FRONT] * p[C_REAR])) / L
    loads, share = np.array([p[STATIC_F], p[STATIC_R]]), np.array([p[DRIVE_SHARE], 1.0 - p[DRIVE_SHARE]])
    peaks = np.array([[peak(t, F_z, 1.0) for t, F_z in zip((front, rear), loads, strict=True)] for peak in PEAKS])
    made[[ALONG, ACROSS]] = peaks.sum(axis=1) / loads.sum()
    made[TRACTION] = min(1.0, *(loads[share > 0.0] / share[share > 0.0] / loads.sum()))
    made[FORCE_0 : FORCE_0 + KNOTS] = at_knots(np.maximum.reduce(list(forwards(p, box))))
    made[BACKWARDS] = in_gear(p, box, REVERSE)[0]
    return made


PEAKS = tyre.longitudinal_peak, adhesion.lateral_peak  # [N] of a wheel at a load [N] and a friction [1]


# -- the drive -------------------------------------------------------------------------------------


def rolling_mass(p: np.ndarray) -> float:
    """Mass [kg] with the wheels, which turn."""
    return p[MASS] + 2.0 * (p[J_WF] + p[J_WR]) / p[RADIUS] ** 2


@cache
def speeds() -> np.ndarray:
    """Speeds [m/s] at which the drive is looked at."""
    return np.arange(0.0, KNOTS * KNOT_SPEED, FINE)


def at_knots(F: np.ndarray) -> np.ndarray:
    """Force [N] at the knots: the mean of all speeds that are nearer to this knot than to another."""
    nearest = np.minimum(np.rint(speeds() / KNOT_SPEED), KNOTS - 1).astype(int)
    return np.bincount(nearest, F, KNOTS) / np.bincount(nearest, minlength=KNOTS)


def forwards(p: np.ndarray, box: np.ndarray) -> Iterator[np.ndarray]:
    """Force [N] over `speeds`, gear by gear, while the schedule has it at full pedal; 0 elsewhere."""
    below, v = 0.0, speeds()
    count = int(np.count_nonzero(box[G_RATIO, FIRST:]))
    for gear in range(FIRST, FIRST + count):
        is_last = gear == FIRST + count - 1
        above = np.inf if is_last else box[G_UP_FULL, gear] * p[RADIUS] / box[G_RATIO, gear]
        F = np.where((v >= below) & (v < above), in_gear(p, box, gear), 0.0)
        yield F * (interrupted(F, p, box, gear) if gear > FIRST and p[COUPLING] == CLUTCHED else 1.0)
        below = above


def interrupted(F: np.ndarray, p: np.ndarray, box: np.ndarray, gear: int) -> float:
    """t/(t + t_shift) [1] of a gear that gives these forces [N]."""
    without = box[G_DISENGAGE, gear - 1] + box[G_OPEN, gear] + 0.5 * box[G_ENGAGE, gear]
    t = (p[MASS] * FINE / F[F > 0.0]).sum()
    return float(t / (t + without)) if t else 1.0


def in_gear(p: np.ndarray, box: np.ndarray, gear: int) -> np.ndarray:
    """Force [N] over `speeds` at full pedal in a gear, as of a vehicle in which nothing turns but its wheels; at most to the rev limit."""
    i = abs(box[G_RATIO, gear])
    w = i * speeds() / p[RADIUS]
    T, slips = engine_side(p, w)
    F = (T * (1.0 - p[LOSS_SHARE]) - p[LOSS_TORQUE]) * i / p[RADIUS]
    turning = (np.where(slips, 0.0, p[J_E]) + box[G_INERTIA, gear]) * i**2 / p[RADIUS] ** 2
    return np.where(w <= p[LIMIT], np.maximum(F, 0.0) * rolling_mass(p) / (rolling_mass(p) + turning), 0.0)


def engine_side(p: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Torque [Nm] at the gearbox's input at full pedal and these speeds [rad/s] there, and where the coupling slips."""
    if p[COUPLING] == CONVERTER:
        return converted(p, w)
    least = p[LAUNCH] if p[COUPLING] == CLUTCHED else 0.0
    return full_curve(p, np.maximum(w, least)), w < least


def converted(p: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same behind a converter: the engine turns as fast as its pump lets it, until the lock-up closes."""
    w_e = np.linspace(1.0, p[LIMIT], 400)[:, None]
    is_fluid = w > p[FLUID_RATIO] * w_e
    pump = np.where(is_fluid, square(p[[FLUID_1, FLUID_2, FLUID_3]], w_e, w), square(p[[PUMP_1, PUMP_2, PUMP_3]], w_e, w))
    turbine = np.where(is_fluid, pump, square(p[[TURBINE_1, TURBINE_2, TURBINE_3]], w_e, w))
    spare = full_curve(p, w_e) - pump
    there = np.argmin(np.abs(spare), axis=0)
    locks = (w > p[LOCK_UP]) & (w > p[FLUID_RATIO] * w_e[there, 0])
    return np.where(locks, full_curve(p, w), turbine[there, np.arange(w.size)]), ~locks


def square(factors: np.ndarray, w_e: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Torque [Nm] of a converter with these factors at speeds [rad/s] of pump and turbine."""
    return factors[0] * w_e**2 + factors[1] * w_e * w + factors[2] * w**2


def full_curve(p: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Full-load torque [Nm] at engine speeds [rad/s]."""
    hinges = np.maximum(w[..., None] - np.arange(CURVE - 1) * p[KNOT], 0.0)
    return p[CURVE_0] + hinges @ p[CURVE_0 + 1 : CURVE_0 + CURVE]
