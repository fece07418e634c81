"""Outlines: the gap between two boxes on the ground that do not overlap.

The nearest points of two convex polygons that are apart include a corner of one of them, so that the least distance of all corners of each
to the other box is the gap (J. O'Rourke, Computational Geometry in C, 2nd ed., section 7.4).
"""

from math import cos, inf, sin, sqrt

from studio.compiled import inlined, lean


@inlined
def to_box(x, y, length, width):
    """Distance [m] of a point, given in the axes of a box from its middle, to the box; zero inside."""
    beyond_x, beyond_y = max(abs(x) - 0.5 * length, 0.0), max(abs(y) - 0.5 * width, 0.0)
    return sqrt(beyond_x * beyond_x + beyond_y * beyond_y)


@lean
def corners_to_box(dx, dy, psi, length, width, psi_box, length_box, width_box):
    """Least distance [m] of the corners of a box, whose middle is (dx, dy) [m] from that of another, to the other."""
    c, s, least = cos(psi_box), sin(psi_box), inf
    a, b = 0.5 * length, 0.5 * width
    for ahead, left in ((a, b), (a, -b), (-a, b), (-a, -b)):
        x, y = dx + ahead * cos(psi) - left * sin(psi), dy + ahead * sin(psi) + left * cos(psi)
        least = min(least, to_box(x * c + y * s, y * c - x * s, length_box, width_box))
    return least


@lean
def gap(dx, dy, psi_a, length_a, width_a, psi_b, length_b, width_b):
    """Gap [m] between two boxes that do not overlap, the middle of b (dx, dy) [m] from that of a."""
    of_b = corners_to_box(dx, dy, psi_b, length_b, width_b, psi_a, length_a, width_a)
    return min(of_b, corners_to_box(-dx, -dy, psi_a, length_a, width_a, psi_b, length_b, width_b))
