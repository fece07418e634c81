"""What joins engine and gearbox: a friction clutch, a torque converter with lock-up, or a shaft.

Converter (A. Kotwicki, SAE 820393; Massow & Radusch 2018, Eq. 6), w_e pump, w_t turbine:

    T_p = a1 w_e² + a2 w_e w_t + a3 w_t²,    T_t = b1 w_e² + b2 w_e w_t + b3 w_t²    below the coupling ratio of w_t/w_e
    T_p = T_t = c1 w_e² + c2 w_e w_t + c3 w_t²                                       above it

Clutch (Eq. 7): Coulomb friction of capacity u_c T_cap. It sticks when the torque that makes both sides equally fast at the end
of the step lies within its capacity, else it slips with its capacity. With A the input speed that the gearbox would reach
without engine, and B its change per torque and time, that torque is

    T_c = (w_e + dt (T_e - T_p)/J_e - A)/(dt (1/J_e + B))

so slipping, closed and open are one formula, without a state to keep. A shaft is a clutch that never slips.
"""

from studio.compiled import inlined

STALL, FIRM = 0.5, 0.9  # parts of the idle speed between which a clutch lets go, so that it does not stall the engine


@inlined
def converter(w_e, w_t, a1, a2, a3, b1, b2, b3, c1, c2, c3, ratio):
    """T_p, T_t [Nm]: load of the engine, and torque at the gearbox."""
    ee, et, tt = w_e * w_e, w_e * w_t, w_t * w_t
    as_coupling = c1 * ee + c2 * et + c3 * tt
    is_coupling = w_t > ratio * w_e
    T_p = as_coupling if is_coupling else a1 * ee + a2 * et + a3 * tt
    T_t = as_coupling if is_coupling else b1 * ee + b2 * et + b3 * tt
    return T_p, T_t


@inlined
def capacity(u_c, T_cap, w_e, w_idle):
    """Torque [Nm] that the clutch can carry; less when the engine is about to stall."""
    firm = min(max((w_e - STALL * w_idle) / max((FIRM - STALL) * w_idle, 1.0), 0.0), 1.0)
    return u_c * T_cap * (firm if w_idle > 0.0 else 1.0)


@inlined
def clutch(T_cap, w_e, T_net, J_e, A, B, dt):
    """T_c [Nm] that the clutch carries; T_net [Nm] on the engine without it."""
    stick = (w_e + dt * T_net / J_e - A) / (dt * (1.0 / J_e + B))
    return min(max(stick, -T_cap), T_cap)
