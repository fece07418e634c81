"""Downloads a place: a name becomes a box by a Nominatim server, a box becomes a map by an Overpass server.

Why two servers: Overpass could look a name up too, but would have to go through the whole world for it, knows no other language
than the mapped one, and has no idea which of many Bahnhofstraßen is meant. Nominatim is made for that question, answers it with
boxes, and names what it found so that somebody can choose. Who gives a box needs Overpass only.

Both are asked politely: once, under our name, and again only after the time that a busy server asks for. An answer is streamed
to a file, no more of it than `osm.LARGEST_FILE`.
"""

import json
import math
import os
import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import httpx

from studio.errors import MapError, Problem
from studio.road.formats import osm
from studio.road.formats.osm import Box

OVERPASS, SEARCH = "https://overpass-api.de/api/interpreter", "https://nominatim.openstreetmap.org/search"
LARGEST_AREA = 40.0  # [km²] an answer for a dense city of this size is near the largest file
LARGEST_LIST = 2**20  # [B] of places found
LEAST_REACH = 500.0  # [m] to each side of the centre of a place that is smaller
BUSY = (429, 502, 503, 504)
SHOWN = 8  # places that a message lists


@dataclass(frozen=True)
class Servers:
    """The addresses that are asked."""

    overpass: str = OVERPASS
    search: str = SEARCH


@dataclass(frozen=True)
class Patience:
    """How long a server is waited for [s], and how often it is asked again when it is busy."""

    connect: float = 15.0
    silence: float = 200.0  # Overpass works before it says a word; it is told to take 180 s at most
    whole: float = 600.0
    retries: int = 3
    first_wait: float = 5.0  # where the server does not say how long; twice as long each time
    longest_wait: float = 60.0


@dataclass(frozen=True)
class Place:
    """A place that was found: its full name and its box."""

    name: str
    box: Box


Told = Callable[[str], None]


def servers(overpass: str | None = None, search: str | None = None) -> Servers:
    """The servers that are named, else those of STUDIO_OVERPASS and STUDIO_NOMINATIM, else the public ones; raises MapError."""
    chosen = Servers(overpass or os.environ.get("STUDIO_OVERPASS") or OVERPASS, search or os.environ.get("STUDIO_NOMINATIM") or SEARCH)
    for address in (chosen.overpass, chosen.search):
        if urlsplit(address).scheme not in ("http", "https") or not urlsplit(address).hostname:
            problem = Problem("address", "is none", address, "http:// or https://", "see --overpass, --search and the environment")
            raise MapError("The address of a map server cannot be used.", [problem])
    return chosen


# -- a map for a box -------------------------------------------------------------------------------


def download(box: Box, target: Path, *, by: Servers, patience: Patience = Patience(), progress: Told = lambda text: None) -> None:
    """Writes what an Overpass server has of a box into a file, as the server's JSON.

    Raises:
        MapError: the box is too large, or the server does not answer with data.
    """
    check_area(box)
    query_text = query(box, patience)
    fetch(by.overpass, target, largest=osm.LARGEST_FILE, patience=patience, progress=progress, data={"data": query_text})


def check_area(box: Box) -> None:
    """Raises MapError for a box that no server should be asked for."""
    size = area(box)
    if size > LARGEST_AREA:
        lat, lon = box.centre
        part = text(Box(lat, lon, lat, lon).grown(1000.0))
        problem = Problem("bbox", "is too large", f"{size:.0f} km²", f"at most {LARGEST_AREA:g} km²", f"its middle, 2 km a side, is {part}")
        raise MapError("The place is too large to download.", [problem])


def area(box: Box) -> float:
    """The area of a box [km²]."""
    height = math.radians(box.north - box.south) * osm.EARTH_RADIUS
    width = math.radians(box.east - box.west) * osm.EARTH_RADIUS * math.cos(math.radians(box.centre[0]))
    return height * width / 1e6


def text(box: Box) -> str:
    """A box as "west,south,east,north" [deg]; seven digits are a centimetre."""
    return f"{box.west:.7f},{box.south:.7f},{box.east:.7f},{box.north:.7f}"


