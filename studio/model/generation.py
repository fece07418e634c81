"""When messages are due that trigger themselves: awareness (CAM) and perceived objects (CPM).

ETSI EN 302 637-2 V1.4.1, 6.1.3: it is looked at least every 100 ms. A CAM is generated when T_GenCam_Dcc has passed since the last one
and since then the heading has changed by more than 4 degrees, the position by more than 4 m or the speed by more than 0.5 m/s; T_GenCam is
then the time that has passed. It is also generated when T_GenCam has passed; after N_GenCam = 3 of these in a row T_GenCam is 1 s again.

ETSI TS 103 324, 6.1.2.3: an object belongs into a CPM when it has moved by more than 4 m, has become faster or slower by more than
0.5 m/s, or has turned by more than 4 degrees since it was last told of, or when T_GenCpmMax = 1 s has passed.

The conditions are strict, and usual speeds meet them with equality: 40 m/s for 0.1 s are 4 m. So everything is counted in whole numbers,
in the steps in which messages carry it: ms, cm, cm/s and tenths of a degree.
"""

from math import degrees

from studio.compiled import compiled

MOVED = 400  # [cm]
TURNED = 40  # [0.1 degree]
FASTER = 50  # [cm/s]
SHORTEST, LONGEST = 100, 1000  # [ms] between two messages
IN_A_ROW = 3  # messages that only time has triggered, after which T_GenCam is LONGEST


@compiled
def milliseconds(time):
    """Whole ms of a time [s]."""
    return int(round(time * 1e3))


@compiled
def hundredths(value):
    """Whole cm of a length [m], or cm/s of a speed [m/s]."""
    return int(round(value * 1e2))


@compiled
def tenths_of_degree(angle):
    """Whole tenths of a degree of an angle [rad]."""
    return int(round(degrees(angle) * 10.0))


@compiled
def has_changed(moved, turned, faster):
    """Whether something has changed so much that others must know: [cm], [0.1 degree], [cm/s]."""
    return moved > MOVED or abs(turned) > TURNED or abs(faster) > FASTER


@compiled
def awareness(elapsed, gap, interval, timed, changed):
    """Whether a CAM is due `elapsed` [ms] after the last; T_GenCam [ms] and the number of timed ones in a row from then on.

    `gap` is T_GenCam_Dcc, `interval` T_GenCam [ms]; `changed` is what `has_changed` says.
    """
    if changed and elapsed >= max(gap, SHORTEST):
        return True, min(elapsed, LONGEST), 0
    if elapsed < max(interval, gap):
        return False, interval, timed
    return True, (LONGEST if timed + 1 >= IN_A_ROW else interval), timed + 1


@compiled
def is_told(elapsed, changed):
    """Whether an object belongs into a CPM `elapsed` [ms] after it was last told of."""
    return changed or elapsed >= LONGEST
