"""A town drawn on a grid: 5 by 5 blocks between main streets, quiet streets, a pair of one-way streets and a roundabout.

    main        two lanes each way, 50 km/h; signals with lanes for turns where it meets its like or the one-way pair
    one_way     two lanes, 50 km/h, one street north and the next one south
    quiet       one lane each way, 30 km/h, parking along the kerbs, right before left

Columns count from west to east, rows from south to north. Nothing is left to chance: heights and trees follow from numbers.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from studio.road.drawn.drawing import Drawing, Point

BLOCKS = 5
PITCH = 120.0  # [m] from street to street
ARM = 130.0  # [m] of a street beyond the last crossing
LANE = 3.2  # [m] netconvert's own width
POCKET = 45.0  # [m] of the lanes for turns before a signal
ROUNDABOUT, RING = (0, 2), 15.0  # column and row, and radius [m]
ZEBRA = 12.0  # [m] from the ring to a zebra
COLUMNS = ("quiet", "main", "north", "south", "main", "quiet")
ROWS = ("quiet", "main", "quiet", "quiet", "main", "quiet")
NAMES = {
    "column": ("Ahornweg", "Westallee", "Nordstraße", "Südstraße", "Ostallee", "Birkenweg"),
    "row": ("Hafenweg", "Ringstraße", "Lindenweg", "Parkweg", "Marktstraße", "Gartenweg"),
}
TAGS = {
    "main": {"highway": "secondary", "maxspeed": "50"},
    "north": {"highway": "tertiary", "maxspeed": "50", "oneway": "yes", "lanes": "2"},
    "south": {"highway": "tertiary", "maxspeed": "50", "oneway": "yes", "lanes": "2"},
    "quiet": {"highway": "residential", "maxspeed": "30", "lanes": "2"},
}
KERBS = {"quiet": {"parking:both": "lane"}, "north": {"parking:right": "lane"}, "south": {"parking:right": "lane"}}
HALF = {"main": 3.0 * LANE, "north": LANE, "south": LANE, "quiet": LANE}  # [m] from the axis to the farther kerb
SET_BACK = {"main": 3.0 * LANE + 5.0, "north": LANE + 6.0, "south": LANE + 6.0, "quiet": LANE + 6.0}  # [m] axis to house front
PAVEMENT = 2.0  # [m] before a house at the ring
DEPTH = 13.0  # [m] of a house
PARK, SQUARE, MARKET = (2, 2), (1, 3), (3, 1)  # blocks without houses around a yard
EAST, NORTH, WEST, SOUTH = (1, 0), (0, 1), (-1, 0), (0, -1)


def town() -> Drawing:
    """The whole town."""
    plan = Drawing(reach=BLOCKS * PITCH / 2.0 + ARM)
    for column, kind in enumerate(COLUMNS):
        street(plan, kind, NAMES["column"][column], [(column, row) for row in range(BLOCKS + 1)])
    for row, kind in enumerate(ROWS):
        street(plan, kind, NAMES["row"][row], [(column, row) for column in range(BLOCKS + 1)])
    roundabout(plan)
    for column in range(BLOCKS):
        for row in range(BLOCKS):
            block(plan, column, row)
    return plan


def place(column: float, row: float) -> np.ndarray:
    """Where streets cross [m]."""
    return (np.array([column, row]) - BLOCKS / 2.0) * PITCH


# -- streets ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Crossing:
    """Where a column meets a row."""

    column: int
    row: int

    @property
    def signalled(self) -> bool:
        """Whether there are lights: where neither street is quiet."""
        return "quiet" not in (COLUMNS[self.column], ROWS[self.row])

    def half(self, heading: tuple[int, int]) -> float:
        """Half width of the street that one crosses, driving in this direction [m]."""
        return HALF[ROWS[self.row] if heading[0] == 0 else COLUMNS[self.column]]

    def exits(self) -> set[tuple[int, int]]:
        """The directions in which one may leave."""
        ways = {NORTH, SOUTH, EAST, WEST}
        return ways - {{"north": SOUTH, "south": NORTH}.get(COLUMNS[self.column])}

    def turns(self, heading: tuple[int, int]) -> str:
        """turn:lanes, from the left, of three lanes that arrive in this direction."""
        x, y = heading
        left, right = (-y, x) in self.exits(), (y, -x) in self.exits()
        through = ["through"] * (3 - left - right)
        return "|".join([*["left"] * left, *through, *["right"] * right])


End = tuple[np.ndarray, Crossing | None]  # of a stretch: its place, and the crossing there


def heading_of(way: np.ndarray) -> tuple[int, int]:
    """The direction of a way along an axis, as one step."""
    x, y = np.sign(way)
    return int(x), int(y)


def street(plan: Drawing, kind: str, name: str, stations: list[tuple[int, int]]) -> None:
    """One street from end to end, with its arms beyond the last crossings."""
    first, last = place(*stations[0]), place(*stations[-1])
    ahead = heading_of(last - first)
    step = np.array(ahead)
    ends: list[End] = [(place(*station), Crossing(*station)) for station in stations]
    if kind != "quiet" or stations[0] == ROUNDABOUT:
        ends.insert(0, (first - ARM * step, None))
    if kind != "quiet":
        ends.append((last + ARM * step, None))
    for start, end in pairwise(ends):
        stretch(plan, kind, name, start, end, ahead)


def stretch(plan: Drawing, kind: str, name: str, start: End, end: End, ahead: tuple[int, int]) -> None:
    """A street from one crossing to the next; a main street has lanes for turns before the lights."""
    (a, at_start), (b, at_end) = start, end
    length, step = float(np.abs(b - a).sum()), np.array(ahead)
    stops = {0.0, length}
    stops |= {at_start.half(ahead) + 2.0, POCKET} if at_start and at_start.signalled else set()
    stops |= {length - at_end.half(ahead) - 2.0, length - POCKET} if at_end and at_end.signalled else set()
    stops |= set(zebras(kind, at_start, at_end, length))
    stops ^= {0.0, RING} if at_start and (at_start.column, at_start.row) == ROUNDABOUT else set()
    stops ^= {length, length - RING} if at_end and (at_end.column, at_end.row) == ROUNDABOUT else set()
    cuts = sorted(stops & {0.0, length, RING, length - RING, *((POCKET, length - POCKET) if kind == "main" else ())})
    for low, high in pairwise(cuts):
        places = [a + s * step for s in sorted(stops) if low <= s <= high]
        arriving = at_end.turns(ahead) if kind == "main" and at_end and at_end.signalled and high == length else ""
        back = (-ahead[0], -ahead[1])
        leaving = at_start.turns(back) if kind == "main" and at_start and at_start.signalled and low == 0.0 else ""
        text = {"name": name, **TAGS[kind], **lanes(kind, arriving, leaving), **KERBS.get(kind, {})}
        line(plan, places if kind != "south" else places[::-1], text)
    for s in zebras(kind, at_start, at_end, length):
        plan.node(a + s * step, highway="crossing", crossing="zebra")
    for crossing, at in ((at_start, a), (at_end, b)):
        signals(plan, kind, crossing, at, step if crossing is at_start else -step)


def zebras(kind: str, start: Crossing | None, end: Crossing | None, length: float) -> Iterator[float]:
    """Where a quiet street has a zebra, from its start [m]: before the roundabout, and at the park's long sides."""
    if kind == "quiet" and start and (start.column, start.row) == ROUNDABOUT:
        yield RING + ZEBRA
    if kind == "quiet" and end and (end.column, end.row) == ROUNDABOUT:
        yield length - RING - ZEBRA
    if kind == "quiet" and start and end and start.column == PARK[0] and end.column == PARK[0] + 1 and start.row in (PARK[1], PARK[1] + 1):
        yield length / 2.0


