"""What a body covers of the field of a sensor: the bearings between which its outline lies, and the point of it that is nearest.

An outline is a rectangle: the place of its middle x, y [m] seen from the sensor (forward, left), the cosine c and sine s of its heading
against that of the sensor, its length and width [m]. A bearing is an angle [rad] from straight ahead, left positive. An outline reaches
from `low`, within (-π, π], to `high`, which is not below `low`: behind the sensor it goes beyond π.
"""

from math import atan2, cos, inf, pi, sin, sqrt

from studio.compiled import inlined
from studio.model.elementary import atan


@inlined
def holds(x, y, c, s, length, width):
    """Whether the sensor is inside the outline."""
    return abs(x * c + y * s) <= 0.5 * length and abs(y * c - x * s) <= 0.5 * width


@inlined
def edges(x, y, c, s, length, width):
    """From which bearing to which [rad] an outline reaches; all around from inside.

    Where all corners lie ahead of the sensor, the outermost are those with the least and the greatest left/ahead.
    """
    along_x, along_y, aside_x, aside_y = 0.5 * length * c, 0.5 * length * s, -0.5 * width * s, 0.5 * width * c
    if x - abs(along_x) - abs(aside_x) <= 0.0:
        return widest(x, y, c, s, length, width)
    a, b = (y + along_y + aside_y) / (x + along_x + aside_x), (y + along_y - aside_y) / (x + along_x - aside_x)
    d, e = (y - along_y + aside_y) / (x - along_x + aside_x), (y - along_y - aside_y) / (x - along_x - aside_x)
    return atan(min(a, b, d, e)), atan(max(a, b, d, e))


@inlined
def widest(x, y, c, s, length, width):
    """The same for an outline that is beside or behind the sensor, or around it: the outermost to each side of its middle."""
    if holds(x, y, c, s, length, width):
        return -pi, pi
    low_x, low_y, high_x, high_y = x, y, x, y
    for i in range(4):
        along, aside = (0.5 - i // 2) * length, (0.5 - i % 2) * width
        px, py = x + along * c - aside * s, y + along * s + aside * c
        if x * py - y * px >= 0.0:
            if high_x * py - high_y * px > 0.0:
                high_x, high_y = px, py
        elif low_x * py - low_y * px < 0.0:
            low_x, low_y = px, py
    first = atan2(low_y, low_x)
    if first <= -pi:
        first += 2.0 * pi
    return first, first + atan2(low_x * high_y - low_y * high_x, low_x * high_x + low_y * high_y)


@inlined
def nearest(x, y, c, s, length, width):
    """The point of an outline that is nearest: forward and left [m]."""
    along = min(max(-(x * c + y * s), -0.5 * length), 0.5 * length)
    aside = min(max(x * s - y * c, -0.5 * width), 0.5 * width)
    return x + along * c - aside * s, y + along * s + aside * c


@inlined
def met(bearing, x, y, c, s, length, width):
    """Distance [m] along a bearing to an outline; infinite where it is missed. The part of a line within a box: A. Williams et al. 2005."""
    ahead, left = cos(bearing), sin(bearing)
    enters, leaves = 0.0, inf
    for i in range(2):
        start = -(x * c + y * s) if i == 0 else x * s - y * c
        step = ahead * c + left * s if i == 0 else left * c - ahead * s
        half = 0.5 * length if i == 0 else 0.5 * width
        if abs(step) < 1e-12:
            if abs(start) > half:
                return inf
            continue
        one, other = (-half - start) / step, (half - start) / step
        enters, leaves = max(enters, min(one, other)), min(leaves, max(one, other))
    return enters if enters <= leaves else inf


@inlined
def grown(noise, growth, distance):
    """Standard deviation of a noise that grows with the distance [m]."""
    return noise + growth * distance


@inlined
def far(x, y):
    """Distance [m]."""
    return sqrt(x * x + y * y)
