"""The tyre: Magic Formula 5.2, steady state, pure and combined slip, F_x and F_y.

Source: H. B. Pacejka, Tyre and Vehicle Dynamics, 2nd edition 2006, section 4.3.2 (4.E9 to 4.E67), turn slip off.
All forces have the same shape (4.E9, 4.E19):

    F = D sin(C atan(B x - E (B x - atan(B x)))) + S_V,    x = slip + S_H

B C D is the slope at the origin, D the peak, C the shape, E the curvature. The coefficients P.. of pure slip and R.. of
combined slip depend on the load by df_z = (F_z - F_z0)/F_z0; L.. scale them.

alpha stands for the book's alpha* = tan(side-slip angle) = v_y/|v_x| (4.E3), gamma for gamma* = sin(camber) (4.E4).
"""

from math import atan, copysign, cos, exp, sin
from typing import NamedTuple

from studio.compiled import compiled

SMALL = 1e-6  # keeps the stiffness factor finite at zero load, as the book's epsilons do


class Tyre(NamedTuple):
    """Coefficients of one tyre: names as in a property file. Forces [N], angles [rad], lengths [m]."""

    FNOMIN: float
    UNLOADED_RADIUS: float
    LFZO: float
    LCX: float
    LMUX: float
    LEX: float
    LKX: float
    LHX: float
    LVX: float
    LCY: float
    LMUY: float
    LEY: float
    LKY: float
    LHY: float
    LVY: float
    LGAX: float
    LGAY: float
    LXAL: float
    LYKA: float
    LVYKA: float
    PCX1: float
    PDX1: float
    PDX2: float
    PDX3: float
    PEX1: float
    PEX2: float
    PEX3: float
    PEX4: float
    PKX1: float
    PKX2: float
    PKX3: float
    PHX1: float
    PHX2: float
    PVX1: float
    PVX2: float
    RBX1: float
    RBX2: float
    RCX1: float
    REX1: float
    REX2: float
    RHX1: float
    PCY1: float
    PDY1: float
    PDY2: float
    PDY3: float
    PEY1: float
    PEY2: float
    PEY3: float
    PEY4: float
    PKY1: float
    PKY2: float
    PKY3: float
    PHY1: float
    PHY2: float
    PHY3: float
    PVY1: float
    PVY2: float
    PVY3: float
    PVY4: float
    RBY1: float
    RBY2: float
    RBY3: float
    RCY1: float
    REY1: float
    REY2: float
    RHY1: float
    RHY2: float
    RVY1: float
    RVY2: float
    RVY3: float
    RVY4: float
    RVY5: float
    RVY6: float


@compiled
def formula_angle(B, C, E, x):
    """Argument of the sine or cosine of the Magic Formula [rad]."""
    z = B * x
    return C * atan(z - E * (z - atan(z)))


@compiled
def load_change(t, F_z):
    """df_z (4.E2a): relative distance from the nominal load F_z0 = LFZO FNOMIN."""
    F_z0 = t.LFZO * t.FNOMIN
    return (F_z - F_z0) / F_z0


@compiled
def sign(x):
    """1 or -1, for the curvature factor's step at zero slip."""
    return copysign(1.0, x)


@compiled
def slip_stiffness(t, F_z):
    """K_x [N] (4.E15): slope of F_x over kappa at the origin."""
    df_z = load_change(t, F_z)
    return F_z * (t.PKX1 + t.PKX2 * df_z) * exp(t.PKX3 * df_z) * t.LKX


@compiled
def cornering_stiffness(t, gamma, F_z):
    """K_y [N/rad] (4.E25), negative in these axes: slope of F_y over alpha at the origin."""
    F_z0 = t.LFZO * t.FNOMIN
    saturation = sin(2.0 * atan(F_z / (t.PKY2 * F_z0)))
    return t.PKY1 * F_z0 * saturation * (1.0 - t.PKY3 * abs(gamma * t.LGAY)) * t.LKY


