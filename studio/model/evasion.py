"""The way around an obstacle, and the way to stand before it: what both take.

A lane change of width W [m] that takes T [s] is the quintic of minimum jerk, y = W f(t/T), f(u) = 10 u³ - 15 u⁴ + 6 u⁵: its greatest
lateral acceleration is 10/sqrt(3) W/T², its greatest jerk 60 W/T³ (T. Flash, N. Hogan, The coordination of arm movements, Journal of
Neuroscience 5 (1985) 1688). So T = sqrt(10/sqrt(3) W/a_y). A tyre has one force for both directions: a_x² + a_y² <= (mu g)².
"""

from math import sqrt

from studio.compiled import compiled

PEAK = 10.0 / sqrt(3.0)  # [1] greatest f''
BISECTIONS = 40
PROCESSING = 0.05  # [s] in which a request is weighed
BRAKE_LAG, STEERING_LAG = 0.2, 0.1  # [s] of the actuators, as the formula has them
LONG_MARGIN, SIDE_MARGIN = 0.5, 0.2  # [m] that are kept


@compiled
def share(u):
    """f, 0 before and 1 after [1]."""
    u = min(max(u, 0.0), 1.0)
    return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)


@compiled
def slope(u):
    """f' [1]."""
    u = min(max(u, 0.0), 1.0)
    return 30.0 * u * u * (1.0 - u) * (1.0 - u)


@compiled
def bend(u):
    """f'' [1]."""
    return 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) if 0.0 < u < 1.0 else 0.0


@compiled
def moment(part):
    """u at which f has a value [1] between 0 and 1, by bisection: f rises."""
    low, high = 0.0, 1.0
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if share(middle) < part:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@compiled
def change_time(W, a_y):
    """T [s] of a lane change of W [m] with at most a_y [m/s²]."""
    return sqrt(PEAK * abs(W) / a_y)


@compiled
def left_over(grip, a_y):
    """Braking [m/s²] that a tyre has left at a lateral acceleration, of `grip` [m/s²] in all."""
    return sqrt(max(grip * grip - a_y * a_y, 0.0))


@compiled
def stopping_distance(v, a, t_d, t_b):
    """Way [m] to stand from v [m/s]: t_d [s] nothing happens, within t_b [s] the deceleration rises to a [m/s²]."""
    return v * (t_d + 0.5 * t_b) + v * v / (2.0 * a) - a * t_b * t_b / 24.0


@compiled
def clearing_time(way, b):
    """Time [s] in which a car that brakes with b [m/s²] falls back by a way [m]."""
    return sqrt(2.0 * max(way, 0.0) / b)


@compiled
def cooperative_distance(v, latency, W, beside, ahead, length, width, obstacle, a_y, b_B):
    """Least distance [m] of an obstacle of the width `obstacle` [m] that two cars of the same size side by side can evade together.

    From the front bumper of the one that evades to the obstacle's near edge, from the moment at which it has recognised it. `beside` [m] is
    how far aside the other one's middle is, `ahead` [m] how far the first is ahead of it. The other brakes with b_B [m/s²] when the request
    has come; the first steers when it has heard that, and so that the other has fallen back when both would overlap.
    """
    T = change_time(W, a_y)
    t_clear = latency + PROCESSING + BRAKE_LAG + clearing_time(length - ahead + LONG_MARGIN, b_B)
    overlap = moment((beside - width - SIDE_MARGIN) / W)
    start = max(2.0 * latency + PROCESSING + STEERING_LAG, t_clear - T * overlap)
    return v * (start + T * moment((0.5 * (width + obstacle) + SIDE_MARGIN) / W))
