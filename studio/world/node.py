"""Nodes: the conditions of a script, each with those that stand in it.

nodes_of(settings, finds)   →  nodes, root       root[turn, entry] is the node that the turn of an entry waits for, -1 for none
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from studio.kind.number import Find, numbers, row_of, stations
from studio.kind.settings import inner
from studio.world.setting import Setting
from studio.world.site import joined_at


class Node(NamedTuple):
    """A condition: the entry whose turn (0 to begin, 1 to end) it belongs to, its kind, its settings as numbers, the nodes in it.

    `height` is 0 for one that is about no others, else one more than that of the highest of these.
    """

    entry: int
    turn: int
    kind: str
    row: list[float]
    parts: tuple[int, ...]
    height: int


def nodes_of(settings: Sequence[Setting], finds: Sequence[Find]) -> tuple[list[Node], np.ndarray]:
    """All conditions of all worlds, those within another before it."""
    nodes: list[Node] = []
    root = np.full((2, sum(len(each.scenario.script) for each in settings)), -1)
    entry = 0
    for each, find in zip(settings, finds, strict=True):
        for one in each.scenario.script.values():
            for turn, part in enumerate((one.when, one.until)):
                if part is not None:
                    root[turn, entry] = grow(part, entry, turn, each, find, nodes)
            entry += 1
    return nodes, root


def grow(part: Any, entry: int, turn: int, setting: Setting, find: Find, nodes: list[Node]) -> int:
    """Adds a condition and all that stand in it; its number."""
    parts = tuple(grow(each, entry, turn, setting, find, nodes) for _, each in inner(part))
    height = 1 + max((nodes[each].height for each in parts), default=-1)
    nodes.append(Node(entry, turn, part.kind, numbers_of(part, setting, find), parts, height))
    return len(nodes) - 1


def numbers_of(part: Any, setting: Setting, find: Find) -> list[float]:
    """A condition's settings as numbers; stations count on the path that the vehicle drives, which may begin later than its route."""
    made = numbers(part, find)
    for station, vehicle in stations(type(part)):
        who = getattr(part, vehicle)
        made[row_of(type(part), station)] -= joined_at(who, setting.scenario, setting.network, setting.lock_of(who))
    return made