@compiled
def longitudinal_pure(t, kappa, gamma, F_z, mu):
    """F_x0 [N] (4.E9 to 4.E18); `mu` scales the friction of the road."""
    df_z = load_change(t, F_z)
    kappa_x = kappa + (t.PHX1 + t.PHX2 * df_z) * t.LHX
    gamma_x = gamma * t.LGAX
    mu_x = (t.PDX1 + t.PDX2 * df_z) * (1.0 - t.PDX3 * gamma_x * gamma_x) * t.LMUX * mu
    C = t.PCX1 * t.LCX
    D = mu_x * F_z
    E = (t.PEX1 + t.PEX2 * df_z + t.PEX3 * df_z * df_z) * (1.0 - t.PEX4 * sign(kappa_x)) * t.LEX
    B = slip_stiffness(t, F_z) / (C * D + SMALL)
    S_V = F_z * (t.PVX1 + t.PVX2 * df_z) * t.LVX * t.LMUX * mu
    return D * sin(formula_angle(B, C, min(E, 1.0), kappa_x)) + S_V


@compiled
def lateral_friction(t, gamma, F_z, mu):
    """mu_y [1] (4.E23)."""
    gamma_y = gamma * t.LGAY
    return (t.PDY1 + t.PDY2 * load_change(t, F_z)) * (1.0 - t.PDY3 * gamma_y * gamma_y) * t.LMUY * mu


@compiled
def lateral_pure(t, alpha, gamma, F_z, mu):
    """F_y0 [N] (4.E19 to 4.E30)."""
    df_z = load_change(t, F_z)
    gamma_y = gamma * t.LGAY
    alpha_y = alpha + (t.PHY1 + t.PHY2 * df_z) * t.LHY + t.PHY3 * gamma_y
    C = t.PCY1 * t.LCY
    D = lateral_friction(t, gamma, F_z, mu) * F_z
    E = (t.PEY1 + t.PEY2 * df_z) * (1.0 - (t.PEY3 + t.PEY4 * gamma_y) * sign(alpha_y)) * t.LEY
    B = cornering_stiffness(t, gamma, F_z) / (C * D + SMALL)
    S_V = F_z * ((t.PVY1 + t.PVY2 * df_z) * t.LVY + (t.PVY3 + t.PVY4 * df_z) * gamma_y) * t.LMUY * mu
    return D * sin(formula_angle(B, C, min(E, 1.0), alpha_y)) + S_V


@compiled
def longitudinal_weight(t, kappa, alpha, F_z):
    """G_x,alpha [1] (4.E51 to 4.E57): how much of F_x0 side-slip leaves."""
    B = t.RBX1 * cos(atan(t.RBX2 * kappa)) * t.LXAL
    E = min(t.REX1 + t.REX2 * load_change(t, F_z), 1.0)
    shifted = cos(formula_angle(B, t.RCX1, E, alpha + t.RHX1))
    return shifted / cos(formula_angle(B, t.RCX1, E, t.RHX1))


@compiled
def lateral_weight(t, kappa, alpha, F_z):
    """G_y,kappa [1] (4.E60 to 4.E65): how much of F_y0 longitudinal slip leaves."""
    df_z = load_change(t, F_z)
    S_H = t.RHY1 + t.RHY2 * df_z
    B = t.RBY1 * cos(atan(t.RBY2 * (alpha - t.RBY3))) * t.LYKA
    E = min(t.REY1 + t.REY2 * df_z, 1.0)
    shifted = cos(formula_angle(B, t.RCY1, E, kappa + S_H))
    return shifted / cos(formula_angle(B, t.RCY1, E, S_H))


@compiled
def braking_side_force(t, kappa, alpha, gamma, F_z, mu):
    """S_Vy,kappa [N] (4.E66, 4.E67): side force that longitudinal slip itself makes."""
    fraction = t.RVY1 + t.RVY2 * load_change(t, F_z) + t.RVY3 * gamma
    D = lateral_friction(t, gamma, F_z, mu) * F_z * fraction * cos(atan(t.RVY4 * alpha))
    return D * sin(t.RVY5 * atan(t.RVY6 * kappa)) * t.LVYKA


@compiled
def forces(t, kappa, alpha, gamma, F_z, mu):
    """F_x, F_y [N] in combined slip (4.E50, 4.E58), wheel axes.

    kappa [1], alpha tangent of the side-slip angle [1], gamma sine of the camber [1], F_z load [N],
    mu friction of the road relative to the tyre's test track [1].
    """
    F_x = longitudinal_pure(t, kappa, gamma, F_z, mu) * longitudinal_weight(t, kappa, alpha, F_z)
    F_y = lateral_pure(t, alpha, gamma, F_z, mu) * lateral_weight(t, kappa, alpha, F_z)
    return F_x, F_y + braking_side_force(t, kappa, alpha, gamma, F_z, mu)