def line(plan: Drawing, places: list[np.ndarray], text: dict[str, str]) -> None:
    """A way with tags whose names may hold a colon."""
    plan.way(places, **{key.replace(":", "__"): value for key, value in text.items()})


def lanes(kind: str, arriving: str, leaving: str) -> dict[str, str]:
    """The tags that tell of a main street's lanes: three where one may turn, else two."""
    if kind != "main":
        return {}
    ahead, back = 3 if arriving else 2, 3 if leaving else 2
    text = {"lanes": str(ahead + back), "lanes:forward": str(ahead), "lanes:backward": str(back)}
    text |= {"turn:lanes:forward": arriving} if arriving else {}
    return text | ({"turn:lanes:backward": leaving} if leaving else {})


def signals(plan: Drawing, kind: str, crossing: Crossing | None, at: np.ndarray, inward: np.ndarray) -> None:
    """The lights of a crossing, and where walkers cross this arm of it."""
    if crossing is None or not crossing.signalled:
        return
    plan.node(at, highway="traffic_signals")
    walked = at + (crossing.half(heading_of(inward)) + 2.0) * inward
    plan.node(walked, highway="crossing", crossing="traffic_signals")


def roundabout(plan: Drawing) -> None:
    """A ring of one lane with a green middle."""
    middle = place(*ROUNDABOUT)
    angle = np.linspace(0.0, 2.0 * np.pi, 33)[:-1]
    ring = [middle + RING * np.array([np.cos(each), np.sin(each)]) for each in angle]
    plan.way([*ring, ring[0]], highway="residential", junction="roundabout", oneway="yes", lanes="1", maxspeed="30", name="Lindenrondell")
    island = RING - LANE / 2.0 - 1.0
    plan.area([middle + island * np.array([np.cos(each), np.sin(each)]) for each in angle], landuse="grass")
    for each in angle[::8] + np.pi / 4.0:
        plan.node(middle + 0.5 * island * np.array([np.cos(each), np.sin(each)]), natural="tree")


