"""The vehicle without driving it: what its parameters and tyres say in closed form, for small angles.

Quantities "per a_y" are those of a steady bend, divided by its lateral acceleration.
"""

from typing import NamedTuple

import numpy as np

from studio.conventions import GRAVITY
from studio.model import tyre
from studio.model.tyre import Tyre
from studio.model.wheel import SIGMA
from studio.vehicle import fleet
from studio.vehicle.parameter import (
    ARB_F,
    ARB_R,
    CAMBER_F,
    CAMBER_R,
    GAIN_F,
    GAIN_R,
    J_Z,
    K_F,
    K_R,
    K_TF,
    K_TR,
    L_F,
    L_R,
    LINK_F,
    LINK_R,
    M_UF,
    M_UR,
    MASS,
    RADIUS,
    STATIC_F,
    STATIC_R,
    TRACK_F,
    TRACK_R,
    H,
)  # fmt: skip

SMALL = 1e-5  # [1] slip or camber, [relative] load of a finite difference


class Axle(NamedTuple):
    """One axle: x [m] ahead of the centre of gravity; share of the lateral force; the parameters of its corners."""

    x: float
    share: float
    track: float
    k: float
    bar: float
    k_t: float
    link: float
    static: float
    camber: float
    gain: float
    m_u: float
    tyre: Tyre


def axles(ground, v=0) -> tuple[Axle, Axle]:
    """Front and rear axle of a car on the proving ground."""
    p = ground.parameter[:, v]
    L = p[L_F] + p[L_R]
    front = [p[row] for row in (TRACK_F, K_F, ARB_F, K_TF, LINK_F, STATIC_F, CAMBER_F, GAIN_F, M_UF)]
    rear = [p[row] for row in (TRACK_R, K_R, ARB_R, K_TR, LINK_R, STATIC_R, CAMBER_R, GAIN_R, M_UR)]
    tyres = fleet.tyres_of(ground.models[v])
    return Axle(p[L_F], p[L_R] / L, *front, tyres[0]), Axle(-p[L_R], p[L_F] / L, *rear, tyres[1])


# --- roll ----------------------------------------------------------------------------------------------------------------
#
# x = x_left - x_right: difference of travel; dF = F_left - F_right: of load; F_y: of an axle. The body rolls by phi:
#     dF = c x - link F_y,  c = k + 2 k_a          springs, bar, links
#     x  = -phi T - dF/k_t                         the tyres give as well
# so x = phi a + F_y b with a = -T/(1 + c/k_t), b = (link/k_t)/(1 + c/k_t). Moments about the vehicle's axis, small angles:
#     sum_axles ((T/2 - R camber) dF - R gain x (F_z0 - m_u g)) + H m (a_y + g phi) = 0
# The contact points stay in the planes of the leaning wheels, so the centre of gravity moves outwards by H phi against them;
# static camber and its gain move them by R camber.


def travel_difference(axle: Axle, phi: float, F_y: float) -> float:
    """x_left - x_right [m]."""
    yields = 1.0 + (axle.k + 2.0 * axle.bar) / axle.k_t
    return (-phi * axle.track + F_y * axle.link / axle.k_t) / yields


def load_difference(axle: Axle, phi: float, F_y: float) -> float:
    """F_z,left - F_z,right [N]."""
    return (axle.k + 2.0 * axle.bar) * travel_difference(axle, phi, F_y) - axle.link * F_y


def rolling_moment(axle: Axle, R: float, phi: float, F_y: float) -> float:
    """Moment [Nm] of an axle's loads about the vehicle's axis, linear in phi [rad] and F_y [N]."""
    lever = 0.5 * axle.track - R * axle.camber
    shift = R * axle.gain * travel_difference(axle, phi, F_y)
    return lever * load_difference(axle, phi, F_y) - shift * (axle.static - axle.m_u * GRAVITY)


def roll_angle(ground, v=0) -> float:
    """phi per a_y [rad s²/m]."""
    p, both = ground.parameter[:, v], axles(ground, v)
    by_force = sum(rolling_moment(axle, p[RADIUS], 0.0, p[MASS] * axle.share) for axle in both) + p[MASS] * p[H]
    by_roll = sum(rolling_moment(axle, p[RADIUS], 1.0, 0.0) for axle in both) + p[MASS] * p[H] * GRAVITY
    return -by_force / by_roll


# --- the single track ----------------------------------------------------------------------------------------------------


def change(axle: Axle, *, alpha=0.0, camber=0.0, load=0.0) -> np.ndarray:
    """Lateral force [N] and aligning moment [Nm] of a left wheel at its static load and camber, changed a little."""
    _, F_y, M_z = tyre.forces(axle.tyre, 0.0, alpha, camber - axle.camber, axle.static * (1.0 + load), 1.0)
    return np.array([F_y, M_z])


def slope(axle: Axle, **which) -> np.ndarray:
    """Derivative of both by one of alpha [1], camber [1], load [N]."""
    ((name, _),) = which.items()
    difference = (change(axle, **{name: SMALL}) - change(axle, **{name: -SMALL})) / (2.0 * SMALL)
    return difference / axle.static if name == "load" else difference


def understeer_gradient(ground, v=0) -> float:
    """EG [rad s²/m]: steer angle = L/R + EG a_y, from the tyres' slopes at the static loads.

    Of each axle: F_y = 2 dF_y/dalpha alpha + what roll adds by camber and, where wheels push inwards already when going
    straight, by load transfer; the same for M_z. Unknown are the two alphas, given the sums of forces and moments.
    """
    p, both, phi = ground.parameter[:, v], axles(ground, v), roll_angle(ground, v)
    A, b = np.zeros((2, 2)), np.array([p[MASS], 0.0])
    for k, axle in enumerate(both):
        F_y = p[MASS] * axle.share
        lean = phi - 0.5 * axle.gain * travel_difference(axle, phi, F_y)
        by_alpha = 2.0 * slope(axle, alpha=True)
        by_roll = 2.0 * lean * slope(axle, camber=True) + load_difference(axle, phi, F_y) * slope(axle, load=True)
        A[:, k] = by_alpha[0], axle.x * by_alpha[0] + by_alpha[1]
        b -= by_roll[0], axle.x * by_roll[0] + by_roll[1]
    alpha_front, alpha_rear = np.linalg.solve(A, b)
    return alpha_rear - alpha_front


def single_track(ground, speed: float, *, sigma=SIGMA) -> tuple[np.ndarray, np.ndarray]:
    """A, b of dx/dt = A x + b delta, x = (v_y, r, alpha_front, alpha_rear): linear single track whose contact patches take up
    slip over sigma [m]."""
    p, (front, rear) = ground.p, axles(ground)
    C_f, C_r = (-2.0 * slope(axle, alpha=True)[0] for axle in (front, rear))
    rate = speed / sigma
    A = np.array([
        [0.0, -speed, -C_f / p[MASS], -C_r / p[MASS]],
        [0.0, 0.0, -front.x * C_f / p[J_Z], -rear.x * C_r / p[J_Z]],
        [rate / speed, rate * front.x / speed, -rate, 0.0],
        [rate / speed, rate * rear.x / speed, 0.0, -rate],
    ])  # fmt: skip
    return A, np.array([0.0, 0.0, -rate, 0.0])
