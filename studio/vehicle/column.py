"""A column of parameters: from the names and units of a vehicle's file to the rows of the arrays."""

from functools import cache

import numpy as np

from studio.conventions import GRAVITY
from studio.errors import Problem, ScenarioError
from studio.model import tyre
from studio.model.tyre import Tyre
from studio.model.wheel import SIGMA
from studio.scenario.vehicle import Vehicle
from studio.vehicle.parameter import (
    ARB_F,
    ARB_R,
    AREA,
    BRAKE_MAX,
    BRAKE_SHARE,
    C_D,
    C_FRONT,
    C_REAR,
    C_ROLL,
    CAMBER_F,
    CAMBER_R,
    CAPACITY,
    CLUTCHED,
    CONVERTER,
    COUPLING,
    CURVE,
    CURVE_0,
    D_F,
    D_R,
    D_STEER,
    D_T,
    DELAY_BRAKE,
    DELAY_DRIVE,
    DRAG,
    DRAG_SLOPE,
    DRIVE_SHARE,
    FLUID_1,
    FLUID_2,
    FLUID_3,
    FLUID_RATIO,
    FRONT,
    G_DISENGAGE,
    G_DOWN_FULL,
    G_DOWN_LIGHT,
    G_ENGAGE,
    G_INERTIA,
    G_OPEN,
    G_RATIO,
    G_UP_FULL,
    G_UP_LIGHT,
    GAIN_F,
    GAIN_R,
    GEARBOX,
    GEARS,
    IDLE,
    J_E,
    J_STEER,
    J_WF,
    J_WR,
    J_X,
    J_Y,
    J_Z,
    K_BRAKE,
    K_F,
    K_R,
    K_TF,
    K_TR,
    KNOT,
    L_F,
    L_R,
    LAUNCH,
    LENGTH,
    LIMIT,
    LINK_F,
    LINK_R,
    LOCK_UP,
    LOSS_SHARE,
    LOSS_TORQUE,
    M_UF,
    M_UR,
    MASS,
    MASS_S,
    PARAMETER,
    PUMP_1,
    PUMP_2,
    PUMP_3,
    RADIUS,
    REGEN,
    REST_AF,
    REST_AR,
    REST_DAMPING,
    REST_KF,
    REST_KR,
    RIGID,
    STATIC_F,
    STATIC_R,
    STEER_MAX,
    STEER_RATE,
    STEER_RATIO,
    TAU_BRAKE,
    TAU_DRIVE,
    TAU_STEER,
    TRACK_F,
    TRACK_R,
    TRAIL,
    TURBINE_1,
    TURBINE_2,
    TURBINE_3,
    UNASSISTED,
    WIDTH,
    H,
)  # fmt: skip

SLIDING = 0.95  # part of the peak force at which a contact patch at rest lets go
MOST_LOAD = 2.0  # [1] static load over nominal load
REST_RATIO = 0.5  # damping ratio of a standing car on its contact patches
KINDS = {"rigid": RIGID, "clutch": CLUTCHED, "converter": CONVERTER}
NEVER = 1e9  # a bound that is none


def parameter_rows(vehicle: Vehicle, front: Tyre, rear: Tyre) -> np.ndarray:
    """float64[PARAMETER] of a vehicle on its tyres."""
    p = np.zeros(len(PARAMETER))
    for fill in (body_rows, suspension_rows, load_rows, wheel_rows, steering_rows, brake_rows, engine_rows, coupling_rows):
        fill(p, vehicle)
    rest_rows(p, front, rear)
    p[[LOSS_TORQUE, LOSS_SHARE, DRIVE_SHARE]] = vehicle.gearbox.loss_torque, vehicle.gearbox.loss_share, vehicle.gearbox.front_share
    p[[C_D, AREA]] = vehicle.air.drag_coefficient, vehicle.air.frontal_area
    p[C_FRONT] = -2.0 * tyre.cornering_stiffness(front, 0.0, p[STATIC_F])
    p[C_REAR] = -2.0 * tyre.cornering_stiffness(rear, 0.0, p[STATIC_R])
    return p


