"""Following: how near a follower (f) with gap s [m], bumper to bumper, came to the leader (l) ahead of it on its path.

With Δv = v_f - v_l and Δa = a_f - a_l:

    TTC  = s/Δv                            while closing      (J. C. Hayward, Near miss determination, 1972)
    THW  = s/v_f                           while rolling
    DRAC = Δv²/(2 s)                       deceleration that just avoids a collision with a leader who keeps his speed
                                           (D. F. Cooper, N. Ferguson, Traffic studies at T-junctions, 1976)
    MDRAC = Δv/(2 (TTC - PRT))             the same after a reaction time PRT (S. M. S. Mahmud et al., IATSS Research 41 (2017) 153)
    MTTC : s = Δv t + Δa t²/2, its least positive root t      (K. Ozbay et al., Transportation Research Record 2083 (2008) 105)
    TET  = ∫ 1[TTC < TTC*] dt,   TIT = ∫ (TTC* - TTC)⁺ dt
                                           (M. M. Minderhoud, P. H. L. Bovy, Accident Analysis and Prevention 33 (2001) 89)

Required deceleration of a leader who brakes himself with b_l = -a_l: while both roll the gap closes by Δv²/(2 (b - b_l)), which gives

    b = b_l + Δv²/(2 s)                    if speeds are equal before he stands, v_l/b_l ≥ Δv/(b - b_l),
    b = v_f²/(2 (s + v_l²/(2 b_l)))        if he stands first.

Brake threat number: b over the greatest deceleration (M. Brännström et al., Model-based threat assessment for avoiding arbitrary vehicle
collisions, IEEE Trans. Intelligent Transportation Systems 11 (2010) 658). Steer threat number: the lateral acceleration that carries the
car past the nearer side of what is ahead until it would be there, a_y = 2 (Δy - v_y TTC)/TTC², over the greatest one (as before).

All arguments are arrays of one shape; what does not apply is infinite, or zero for a deceleration; without a leader it is not a number.
"""

from typing import NamedTuple

import numpy as np

from studio.execution.record import Record

CLOSING = 0.1  # [m/s] slower than this nobody comes nearer: it would take minutes, and sensors could not tell
ROLLING = 0.5  # [m/s] below this speed a time gap says nothing
STEADY = 1e-6  # [m/s²] accelerations that differ by less are the same


class Pair(NamedTuple):
    """Followers and their leaders over time, float64[vehicle, n]."""

    gap: np.ndarray  # [m]
    speed: np.ndarray  # [m/s] of the follower
    ahead_speed: np.ndarray  # [m/s]
    acceleration: np.ndarray  # [m/s²]
    ahead_acceleration: np.ndarray  # [m/s²]


def pairs(record: Record) -> Pair:
    """Every recorded vehicle with what is ahead of it."""
    gap, speed, ahead_speed, acceleration = map(record.channel, ("gap", "speed", "ahead_speed", "acceleration"))
    return Pair(gap, speed, ahead_speed, acceleration, ahead_acceleration(record))


def ahead_acceleration(record: Record) -> np.ndarray:
    """Acceleration [m/s²] of what is ahead: its own where it was recorded, else the change of its speed while it is the same one."""
    row, ahead = rows_ahead(record), record.channel("ahead")
    own = np.take_along_axis(record.channel("acceleration"), np.maximum(row, 0), axis=0)
    return np.where(row >= 0, own, change(record.channel("ahead_speed"), ahead, record.time))


def rows_ahead(record: Record) -> np.ndarray:
    """The row of the vehicle ahead of every vehicle, int[vehicle, n]; -1 where there is none that was recorded."""
    ahead, place = record.channel("ahead"), {name: i for i, name in enumerate(record.vehicles)}
    rows = np.array([*(place.get(record.called.get(i, ""), -1) for i in range(1 + max(record.called, default=-1))), -1])
    number = np.where(np.isfinite(ahead) & (ahead >= 0.0), ahead, -1.0).astype(int)
    return rows[np.where(number < rows.size - 1, number, -1)]


