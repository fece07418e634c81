"""Adhesion: how much of it the wheels use, made of the fleet's state whenever somebody records it.

A tyre past its peak of slip transmits less than it could: its use of adhesion is below 1, and yet it is at its limit. Which tyres are is
kept as one number, of a bit for each.
"""

from math import nan

from studio.compiled import inlined, lean
from studio.model import adhesion, tyre
from studio.rows import Role, Table
from studio.vehicle.contact import MU
from studio.vehicle.corner import OVERLOAD
from studio.vehicle.state import ALPHA, F_X, F_Y, F_Z, KAPPA
from studio.vehicle.tile import tyre_at

ADHESION = Table("adhesion", Role.RECORD, per="recorded vehicle")
FRONT_LEFT = ADHESION.row(
    "adhesion_front_left", "1", "force of the tyre over the greatest that it can transmit", label="Use of adhesion, front left"
)
FRONT_RIGHT = ADHESION.row("adhesion_front_right", "1", "the same of this wheel", label="Use of adhesion, front right")
REAR_LEFT = ADHESION.row("adhesion_rear_left", "1", "the same of this wheel", label="Use of adhesion, rear left")
REAR_RIGHT = ADHESION.row("adhesion_rear_right", "1", "the same of this wheel", label="Use of adhesion, rear right")
SLIDING = ADHESION.row(
    "tyres_sliding", "1", "tyres past their peak of slip: the sum of 1 front left, 2 front right, 4 rear left, 8 rear right",
    label="Tyres past their peak of slip",
)  # fmt: skip


@lean
def use(columns, n, tyres, tyres_of, wheels, ground, values):
    """Use of adhesion of some of n vehicles, float64[wheel, vehicle]; tyres_of int64[2, n] are those of the front and the rear axle.

    Of light vehicles, which have none, it is not a number.

    Vehicles that stand side by side on the same tyres are gone through together, wheel by wheel, in vector registers.
    """
    values[SLIDING] = 0.0
    first = 0
    while first < columns.size:
        end = first + alike(first, columns, tyres_of)
        if not has_tyres(columns[first], tyres_of):
            values[:, first:end] = nan
            first = end
            continue
        for corner in range(4):
            t, w = tyre_at(tyres, tyres_of[corner // 2, columns[first]]), corner * n + columns[first]
            run = slice(w, w + end - first)
            F_x, F_y, F_z, mu = wheels[F_X, run], wheels[F_Y, run], wheels[F_Z, run], ground[MU, run]
            use_corner(t, F_x, F_y, F_z, mu, values[corner, first:end])
            slide(t, corner, wheels[KAPPA, run], wheels[ALPHA, run], F_z, mu, values[SLIDING, first:end])
        first = end


@inlined
def alike(first, columns, tyres_of):
    """How many of the vehicles from one on stand side by side on the same tyres."""
    v, count = columns[first], 1
    while first + count < columns.size and columns[first + count] == v + count and has_same(v, v + count, tyres_of):
        count += 1
    return count


@inlined
def has_tyres(v, tyres_of):
    """Whether it is known what the tyres of a vehicle do."""
    return tyres_of[0, v] >= 0


@inlined
def has_same(v, other, tyres_of):
    """Whether two vehicles have the same tyres."""
    return tyres_of[0, v] == tyres_of[0, other] and tyres_of[1, v] == tyres_of[1, other]


@inlined
def load(t, F_z):
    """The load [N] that counts."""
    return min(F_z, OVERLOAD * t.LFZO * t.FNOMIN)


@inlined
def use_corner(t, F_x, F_y, F_z, mu, values):
    """Use of adhesion of one wheel of several vehicles.

    Forces are those that have just acted. Where the ground has become slippery since, they are more than it gives now: all of it is used.
    """
    for i in range(values.size):
        values[i] = min(adhesion.used(t, F_x[i], F_y[i], load(t, F_z[i]), mu[i]), 1.0)


@inlined
def slide(t, corner, kappa, alpha, F_z, mu, values):
    """Adds the bit of a corner for those whose tyre is past its peak there."""
    side, bit = 1.0 - 2.0 * (corner % 2), float(1 << corner)
    for i in range(values.size):
        values[i] += bit if tyre.slides(t, kappa[i], side * alpha[i], load(t, F_z[i]), mu[i]) else 0.0