def body_rows(p: np.ndarray, vehicle: Vehicle) -> None:
    """Masses and dimensions; the roll and pitch inertias are the body's, the mass and the yaw inertia the vehicle's."""
    b = vehicle.body
    p[MASS], p[MASS_S] = b.mass, b.mass - b.unsprung_mass_front - b.unsprung_mass_rear
    p[[J_X, J_Y, J_Z]] = b.roll_inertia, b.pitch_inertia, b.yaw_inertia
    p[[L_F, L_R, H]] = b.front_distance, b.wheelbase - b.front_distance, b.gravity_height
    p[[TRACK_F, TRACK_R, LENGTH, WIDTH]] = b.front_track, b.rear_track, b.length, b.width
    p[FRONT] = b.front_distance + b.front_overhang
    p[[M_UF, M_UR]] = 0.5 * b.unsprung_mass_front, 0.5 * b.unsprung_mass_rear


def suspension_rows(p: np.ndarray, vehicle: Vehicle) -> None:
    """Springs, dampers, bars as force per difference of travel, camber, links."""
    s = vehicle.suspension
    p[[K_F, K_R, D_F, D_R]] = s.stiffness_front, s.stiffness_rear, s.damping_front, s.damping_rear
    p[[ARB_F, ARB_R]] = s.anti_roll_front / p[TRACK_F] ** 2, s.anti_roll_rear / p[TRACK_R] ** 2
    p[[CAMBER_F, CAMBER_R, GAIN_F, GAIN_R]] = s.camber_front, s.camber_rear, s.camber_gain_front, s.camber_gain_rear


def load_rows(p: np.ndarray, vehicle: Vehicle) -> None:
    """Static loads, and the levers of the links, (m_s h_rc + m_u R)/m of each axle over half the track."""
    s, R, L = vehicle.suspension, vehicle.wheels.radius, p[L_F] + p[L_R]
    for static, link, distance, m_u, h_rc, track in (
        (STATIC_F, LINK_F, L_R, M_UF, s.roll_centre_front, TRACK_F),
        (STATIC_R, LINK_R, L_F, M_UR, s.roll_centre_rear, TRACK_R),
    ):
        m_s = 0.5 * p[MASS_S] * p[distance] / L
        p[static] = (m_s + p[m_u]) * GRAVITY
        p[link] = (m_s * h_rc + p[m_u] * R) / (m_s + p[m_u]) / (0.5 * p[track])


def wheel_rows(p: np.ndarray, vehicle: Vehicle) -> None:
    """Wheels and the vertical side of the tyres."""
    w = vehicle.wheels
    p[[K_TF, K_TR, D_T]] = w.stiffness_front, w.stiffness_rear, w.damping
    p[[RADIUS, J_WF, J_WR, C_ROLL]] = w.radius, w.inertia_front, w.inertia_rear, w.rolling_resistance


def check_tyre(t: Tyre, F_z: float, axle: str) -> None:
    """Refuses a tyre whose formula turns round at the static load of an axle; raises ScenarioError."""
    slips = tyre.slip_stiffness(t, F_z), -tyre.cornering_stiffness(t, 0.0, F_z), tyre.longitudinal_peak(t, F_z, 1.0)
    if F_z > MOST_LOAD * t.LFZO * t.FNOMIN or min(slips) <= 0.0:
        what = f"is not made for the load of a {axle} wheel"
        allowed = f"up to {MOST_LOAD:g} times the nominal load, {MOST_LOAD * t.LFZO * t.FNOMIN:.0f} N, with positive stiffness"
        problem = Problem(f"tyres.{axle}", what, f"{F_z:.0f} N", allowed, "a lighter vehicle, or a stronger tyre")
        raise ScenarioError("The tyres do not carry this vehicle.", [problem])


def rest_rows(p: np.ndarray, front: Tyre, rear: Tyre) -> None:
    """What a contact patch can store at rest, and how it is damped."""
    check_tyre(front, p[STATIC_F], "front")
    check_tyre(rear, p[STATIC_R], "rear")
    p[[REST_KF, REST_AF]] = rest_slips(front, p[STATIC_F])
    p[[REST_KR, REST_AR]] = rest_slips(rear, p[STATIC_R])
    stiffness = tyre.slip_stiffness(front, p[STATIC_F]) / SIGMA
    p[REST_DAMPING] = 2.0 * REST_RATIO * np.sqrt(p[STATIC_F] / GRAVITY / stiffness)


