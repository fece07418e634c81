"""Tracks: a sensor that follows several targets gives each a number, which it keeps, and tells for how sure it takes it that it exists.

A real tracker knows no vehicle's name: a target gets the next number when it is seen first, and another one when it comes again after it
has been forgotten. With each look at which a target is seen its existence e goes to 1 - (1 - e)(1 - g), with each at which it is not to
e (1 - g), g a gain: that of a target that is always there after n looks is 1 - (1 - g)ⁿ. Below FORGOTTEN the track ends. Which target of
a look is which track is always told right: mistaking one for another is not simulated.

A kind keeps `Tracks` as its Memory:

    begin(view, memory)                                 before a look
    t = follow(view, me, who, gain)                     for every target that is seen; its number is `number(view, t)`, and so on
    return count, end(view, gain)                       after it
"""

from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.world.passes.sight import TRACK_EXISTENCE, TRACK_NUMBER, TRACK_SEEN, TRACK_SINCE, TRACK_WHO

MOST = 8  # tracks of a sensor
NOBODY = -1.0
FORGOTTEN = 0.05
Eight = tuple[float, float, float, float, float, float, float, float]
NONE = (0.0,) * MOST


class Tracks(NamedTuple):
    """The tracks of a sensor; who is followed is for telling targets apart, and goes to nobody."""

    who: Annotated[Eight, "1", "number in its world of what is followed, or OBJECT - i; -1 for nobody"] = (NOBODY,) * MOST
    number: Annotated[Eight, "1", "of the track"] = NONE
    since: Annotated[Eight, "s", "when it began"] = NONE
    existence: Annotated[Eight, "1", "how sure it is"] = NONE
    last: Annotated[float, "1", "number of the newest track"] = 0.0


@inlined
def are_none(memory):
    """Whether nobody is followed."""
    for each in memory.existence:
        if each > 0.0:
            return False
    return True


@inlined
def begin(view, memory):
    """Lays the tracks out; nobody has been seen at this look."""
    for t in range(MOST):
        view.sight[TRACK_WHO, t], view.sight[TRACK_NUMBER, t] = memory.who[t], memory.number[t]
        view.sight[TRACK_SINCE, t], view.sight[TRACK_EXISTENCE, t], view.sight[TRACK_SEEN, t] = memory.since[t], memory.existence[t], 0.0
    view.sight[TRACK_NUMBER, MOST] = memory.last


@inlined
def name_of(view, me, who):
    """How a track remembers a vehicle, by its column, or object: as their world numbers them, whatever batch it is in."""
    return view.number[int(who)] if who >= 0.0 else who + view.first_object[me.world]


@inlined
def track_of(view, name):
    """The track of somebody, else the one that is least sure among those not seen at this look."""
    best, least = 0, 2.0
    for t in range(MOST):
        if view.sight[TRACK_WHO, t] == name:
            return t
        if view.sight[TRACK_SEEN, t] == 0.0 and view.sight[TRACK_EXISTENCE, t] < least:
            best, least = t, view.sight[TRACK_EXISTENCE, t]
    return best


@inlined
def follow(view, me, who, gain):
    """The track of a target that is seen; a new one for one that is new."""
    sight, name = view.sight, name_of(view, me, who)
    t = track_of(view, name)
    if sight[TRACK_WHO, t] != name:
        sight[TRACK_NUMBER, MOST] += 1.0
        sight[TRACK_WHO, t], sight[TRACK_NUMBER, t] = name, sight[TRACK_NUMBER, MOST]
        sight[TRACK_SINCE, t], sight[TRACK_EXISTENCE, t] = view.time, 0.0
    sight[TRACK_EXISTENCE, t] = 1.0 - (1.0 - sight[TRACK_EXISTENCE, t]) * (1.0 - gain)
    sight[TRACK_SEEN, t] = 1.0
    return t


@inlined
def end(view, gain):
    """The tracks after a look."""
    sight = view.sight
    for t in range(MOST):
        if sight[TRACK_SEEN, t] == 0.0:
            sight[TRACK_EXISTENCE, t] *= 1.0 - gain
            if sight[TRACK_EXISTENCE, t] < FORGOTTEN:
                sight[TRACK_WHO, t], sight[TRACK_EXISTENCE, t] = NOBODY, 0.0
    return Tracks(
        eight(sight, TRACK_WHO), eight(sight, TRACK_NUMBER), eight(sight, TRACK_SINCE), eight(sight, TRACK_EXISTENCE),
        sight[TRACK_NUMBER, MOST],
    )  # fmt: skip


@inlined
def eight(sight, row):
    """The first columns of a row."""
    return (
        sight[row, 0], sight[row, 1], sight[row, 2], sight[row, 3], sight[row, 4], sight[row, 5], sight[row, 6], sight[row, 7],
    )  # fmt: skip


@inlined
def number(view, t):
    """Of a track."""
    return view.sight[TRACK_NUMBER, t]


@inlined
def existence(view, t):
    """Of a track."""
    return view.sight[TRACK_EXISTENCE, t]


@inlined
def lasted(view, t):
    """How long [s] a track has been followed."""
    return view.time - view.sight[TRACK_SINCE, t]
