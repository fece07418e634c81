"""The tyre: Magic Formula 5.2, steady state, pure and combined slip: F_x, F_y and M_z.

Source: H. B. Pacejka, Tyre and Vehicle Dynamics, 2nd edition 2006, section 4.3.2 (4.E9 to 4.E78), turn slip off.
Forces in pure slip have the shape (4.E9, 4.E19)

    F = D sin(C atan(B x - E (B x - atan(B x)))) + S_V,    x = slip + S_H

B C D is the slope at the origin, D the peak, C the shape, E the curvature. Weights G of combined slip and the
pneumatic trail have the same shape with a cosine. Coefficients P.. belong to pure slip, R.. to combined slip, Q.. and
SSZ. to the aligning moment; they depend on the load by df_z = (F_z - F_z0)/F_z0, F_z0 = LFZO FNOMIN. L.. scale them.

Every force is the load times a function of df_z. So the functions below hold forces and stiffnesses per unit of load:
mu in place of D = mu F_z, K/F_z in place of K. Then B = K/(C D) is finite at zero load, and no load gives exactly no
force.

alpha stands for the book's alpha* = tan(side-slip angle) = v_y/|v_x| (4.E3), gamma for gamma* = sin(camber) (4.E4);
positive alpha gives negative F_y. Slips far outside the measured range stay finite. The wheel rolls forwards.

MF-Tyre 5.2 is older than the book's second edition. Where they differ the coefficients of 5.2 decide: camber in mu_x
(PDX3), S_Hy (PHY3), B_t (QBZ4, QBZ5) and D_t (QDZ3), and the equivalent slips of the aligning moment.

A set without coefficients of combined slip or of the aligning moment holds zeros there: all R.. zero give weights of 1
and no S_Vy,kappa, all Q.. and SSZ. zero give no M_z.
"""

from math import copysign, pi, sqrt
from typing import NamedTuple

from studio.compiled import compiled
from studio.model.elementary import atan, cos, cos_atan, exp, sin

SMALL = 1e-9  # keeps stiffness factors finite where there is no friction, as the book's epsilons do


class Tyre(NamedTuple):
    """Coefficients of one tyre, named as in a property file: FNOMIN [N], UNLOADED_RADIUS [m], all others [1]."""

    FNOMIN: float
    UNLOADED_RADIUS: float
    LFZO: float
    LCX: float
    LMUX: float
    LEX: float
    LKX: float
    LHX: float
    LVX: float
    LGAX: float
    LCY: float
    LMUY: float
    LEY: float
    LKY: float
    LHY: float
    LVY: float
    LGAY: float
    LTR: float
    LRES: float
    LGAZ: float
    LXAL: float
    LYKA: float
    LVYKA: float
    LS: float
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
    QBZ1: float
    QBZ2: float
    QBZ3: float
    QBZ4: float
    QBZ5: float
    QBZ9: float
    QBZ10: float
    QCZ1: float
    QDZ1: float
    QDZ2: float
    QDZ3: float
    QDZ4: float
    QDZ6: float
    QDZ7: float
    QDZ8: float
    QDZ9: float
    QEZ1: float
    QEZ2: float
    QEZ3: float
    QEZ4: float
    QEZ5: float
    QHZ1: float
    QHZ2: float
    QHZ3: float
    QHZ4: float
    SSZ1: float
    SSZ2: float
    SSZ3: float
    SSZ4: float


class Factors(NamedTuple):
    """Factors of one force in pure slip that do not depend on its slip, per unit of load.

    All [1]: K slope at the origin, B stiffness, C shape, mu peak, S_H shift of the slip, S_V shift of the force.
    """

    K: float
    B: float
    C: float
    mu: float
    S_H: float
    S_V: float


# --- the formula -------------------------------------------------------------------------------------------------------


@compiled(forceinline=True)
def formula_angle(B, C, E, x):
    """Argument of the sine or cosine of the Magic Formula [rad]."""
    z = B * x
    return C * atan(z - E * (z - atan(z)))


@compiled(forceinline=True)
def formula(f, E, slip):
    """Force per unit of load [1] in pure slip, from its factors f and the curvature E."""
    return f.mu * sin(formula_angle(f.B, f.C, E, slip + f.S_H)) + f.S_V


@compiled(forceinline=True)
def formula_weight(B, C, E, S_H, slip):
    """G [1] (4.E51, 4.E59): the cosine at the shifted slip, over its value at no slip."""
    return cos(formula_angle(B, C, E, slip + S_H)) / cos(formula_angle(B, C, E, S_H))


