"""Changing lanes: whether another lane is worth it, to oneself and to others, and how a car goes over.

Whether: MOBIL, A. Kesting, M. Treiber, D. Helbing, General lane-changing model MOBIL for car-following models, Transportation Research
Record 1999 (2007) 86. With a the acceleration of the law of following and ~ what it would be after the change, c oneself, n the new and o
the old follower, a change is safe while a~_n is no less than -b_safe, and it is wanted when

    a~_c - a_c + p (a~_n - a_n + a~_o - a_o) > a_threshold         p politeness

How: on the quintic of minimum jerk (T. Flash, N. Hogan, The coordination of arm movements, 1985) from one line to the other. It takes a
time, 4 to 6 s as a rule (T. Toledo, D. Zohar, Modeling duration of lane changes, Transportation Research Record 1999 (2007) 71); who is
slow goes over on a length instead, on which a car can be steered.
"""

from studio.compiled import compiled, inlined

DURATION = 5.0  # [s]
SHORTEST = 12.0  # [m] to go over by a lane: the sharpest bend of the quintic, 5.8 · 3.5 m/(12 m)², has a radius of 7 m


@compiled
def incentive(own, own_then, follower, follower_then, old, old_then, p):
    """What a change is worth [m/s²]; accelerations now and then [m/s²]: one's own, of the follower there and of the follower here."""
    return own_then - own + p * (follower_then - follower + old_then - old)


@inlined
def gone_over(share, v, tick):
    """The share [1] of the way over that has been driven a tick [s] later, at v [m/s]."""
    return min(share + tick * min(1.0 / DURATION, max(v, 0.0) / SHORTEST), 1.0)


@inlined
def left_over(share):
    """What is left [1] to go aside, from 1 to 0."""
    return 1.0 - share * share * share * (10.0 - share * (15.0 - 6.0 * share))