def query(box: Box, patience: Patience = Patience()) -> str:
    """Overpass QL for all that the importer reads, complete shapes with their nodes, without the names of mappers."""
    return f"""[out:json][timeout:{max(1, int(patience.silence) - 20)}][maxsize:{osm.LARGEST}]
[bbox:{box.south:.7f},{box.west:.7f},{box.north:.7f},{box.east:.7f}];
(
  way["highway"];
  way["building"]["building"!="no"];
  way["building:part"];
  way["amenity"~"^parking"];
  way["barrier"];
  way["landuse"];
  way["leisure"];
  way["natural"]["natural"!="coastline"];
  way["waterway"="riverbank"];
  way["place"="square"];
  way["golf"="bunker"];
  relation["type"="multipolygon"][~"^(building|building:part|amenity|landuse|leisure|natural|waterway|highway|place|golf)$"~"."];
)->.shapes;
(
  .shapes;
  .shapes >;
  relation["type"="restriction"];
  node["highway"];
  node["natural"="tree"];
  node["amenity"~"^parking"];
  node["barrier"];
  node["power"~"^(pole|tower)$"];
  node["man_made"~"^(mast|flagpole|utility_pole)$"];
);
out body;
"""


# -- a box for a name ------------------------------------------------------------------------------


def find(place: str, *, by: Servers, target: Path, patience: Patience = Patience(), progress: Told = lambda text: None) -> Place:
    """The place of a name, at least `LEAST_REACH` to every side; `target` is where the server's answer may be put.

    Raises:
        MapError: no place or several have this name, or the server does not answer with places.
    """
    progress(f"looking for {place}")
    ask = {"q": place, "format": "jsonv2", "limit": "20"}
    fetch(by.search, target, largest=LARGEST_LIST, patience=patience, progress=progress, params=ask)
    found = apart(read_places(target, by.search))
    if not found:
        problem = Problem("place", "is not known", repr(place), remedy="write it as on the map, with its city, or give a bbox")
        raise MapError(f"No place is called {place!r}.", [problem])
    if len(found) > 1:
        listed = [Problem(each.name, "has this name", text(each.box)) for each in found[:SHOWN]]
        more = f" (the first {SHOWN} of {len(found)})" if len(found) > SHOWN else ""
        raise MapError(f"Several places are called {place!r}; say more of the name, or give a bbox{more}.", listed)
    return found[0]


def read_places(answer: Path, address: str) -> list[Place]:
    """The places of a Nominatim answer; raises MapError."""
    try:
        return [place_of(each) for each in json.loads(answer.read_bytes())]
    except (ValueError, KeyError, TypeError, RecursionError):
        raise MapError(f"{address}: this is no list of places, as a Nominatim server gives it") from None


def place_of(found: dict[str, Any]) -> Place:
    """One place of the list; raises ValueError, KeyError or TypeError."""
    south, north, west, east = (float(each) for each in found["boundingbox"])
    if not (-180 <= west <= east <= 180 and -85 <= south <= north <= 85):
        raise ValueError
    box = Box(south, west, north, east)
    least = box.around(LEAST_REACH)
    grown = Box(min(south, least.south), min(west, least.west), max(north, least.north), max(east, least.east))
    return Place(str(found["display_name"]), grown)


def apart(places: list[Place]) -> list[Place]:
    """The places without those whose middle lies in one that came before: the same again, or a part of it."""
    found: list[Place] = []
    for place in places:
        latitude, longitude = place.box.centre
        if not any(b.box.south <= latitude <= b.box.north and b.box.west <= longitude <= b.box.east for b in found):
            found.append(place)
    return found


# -- asking ------------------------------------------------------------------------------------------


