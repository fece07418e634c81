"""Brakes: hydraulics of one axle, first order with a dead time.

tau_b dP/dt = b u(t - t_d) - P,    T_front = K_b xi P,    T_rear = K_b (1 - xi) P        (Massow & Radusch 2018, Eqs. 2, 3)
"""

from studio.compiled import inlined
from studio.model import actuator


@inlined
def pressure(P, T_request, K_b, T_max, tau, dt):
    """P [Pa] after dt towards the pressure that gives the requested torque [Nm], within 0 and T_max."""
    return actuator.lag(P, min(max(T_request, 0.0), T_max) / K_b, tau, dt)


@inlined
def axle_torque(P, K_b, share):
    """Brake torque [Nm] of one axle, both wheels."""
    return K_b * share * P
