"""One object stands somewhere on the map, turned as one likes: a box, a barrel, a cone, a barrier, a piece of wall, a tree.

It is there while the entry acts. Sensors see it (a radar sees no cones), drivers brake for it once it is in their way, and cars hit it.
To them it is the box around it; how tall it is counts for nobody. Its name is that of its entry.
Sizes that are left out: a cone of 0.75 m and a barrier board as elsewhere in the studio; a barrel of 0.6 m; a trunk of 0.4 m, which is what
a car hits of a tree; a piece of wall 4 m long; a box of 1 m. Estimated, but for cone and barrier.
"""

from math import cos, sin
from typing import Literal

from pydantic import Field

from studio.kind.settings import Part, number
from studio.world.effect import Walk

KIND = "action"
TITLE = "Put one object somewhere"
MOVES = True
SIZES = {"cuboid": (1.0, 1.0), "cylinder": (0.6, 0.6), "cone": (0.3, 0.3), "barrier": (1.5, 0.25), "wall": (4.0, 0.25), "tree": (0.4, 0.4)}
AHEAD = 0.1  # [m] the second corner of a line that nobody goes along: it says which way the object looks

LEVEL = "where roads lie above each other, on which it stands, 1 on a bridge, -1 in a tunnel; left out: on the land"


class Settings(Part):
    """Which, where, and how large."""

    shape: Literal["cuboid", "cylinder", "cone", "barrier", "wall", "tree"] = Field("cuboid", title="Shape")
    x: float = number(..., unit="m", title="East", ge=-100_000, le=100_000)
    y: float = number(..., unit="m", title="North", ge=-100_000, le=100_000)
    level: int | None = Field(None, ge=-10, le=10, title="Level", description=LEVEL)
    heading: float = number(0.0, unit="rad", title="Heading", description="of its length; 0 is east, left positive", ge=-7, le=7)
    length: float | None = Field(
        None, gt=0.05, le=50, title="Length", description="left out: as usual for its shape", json_schema_extra={"unit": "m"}
    )
    width: float | None = Field(
        None, gt=0.05, le=50, title="Width", description="left out: as usual for its shape", json_schema_extra={"unit": "m"}
    )


def effects(settings, place):
    """One who does not move."""
    length, width = SIZES[settings.shape]
    ahead = (settings.x + AHEAD * cos(settings.heading), settings.y + AHEAD * sin(settings.heading))
    size = (settings.length or length, settings.width or width)
    who = "box" if settings.shape == "cuboid" else settings.shape
    return [Walk(who, ((settings.x, settings.y), ahead), 0.0, True, size, settings.level)]


def told(settings):
    """In words."""
    return f"a {settings.shape} stands there"
