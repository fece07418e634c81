"""Shortest ways of a car that can drive forward and backward, and turns no tighter than a circle of radius r.

words(x, y, phi)     →  Word, ...      every candidate that ends at a goal, for r = 1
shortest(x, y, phi, r)  →  Word        the shortest of them

J. A. Reeds, L. A. Shepp, Optimal paths for a car that goes both forwards and backwards, Pacific J. Math. 145 (1990) 367, Sect. 8.

A word is a list of pieces: turn +1 left, 0 straight, -1 right, and signed length [r], negative backward. Only one of the symmetric forms of
each family is written down: driven the other way in time (x, phi change signs), mirrored (y, phi change signs), from the goal to the start.
Every candidate is driven to its end before it is believed, so that a wrong branch of an arc function cannot give a wrong way.
"""

from collections.abc import Iterator
from itertools import pairwise
from math import acos, asin, atan2, cos, hypot, pi, sin, sqrt
from typing import NamedTuple

LEFT, STRAIGHT, RIGHT = 1, 0, -1
NEAR = 1e-6  # [r], [rad] of a goal that is reached


class Piece(NamedTuple):
    """An arc of the circle, or a straight."""

    turn: int  # 1 left, 0 straight, -1 right
    length: float  # [r], negative backward


Word = tuple[Piece, ...]


def wrapped(angle: float) -> float:
    """An angle [rad] within ±pi."""
    return atan2(sin(angle), cos(angle))


def moved(x: float, y: float, phi: float, piece: Piece) -> tuple[float, float, float]:
    """Where a car is after a piece of its way; lengths [r]."""
    turn, s = piece
    if turn == STRAIGHT:
        return x + s * cos(phi), y + s * sin(phi), phi
    psi = phi + turn * s
    return x + turn * (sin(psi) - sin(phi)), y - turn * (cos(psi) - cos(phi)), psi


def end(word: Word) -> tuple[float, float, float]:
    """Where a way from the origin along x ends."""
    at = (0.0, 0.0, 0.0)
    for piece in word:
        at = moved(*at, piece)
    return at


def length(word: Word) -> float:
    """Of all pieces together [r]."""
    return sum(abs(piece.length) for piece in word)


def changes(word: Word) -> int:
    """How often a way changes its direction."""
    signs = [piece.length > 0.0 for piece in word]
    return sum(a != b for a, b in pairwise(signs))


# -- the families, in the form that the paper gives each ---------------------------------------------


def left_straight_left(x: float, y: float, phi: float) -> Iterator[Word]:
    """(8.1) L+ S+ L+."""
    xi, eta = x - sin(phi), y - 1.0 + cos(phi)
    u, t = hypot(xi, eta), atan2(eta, xi)
    yield Piece(LEFT, t), Piece(STRAIGHT, u), Piece(LEFT, wrapped(phi - t))


def left_straight_right(x: float, y: float, phi: float) -> Iterator[Word]:
    """(8.2) L+ S+ R+."""
    xi, eta = x + sin(phi), y - 1.0 - cos(phi)
    away = xi * xi + eta * eta
    if away >= 4.0:
        u = sqrt(away - 4.0)
        t = wrapped(atan2(eta, xi) + atan2(2.0, u))
        yield Piece(LEFT, t), Piece(STRAIGHT, u), Piece(RIGHT, wrapped(t - phi))


def three_arcs(x: float, y: float, phi: float) -> Iterator[Word]:
    """(8.3), (8.4) L+ R- L±."""
    xi, eta = x - sin(phi), y - 1.0 + cos(phi)
    away = hypot(xi, eta)
    if away <= 4.0:
        u = -2.0 * asin(away / 4.0)
        t = wrapped(atan2(eta, xi) + u / 2.0 + pi)
        yield Piece(LEFT, t), Piece(RIGHT, u), Piece(LEFT, wrapped(phi - t + u))


def outer(u: float, v: float, xi: float, eta: float, phi: float) -> tuple[float, float]:
    """Lengths of the first and the last of four arcs, whose inner ones are u and v."""
    delta = wrapped(u - v)
    a, b = sin(u) - sin(delta), cos(u) - cos(delta) - 1.0
    t = atan2(eta * a - xi * b, xi * a + eta * b)
    turned = 2.0 * (cos(delta) - cos(v) - cos(u)) + 3.0 < 0.0
    t = wrapped(t + pi) if turned else t
    return t, wrapped(t - u + v - phi)


