"""Ways: the paths that a vehicle may take over time, one for every choice of the closed and shifted lanes on its path.

Work b of a way is bit b of the number of a path: path 0 is the usual one, path 3 is led around the works 0 and 1.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from studio.road.ways.detour import Work, led, passing
from studio.road.ways.path import Path
from studio.world.site import Site

MOST_WORKS = 4  # on one path: each doubles the number of its paths


@dataclass(frozen=True, eq=False)
class Way:
    """`paths` by number; the numbers of its works; where each path enters and leaves each work, float64[path, work, 2] [m]."""

    paths: tuple[Path, ...]
    works: tuple[int, ...]
    spans: np.ndarray

    def is_touched(self, station: float, ahead: float, works: set[int]) -> bool:
        """Whether a place on the usual path, or less than `ahead` [m] behind it, lies within one of these works."""
        return any(
            number in works and enter - ahead <= station <= leave + ahead
            for number, (enter, leave) in zip(self.works, self.spans[0], strict=True)
        )


class Works:
    """The ways of all paths among the works of a script, each made once.

    `of` is the entry that each work belongs to; `first` are the works that are there from the beginning.
    """

    def __init__(self, sites: Sequence[Site]) -> None:
        self.sites = tuple(sites)
        placed = [(number, each.work) for number, site in enumerate(sites) for each in site.laid if each.work is not None]
        self.of = [number for number, _ in placed]
        self.works = [work for _, work in placed]
        self.first = {i for i, number in enumerate(self.of) if sites[number].is_there_from_the_start}
        self._known: dict[int, tuple[Path, Way]] = {}

    def way(self, path: Path) -> Way:
        """The way of a path."""
        if id(path) not in self._known:
            self._known[id(path)] = path, way(path, self.works)
        return self._known[id(path)][1]

    def name(self, work: int) -> str:
        """The entry of the script that a work belongs to."""
        return self.sites[self.of[work]].name


def way(path: Path, placed: Sequence[Work]) -> Way:
    """All that may become of a path; the number of its works is not bounded here."""
    passed = {number: passing(path, work) for number, work in enumerate(placed)}
    works = tuple(number for number, stations in passed.items() if np.isfinite(stations).any())
    paths, spans = [], []
    for choice in range(2 ** min(len(works), MOST_WORKS)):
        made, at = path, np.arange(path.points.shape[1], dtype=float)
        for bit in order(works, passed):
            if choice >> bit & 1 and is_led(placed[works[bit]]):
                made, on = led(made, placed[works[bit]], passing_on(made, at, passed[works[bit]]))
                at = np.interp(at, np.arange(on.size), on)
        paths.append(made)
        inside = [np.flatnonzero(np.isfinite(passed[number]))[[0, -1]] for number in works]
        spans.append([at[each] for each in inside])
    return Way(tuple(paths), works, np.array(spans).reshape(len(paths), len(works), 2))


def order(works: Sequence[int], passed: dict[int, np.ndarray]) -> list[int]:
    """The bits of the works, in the order in which a path comes to them."""
    return sorted(range(len(works)), key=lambda bit: int(np.isfinite(passed[works[bit]]).argmax()))


def is_led(work: Work) -> bool:
    """Whether a work leads anywhere: where all lanes are closed cars stop on their path."""
    return work.target is not None or work.offset != 0.0


def passing_on(made: Path, at: np.ndarray, stations: np.ndarray) -> np.ndarray:
    """Stations of a work's line for every point of a path whose usual points have come to lie `at` [m]."""
    return np.interp(np.arange(made.points.shape[1]), at, stations, left=np.nan, right=np.nan)
