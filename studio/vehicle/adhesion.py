"""Adhesion: how much of it the wheels use, made of the fleet's state whenever somebody records it.

A tyre past its peak of slip transmits less than it could: its use of adhesion is below 1, and yet it is at its limit. Which tyres are is
kept as one number, of a bit for each.
"""

from studio.compiled import lean
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

    Forces are those that have just acted. Where the ground has become slippery since, they are more than it gives now: all of it is used.
    """
    for i in range(columns.size):
        values[SLIDING, i] = 0.0
        for corner in range(4):
            w, side = corner * n + columns[i], 1.0 - 2.0 * (corner % 2)
            t = tyre_at(tyres, tyres_of[corner // 2, columns[i]])
            F = min(wheels[F_Z, w], OVERLOAD * t.LFZO * t.FNOMIN)
            values[corner, i] = min(adhesion.used(t, wheels[F_X, w], wheels[F_Y, w], F, ground[MU, w]), 1.0)
            if tyre.slides(t, wheels[KAPPA, w], side * wheels[ALPHA, w], F, ground[MU, w]):
                values[SLIDING, i] += 1 << corner
