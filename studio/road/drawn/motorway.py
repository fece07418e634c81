"""A motorway written as OpenDRIVE: straights and bends in turn, joined by clothoids, and hills where they are wanted.

Bends have at least the radius that the German guideline RAA (2008) has for motorways of class EKA 1A, 900 m; their clothoids'
parameter A = sqrt(R L) is at least R/3, as there, so that steering changes slowly. At 130 km/h the tightest needs
v²/R = 1.45 m/s². Crests and sags are parabolas of its least radii, 13 000 and 8800 m.
"""

import itertools
from collections.abc import Iterator

import numpy as np

from studio.errors import MapError, Problem
from studio.road.opendrive.reference_line import Bend

LEAST_RADIUS = 900.0  # [m]
LONGEST_RADIUS = 20_000.0  # [m]
CLOTHOID = 0.4  # [1] of the radius is A
STRAIGHT = 700.0  # [m]
ARC = 600.0  # [m]
CREST, SAG = 13_000.0, 8_800.0  # [m]
STEEPEST = 0.06  # [1]
SLOPE_LENGTH = 500.0  # [m] of even slope
SHORTEST, LONGEST = 500.0, 50_000.0  # [m]
LANE_WIDTH, MEDIAN, STRIP, SHOULDER = 3.75, 4.0, 0.75, 2.5  # [m] the strip lies between lanes and median, and lanes and shoulder
MOST_LANES = 6
LIMIT = 130.0  # [km/h]
PLACES = 6  # decimals of a position [m]: a map needs no more, and the digits behind them differ from processor to processor


def motorway(*, length: float = 6000.0, lanes: int = 3, radius: float = 1000.0, grade: float = 0.0) -> str:
    """The document of a motorway with two carriageways; its road is called "motorway".

    Args:
        length: [m].
        lanes: of each carriageway.
        radius: of the bends [m], to the left and to the right in turn.
        grade: steepest rise and fall [1]; 0 is level.

    Raises:
        MapError: a value is out of its range.
    """
    check(length=length, lanes=lanes, radius=radius, grade=grade)
    elements = list(cut(laid(radius), length))
    return "\n".join(
        [
            '<?xml version="1.0" encoding="UTF-8"?>',
            "<OpenDRIVE>",
            '  <header revMajor="1" revMinor="8" name="Motorway" vendor="Cooperative ADAS Studio">',
            '    <license name="MIT" spdxid="MIT"/>',
            "  </header>",
            f'  <road id="motorway" name="Motorway" length="{length!r}" junction="-1" rule="RHT">',
            '    <type s="0" type="motorway" country="DE">',
            f'      <speed max="{LIMIT:g}" unit="km/h"/>',
            "    </type>",
            "    <planView>",
            *map(geometry, elements),
            "    </planView>",
            "    <elevationProfile>",
            *elevation(length, grade),
            "    </elevationProfile>",
            "    <lanes>",
            '      <laneSection s="0">',
            *(line for sign in (1, 0, -1) for line in side(sign, lanes)),
            "      </laneSection>",
            "    </lanes>",
            "  </road>",
            "</OpenDRIVE>",
            "",
        ]
    )


def check(**given: float) -> None:
    """Refuses a motorway that nobody would build."""
    allowed = {
        "length": (SHORTEST, LONGEST, "m"), "lanes": (1, MOST_LANES, ""), "radius": (LEAST_RADIUS, LONGEST_RADIUS, "m"),
        "grade": (0.0, STEEPEST, ""),
    }  # fmt: skip
    problems = [
        Problem(name, "is out of range", f"{given[name]:g}", f"{low:g} to {high:g} {unit}".strip())
        for name, (low, high, unit) in allowed.items()
        if not low <= given[name] <= high
    ]
    if problems:
        raise MapError("No motorway can be made of these values.", problems)


# -- plan ------------------------------------------------------------------------------------------


