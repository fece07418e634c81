"""Who may drive where: tiles of the ground that one car holds at a time, granted so that nobody waits for ever.

A car's way is a row of steps; each step names the tiles that it covers while it is there. To go on it needs the tiles of its next step,
and gives back what it has left when it is there. A step is granted when its tiles are free and the state after it is safe: there is an
order in which one car after the other could drive to the end of its way while all others stand (the banker's algorithm, E. W. Dijkstra,
EWD 623, 1977). A safe state leads to no deadlock, and from a safe state some car can always go on: the one that is first in that order.
"""

from collections.abc import Sequence

Tiles = frozenset[int]
Way = Sequence[Tiles]


def held(way: Way, place: int) -> Tiles:
    """What a car holds: the tiles of its step; nothing before its way and after it."""
    return way[place] if 0 <= place < len(way) else frozenset()


def taken(ways: Sequence[Way], places: Sequence[int], but: int) -> set[int]:
    """Tiles that all others hold."""
    return {tile for i, way in enumerate(ways) if i != but for tile in held(way, places[i])}


def is_free(ways: Sequence[Way], places: Sequence[int], car: int) -> bool:
    """Whether nobody else holds the tiles of a car's next step."""
    place = places[car] + 1
    return place <= len(ways[car]) and not held(ways[car], place) & taken(ways, places, car)


def can_finish(ways: Sequence[Way], places: Sequence[int], car: int) -> bool:
    """Whether a car can drive to the end of its way while all others stand."""
    others = taken(ways, places, car)
    return all(not step & others for step in ways[car][max(places[car] + 1, 0) :])


def is_safe(ways: Sequence[Way], places: Sequence[int]) -> bool:
    """Whether there is an order in which all come to the end of their ways; who is there holds nothing."""
    now, left = list(places), [i for i in range(len(ways)) if 0 <= places[i] < len(ways[i])]
    while left:
        done = [i for i in left if can_finish(ways, now, i)]
        if not done:
            return False
        for i in done:
            now[i] = len(ways[i])
        left = [i for i in left if i not in done]
    return True


def grants(ways: Sequence[Way], places: Sequence[int], car: int) -> bool:
    """Whether a car may make its next step."""
    after = [place + (i == car) for i, place in enumerate(places)]
    return is_free(ways, places, car) and is_safe(ways, after)
