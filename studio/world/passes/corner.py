"""Corners: who is hidden where strands meet, and how slowly one comes to a place where one gives way.

    hidden     by a building; who is farther from where two strands meet than one sees along his strand is minded by nobody
    careful    who gives way, and would not have passed when one comes whom he does not see yet, drives so that he can stop before the line;
               beyond it he feels his way to where the strands meet, with walking pace at last (German StVO § 8 (2), sentences 2 and 3)

How far one sees stands in the map: road/ways/corner.py.
"""

from math import inf, sqrt

from studio.compiled import inlined
from studio.road.ways.corner import APART, FAR, SAMPLES

WALKING = 2.0  # [m/s] 7 km/h; in such steps one feels one's way, and stops within half a metre
READY = 0.5  # [m] before where strands meet


@inlined
def seen_along(m, to_enter, web):
    """How far [m] one sees along the partner of a meeting, with one's front `to_enter` [m] before it."""
    at = min(max(to_enter / APART, 0.0), SAMPLES - 1.001)
    i = int(at)
    return web.sight[i, m] + (at - i) * (web.sight[i + 1, m] - web.sight[i, m])


@inlined
def appears_after(m, to_enter, web):
    """The same, infinite where one sees far enough."""
    seen = seen_along(m, to_enter, web)
    return seen if seen < FAR else inf


@inlined
def is_hidden(m, to_enter, its_way, web):
    """Whether one who is `its_way` [m] before a place is hidden from one who is `to_enter` before it."""
    return its_way > appears_after(m, to_enter, web)


@inlined
def appears_in(m, to_enter, web):
    """When somebody is where two strands meet [s] who comes around the corner just now; infinite where one sees far enough."""
    return appears_after(m, to_enter, web) / web.fast[m]


@inlined
def has_corner(m, web):
    """Whether one who comes to a meeting does not see all of the partner from afar."""
    return web.sight[SAMPLES - 1, m] < FAR


@inlined
def ready_speed(distance, b):
    """Speed [m/s] from which one stops within a distance [m] with a deceleration b [m/s²], and walking pace at last."""
    return sqrt(WALKING * WALKING + 2.0 * b * max(distance, 0.0))