def laid(radius: float) -> Iterator[tuple[float, float, float]]:
    """Length [m] and curvature at start and end [1/m] of one element after another: straight, bend to the left, straight, to the right."""
    easing = CLOTHOID**2 * radius  # L = A²/R
    for k in itertools.cycle((1.0 / radius, -1.0 / radius)):
        yield from ((STRAIGHT, 0.0, 0.0), (easing, 0.0, k), (ARC, k, k), (easing, k, 0.0))


def cut(shapes: Iterator[tuple[float, float, float]], length: float) -> Iterator[Bend]:
    """The elements one behind the other, up to a length [m]."""
    s, x, y, heading = 0.0, 0.0, 0.0, 0.0
    for own, start, end in shapes:
        left = min(own, length - s)
        bend = Bend(s, x, y, heading, left, start, start + (end - start) * left / own)
        yield bend
        s += left
        if s >= length - 1e-6:
            return
        x, y, heading = bend.at(np.array([left]))[:, 0].tolist()
        x, y = round(x, PLACES), round(y, PLACES)


def geometry(bend: Bend) -> str:
    """One element as a line of the document."""
    shape = "<line/>"
    if bend.start != bend.end:
        shape = f'<spiral curvStart="{bend.start!r}" curvEnd="{bend.end!r}"/>'
    elif bend.start:
        shape = f'<arc curvature="{bend.start!r}"/>'
    at = f's="{bend.s!r}" x="{bend.x!r}" y="{bend.y!r}" hdg="{bend.heading!r}" length="{bend.length!r}"'
    return f"      <geometry {at}>{shape}</geometry>"


# -- height ----------------------------------------------------------------------------------------


def elevation(length: float, grade: float) -> Iterator[str]:
    """The profile: a hill after another, each up through a sag, over a crest and down through a sag."""
    s, z, slope = 0.0, 0.0, 0.0
    for own, bow in hills(grade):
        yield f'      <elevation s="{s!r}" a="{z!r}" b="{slope!r}" c="{bow / 2.0!r}" d="0"/>'
        s, z, slope = s + own, z + own * (slope + 0.5 * bow * own), slope + bow * own
        if s >= length or grade == 0.0:
            return


def hills(grade: float) -> Iterator[tuple[float, float]]:
    """Length [m] and change of slope per metre [1/m]; the slope goes up to `grade`, down to its opposite, and back."""
    into, over = grade * SAG, 2.0 * grade * CREST
    while True:
        yield from ((SLOPE_LENGTH, 0.0), (into, 1.0 / SAG), (SLOPE_LENGTH, 0.0))
        yield from ((over, -1.0 / CREST), (SLOPE_LENGTH, 0.0), (into, 1.0 / SAG))


# -- cross section ---------------------------------------------------------------------------------


def side(sign: int, lanes: int) -> Iterator[str]:
    """The lanes to the left (1) or right (-1) of the middle, or the middle itself (0)."""
    name = {1: "left", 0: "center", -1: "right"}[sign]
    strips = [("median", MEDIAN / 2.0, "none"), ("border", STRIP, "solid"), *[("driving", LANE_WIDTH, "broken")] * (lanes - 1)]
    strips += [("driving", LANE_WIDTH, "solid"), ("border", STRIP, "none"), ("stop", SHOULDER, "none")]
    yield f"        <{name}>"
    if sign == 0:
        yield '          <lane id="0" type="none" level="false"/>'
    outwards = list(enumerate(strips, start=1)) if sign else []
    for number, (kind, width, mark) in outwards[:: -sign or 1]:  # from left to right
        lane = f'<lane id="{sign * number}" type="{kind}" level="false">'
        shape = f'<width sOffset="0" a="{width:g}" b="0" c="0" d="0"/>'
        yield f'          {lane}{shape}<roadMark sOffset="0" type="{mark}" weight="standard" color="standard"/></lane>'
    yield f"        </{name}>"
