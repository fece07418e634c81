"""GPS Exchange Format 1.1, .gpx: the track of a phone or a satellite receiver becomes a speed and a position.

Its points have latitude and longitude [deg] and a time (ISO 8601). Positions are metres east and north of the first point on a sphere of
the earth's mean radius, 6371009 m (Moritz, Geodetic Reference System 1980, Journal of Geodesy 2000); speed is the way between two points
over the time between them, halfway. Schema: Topografix, "GPX 1.1", 2004.
"""

from datetime import datetime
from xml.etree import ElementTree

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.kind.log import Log, signal

KIND = "logformat"
TITLE = "GPS track"
SUFFIXES = (".gpx",)
RADIUS = 6_371_009.0  # [m]
SPACE = "{http://www.topografix.com/GPX/1/1}"
SAMPLE = b"""<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>
<trkpt lat="52.5145" lon="13.3501"><time>2026-05-01T08:00:00Z</time></trkpt>
<trkpt lat="52.5146" lon="13.3501"><time>2026-05-01T08:00:01Z</time></trkpt>
<trkpt lat="52.5148" lon="13.3501"><time>2026-05-01T08:00:02Z</time></trkpt>
</trkseg></trk></gpx>"""


def read(path, dbc):
    """A Log with x, y [m] over the times of the points, and speed [m/s] over those halfway between."""
    try:
        points = [point(each) for each in ElementTree.parse(path).iter(f"{SPACE}trkpt")]
    except (OSError, ElementTree.ParseError, ValueError, TypeError) as error:
        raise refused(path, f"is no track: {error}") from None
    if len(points) < 2:
        raise refused(path, "has no two points with a time")
    time, latitude, longitude = np.array(points).T
    time, turn = time - time[0], np.radians([latitude - latitude[0], longitude - longitude[0]])
    x, y = RADIUS * np.cos(np.radians(latitude[0])) * turn[1], RADIUS * turn[0]
    with np.errstate(divide="ignore", invalid="ignore"):  # two points of one time have no speed, and signal() drops it
        speed = np.hypot(np.diff(x), np.diff(y)) / np.diff(time)
    halfway = time[:-1] + 0.5 * np.diff(time)
    return Log(path.name, {"x": signal("x", "m", time, x), "y": signal("y", "m", time, y), "speed": signal("speed", "m/s", halfway, speed)})


def point(each):
    """Time [s], latitude and longitude [deg]."""
    moment = datetime.fromisoformat(each.findtext(f"{SPACE}time") or "")
    return moment.timestamp(), float(each.get("lat")), float(each.get("lon"))


def refused(path, what):
    """What is told of a file that is none."""
    return ScenarioError(f"{path.name} cannot be read as GPX.", [Problem(str(path), what, remedy="export the track again, with times")])
