"""Causes: what may become of a message on one link. A radio says one of them; 0 is that it arrives.

    FADING = cause("fading", "the signal was too weak for a moment")

A plain integer, which fits into a byte of the log of messages.
"""

from typing import NamedTuple


class Cause(NamedTuple):
    """One of them: its name, and what it is in words."""

    name: str
    meaning: str


CAUSES: list[Cause] = []


def cause(name: str, meaning: str) -> int:
    """Declares a cause and returns its number. Raises ValueError."""
    if name in {each.name for each in CAUSES}:
        raise ValueError(f"there is a cause {name!r} already")
    CAUSES.append(Cause(name, meaning))
    return len(CAUSES) - 1


RECEIVED = cause("received", "it arrives")
CHANCE = cause("chance", "lost at a rate, for no reason that the radio knows")  # the number of a plain yes
OUT_OF_RANGE = cause("out_of_range", "the receiver is farther away than anything can be heard")
TOO_WEAK = cause("too_weak", "the signal is too weak after its way")
BUILDING = cause("building", "it would have been strong enough without the buildings on its way")
FADING = cause("fading", "the signal was too weak for a moment, where its mean would have been enough")
BURST = cause("burst", "the link is in a bad state, in which losses come in runs")
BUSY = cause("busy", "another message was on the channel at the same time")
NO_COVERAGE = cause("no_coverage", "sender or receiver is in no cell")
BANDWIDTH = cause("bandwidth", "the cell has more to carry than it can")
JAMMED = cause("jammed", "the receiver is where a jammer sends")
DROPPED = cause("dropped", "the script has had it dropped")
ABSENT = cause("absent", "the receiver takes no part")
DECK = cause("deck", "it would have been strong enough without the bridge or the tunnel between the two")
