"""The light vehicle: a single track that rolls without sliding, with first-order lags and a bound of what the tyres can transmit.

Across. The front wheels by their angle delta, less the slip that the axles need for the lateral acceleration, ask for a curvature of the
way of the rear axle, which takes it up by two equal lags with the natural frequency of the linear single track:

    kappa_0 = tan(delta)/(L + (S_f - S_r) v |v|)          S = m l_other/(L C), slip angle of an axle per lateral acceleration
    tau dkappa_1/dt = kappa_0 - kappa_1,     tau dkappa/dt = kappa_1 - kappa,     tau = |v| √(m J_z/(C_f C_r L² (1 + (S_f - S_r) v²/L)))
    dchi/dt = v kappa,     psi = chi + S_r v |v| kappa,     r = dpsi/dt,     v_y = l_r r - v (psi - chi)

chi is the course of the rear axle, psi the heading, v the speed along the body, v_y that across at the centre of gravity.

Along. The drive gives what is asked for after its dead time and lag, bounded by what engine and gearbox can at this speed; the brake
likewise. Brake and rolling resistance are frictions: they bring a car to a stop, and hold it.

    m_eff dv/dt = s F_drive - F_air - m g sin(slope) - sign(v) (s F_brake + F_roll)

Friction. What is asked for along and across lies within the ellipse of the tyres at the vehicle's weight; where it does not, both get the
same share:

    s = 1/max(1, √(f_x² + f_y²)),     f_x = F_x/(mu_x N),     f_y = m v² kappa_0/(mu_y N)

It neither rolls nor pitches on springs, no wheel locks or spins, and it cannot be turned over: beyond the ellipse it runs wide.
Sources: M. Mitschke, H. Wallentowitz, Dynamik der Kraftfahrzeuge, 5th edition 2014, chapter 20 (single track); S. M. LaValle, Planning
Algorithms, 2006, 13.1.2 (the way of the rear axle); adhesion as in studio/model/adhesion.py.
"""

from math import sqrt

from studio.compiled import inlined
from studio.model.elementary import cos, exp, sin
from studio.model.wheel import held

LEAST_BASE = 0.5  # [1] of the wheelbase, below which no slip makes it count: a light vehicle oversteers so far, and is never unstable


@inlined
def taken_up(value, request, tau, dt):
    """A value after dt [s] towards a request with the time constant tau [s], exactly."""
    return request + (value - request) * exp(-dt / tau)


@inlined
def turned(delta, request, tau, rate, dt):
    """Road wheel angle [rad] after dt towards the requested one, no faster than `rate` [rad/s]."""
    change = taken_up(delta, request, tau, dt) - delta
    return delta + min(max(change, -rate * dt), rate * dt)


@inlined
def bend(delta, L, understeer, v):
    """kappa_0 [1/m] for an angle of the road wheels [rad]; understeer [rad s²/m] is S_f - S_r."""
    return sin(delta) / cos(delta) / max(L + understeer * v * abs(v), LEAST_BASE * L)


@inlined
def bend_time(v, L, understeer, yaw_time):
    """tau [s]; yaw_time [s²/m] is tau/|v| without understeer."""
    return abs(v) * yaw_time / sqrt(max(1.0 + understeer * v * abs(v) / L, LEAST_BASE))


@inlined
def share(f_x, f_y):
    """s [1] of what is asked for, in parts of what the tyres can along and across."""
    return 1.0 / max(sqrt(f_x * f_x + f_y * f_y), 1.0)


@inlined
def left_across(f_x):
    """Greatest f_y [1] beside a force along."""
    return sqrt(max(1.0 - f_x * f_x, 0.0))


@inlined
def speed_after(v, a, friction, dt):
    """v [m/s] after dt at an acceleration and a deceleration by frictions [m/s²], which turns nothing backwards."""
    return held(v + dt * a, dt * friction)


@inlined
def leant(v, kappa, S_r):
    """psi - chi [rad]: the slip angle of the rear axle, to the inside of the bend."""
    return S_r * v * abs(v) * kappa