# -- blocks ----------------------------------------------------------------------------------------


def block(plan: Drawing, column: int, row: int) -> None:
    """What stands between four streets."""
    x0, y0 = place(column, row) + [SET_BACK[COLUMNS[column]], SET_BACK[ROWS[row]]]
    x1, y1 = place(column + 1, row + 1) - [SET_BACK[COLUMNS[column + 1]], SET_BACK[ROWS[row + 1]]]
    drawn = {PARK: park, SQUARE: square, MARKET: market}.get((column, row))
    if drawn:
        drawn(plan, x0, y0, x1, y1)
    else:
        houses(plan, x0, y0, x1, y1, 5 * column + 3 * row)
    verge(plan, column, row, x0, y0, x1, y1)


def houses(plan: Drawing, x0: float, y0: float, x1: float, y1: float, number: int) -> None:
    """Houses along all four sides, and a green yard within."""
    for low, high in ((y0, y0 + DEPTH), (y1 - DEPTH, y1)):
        for k, (left, right) in enumerate(split(x0, x1)):
            house(plan, left, low, right, high, floors(number + k))
    for low, high in ((x0, x0 + DEPTH), (x1 - DEPTH, x1)):
        for k, (bottom, top) in enumerate(split(y0 + DEPTH, y1 - DEPTH)):
            house(plan, low, bottom, high, top, floors(number + 2 * k + 1))
    yard = DEPTH + 3.0
    plan.rectangle(x0 + yard, y0 + yard, x1 - yard, y1 - yard, leisure="garden")
    for x, y in spots(x0 + yard + 4.0, y0 + yard + 4.0, x1 - yard - 4.0, y1 - yard - 4.0, 14.0):
        plan.node((x, y), natural="tree")


def house(plan: Drawing, x0: float, y0: float, x1: float, y1: float, levels: int) -> None:
    """One house, where the ring of the roundabout leaves room for it."""
    x, y = place(*ROUNDABOUT)
    away = np.hypot(max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0))
    if away > RING + LANE + PAVEMENT:
        plan.rectangle(x0, y0, x1, y1, building="apartments", building__levels=str(levels))


def split(low: float, high: float) -> Iterator[tuple[float, float]]:
    """A front in houses of about 18 m."""
    cuts = np.linspace(low, high, max(1, round((high - low) / 18.0)) + 1)
    yield from zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True)