def fetch(address: str, target: Path, *, largest: int, patience: Patience, progress: Told, **request) -> None:
    """Writes a server's answer into a file: by POST when there is `data`, else by GET.

    Raises:
        MapError: the server cannot be reached, stays busy, refuses, is too slow, or sends too much or no data.
    """
    method = "POST" if "data" in request else "GET"
    timeout = httpx.Timeout(patience.silence, connect=patience.connect)
    agent = {"User-Agent": f"cooperative-adas-studio/{version('cooperative-adas-studio')}", "Accept": "application/json"}
    try:
        with httpx.Client(timeout=timeout, headers=agent) as client:
            for attempt in range(patience.retries + 1):
                progress(f"asking {urlsplit(address).hostname}")
                with client.stream(method, address, **request) as response:
                    if response.status_code not in BUSY:
                        save(response, target, largest, patience, progress)
                        return
                    wait = wait_for(response, attempt, patience)
                progress(f"the server is busy; waiting {wait:.0f} s")
                time.sleep(wait)
    except httpx.TimeoutException:
        raise MapError(f"{address}: the server did not answer in time; try again later, or a smaller place") from None
    except (httpx.HTTPError, httpx.InvalidURL, OSError) as error:
        raise MapError(f"{address}: the download failed ({str(error) or type(error).__name__})") from None


def wait_for(response: httpx.Response, attempt: int, patience: Patience) -> float:
    """How long to wait until a busy server is asked again [s]; raises MapError when it was asked often enough."""
    if attempt == patience.retries:
        times = f"{attempt + 1} times" if attempt else "once"
        raise MapError(f"{response.url}: the server is busy ({response.status_code}), asked {times}; try again later")
    wait = retry_after(response.headers.get("Retry-After", ""), patience.first_wait * 2**attempt)
    if wait > patience.longest_wait:
        raise MapError(f"{response.url}: the server is busy ({response.status_code}) and wants to be asked again in {wait:.0f} s")
    return wait


def retry_after(header: str, otherwise: float) -> float:
    """What a Retry-After header means [s] (RFC 9110, 10.2.3): seconds or a date.

    >>> retry_after("7", 5.0), retry_after("", 5.0), retry_after("Sun, 06 Nov 1994 08:49:37 GMT", 5.0)
    (7.0, 5.0, 0.0)
    """
    if re.fullmatch(r"\d{1,9}", header.strip()):
        return float(header)
    try:
        until = parsedate_to_datetime(header)
    except ValueError:
        return otherwise
    return max(0.0, (until.replace(tzinfo=until.tzinfo or UTC) - datetime.now(UTC)).total_seconds())


def save(response: httpx.Response, target: Path, largest: int, patience: Patience, progress: Told) -> None:
    """Writes the body of an answer into a file as it comes; raises MapError."""
    began, size = time.monotonic(), 0
    progress("downloading")
    with target.open("wb") as file:
        for part in response.iter_bytes():
            before, size = size, size + len(part)
            if size > largest:
                raise MapError(f"{response.url}: the answer is larger than {largest // 2**20} MiB; choose a smaller place")
            if time.monotonic() - began > patience.whole:
                raise MapError(f"{response.url}: the answer took longer than {patience.whole:g} s; choose a smaller place")
            file.write(part)
            if size // 2**20 > before // 2**20:
                progress(f"downloading, {size // 2**20} MiB so far")
    check_answer(response, target)


def check_answer(response: httpx.Response, target: Path) -> None:
    """Raises MapError when the server refused, or sent a page for people instead of data."""
    with target.open("rb") as file:
        head = file.read(4096)
    if response.status_code == 200 and head.lstrip()[:1] in (b"{", b"["):
        return
    said = plain(head.decode("utf-8", "replace"))
    if response.status_code != 200:
        raise MapError(f"{response.url}: the server refused ({response.status_code}): {said}")
    raise MapError(f"{response.url}: the server answered with something else than data: {said or 'nothing'}")


def plain(page: str) -> str:
    """What a page says, in a line.

    >>> plain("<html><head><style>p {}</style></head><body><p><b>Error</b>: too   busy</p></body></html>")
    'Error: too busy'
    """
    page = re.sub(r"(?is)<(style|script|title).*?</\1>|<[^>]*>", "", page)
    return " ".join(page.split())[:200]
