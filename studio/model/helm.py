"""The helm: how a driver steers along a path, and back to it from wherever the car is.

On the path: the controller of G. Hoffmann, C. Tomlin, M. Montemerlo, S. Thrun, ACC 2007, Eqs. 5 and 9, at the front axle, which goes
where its wheels point but for their slip. Beside the path it is asked to follow the way back, which has a course and a curvature at every
offset e: an arc of curvature c that ends along the path, with an exponential tail,

    sin chi < c/k:  chi = k e;      else  cos chi = cos chi_0 - c (|e| - e_0)        where both meet, at e_0 = chi_0/k, sin chi_0 = c/k

c is bounded by the lateral acceleration of the arc and by how fast the wheels turn, k by how fast the front axle takes up a course: with
the time constant T its offset obeys T e'' + e' + k v e = 0, which is well damped while k v T stays below DAMPING.
The car itself is turned by no more than a lateral acceleration and a rate of the wheels, whatever the law asks for.

In a bend the rear axle cuts by L² kappa/2 what the front axle drives; so the front axle goes wide by a quarter of this.
Backwards the rear axle leads: it goes where the car points, and the heading is steered as the course is forwards.
"""

from math import acos, asin, atan, atan2, copysign, cos, pi, sin

from studio.compiled import compiled, inlined

ARC = 2.7  # [m/s²] across on the way back
EASY, HARD = 3.5, 4.9  # [m/s²] across to get there; the second where much is to be turned, and with the bend of the path
URGENCY = 2.0  # [s] in which a speed across that is wrong should be gone
MARGIN = 1.0  # [m/s²] across that is left where a bend takes all of it
HAND = 0.7  # [1] of the rate of the wheels that the way back counts on
REACH = 1.5  # [1] times what the wheels turn within a wheelbase of way, the car is turned more than the path
LOCK = 0.5  # [1] of the sharpest bend
STEEPEST = 1.0  # [rad] course towards the path
DAMPING = 0.5  # [1] k v T
QUICK = 0.35  # [s] in which the front axle takes up a course, where it would take longer by itself
BACKING = 0.2  # [m/s] from here on a car drives backwards
SWING = 0.125  # [1] times L² kappa the front axle goes wide
ROLLING = 0.1  # [m/s] below this speeds count as this
PROMPT, SWIFT = 1.5, 0.7  # [1], [s] backwards a heading is taken up over (L + SWIFT v)/PROMPT metres
TRAILING = 2.5  # [1] and an offset over so many times that


@compiled
def compliance(m, l_other, L, C):
    """Slip angle of an axle per lateral acceleration [rad s²/m]: m l_other/(L C), stiffness C [N/rad], l_other [m] of the other axle."""
    return m * l_other / (L * C)


@inlined
def wrapped(angle):
    """The same angle [rad] between -pi and pi."""
    return angle - 2.0 * pi * round(angle / (2.0 * pi))


@inlined
def quickened(v, compliance):
    """By how much [1] a wrong course of the front axle is answered beyond its own slip; that alone takes the time compliance v."""
    return max(compliance * v / QUICK, 1.0)


@inlined
def tail(v, gain, compliance):
    """k [1/m] of the way back at v [m/s]: gain [1/s] while the axle is quick enough."""
    return min(gain / (1.0 + v), DAMPING * quickened(v, compliance) / (compliance * v * v + 1e-9))


@inlined
def arc(v, k, L, rate, delta_max):
    """c [1/m] of the way back: over the tail's length the wheels, of this rate [rad/s], turn from straight to this bend."""
    return min(min(ARC / (v * v), HAND * rate / (L * v * k)), LOCK * sin(min(delta_max, 0.5 * pi)) / L)


@compiled
def way_back(e, k, c):
    """Course [rad] against the path's and curvature [1/m] of the way back at an offset e [m], left positive."""
    chi_0 = asin(min(c / k, sin(STEEPEST)))
    e_0 = chi_0 / k
    beyond = abs(e) - e_0
    if beyond <= 0.0:
        return -k * e, 0.0
    cosine = cos(chi_0) - c * beyond
    if cosine < cos(STEEPEST):
        return copysign(STEEPEST, -e), 0.0
    return copysign(acos(cosine), -e), copysign(c * min(beyond / e_0, 1.0), e)


@inlined
def beside(e, kappa):
    """Curvature [1/m] of the line at the offset e [m] along a path of curvature kappa."""
    return kappa / max(1.0 - kappa * e, 0.5)


@inlined
def urged(v, error):
    """Lateral acceleration [m/s²] that a wrong course is worth."""
    return min(max(EASY, abs(v * error) / URGENCY), HARD)


@inlined
def bounded(kappa, bend, a, v, rate, L):
    """A curvature [1/m] within reach of the bend of the path: by a [m/s²], by the wheels, and all in all by HARD."""
    reach = min(a / (v * v), REACH * rate / v)
    left = min(bend + reach, max(HARD / (v * v), bend + MARGIN / (v * v)))
    right = max(bend - reach, min(-HARD / (v * v), bend - MARGIN / (v * v)))
    return min(max(kappa, right), left)


@inlined
def ahead(car, psi, gain, yaw_damping):
    """Road wheel angle [rad] forwards."""
    v, per = max(car.rolling, ROLLING), car.compliance
    k = tail(v, gain, per)
    outwards = SWING * car.wheelbase * car.wheelbase * car.curvature
    chi, back = way_back(car.offset + outwards, k, arc(v, k, car.wheelbase, car.steering_rate, car.steering_max))
    bend = beside(car.offset, car.curvature)
    error, drifts = chi - psi, atan2(car.sideways, max(v, 1.0))
    kappa = bend + back
    angle = error + (quickened(v, per) - 1.0) * (error - drifts) + per * v * v * kappa + yaw_damping * (v * kappa - car.yaw_rate)
    per_bend = car.wheelbase + max(car.understeer, 0.0) * v * v  # [m] angle of a steady bend over its curvature
    return per_bend * bounded(angle / per_bend, car.curvature, urged(v, error), v, car.steering_rate, car.wheelbase)


@inlined
def backwards(car, psi):
    """Road wheel angle [rad] backwards: offset and course of the rear axle, whose way turns by kappa + K (course - wanted) - that back."""
    v, L = abs(car.rolling), car.wheelbase
    K = PROMPT / (L + SWIFT * v)
    forth = L * cos(psi)
    e = car.offset - L * sin(psi) - 0.5 * car.curvature * forth * forth
    course = psi + car.curvature * forth - atan((car.sideways - L * car.yaw_rate) / v)
    chi, back = way_back(e, K / TRAILING, arc(v, K, L, car.steering_rate, car.steering_max))
    kappa = car.curvature + K * (course + chi) - back
    return atan(L * bounded(kappa, car.curvature, ARC, v, car.steering_rate, L))


@compiled
def path_steering(car, gain, yaw_damping):
    """Road wheel angle [rad] that leads a car along its path, and back to it.

    car: what a driver sees of it, its wheels and its path, as `Sees` in studio/kind/driver.py has it. gain [1/s] is how fast an offset is
    steered away, yaw_damping [s].
    """
    psi = wrapped(car.heading)
    angle = backwards(car, psi) if car.rolling < -BACKING else ahead(car, psi, gain, yaw_damping)
    return min(max(angle, -car.steering_max), car.steering_max)