@compiled(forceinline=True)
def load_change(t, F_z):
    """df_z [1] (4.E2): relative distance from the nominal load F_z0 = LFZO FNOMIN."""
    return F_z * (1.0 / (t.LFZO * t.FNOMIN)) - 1.0


@compiled(forceinline=True)
def sign(x):
    """1 or -1, for the curvature factor's step at zero slip."""
    return copysign(1.0, x)


# --- pure longitudinal slip --------------------------------------------------------------------------------------------


@compiled(forceinline=True)
def longitudinal_factors(t, gamma, df_z, mu):
    """K_x, B_x, C_x, mu_x, S_Hx, S_Vx per unit of load (4.E11 to 4.E18)."""
    gamma_x = gamma * t.LGAX
    mu_x = (t.PDX1 + t.PDX2 * df_z) * (1.0 - t.PDX3 * gamma_x * gamma_x) * t.LMUX * mu
    K = (t.PKX1 + t.PKX2 * df_z) * exp(t.PKX3 * df_z) * t.LKX
    C = t.PCX1 * t.LCX
    S_H = (t.PHX1 + t.PHX2 * df_z) * t.LHX
    S_V = (t.PVX1 + t.PVX2 * df_z) * t.LVX * t.LMUX * mu
    return Factors(K, K / (C * mu_x + SMALL), C, mu_x, S_H, S_V)


@compiled(forceinline=True)
def longitudinal_curvature(t, df_z, kappa_x):
    """E_x [1] (4.E14)."""
    E = (t.PEX1 + t.PEX2 * df_z + t.PEX3 * df_z * df_z) * (1.0 - t.PEX4 * sign(kappa_x)) * t.LEX
    return min(E, 1.0)


@compiled(forceinline=True)
def longitudinal_per_load(t, x, kappa, df_z):
    """F_x0/F_z [1] (4.E9) from the longitudinal factors x."""
    return formula(x, longitudinal_curvature(t, df_z, kappa + x.S_H), kappa)


@compiled(forceinline=True)
def longitudinal_pure(t, kappa, gamma, F_z, mu):
    """F_x0 [N] (4.E9 to 4.E18); `mu` scales the friction of the road."""
    df_z = load_change(t, F_z)
    return F_z * longitudinal_per_load(t, longitudinal_factors(t, gamma, df_z, mu), kappa, df_z)


@compiled(forceinline=True)
def slip_stiffness(t, F_z):
    """K_x [N] (4.E15): slope of F_x over kappa at the origin."""
    return F_z * longitudinal_factors(t, 0.0, load_change(t, F_z), 1.0).K


@compiled(forceinline=True)
def longitudinal_peak(t, F_z, mu):
    """Bound of |F_x0| [N]: D_x and |S_Vx|, camber left aside."""
    x = longitudinal_factors(t, 0.0, load_change(t, F_z), mu)
    return F_z * (abs(x.mu) + abs(x.S_V))


# --- pure lateral slip -------------------------------------------------------------------------------------------------


@compiled(forceinline=True)
def lateral_factors(t, gamma, df_z, mu):
    """K_y, B_y, C_y, mu_y, S_Hy, S_Vy per unit of load (4.E21 to 4.E28).

    With n = F_z/F_z0 = 1 + df_z, sin(2 atan(n/PKY2)) of 4.E25 is 2 n PKY2/(PKY2² + n²).
    """
    gamma_y, n = gamma * t.LGAY, 1.0 + df_z
    mu_y = (t.PDY1 + t.PDY2 * df_z) * (1.0 - t.PDY3 * gamma_y * gamma_y) * t.LMUY * mu
    saturation = 2.0 * t.PKY2 / (t.PKY2 * t.PKY2 + n * n)
    K = t.PKY1 * saturation * (1.0 - t.PKY3 * abs(gamma_y)) * t.LKY
    C = t.PCY1 * t.LCY
    S_H = (t.PHY1 + t.PHY2 * df_z) * t.LHY + t.PHY3 * gamma_y
    S_V = ((t.PVY1 + t.PVY2 * df_z) * t.LVY + (t.PVY3 + t.PVY4 * df_z) * gamma_y) * t.LMUY * mu
    return Factors(K, K / (C * mu_y + SMALL), C, mu_y, S_H, S_V)


@compiled(forceinline=True)
def lateral_curvature(t, gamma, df_z, alpha_y):
    """E_y [1] (4.E24)."""
    E = (t.PEY1 + t.PEY2 * df_z) * (1.0 - (t.PEY3 + t.PEY4 * gamma * t.LGAY) * sign(alpha_y)) * t.LEY
    return min(E, 1.0)


@compiled(forceinline=True)
def lateral_per_load(t, y, alpha, gamma, df_z):
    """F_y0/F_z [1] (4.E19) from the lateral factors y."""
    return formula(y, lateral_curvature(t, gamma, df_z, alpha + y.S_H), alpha)


