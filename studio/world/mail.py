"""Mail: which messages were sent, came in or were lost since the tick before, for conditions of the script that look at it.

Columns stand for the senders of every kind of message, and for every link between two units. A message counts as sent, and as lost on a
link that it will not come over, when it is sent; as received when it has arrived. All follows from what is under way; nothing is kept.
"""

from collections.abc import Sequence

import numpy as np

from studio.kind import registry
from studio.rows import Role, Table
from studio.world.board.post import Post
from studio.world.table.unit import S_NUMBER, S_TIME

MAIL = Table("mail", Role.SCRATCH, per="sender or link of a kind of message")
M_KIND = MAIL.row("kind", "1", "of the message, among all kinds in the order of their names")
M_SENDER = MAIL.row("sender", "1", "number of the unit that sends")
M_RECEIVER = MAIL.row("receiver", "1", "number of the unit that hears; -1 for what is said of the sender alone")
M_SENT = MAIL.row("sent", "1", "messages that were sent since the tick before")
M_RECEIVED = MAIL.row("received", "1", "messages that have come in since the tick before")
M_LOST = MAIL.row("lost", "1", "messages sent since the tick before that do not arrive")
EARLY = 1e-9  # [s] a message of this instant must not be one of the last by rounding


def number_of(kind: str) -> int:
    """The number of a kind of message."""
    return sorted(registry.known("message")).index(kind)


def mail_of(posts: Sequence[Post]) -> np.ndarray:
    """The table before anything has been sent."""
    parts = [np.zeros((len(MAIL), 0))]
    for post in posts:
        table = np.zeros((len(MAIL), post.sender.size + post.link_receiver.size))
        table[M_KIND] = number_of(post.kind.name)
        table[M_SENDER] = np.concatenate([post.sender, post.sender[post.link_sender]])
        table[M_RECEIVER] = np.concatenate([np.full(post.sender.size, -1), post.link_receiver])
        parts.append(table)
    return np.concatenate(parts, axis=1)


def sort(posts: Sequence[Post], time: float, tick: float, mail: np.ndarray) -> None:
    """Counts what has happened since the tick before a time [s]."""
    first = 0
    for post in posts:
        senders, links = post.sender.size, post.link_receiver.size
        of_senders, of_links = mail[:, first : first + senders], mail[:, first + senders : first + senders + links]
        first += senders + links
        at, number = (post.ring[row].reshape(-1, senders) for row in (S_TIME, S_NUMBER))
        is_new = (number >= 0.0) & (at >= time - tick - EARLY) & (at < time - EARLY)
        of_senders[M_SENT] = is_new.sum(axis=0)
        of_links[M_SENT] = of_senders[M_SENT, post.link_sender]
        of_links[M_LOST] = (is_new[:, post.link_sender] & np.isinf(post.arrival)).sum(axis=0)
        is_used = number[:, post.link_sender] >= 0.0
        of_links[M_RECEIVED] = (is_used & (post.arrival > time - tick + EARLY) & (post.arrival <= time + EARLY)).sum(axis=0)
