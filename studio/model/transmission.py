"""Transmission: gearbox, final drive and open differentials.

    T_out = (eta T_in - T_loss - J_g dw_in/dt) i,    w_in = i sum s_j w_j,    T_j = s_j T_out
                                                                        (Massow & Radusch 2018, Eqs. 8, 9)
s_j is the share of wheel j: s/2 at the front, (1 - s)/2 at the rear; front, rear and all-wheel drive with open
differentials are one formula. Seen from the input, the wheels answer linearly within a step:

    w_in_new = (A + B J_g w_in + dt B (eta T_in - T_loss))/D,    D = 1 + B J_g,    A = i sum s_j w_j_free,    B = i² sum s_j²/I_j
"""

from math import copysign

from studio.compiled import inlined

CRAWL = 2.0  # [rad/s] below this the constant loss fades out


@inlined
def efficiency(T, loss_share):
    """eta [1]: less arrives than is sent, in both directions."""
    return 1.0 - copysign(loss_share, T)


@inlined
def constant_loss(w_in, T_loss):
    """Loss [Nm] at the input that does not depend on the torque."""
    return T_loss * min(max(w_in * (1.0 / CRAWL), -1.0), 1.0)


@inlined
def input_free(A, B, w_in, T, J_g, dt):
    """Speed [rad/s] of the input after dt under the torque T [Nm] there."""
    return (A + B * (J_g * w_in + dt * T)) / (1.0 + B * J_g)


@inlined
def input_mobility(B, J_g):
    """Change of the input's speed per torque and time [1/(kg m²)]."""
    return B / (1.0 + B * J_g)


@inlined
def output_torque(T, J_g, acceleration, i):
    """T_out [Nm], sum of the wheels; T [Nm] at the input after losses, acceleration [rad/s²] of the input."""
    return (T - J_g * acceleration) * i