@compiled(forceinline=True)
def lateral_pure(t, alpha, gamma, F_z, mu):
    """F_y0 [N] (4.E19 to 4.E28)."""
    df_z = load_change(t, F_z)
    return F_z * lateral_per_load(t, lateral_factors(t, gamma, df_z, mu), alpha, gamma, df_z)


@compiled(forceinline=True)
def cornering_stiffness(t, gamma, F_z):
    """K_y [N/rad] (4.E25), negative in these axes: slope of F_y over alpha at the origin."""
    return F_z * lateral_factors(t, gamma, load_change(t, F_z), 1.0).K


# --- beyond the peak ---------------------------------------------------------------------------------------------------


@compiled(forceinline=True)
def is_past_peak(f, E, slip):
    """Whether a slip lies beyond the greatest force, from the factors f and the curvature E: the sine's argument beyond a right angle."""
    return abs(formula_angle(f.B, f.C, E, slip + f.S_H)) > 0.5 * pi


@compiled(forceinline=True)
def slides(t, kappa, alpha, F_z, mu):
    """Whether a loaded tyre is past its peak of slip, along or across the wheel: more slip gives less force. Camber left aside."""
    df_z = load_change(t, F_z)
    x, y = longitudinal_factors(t, 0.0, df_z, mu), lateral_factors(t, 0.0, df_z, mu)
    along = is_past_peak(x, longitudinal_curvature(t, df_z, kappa + x.S_H), kappa)
    across = is_past_peak(y, lateral_curvature(t, 0.0, df_z, alpha + y.S_H), alpha)
    return F_z > 0.0 and (along or across)


# --- combined slip -----------------------------------------------------------------------------------------------------


@compiled(forceinline=True)
def longitudinal_weight(t, kappa, alpha, F_z):
    """G_x,alpha [1] (4.E51 to 4.E57): how much of F_x0 side-slip leaves."""
    B = t.RBX1 * cos_atan(t.RBX2 * kappa) * t.LXAL
    E = min(t.REX1 + t.REX2 * load_change(t, F_z), 1.0)
    return formula_weight(B, t.RCX1, E, t.RHX1, alpha)


@compiled(forceinline=True)
def lateral_weight(t, kappa, alpha, F_z):
    """G_y,kappa [1] (4.E59 to 4.E65): how much of F_y0 longitudinal slip leaves."""
    df_z = load_change(t, F_z)
    B = t.RBY1 * cos_atan(t.RBY2 * (alpha - t.RBY3)) * t.LYKA
    E = min(t.REY1 + t.REY2 * df_z, 1.0)
    return formula_weight(B, t.RCY1, E, t.RHY1 + t.RHY2 * df_z, kappa)


@compiled(forceinline=True)
def braking_side_per_load(t, kappa, alpha, gamma, df_z, mu_y):
    """S_Vy,kappa/F_z [1] (4.E66, 4.E67)."""
    D = mu_y * (t.RVY1 + t.RVY2 * df_z + t.RVY3 * gamma) * cos_atan(t.RVY4 * alpha)
    return D * sin(t.RVY5 * atan(t.RVY6 * kappa)) * t.LVYKA


# --- aligning moment ---------------------------------------------------------------------------------------------------


@compiled(forceinline=True)
def tangent_squared(x):
    """tan(x)² by its series to x⁶: relative error below 3e-4 for |x| < 0.3; no poles beyond."""
    u = x * x
    return u * (1.0 + u * (2.0 / 3.0 + u * (17.0 / 45.0)))


@compiled(forceinline=True)
def equivalent_slip(shifted, slip):
    """|alpha_eq| [rad] of side-slip `shifted` (alpha_t, alpha_r) and of longitudinal slip `slip` = (K_x/K_y) kappa:

        alpha_eq = atan(sqrt(tan(shifted)² + slip²)) sgn(shifted)

    as PAC2002 (MF-Tyre 5.2) has it, with `shifted` as an angle. The book (4.E77, 4.E78) drops tangent and arc tangent;
    with its form M_z in the tests' reference rows would differ by up to 12 Nm. Only even functions follow: no sign.
    """
    return atan(sqrt(tangent_squared(shifted) + slip * slip))


@compiled(forceinline=True)
def trail_curvature(t, gamma_z, df_z, slope):
    """E_t [1] (4.E44); `slope` = B_t C_t alpha_t, with alpha_t as in pure slip also when slip is combined."""
    E = (t.QEZ1 + t.QEZ2 * df_z + t.QEZ3 * df_z * df_z) * (1.0 + (t.QEZ4 + t.QEZ5 * gamma_z) * (2.0 / pi) * atan(slope))
    return min(E, 1.0)