def four_arcs(x: float, y: float, phi: float) -> Iterator[Word]:
    """(8.7) L+ R+ L- R- and (8.8) L+ R- L- R+, the inner arcs of equal length."""
    xi, eta = x + sin(phi), y - 1.0 - cos(phi)
    rho = (2.0 + hypot(xi, eta)) / 4.0
    if rho <= 1.0:
        u = acos(rho)
        t, v = outer(u, -u, xi, eta, phi)
        yield Piece(LEFT, t), Piece(RIGHT, u), Piece(LEFT, -u), Piece(RIGHT, v)
    rho = (20.0 - xi * xi - eta * eta) / 16.0
    if 0.0 <= rho <= 1.0:
        u = -acos(rho)
        t, v = outer(u, u, xi, eta, phi)
        yield Piece(LEFT, t), Piece(RIGHT, u), Piece(LEFT, u), Piece(RIGHT, v)


def quarter_then_straight(x: float, y: float, phi: float) -> Iterator[Word]:
    """(8.9) L+ R-(pi/2) S- L- and (8.10) L+ R-(pi/2) S- R-."""
    xi, eta = x - sin(phi), y - 1.0 + cos(phi)
    away = hypot(xi, eta)
    if away >= 2.0:
        r = sqrt(away * away - 4.0)
        t = wrapped(atan2(eta, xi) + atan2(r, -2.0))
        yield Piece(LEFT, t), Piece(RIGHT, -pi / 2.0), Piece(STRAIGHT, 2.0 - r), Piece(LEFT, wrapped(phi - pi / 2.0 - t))
    xi, eta = x + sin(phi), y - 1.0 - cos(phi)
    away, t = hypot(xi, eta), atan2(xi, -eta)
    if away >= 2.0:
        yield Piece(LEFT, t), Piece(RIGHT, -pi / 2.0), Piece(STRAIGHT, 2.0 - away), Piece(RIGHT, wrapped(t + pi / 2.0 - phi))


def two_quarters(x: float, y: float, phi: float) -> Iterator[Word]:
    """(8.11) L+ R-(pi/2) S- L-(pi/2) R+."""
    xi, eta = x + sin(phi), y - 1.0 - cos(phi)
    away = hypot(xi, eta)
    if away >= 2.0:
        u = 4.0 - sqrt(away * away - 4.0)
        t = wrapped(atan2((4.0 - u) * xi - 2.0 * eta, -2.0 * xi + (u - 4.0) * eta))
        quarter = -pi / 2.0
        yield Piece(LEFT, t), Piece(RIGHT, quarter), Piece(STRAIGHT, u), Piece(LEFT, quarter), Piece(RIGHT, wrapped(t - phi))


FAMILIES = (left_straight_left, left_straight_right, three_arcs, four_arcs, quarter_then_straight, two_quarters)


def images(word: Word, back: bool, mirrored: bool) -> Word:
    """A word of a symmetric problem as one of the given one."""
    return tuple(Piece(-turn if mirrored else turn, -s if back else s) for turn, s in word)


def words(x: float, y: float, phi: float) -> Iterator[Word]:
    """Every candidate from the origin along x to a goal [r], [rad]."""
    from_goal = (x * cos(phi) + y * sin(phi), x * sin(phi) - y * cos(phi))
    for family in FAMILIES:
        for back in (False, True):
            for mirrored in (False, True):
                a, b, turn = (-1.0 if back else 1.0), (-1.0 if mirrored else 1.0), (-1.0 if back != mirrored else 1.0) * phi
                found = [images(each, back, mirrored) for each in family(a * x, b * y, turn)]
                found += [images(each, back, mirrored)[::-1] for each in family(a * from_goal[0], b * from_goal[1], turn)]
                yield from (each for each in found if reaches(each, x, y, phi))


def reaches(word: Word, x: float, y: float, phi: float) -> bool:
    """Whether a way ends at the goal."""
    at = end(word)
    return hypot(at[0] - x, at[1] - y) < NEAR and abs(wrapped(at[2] - phi)) < NEAR


def shortest(x: float, y: float, phi: float, r: float = 1.0) -> Word:
    """The shortest way from the origin along x to a goal [m], [rad]; lengths are in r."""
    return min(words(x / r, y / r, phi), key=length)
