"""Bursts: a link that is good or bad for a while, by counter.

Two states (E. N. Gilbert, Bell System Technical Journal 39, 1960; E. O. Elliott, the same 42, 1963). From one step to the next a good link
turns bad with the probability a, a bad one good with b:

    share of bad steps  a/(a + b)        mean run of bad steps  1/b        of good ones  1/a

Which state a step has is found without remembering any: the draw u of a step decides alone if it is below the lesser of a and 1 - b (bad,
whatever was before) or not below the greater (good); in between it keeps the state before where a < 1 - b, and turns it where a > 1 - b.
So one looks back to the last draw that decides, |1 - a - b| of all do not (J. G. Propp, D. B. Wilson, Random Structures and Algorithms 9,
1996: coupling from the past). The states are those of a chain that has run for ever, whoever asks for them and in whatever order.
"""

from studio.compiled import compiled
from studio.model.random import uniforms

FARTHEST = 20_000  # steps that are looked back; beyond it a chain that hardly ever changes is good
FIRST = 1 << 30  # numbers of draws are not negative


@compiled
def is_bad(seed, entity, stream, step, to_bad, to_good):
    """Whether a link is bad at a step; to_bad is a, to_good b. Four steps each are drawn together."""
    low, high = min(to_bad, 1.0 - to_good), max(to_bad, 1.0 - to_good)
    turns, turned = to_bad > 1.0 - to_good, False
    four, last = (FIRST + step) // 4, (FIRST + step) % 4
    for _ in range(FARTHEST // 4):
        draws = uniforms(seed, entity, stream, four)
        for i in range(last, -1, -1):
            if draws[i] < low or draws[i] >= high:
                return (draws[i] < low) != turned
            turned = turned != turns
        four, last = four - 1, 3
    return False


@compiled
def of_loss(loss, run):
    """a and b with this share of bad steps and this mean run of them; independent steps where runs are not longer than chance's."""
    if loss >= 1.0:
        return 1.0, 0.0
    run = max(run, 1.0 / (1.0 - loss))
    return loss / (run * (1.0 - loss)), 1.0 / run


@compiled
def of_times(good, bad, step):
    """a and b of a chain in time: mean durations of both states and of a step [s]; a duration of 0 is a state that is never there."""
    if bad <= 0.0:
        return 0.0, 1.0
    if good <= 0.0:
        return 1.0, 0.0
    return min(step / good, 1.0), min(step / bad, 1.0)
