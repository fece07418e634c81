"""What joins engine and gearbox: a friction clutch, a torque converter with lock-up, or a shaft.

Converter (A. Kotwicki, SAE 820393; Massow & Radusch 2018, Eq. 6), w_e pump, w_t turbine:

    T_p = a1 w_e² + a2 w_e w_t + a3 w_t²,    T_t = b1 w_e² + b2 w_e w_t + b3 w_t²    below the coupling ratio of w_t/w_e
    T_p = T_t = c1 w_e² + c2 w_e w_t + c3 w_t²                                       above it

They hold for w_t >= 0; a turbine that is turned backwards is taken as standing.

Clutch (Eq. 7): Coulomb friction of capacity u_c T_cap. It sticks when the torque that makes both sides equally fast at the end
of the step lies within its capacity, else it slips with its capacity; so slipping, closed and open are one formula, without
a state to keep. A shaft is a clutch that never slips.

Both lie between the same two speeds, which answer stiffly. One step solves them together, implicitly in the converter
(linearised: P_e = dT_p/dw_e, P_t = dT_p/dw_t, Q_e, Q_t the same of T_t) and in the clutch. With A the input's speed without any
torque on it and M its change per torque and time, the changes D_e, D_t of both speeds follow from

    (J_e/dt + P_e) D_e + P_t D_t = T_e - T_p - T_c
    -M dt eta Q_e D_e + (1 - M dt eta Q_t) D_t = A - w_t + M dt (eta (T_t + T_c) - T_loss)
"""

from studio.compiled import inlined

STALL, FIRM = 0.85, 1.1  # parts of the idle speed between which a clutch at least lets go, so that the engine lives


@inlined
def converter(w_e, w_t, a1, a2, a3, b1, b2, b3, c1, c2, c3, ratio):
    """T_p, T_t [Nm], and their slopes P_e, P_t, Q_e, Q_t [Nm s/rad]."""
    w, turns = max(w_t, 0.0), 1.0 if w_t > 0.0 else 0.0
    is_coupling = w > ratio * w_e
    p1, p2, p3 = c1 if is_coupling else a1, c2 if is_coupling else a2, c3 if is_coupling else a3
    q1, q2, q3 = c1 if is_coupling else b1, c2 if is_coupling else b2, c3 if is_coupling else b3
    T_p = p1 * w_e * w_e + p2 * w_e * w + p3 * w * w
    T_t = q1 * w_e * w_e + q2 * w_e * w + q3 * w * w
    P_e, P_t = max(2.0 * p1 * w_e + p2 * w, 0.0), turns * (p2 * w_e + 2.0 * p3 * w)
    Q_e, Q_t = 2.0 * q1 * w_e + q2 * w, turns * min(q2 * w_e + 2.0 * q3 * w, 0.0)
    return T_p, T_t, P_e, P_t, Q_e, Q_t


@inlined
def capacity(u_c, T_cap, w_e, w_idle, w_firm):
    """Torque [Nm] that an automated clutch carries: it lets the engine rev up to w_firm, and go before it stalls."""
    low = STALL * w_idle
    high = max(w_firm, FIRM * w_idle)
    return u_c * T_cap * min(max((w_e - low) / max(high - low, 1.0), 0.0), 1.0)


@inlined
def join(w_e, w_t, T_e, T_loss, T_cap, eta, J_e, A, M, torques, dt):
    """D_e, D_t [rad/s], and the torque [Nm] at the gearbox's input before its losses.

    A [rad/s] speed of the input after dt without torque, M [1/(kg m²)] its mobility, torques as `converter` gives them.
    """
    T_p, T_t, P_e, P_t, Q_e, Q_t = torques
    m = M * dt
    a_ee, a_et, a_te, a_tt = J_e / dt + P_e, P_t, -m * eta * Q_e, 1.0 - m * eta * Q_t
    b_e, b_t = T_e - T_p, A - w_t + m * (eta * T_t - T_loss)
    scale = 1.0 / (a_ee * a_tt - a_et * a_te)
    D_e, D_t = (b_e * a_tt - a_et * b_t) * scale, (a_ee * b_t - a_te * b_e) * scale
    S_e, S_t = -(a_tt + a_et * m * eta) * scale, (a_ee * m * eta + a_te) * scale  # changes per clutch torque
    stick = (w_t + D_t - w_e - D_e) / (S_e - S_t)
    T_c = min(max(stick, -T_cap), T_cap)
    D_e, D_t = D_e + T_c * S_e, D_t + T_c * S_t
    return D_e, D_t, T_t + Q_e * D_e + Q_t * D_t + T_c
