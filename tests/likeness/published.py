"""What was measured on roads: a range of each figure, and where it stands. Where ours is not within, it is told."""

from math import inf
from typing import NamedTuple


class Published(NamedTuple):
    """Of one figure: least and greatest value, in its unit, and the source."""

    least: float
    most: float
    unit: str
    source: str


BAST = "BASt 2016, cars on motorways limited to 130 km/h: 118.3 km/h, without a limit 124.7"
FREE = "W. Knospe, L. Santen, A. Schadschneider, M. Schreckenberg, Phys. Rev. E 65 (2002) 056133: A1 and A3, most often 0.8 to 1.8 s"
FOLLOWERS = "P. Wasielewski, Transportation Science 13 (1979) 36: followers 1.32 s on the mean, whatever the flow"
MEDIAN = "Headway times on urban, multiple lane freeways (Los Angeles, video): median 1.74 s, 58 % below 2 s"
DURET = "A. Duret, S. Ahn, C. Buisson, Transportation Research C 24 (2012) 157: falls with the flow"
DURET_LEFT = "the same: rises linearly with the flow"
SNARE = "M. Snare, Virginia Tech 2002: drivers use 0.60 ± 0.08 of what their car can do"
STOPS = "J. Wang et al., TRB 2005: 3.4 m/s² is the greatest of nearly all drivers who stop at a sign"

PUBLISHED = {
    "mean speed of cars, little traffic": Published(115.0, 125.0, "km/h", BAST),
    "headway that is most frequent, little traffic": Published(0.8, 1.8, "s", FREE),
    "headway that is most frequent, dense traffic": Published(0.8, 1.8, "s", FREE),
    "mean headway of followers, dense traffic": Published(1.2, 1.5, "s", FOLLOWERS),
    "median headway below 5 s, dense traffic": Published(1.4, 2.0, "s", MEDIAN),
    "share of the lane at the kerb, dense over little traffic": Published(-inf, 1.0, "1", DURET),
    "share of the lane at the median, dense over little traffic": Published(1.0, inf, "1", DURET_LEFT),
    "acceleration from rest over what the car can do": Published(0.44, 0.76, "1", SNARE),
    "greatest deceleration before a stop, 85 of 100": Published(1.5, 3.4, "m/s²", STOPS),
}
