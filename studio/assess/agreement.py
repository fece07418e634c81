"""Agreement: how long it took until a maneuver was agreed on.

A unit that asks for a maneuver gives it a number; its messages about it carry the step and this number first
(studio/kinds/message/maneuver.py). From its first request to its first commitment is the time of the agreement.
"""

from collections.abc import Iterator

from studio.execution.record import Record
from studio.kind.metric import Found

MANEUVER = "maneuver"
REQUEST, COMMIT, ABORT = 1.0, 4.0, 6.0


def agreements(record: Record) -> Iterator[Found]:
    """Time [s] from request to commitment of every maneuver that came so far: who asked, and when it was agreed on."""
    sent = record.messages
    if MANEUVER not in sent.kinds:
        return
    for sender, identity in maneuvers(record):
        own = (sent.kind == sent.kinds.index(MANEUVER)) & (sent.sender == sender) & (sent.said_1 == identity)
        asked, agreed = (sent.time[own & (sent.said_0 == step)] for step in (REQUEST, COMMIT))
        if asked.size and agreed.size and agreed[0] >= asked[0]:
            yield Found(float(agreed[0] - asked[0]), (sent.units[sender],), float(agreed[0]))


def maneuvers(record: Record) -> list[tuple[int, float]]:
    """Who has asked, and the numbers that they have given."""
    sent = record.messages
    asking = (sent.kind == sent.kinds.index(MANEUVER)) & (sent.said_0 == REQUEST)
    return sorted(set(zip(sent.sender[asking].tolist(), sent.said_1[asking].tolist(), strict=True)))


def aborted(record: Record) -> float:
    """How many maneuvers were asked for and taken back by who had asked [1]; none asked for: nothing."""
    sent = record.messages
    if MANEUVER not in sent.kinds or not (asked := maneuvers(record)):
        return float("nan")
    back = (sent.kind == sent.kinds.index(MANEUVER)) & (sent.said_0 == ABORT)
    return float(len(set(asked) & set(zip(sent.sender[back].tolist(), sent.said_1[back].tolist(), strict=True))))