def floors(number: int) -> int:
    """Three to six floors, different from house to house."""
    return 3 + (number * number + number // 3) % 4


def spots(x0: float, y0: float, x1: float, y1: float, spacing: float) -> Iterator[Point]:
    """Points of a net that is a little out of line."""
    for k, x in enumerate(np.arange(x0, x1 + 1e-6, spacing)):
        for n, y in enumerate(np.arange(y0, y1 + 1e-6, spacing)):
            yield float(x + 1.3 * ((3 * k + 5 * n) % 3 - 1)), float(y + 1.3 * ((2 * k + n) % 3 - 1))


def park(plan: Drawing, x0: float, y0: float, x1: float, y1: float) -> None:
    """A park with a pond, a sandy playground and a hedge along one side."""
    plan.rectangle(x0, y0, x1, y1, leisure="park", name="Stadtpark")
    middle, angle = np.array([(x0 + x1) / 2.0 + 12.0, (y0 + y1) / 2.0]), np.linspace(0.0, 2.0 * np.pi, 25)[:-1]
    plan.area([middle + [20.0 * np.cos(each), 13.0 * np.sin(each)] for each in angle], natural="water")
    plan.rectangle(x0 + 8.0, y0 + 8.0, x0 + 24.0, y0 + 20.0, natural="sand")
    plan.way([(x0, y1), (x1, y1)], barrier="hedge")


def square(plan: Drawing, x0: float, y0: float, x1: float, y1: float) -> None:
    """A square with a church, bollards around it, and lamps."""
    plan.rectangle(x0, y0, x1, y1, place="square", name="Kirchplatz")
    x, y = (x0 + x1) / 2.0, (y0 + y1) / 2.0
    plan.rectangle(x - 22.0, y - 8.0, x + 16.0, y + 8.0, building="church", height="14")
    plan.rectangle(x + 16.0, y - 5.0, x + 26.0, y + 5.0, building="church", height="38")
    plan.way([(x0, y0), (x1, y0)], barrier="bollard")
    plan.way([(x0, y1), (x1, y1)], barrier="bollard")
    for place_ in spots(x0 + 6.0, y0 + 6.0, x1 - 6.0, y0 + 6.0, 12.0):
        plan.node(place_, natural="tree")
    for corner in ((x0 + 3, y1 - 3), (x1 - 3, y1 - 3), (x0 + 3, y0 + 3), (x1 - 3, y0 + 3)):
        plan.node(corner, highway="street_lamp")


def market(plan: Drawing, x0: float, y0: float, x1: float, y1: float) -> None:
    """A market hall with a parking lot: two rows of spaces along one aisle, fenced in."""
    plan.rectangle(x0, y1 - 26.0, x1, y1, building="retail", height="7")
    plan.rectangle(x0, y0, x1, y1 - 30.0, amenity="parking", parking="surface")
    aisle = (y0 + y1 - 30.0) / 2.0
    plan.way([(x0 + 4.0, aisle), (x1 - 4.0, aisle)], highway="service", service="parking_aisle")
    for k in range(int((x1 - x0 - 12.0) // 2.5)):
        x = x0 + 6.0 + 2.5 * k
        plan.rectangle(x, aisle + 3.0, x + 2.5, aisle + 8.0, amenity="parking_space")
        plan.rectangle(x, aisle - 8.0, x + 2.5, aisle - 3.0, amenity="parking_space")
    plan.way([(x0, y1 - 30.0), (x0, y0), (x1, y0), (x1, y1 - 30.0)], barrier="fence")


def verge(plan: Drawing, column: int, row: int, x0: float, y0: float, x1: float, y1: float) -> None:
    """Trees and lamps before the houses that look on a main street."""
    sides = [(COLUMNS[column], (x0 - 2.0, y0), (x0 - 2.0, y1)), (COLUMNS[column + 1], (x1 + 2.0, y0), (x1 + 2.0, y1))]
    sides += [(ROWS[row], (x0, y0 - 2.0), (x1, y0 - 2.0)), (ROWS[row + 1], (x0, y1 + 2.0), (x1, y1 + 2.0))]
    for kind, start, end in sides:
        along = np.linspace(start, end, 9)
        for k, at in enumerate(along[1:-1] if kind == "main" else along[2:-1:4]):
            plan.node(at, **({"natural": "tree"} if kind == "main" and k % 3 else {"highway": "street_lamp"}))
