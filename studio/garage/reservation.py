"""Who may drive where: tiles of the ground that one car holds at a time, granted so that nobody waits for ever.

A car's way is a row of steps; each step names the tiles that it covers while it is there. To go on it needs the tiles of its next step,
and gives back what it has left when it is there. A step is granted when its tiles are free and the state after it is safe: all who are
there can come to the end of their ways.

Mostly there is an order in which one car after the other could do so while all others stand (the banker's algorithm, E. W. Dijkstra,
EWD 623, 1977), which is soon looked up. In a circle there is none as soon as each stands before the next one, and yet all can move on
by turns. So where the banker says no it is searched, depth first: who could go on, and is one of the states after that safe? What is
searched is bounded by SEARCHED, for in general the question is as hard as any; what is not found by then is taken for unsafe.

From a safe state some car can always go on, also where the search was bounded: the first step that was found leads to a state whose own
search looks at some of the same states and at no other ones, so it ends within the same bound.
"""

from collections.abc import Sequence

Tiles = frozenset[int]
Way = Sequence[Tiles]
SEARCHED = 1000  # states


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


def is_ordered(ways: Sequence[Way], places: Sequence[int]) -> bool:
    """Whether there is an order in which one after the other comes to the end of its way; who is not there yet holds nothing."""
    now, left = list(places), on_way(ways, places)
    while left:
        done = [i for i in left if can_finish(ways, now, i)]
        if not done:
            return False
        for i in done:
            now[i] = len(ways[i])
        left = [i for i in left if i not in done]
    return True


def on_way(ways: Sequence[Way], places: Sequence[int]) -> list[int]:
    """Cars that are there and not at the end of their ways."""
    return [i for i in range(len(ways)) if 0 <= places[i] < len(ways[i])]


def moved(places: Sequence[int], car: int) -> tuple[int, ...]:
    """The state after a car's next step."""
    return tuple(place + (i == car) for i, place in enumerate(places))


def is_safe(ways: Sequence[Way], places: Sequence[int]) -> bool:
    """Whether all who are there can come to the end of their ways, as far as that is found."""
    seen: set[tuple[int, ...]] = set()
    left = [tuple(places)]
    while left and len(seen) < SEARCHED:
        state = left.pop()
        if state not in seen:
            if is_ordered(ways, state):
                return True
            seen.add(state)
            left += [moved(state, i) for i in reversed(on_way(ways, state)) if is_free(ways, state, i)]
    return False


def grants(ways: Sequence[Way], places: Sequence[int], car: int) -> bool:
    """Whether a car may make its next step."""
    return is_free(ways, places, car) and is_safe(ways, moved(places, car))
