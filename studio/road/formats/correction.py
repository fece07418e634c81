"""Corrections: tags of map elements that a user knows better than the map.

A correction is applied while the map is read, before anything is built of it, so everything follows that follows from tags:
lanes, widths, limits, arrows, signals, access, heights. What was guessed for want of a tag is then no guess any more. The map
file itself is never changed, so corrections outlive it: the next, newer file gets them too.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from studio.road.formats.identity import kept, named
from studio.road.network.report import Notes, Spot


@dataclass(frozen=True)
class Correction:
    """What is known better about an element ("way 4711", "node 7", "relation 5"): tags to set, and keys to take away."""

    element: str
    tags: dict[str, str] = field(default_factory=dict)
    removed: tuple[str, ...] = ()

    def applied(self, tags: dict[str, str]) -> dict[str, str]:
        """The corrected tags."""
        return {**{key: value for key, value in tags.items() if key not in self.removed}, **self.tags}

    def joined(self, later: "Correction") -> "Correction":
        """Both as one; where they disagree, the later one counts."""
        tags = {key: value for key, value in self.tags.items() if key not in later.removed} | later.tags
        removed = {*self.removed, *later.removed} - set(later.tags)
        return Correction(self.element, dict(sorted(tags.items())), tuple(sorted(removed)))

    def as_json(self) -> dict[str, Any]:
        """As it stands in corrections.json."""
        return {"element": self.element, "tags": self.tags, "removed": list(self.removed)}


Corrections = tuple[Correction, ...]


def added(to: Corrections, new: Correction) -> Corrections:
    """The corrections with one more, by element; those of the same element are joined."""
    by_element = {each.element: each for each in to}
    by_element[new.element] = by_element[new.element].joined(new) if new.element in by_element else new
    return tuple(by_element[element] for element in sorted(by_element))


class Corrector:
    """Corrects a map's elements as they come by, and notes what each correction met."""

    def __init__(self, corrections: Iterable[Correction], notes: Notes) -> None:
        self.wanted = {each.element: each for each in corrections}
        self.notes = notes
        self.met: set[str] = set()

    def seen(self, thing):
        """The element of osmium, with its corrected tags where it has some."""
        if not self.wanted or element_of(thing) not in self.wanted:
            return thing
        return Retagged(thing, self.retagged(element_of(thing), dict(thing.tags), place_of(thing)))

    def retagged(self, element: str, tags: dict[str, str], place: tuple[float, float]) -> dict[str, str]:
        """The corrected tags of an element at a longitude and latitude [deg]; noted the first time."""
        one = self.wanted[element]
        if element not in self.met:
            self.met.add(element)
            before = {key: tags.get(key, "") for key in (*one.tags, *one.removed)}
            name = tags.get("name", "")
            spot = Spot(element + (f" ({name})" if name else ""), place[1], place[0], element)
            self.notes.correct(spot, tags=one.tags, removed=one.removed, before=before)
        return one.applied(tags)

    def bare_nodes(self, ways) -> dict[int, dict[str, str]]:
        """The tags of nodes that have none in the map and lie on these ways: they never come by on their own."""
        bare = {kept(int(name.split()[1])): name for name in self.wanted if name.startswith("node ") and name not in self.met}
        places = {node: place for way in ways for node, place in zip(way.nodes, way.points, strict=True) if node in bare}
        return {node: self.retagged(bare[node], {}, place) for node, place in places.items()}

    def finish(self, place: tuple[float, float]) -> None:
        """Notes the corrections whose element did not come by, at some longitude and latitude of the map [deg]."""
        for element, one in self.wanted.items():
            if element not in self.met:
                spot = Spot(element, place[1], place[0], element)
                self.notes.skip(
                    "correction", text(one.tags, one.removed), spot, "the map has no such element; a bare node must lie on a road"
                )


class Retagged:
    """An element of osmium with other tags; everything else is its own."""

    def __init__(self, thing, tags: dict[str, str]) -> None:
        self.thing, self.tags = thing, tags

    def __getattr__(self, name: str):
        return getattr(self.thing, name)


def element_of(thing) -> str:
    """The name of an element of osmium; an area is the way or relation that it is made of."""
    if thing.is_area():
        return named("way" if thing.from_way() else "relation", thing.orig_id())
    return named("node" if thing.is_node() else "way" if thing.is_way() else "relation", thing.id)


def place_of(thing) -> tuple[float, float]:
    """Some longitude and latitude of an element [deg]; 0, 0 where it has none."""
    if thing.is_node():
        points = [thing.location]
    elif thing.is_way():
        points = [node.location for node in thing.nodes if node.location.valid()]
    else:
        points = [node.location for ring in thing.outer_rings() for node in ring] if thing.is_area() else []
    middle = points[len(points) // 2] if points else None
    return (middle.lon, middle.lat) if middle is not None and middle.valid() else (0.0, 0.0)


def text(tags: dict[str, str], removed: Iterable[str]) -> str:
    """Tags in one line.

    >>> text({"lanes": "2"}, ["width"])
    'lanes=2, no width'
    """
    return ", ".join([*(f"{key}={value}" for key, value in tags.items()), *(f"no {key}" for key in removed)])