def change(speed: np.ndarray, ahead: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Change of a speed per time [m/s²], backwards; zero where it is that of somebody else than at the sample before."""
    found = np.zeros(speed.shape)
    if time.size > 1:
        same = ahead[:, 1:] == ahead[:, :-1]
        found[:, 1:] = np.where(same, np.diff(speed, axis=1) / np.diff(time), 0.0)
    return found


def closing_speed(p: Pair) -> np.ndarray:
    """Δv [m/s]."""
    return p.speed - p.ahead_speed


def time_to_collision(gap: np.ndarray, speed: np.ndarray, ahead_speed: np.ndarray) -> np.ndarray:
    """TTC [s], infinite while not closing."""
    closing = speed - ahead_speed
    ttc = np.full(gap.shape, np.inf)
    np.divide(gap, closing, out=ttc, where=closing > CLOSING)
    return np.where(np.isnan(gap), np.nan, ttc)


def ttc(record: Record) -> np.ndarray:
    """TTC [s] of every recorded vehicle over time."""
    return time_to_collision(record.channel("gap"), record.channel("speed"), record.channel("ahead_speed"))


def time_headway(p: Pair) -> np.ndarray:
    """THW [s], infinite at standstill."""
    return np.where(p.speed > ROLLING, p.gap / np.maximum(p.speed, ROLLING), np.where(np.isnan(p.gap), np.nan, np.inf))


def drac(p: Pair) -> np.ndarray:
    """DRAC [m/s²], zero while not closing, infinite at contact."""
    return decelerated(closing_speed(p), p.gap)


def decelerated(closing: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """Δv²/(2 s) [m/s²]."""
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.where(gap > 0.0, closing**2 / (2.0 * gap), np.inf)
    return np.where(np.isnan(gap), np.nan, np.where(closing > CLOSING, found, 0.0))


def mdrac(p: Pair, reaction: float) -> np.ndarray:
    """MDRAC [m/s²] with PRT [s], zero while not closing, infinite once it is too late to react."""
    left = time_to_collision(p.gap, p.speed, p.ahead_speed) - reaction
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.where(left > 0.0, closing_speed(p) / (2.0 * left), np.inf)
    return np.where(np.isnan(p.gap), np.nan, np.where(np.isinf(left), 0.0, found))


def mttc(p: Pair) -> np.ndarray:
    """MTTC [s], infinite where the gap never closes while both keep their accelerations.

    t = 2 s/(Δv + √(Δv² + 2 Δa s)) is that root for Δa of either sign, and TTC for Δa = 0.
    """
    closing, da = closing_speed(p), p.acceleration - p.ahead_acceleration
    da = np.where(np.abs(da) < STEADY, 0.0, da)
    inside = closing**2 + 2.0 * da * p.gap
    with np.errstate(divide="ignore", invalid="ignore"):
        root = 2.0 * p.gap / (closing + np.sqrt(inside))
    meets = (inside >= 0.0) & (root > 0.0) & ((da > 0.0) | (closing > CLOSING))
    return np.where(np.isnan(p.gap), np.nan, np.where(meets, root, np.inf))


def required_deceleration(p: Pair) -> np.ndarray:
    """b [m/s²], at least zero; infinite at contact."""
    closing, b_l = closing_speed(p), np.maximum(-p.ahead_acceleration, 0.0)
    both = b_l + decelerated(closing, p.gap)
    with np.errstate(divide="ignore", invalid="ignore"):
        stands = np.where(b_l > STEADY, p.ahead_speed / b_l, np.inf)  # [s] until the leader does
        equal = np.where(closing > CLOSING, 2.0 * p.gap / closing, np.where(b_l > STEADY, np.inf, 0.0))  # [s] until speeds are
        first = p.speed**2 / (2.0 * (p.gap + np.where(b_l > STEADY, p.ahead_speed**2 / (2.0 * b_l), 0.0)))
    found = np.where(equal <= stands, both, first)
    return np.where(np.isnan(p.gap), np.nan, np.where(p.gap > 0.0, found, np.inf))


def lateral_acceleration_needed(aside: np.ndarray, lateral_speed: np.ndarray | float, ttc: np.ndarray) -> np.ndarray:
    """a_y [m/s²] that carries a car over a way aside Δy [m] within TTC, which it begins with v_y [m/s]; zero with time for ever."""
    with np.errstate(divide="ignore", invalid="ignore"):
        found = 2.0 * (aside - lateral_speed * ttc) / ttc**2
    return np.where(np.isnan(ttc), np.nan, np.where(np.isinf(ttc), 0.0, np.maximum(found, 0.0)))


# -- for how long --------------------------------------------------------------------------------------


def time_exposed(ttc: np.ndarray, time: np.ndarray, limit: float) -> np.ndarray:
    """TET [s], per row, and where TTC passes the limit between two samples found by a straight line in 1/TTC."""
    return crossed(ttc, time, limit)[0]


def time_integrated(ttc: np.ndarray, time: np.ndarray, limit: float) -> np.ndarray:
    """TIT [s²], per row, by trapezoids that begin and end where TTC passes the limit."""
    return crossed(ttc, time, limit)[1]


def crossed(ttc: np.ndarray, time: np.ndarray, limit: float) -> tuple[np.ndarray, np.ndarray]:
    """TET and TIT of each row, float64[vehicle, n]."""
    with np.errstate(divide="ignore", invalid="ignore"):
        urgency = np.where(np.isnan(ttc), 0.0, 1.0 / np.maximum(ttc, 0.0)) - 1.0 / limit  # [1/s] above zero: in danger
    deep = np.where(np.isfinite(ttc), np.maximum(limit - ttc, 0.0), 0.0)  # [s]
    u_0, u_1 = urgency[..., :-1], urgency[..., 1:]
    share = np.where((u_0 > 0.0) & (u_1 > 0.0), 1.0, inside(u_0, u_1))
    lasts = share * np.diff(time)
    return lasts.sum(axis=-1), (0.5 * (deep[..., :-1] + deep[..., 1:]) * lasts).sum(axis=-1)


def inside(u_0: np.ndarray, u_1: np.ndarray) -> np.ndarray:
    """The part of an interval in which a straight line from u_0 to u_1 is above zero, where it passes zero; else none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.maximum(u_0, u_1) / np.abs(u_1 - u_0)
    passes = (u_0 > 0.0) != (u_1 > 0.0)
    return np.where(passes, np.where(np.isfinite(part), part, 1.0), 0.0)
