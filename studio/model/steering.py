"""Steering: Ackermann geometry, and an electric rack under angle or torque control.

    tan(delta_side) = tan(delta)/(1 - y tan(delta)/L)          both wheel axles point at one centre on the rear axle's line
    J d²delta_s/dt² = T + c M_align/i_s - d ddelta_s/dt        delta_s = i_s delta, angle of the steering wheel

T is the torque at the steering wheel, M_align the moment of both tyres about their kingpins, c the part of it that the
power steering leaves. Source: M. Harrer, P. Pfeffer, Steering Handbook, 2017, chapters 4 and 7.
"""

from studio.compiled import inlined
from studio.model import actuator
from studio.model.elementary import cos, cos_atan, sin


@inlined
def wheel_direction(delta, L, y):
    """Cosine and sine of the angle of a front wheel at lateral position y [m] for the mean angle delta [rad]."""
    tangent = sin(delta) / cos(delta)
    tangent = tangent / (1.0 - y * tangent / L)
    c = cos_atan(tangent)
    return c, c * tangent


@inlined
def kingpin_moment(M_z, F_y, trail):
    """Moment [Nm] of one tyre about its kingpin: aligning torque, and side force behind the axis by the trail [m]."""
    return M_z - trail * F_y


@inlined
def by_torque(delta, rate, T, M_align, ratio, J, d, unassisted, dt):
    """Road wheel angle [rad] and its rate [rad/s] after dt under the torque T [Nm] at the steering wheel."""
    push = T + unassisted * M_align / ratio - d * rate * ratio
    rate_new = rate + dt * push / (ratio * (J + dt * d))
    return delta + dt * rate_new, rate_new


@inlined
def by_angle(delta, request, tau, rate_max, dt):
    """Road wheel angle [rad] and its rate [rad/s] after dt towards the requested angle."""
    delta_new = actuator.rate_limited(delta, request, tau, rate_max, dt)
    return delta_new, (delta_new - delta) / dt