@compiled(forceinline=True)
def trail(t, alpha, gamma, df_z, softening, slip):
    """Pneumatic trail over cos(alpha) [m] (4.E33 to 4.E44, 4.E73).

    `softening` = LKY/(LMUY mu) [1] stretches the slip on a slippery road, `slip` = (K_x/K_y) kappa [1].
    """
    gamma_z = gamma * t.LGAZ
    alpha_t = alpha + t.QHZ1 + t.QHZ2 * df_z + (t.QHZ3 + t.QHZ4 * df_z) * gamma_z
    camber_B = 1.0 + t.QBZ4 * gamma_z + t.QBZ5 * abs(gamma_z)
    B = (t.QBZ1 + t.QBZ2 * df_z + t.QBZ3 * df_z * df_z) * camber_B * softening
    camber_D = 1.0 + t.QDZ3 * gamma_z + t.QDZ4 * gamma_z * gamma_z
    D = (1.0 + df_z) * t.UNLOADED_RADIUS * (t.QDZ1 + t.QDZ2 * df_z) * camber_D * t.LTR
    E = trail_curvature(t, gamma_z, df_z, B * t.QCZ1 * alpha_t)
    return D * cos(formula_angle(B, t.QCZ1, E, equivalent_slip(alpha_t, slip)))


@compiled(forceinline=True)
def residual_per_load(t, y, alpha, gamma, df_z, mu, softening, compliance, slip):
    """Residual moment over F_z cos(alpha) [m] (4.E36 to 4.E47, 4.E75) from the lateral factors y; C_r = 1.

    `compliance` = F_z/K_y [1]; the others as for the trail.
    """
    gamma_z = gamma * t.LGAZ
    alpha_r = alpha + y.S_H + y.S_V * compliance
    B = t.QBZ9 * softening + t.QBZ10 * y.B * y.C
    D = (t.QDZ6 + t.QDZ7 * df_z) * t.LRES + (t.QDZ8 + t.QDZ9 * df_z) * gamma_z
    return D * t.UNLOADED_RADIUS * t.LMUY * mu * cos_atan(B * equivalent_slip(alpha_r, slip))


@compiled(forceinline=True)
def moment_arm(t, gamma, df_z, F_y):
    """s [m] (4.E76): lateral distance of F_x from the wheel's plane."""
    share = F_y * (1.0 / (t.LFZO * t.FNOMIN))
    return t.UNLOADED_RADIUS * (t.SSZ1 + t.SSZ2 * share + (t.SSZ3 + t.SSZ4 * df_z) * gamma) * t.LS


@compiled(forceinline=True)
def aligning_per_load(t, x, y, kappa, alpha, gamma, df_z, mu, f_y):
    """(M_z - s F_x)/F_z [m] (4.E71, 4.E72): the residual moment less the trail times f_y = F'_y/F_z.

    x, y are the longitudinal and lateral factors; cos(alpha) is the cosine of the side-slip angle (4.E6).
    """
    softening, compliance = t.LKY / (t.LMUY * mu + SMALL), 1.0 / y.K
    slip = kappa * x.K * compliance
    residual = residual_per_load(t, y, alpha, gamma, df_z, mu, softening, compliance, slip)
    return (residual - trail(t, alpha, gamma, df_z, softening, slip) * f_y) * cos_atan(alpha)


# --- all together ------------------------------------------------------------------------------------------------------


@compiled(forceinline=True)
def forces(t, kappa, alpha, gamma, F_z, mu):
    """F_x, F_y [N] and M_z [Nm] in combined slip (4.E50, 4.E58, 4.E71), wheel axes.

    kappa [1], alpha tangent of the side-slip angle [1], gamma sine of the camber [1], F_z load [N],
    mu friction of the road relative to the tyre's test track [1].
    """
    df_z = load_change(t, F_z)
    x = longitudinal_factors(t, gamma, df_z, mu)
    y = lateral_factors(t, gamma, df_z, mu)
    F_x = F_z * longitudinal_per_load(t, x, kappa, df_z) * longitudinal_weight(t, kappa, alpha, F_z)
    f_y = lateral_per_load(t, y, alpha, gamma, df_z) * lateral_weight(t, kappa, alpha, F_z)
    F_y = F_z * (f_y + braking_side_per_load(t, kappa, alpha, gamma, df_z, y.mu))
    M_z = F_z * aligning_per_load(t, x, y, kappa, alpha, gamma, df_z, mu, f_y)
    return F_x, F_y, M_z + moment_arm(t, gamma, df_z, F_y) * F_x