@cache
def rest_slips(t: Tyre, F_z: float) -> tuple[float, float]:
    """Longitudinal slip and side-slip tangent [1] at which a tyre first gives nearly its peak."""
    slips = np.linspace(0.0, 1.0, 1001)
    along = np.array([abs(tyre.longitudinal_pure(t, slip, 0.0, F_z, 1.0)) for slip in slips])
    across = np.array([abs(tyre.lateral_pure(t, slip, 0.0, F_z, 1.0)) for slip in slips])
    first, second = (float(slips[np.argmax(force >= SLIDING * force.max())]) for force in (along, across))
    return first, second


def steering_rows(p: np.ndarray, vehicle: Vehicle) -> None:
    """The rack and its actuator."""
    s = vehicle.steering
    p[[STEER_RATIO, STEER_MAX, STEER_RATE, TAU_STEER]] = s.ratio, s.angle_max, s.rate_max, s.time
    p[[J_STEER, D_STEER, TRAIL, UNASSISTED]] = s.inertia, s.damping, s.caster_trail, 1.0 - s.assistance


def brake_rows(p: np.ndarray, vehicle: Vehicle) -> None:
    """Hydraulics."""
    b = vehicle.brakes
    p[[K_BRAKE, BRAKE_SHARE, BRAKE_MAX]] = b.torque_max / b.pressure_max, b.front_share, b.torque_max
    p[[TAU_BRAKE, DELAY_BRAKE]] = b.time, b.delay


def engine_rows(p: np.ndarray, vehicle: Vehicle) -> None:
    """Engine or motor; the full-load curve as a sum of hinges."""
    e = vehicle.engine
    p[[J_E, IDLE, LIMIT, DRAG, DRAG_SLOPE, REGEN]] = (
        e.inertia, e.idle_speed if e.kind == "combustion" else 0.0, e.limit_speed, e.drag_torque, e.drag_slope, e.regeneration,
    )  # fmt: skip
    p[[TAU_DRIVE, DELAY_DRIVE]] = e.time, e.delay
    p[KNOT] = e.limit_speed / (CURVE - 2)
    p[CURVE_0 : CURVE_0 + CURVE] = hinges(e.speeds, e.torques, p[KNOT])


def hinges(speeds: list[float], torques: list[float], knot: float) -> np.ndarray:
    """A curve as its value at 0 and the changes of its slope at equidistant knots; level beyond the last one."""
    values = np.interp(np.arange(CURVE - 1) * knot, speeds, torques)
    slopes = np.concatenate([np.diff(values) / knot, [0.0]])
    return np.concatenate([values[:1], slopes[:1], np.diff(slopes)])


def coupling_rows(p: np.ndarray, vehicle: Vehicle) -> None:
    """Clutch, converter or shaft."""
    c = vehicle.coupling
    p[CAPACITY] = NEVER if c.kind == "rigid" else c.capacity
    p[[LAUNCH, LOCK_UP, COUPLING, FLUID_RATIO]] = c.launch_speed, c.lock_up_speed, KINDS[c.kind], c.coupling_ratio
    if c.kind == "converter":
        p[[PUMP_1, PUMP_2, PUMP_3]], p[[TURBINE_1, TURBINE_2, TURBINE_3]] = c.pump, c.turbine
        p[[FLUID_1, FLUID_2, FLUID_3]] = c.fluid


def gearbox_rows(vehicle: Vehicle) -> np.ndarray:
    """float64[GEARBOX · GEARS]: the gearbox, gear by gear."""
    g, table = vehicle.gearbox, np.zeros((len(GEARBOX), GEARS))
    forward = slice(2, 2 + len(g.ratios))
    table[G_RATIO, forward] = np.array(g.ratios) * g.final_ratio
    table[G_RATIO, 0] = -g.reverse_ratio * g.final_ratio
    table[G_INERTIA, forward], table[G_INERTIA, 0] = g.inertias, g.reverse_inertia
    for row, times, back in (
        (G_DISENGAGE, g.disengage_times, g.reverse_times[0]),
        (G_OPEN, g.open_times, g.reverse_times[1]),
        (G_ENGAGE, g.engage_times, g.reverse_times[2]),
    ):
        table[row, forward], table[row, 0] = times, back
    for row, speeds in (
        (G_UP_LIGHT, g.up_light), (G_UP_FULL, g.up_full), (G_DOWN_LIGHT, g.down_light), (G_DOWN_FULL, g.down_full),
    ):  # fmt: skip
        table[row, forward] = speeds
    return table.ravel()
