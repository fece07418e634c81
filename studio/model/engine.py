"""Engine or electric motor: full-load curve, drag, idle control, rev limit, governor, first order with a dead time.

    tau_e dT_e/dt = T_req(t - t_d) - T_e,    T_drag(w) <= T_req <= T_full(w)        (Massow & Radusch 2018, Eq. 11)
    J_e dw/dt = T_e - T_load                                                       (Eq. 10; stepped with the coupling)

All torques are net, at the shaft. The pedal spans the range between drag and full load degressively, by f(u) = u (2 - u): the
first part of a throttle's way does most, as cars are tuned. The full-load curve is linear
between equidistant knots, written as a sum of hinges c_0 + sum c_k max(w - w_k, 0), which needs no search.
Source: L. Guzzella, C. Onder, Introduction to Modeling and Control of Internal Combustion Engine Systems, 2nd edition 2010.
"""

from math import sqrt

from studio.compiled import inlined
from studio.model import actuator

SPEED_TIME = 0.1  # [s] in which idle control and governor remove a difference of speed
MATCH_TIME = 0.25  # [s] in which the engine is brought up for a lower gear; its lag must not carry it beyond
TAPER = 0.03  # [1] of the limit speed, over which full load fades at the rev limit
SLOW = 10.0  # [rad/s] below this drag and regeneration fade out
# [1] slip of the driven wheels up to which a motor takes back all, and from which on nothing; estimated: 2.2 m/s² by one axle on a dry road
# take 0.025, and on snow (0.3) tyres of the catalogue have their peak at 0.04
GRIPS, SLIDES = 0.025, 0.05


@inlined
def drag(w, T_0, slope):
    """Torque [Nm] with the pedal lifted, negative; w [rad/s]."""
    return -(T_0 + slope * abs(w)) * min(max(w * (1.0 / SLOW), -1.0), 1.0)


@inlined
def full_load(w, T_curve, T_drag, w_limit):
    """Greatest torque [Nm]: the curve, faded to the drag at the rev limit."""
    share = min(max((w_limit - w) / (TAPER * w_limit), 0.0), 1.0)
    return T_drag + (T_curve - T_drag) * share


@inlined
def lowest(w, T_drag, T_regeneration):
    """Least torque [Nm] on request: drag and regeneration; backwards nothing is regenerated."""
    return T_drag - T_regeneration * min(max(w * (1.0 / SLOW), 0.0), 1.0)


@inlined
def taken_back(slip):
    """Share of the regeneration [1] that driven wheels with this slip [1], negative when they brake, are left with.

    A motor brakes one axle only. On a slippery road that axle would lock long before the car brakes as hard as all four wheels can, so the
    motor's own control gives way as its wheels begin to slide, within a step; the brakes, which are on all wheels, do the rest.
    """
    return min(max((SLIDES + slip) * (1.0 / (SLIDES - GRIPS)), 0.0), 1.0)


@inlined
def by_pedal(pedal, T_drag, T_curve):
    """Torque [Nm] that a pedal position asks for."""
    u = min(max(pedal, 0.0), 1.0)
    return T_drag + u * (2.0 - u) * (T_curve - T_drag)


@inlined
def pedal_for(T, T_drag, T_curve):
    """Pedal position [1] that asks for a torque."""
    share = min(max((T - T_drag) / max(T_curve - T_drag, 1.0), 0.0), 1.0)
    return 1.0 - sqrt(1.0 - share)


@inlined
def idled(T, w, w_idle, J_e):
    """The request, at least what keeps the engine idling."""
    return max(T, J_e * (1.0 / SPEED_TIME) * (w_idle - w)) if w_idle > 0.0 else T


@inlined
def governed(T, w, w_wanted, T_carried, J_e):
    """The request, at most what the clutch carries plus what leads to the wanted speed [rad/s]."""
    return min(T, T_carried + J_e * (1.0 / SPEED_TIME) * (w_wanted - w))


@inlined
def matched(T, w, w_in, J_e):
    """The request, at least what brings the engine up to the input speed [rad/s] of the gear that comes in."""
    return max(T, J_e * (1.0 / MATCH_TIME) * (w_in - w))


@inlined
def torque(T_e, T_req, T_low, T_full, tau, dt):
    """T_e [Nm] after dt towards the request, within what the engine can do."""
    return actuator.lag(T_e, min(max(T_req, T_low), T_full), tau, dt)
