"""The wheel: the slip that its contact patch takes up, and its spin under drive, brake and tyre force.

Slip. The patch takes up slip over its own length sigma (H. B. Pacejka, Tyre and Vehicle Dynamics, 2nd edition 2006, 7.2):

    sigma dkappa/dt + |V_x| kappa = -V_sx,    sigma dalpha/dt + |V_x| alpha = V_y,    V_sx = V_x - R omega

At speed this is the steady-state slip within a few steps. At rest it is a spring: a braked car on a slope stands, a parked
one does not creep. The step is implicit and holds at any speed. What the patch can store without sliding is bounded; the
bound opens as soon as something slides. At walking pace a damping of the patch is added (I. Besselink, Shimmy of aircraft
main landing gears, Delft 2000, 5.4), so that a stopped car does not swing on its tyres.

Spin. J domega/dt = T_drive - T_roll - T_brake - R F_x        (Massow & Radusch 2018, Eq. 1)
The tyre makes this a stiff spring, so the spin is stepped implicitly in the tyre force, with the secant stiffness
F_x/kappa, which is positive on both sides of the peak. The brake is friction: it can hold a wheel, never turn it backwards.
"""

from math import copysign

from studio.compiled import inlined

SIGMA = 0.1  # [m] length over which the patch takes up slip: half a contact length of a car tyre
SLIP_MAX = 1.5  # [1] slip and side-slip tangent beyond which no tyre is measured; the range that property files state
V_REST = 2.5  # [m/s] below this the damping at rest fades in
V_SLIDE = 1.0  # [m/s] of sliding that opens the bound of the slip by 1
SLIP_SMALL = 1e-6  # [1] below this slip the secant is the slope at the origin
STANDING = 0.02  # [m/s] below this rolling resistance fades out


@inlined
def uptake(slip, V_slide, V_x, dt):
    """Slip [1] after dt: V_slide [m/s] is -V_sx for kappa and V_y for alpha."""
    return (SIGMA * slip + dt * V_slide) / (SIGMA + dt * abs(V_x))


@inlined
def slip_bound(rest, V_sliding):
    """Greatest slip [1] at a sliding speed [m/s]; rest is what the patch stores when nothing slides."""
    return min(rest + V_sliding * (1.0 / V_SLIDE), SLIP_MAX)


@inlined
def bounded(slip, bound):
    """The slip within ± bound."""
    return min(max(slip, -bound), bound)


@inlined
def rest_gain(tau, V_x):
    """Slip per sliding speed [s/m] that the damping at rest adds; tau [s] damping over stiffness of the patch."""
    share = max(1.0 - V_x * V_x * (1.0 / (V_REST * V_REST)), 0.0)
    return share * share * tau * (1.0 / SIGMA)


@inlined
def slip_per_spin(R, V_x, gain, dt):
    """dkappa/domega [s] within one step."""
    return R * (dt / (SIGMA + dt * abs(V_x)) + gain)


@inlined
def secant_stiffness(F_x, kappa, K_x):
    """C [N]: F_x over kappa, between zero and the slope at the origin K_x."""
    tiny = abs(kappa) < SLIP_SMALL
    return K_x if tiny else min(max(F_x / (1.0 if tiny else kappa), 0.0), K_x)


@inlined
def implicit_inertia(J, R, slope, dt):
    """Inertia [kg m²] that the wheel shows within one step, with the tyre's slope dF_x/domega [N s]."""
    return J + dt * R * slope


@inlined
def rolling_torque(c_roll, F_z, R, V_x):
    """Rolling resistance [Nm], a friction."""
    return c_roll * F_z * R * min(abs(V_x) * (1.0 / STANDING), 1.0)


@inlined
def held(omega, change):
    """A spin that friction brings nearer to zero by at most `change` [rad/s]."""
    return copysign(max(abs(omega) - change, 0.0), omega)


@inlined
def spin(omega, F_x, T_drive, T_friction, R, I, dt):
    """omega [rad/s] after dt; torques [Nm] at the wheel, T_friction the magnitude of brake and rolling resistance."""
    return held(omega + dt * (T_drive - R * F_x) / I, dt * T_friction / I)
