"""Requests that are wrong in one way each, drawn from a seed over the OpenAPI description."""

import json
import random
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any
from urllib.parse import quote

from tests.campaign import mutation

BIG = [
    str(2**63),
    str(-(2**63) - 1),
    str(2**64),
    "9" * 30,
    "9" * 5000,
    "1" + "0" * 400,
    "-" + "9" * 40,
    "1e400",
    "0x" + "f" * 20,
    "1e1000000",
]
STRANGE = [
    "\0",
    "\ud800",
    "\udfff",
    "\ufeff",
    "\u202e",
    "e\u0301" * 500,
    "🚗" * 500,
    "ﷺ" * 100,
    "\u2028",
    "\x7f",
    "\x1b[2J",
    "İ",
    "ß",
    "٣",
    "𝟘",
    "\x85",
    "Ａ",
    "a\u200db",
    "\ufffe",
    "⁄",
    "％2e",
]
OUT = [
    "../../../../etc/passwd",
    "..",
    ".",
    "/etc/passwd",
    "//etc/passwd",
    "..%2f..%2fetc%2fpasswd",
    "..%252f..%252fetc",
    "%2e%2e/%2e%2e/etc/passwd",
    "..\\..\\windows\\win.ini",
    "C:/windows/win.ini",
    "\\\\host\\share",
    "file:///etc/passwd",
    "/proc/self/environ",
    "/dev/zero",
    "~/.ssh/id_rsa",
    "maps/../../x",
    "....//....//etc",
    "%00",
    "a%00b",
    "..%c0%afetc",
]
KEPT = "/:@!$&'()*+,;=-._~%?"  # what stands in an address as it is
TYPES = [
    "",
    "text/plain",
    "text/html",
    "application/xml",
    "application/x-www-form-urlencoded",
    "multipart/form-data",
    "application/octet-stream",
    "application/json; charset=utf-16",
    "application/json; charset=nonsense",
    "application/JSON",
    "json",
    "application/json, text/html",
    "x" * 3000,
    "application/yaml",
    ";",
    "application/json;;;=",
]
FIELDS = {
    "/api/runs": {"scenario": "none", "set": {"clock.duration": 0.2}, "seed": 1, "parent": 1},
    "/api/live": {"scenario": "none", "set": {"clock.duration": 0.2}, "seed": 1, "parent": None, "pace": 2.0, "paused": False},
    "/api/live/{run}/pace": {"pace": 2.0},
    "/api/scene": {"scenario": "motorway_platoon", "set": {"clock.duration": 2}, "run": None},
    "/api/scenarios/{scenario}/check": {"set": {"clock.duration": 2, "vehicles.leader.speed": 20}},
    "/api/scenarios/{scenario}": [
        {"op": "replace", "path": "/clock/duration", "value": 20},
        {"op": "test", "path": "/version", "value": 3},
    ],
    "/api/scenarios/{scenario}/copy": {"name": "x"},
    "/api/runs/{run}/verdicts": {"verdict": "open", "reason": "none", "who": "nobody"},
    "/api/runs/{run}/remark": {"name": "x", "tags": ["y"], "note": "z"},
    "/api/verdicts": {"verdicts": [{"run": 1, "verdict": "open", "reason": "none"}], "who": "nobody"},
    "/api/tags": {"tags": [{"run": 1, "add": ["x"], "remove": ["y"]}]},
    "/api/stages": {"wanted": 1},
    "/api/scene/time": {"run": 1, "time": 0.1},
    "/api/maps/download": {"place": "Nowhere", "bbox": None, "name": "x", "replace": False},
    "/api/maps/{map}/corrections": {"element": "way 20", "tags": {"lanes": "2"}, "remove": ["name"]},
}
WITHOUT_BODY = ("GET", "DELETE")
LOST = {"scenario": "none"}  # what is deleted would be missing afterwards
USUAL = {
    "run": "1",
    "scenario": "patched",
    "map": "motorway.xodr",
    "job": "1",
    "element": "way%2020",
    "entry": "1",
    "sort": "application",
    "name": "acc",
}
QUERY = {
    "limit": "10",
    "scenario": "patched",
    "channels": "leader.speed",
    "points": "100",
    "event": "1",
    "a": "1",
    "b": "1",
    "name": "x.osm",
    "bbox": "1,2,3,4",
    "replace": "0",
}
SETTINGS = """
clock.duration clock.tick seed title map.file map.radius vehicles vehicles.leader vehicles.leader.model vehicles.leader.speed
vehicles.leader.position vehicles.leader.position.along vehicles.leader.route vehicles.leader.driver vehicles.leader.driver.kind
vehicles.leader.sensors applications applications.platoon applications.platoon.parameters.headway applications.platoon.units
applications.platoon.application traffic traffic.count traffic.model weather weather.friction weather.visibility script radio
radio.kind goals recording recording.period recording.channels routes routes.motorway measures seeds version stations x .. a.b
""".split()


@dataclass(frozen=True)
class Request:
    """A request as it goes over the line; `route` is the description's, None when it is none of them."""

    method: str
    route: str | None
    address: str
    body: bytes | None = None
    headers: dict[str, str] = field(default_factory=dict)


class Maker:
    """Makes requests over a description."""

    def __init__(self, paths: dict[str, Any]) -> None:
        self.paths = paths
        self.operations = [
            (method.upper(), route) for route in sorted(paths) for method in sorted(paths[route]) if not route.endswith("/socket")
        ]
        self.writing = [each for each in self.operations if each[1] in FIELDS and each[0] not in WITHOUT_BODY]

    def usual(self, chance: random.Random, *, writing: bool = False) -> Request:
        """A good request, but that what it would start does not exist."""
        method, route = chance.choice(self.writing if writing else self.operations)
        body = FIELDS.get(route) if method not in WITHOUT_BODY else None
        kind = {"Content-Type": "application/json-patch+json" if method == "PATCH" else "application/json"} if body is not None else {}
        return Request(method, route, self.address(method, route), json.dumps(body).encode() if body is not None else None, kind)

    def address(self, method: str, route: str, parts: dict[str, str] | None = None, query: dict[str, str] | None = None) -> str:
        """An address of a route."""
        found = route
        for name, value in (USUAL | (LOST if method == "DELETE" else {}) | (parts or {})).items():
            found = found.replace(f"{{{name}}}", value)
        asked = [each["name"] for each in self.paths[route][method.lower()].get("parameters", []) if each["in"] == "query"]
        question = "&".join(f"{name}={(query or {}).get(name, QUERY.get(name, '1'))}" for name in asked)
        return f"{found}?{question}" if question else found

    def somewhere(self, chance: random.Random, values: list[str], *, raw: bool = False) -> Request:
        """A request with one of these values in its address, its question or its body."""
        value = chance.choice(values)
        told = value if raw else quote(value, safe=KEPT if chance.random() < 0.5 else "", errors="surrogatepass")
        if chance.random() < 0.5:
            return self.in_body(chance, value)
        method, route = chance.choice(
            [each for each in self.operations if "{" in each[1] or self.paths[each[1]][each[0].lower()].get("parameters")]
        )
        good = Request(method, route, "")
        body = self.usual(chance, writing=True)
        address = (
            self.address(method, route, dict.fromkeys(USUAL, told), dict.fromkeys(QUERY, told))
            if chance.random() < 0.5
            else self.one(chance, method, route, told)
        )
        return replace(good, address=address, body=body.body if method not in WITHOUT_BODY else None, headers=body.headers)

    def one(self, chance: random.Random, method: str, route: str, told: str) -> str:
        """An address with a value in one place."""
        names = [name for name in USUAL if f"{{{name}}}" in route]
        asked = [each["name"] for each in self.paths[route][method.lower()].get("parameters", []) if each["in"] == "query"]
        chosen = chance.choice([*names, *asked] or ["run"])
        return self.address(method, route, {chosen: told} if chosen in names else {}, {chosen: told} if chosen in asked else {})

    def in_body(self, chance: random.Random, value: Any) -> Request:
        """A request with a value somewhere in its body; numbers as they are written."""
        good = self.usual(chance, writing=True)
        body = json.loads(good.body or b"{}")
        *way, last = chance.choice([each for each in mutation.places(body) if each])
        holder = body
        for key in way:
            holder = holder[key]
        if chance.random() < 0.2 and isinstance(holder, dict) and isinstance(value, str):
            holder[value] = holder.pop(last)
        else:
            holder[last] = "@@"
        text = json.dumps(body)
        return replace(good, body=text.replace('"@@"', value if is_number(value) else json.dumps(value)).encode())


def is_number(value: Any) -> bool:
    """Whether a text is written as a number in JSON."""
    return isinstance(value, str) and value.lstrip("-")[:1].isdigit() and value.lstrip("-").replace(".", "").replace("e", "").isdigit()


# -- what is wrong -----------------------------------------------------------------------------------


def beyond(make: Maker, chance: random.Random) -> Request:
    """Numbers that no machine word holds."""
    return make.somewhere(chance, BIG)


def not_finite(make: Maker, chance: random.Random) -> Request:
    """Numbers that are none."""
    good = make.in_body(chance, "@number@")
    return replace(
        good, body=(good.body or b"").replace(b'"@number@"', chance.choice((b"NaN", b"Infinity", b"-Infinity", b"-NaN", b"1e999", b"nan")))
    )


def deep(make: Maker, chance: random.Random) -> Request:
    """Brackets within brackets."""
    good = make.in_body(chance, "@deep@")
    size = chance.choice((20, 100, 1000, 100_000))
    opening, closing = chance.choice(((b"[", b"]"), (b'{"a":', b"}"), (b'[{"a":', b"}]")))
    return replace(good, body=(good.body or b"").replace(b'"@deep@"', opening * size + b"0" + closing * size))


def long(make: Maker, chance: random.Random) -> Request:
    """Long texts, long lists, many fields."""
    if chance.random() < 0.5:
        return make.somewhere(chance, ["x" * 1000, "a/" * 3000, "x" * 9000, "%41" * 2000], raw=True)
    return make.in_body(
        chance, chance.choice(("y" * 300_000, [0] * 50_000, {str(i): i for i in range(5000)}, [[]] * 10_000, "1" * 300_000))
    )


def strange(make: Maker, chance: random.Random) -> Request:
    """Characters that nobody expects."""
    return make.somewhere(chance, STRANGE)


def twice(make: Maker, chance: random.Random) -> Request:
    """Keys that stand there more than once, in the body or in the question."""
    good = make.usual(chance, writing=chance.random() < 0.7)
    if good.body is None:
        mark = "&" if "?" in good.address else "?"
        return replace(good, address=f"{good.address}{mark}{'&'.join(f'{name}={chance.choice(BIG)}' for name in [*QUERY, *QUERY])}")
    text = good.body.decode()
    return replace(
        good, body=text.replace("{", '{"scenario": "x", "set": 1, "scenario": [], "op": 1, ' * chance.choice((1, 2, 50)), 1).encode()
    )


def wrong_type(make: Maker, chance: random.Random) -> Request:
    """Bodies that are called something else."""
    good = make.usual(chance, writing=True)
    return replace(good, headers={"Content-Type": chance.choice(TYPES)})


def outward(make: Maker, chance: random.Random) -> Request:
    """Paths that lead out of the folders."""
    if chance.random() < 0.3:
        return replace(
            make.usual(chance),
            route=None,
            method="GET",
            address=chance.choice(("/", "/assets/", "/api/", "/scene/")) + chance.choice(OUT),
            body=None,
        )
    return make.somewhere(chance, OUT, raw=chance.random() < 0.7)


def multipart(make: Maker, chance: random.Random) -> Request:
    """Forms with parts that do not end, have no boundary, or lie about it."""
    good = make.usual(chance, writing=True)
    head = "multipart/form-data; boundary=" + chance.choice(("x", "", '"', "y" * 300, "--"))
    part = b'--x\r\nContent-Disposition: form-data; name="file"; filename="../../a.osm"\r\n\r\n<osm/>\r\n'
    body = chance.choice((part, part * 50, part + b"--x--", b"--x", b"--x\r\n\r\n", part[:40], b"--x--\r\n" * 100, chance.randbytes(200)))
    if chance.random() < 0.5:
        return Request("POST", "/api/maps", "/api/maps?name=form.osm", body, {"Content-Type": head})
    return replace(good, body=body, headers={"Content-Type": head})


def broken(make: Maker, chance: random.Random) -> Request:
    """JSON with bytes that are missing, others, or too many."""
    good = make.usual(chance, writing=True)
    body = good.body or b""
    for _ in range(chance.choice((1, 2, 3))):
        body = chance.choice(mutation.BYTES)(chance, body, [body, b"\xff\xfe{}", b"\xef\xbb\xbf{}", b"null", b"[" * 50])
    return replace(good, body=body)


def other_values(make: Maker, chance: random.Random) -> Request:
    """Values of other types."""
    return make.in_body(chance, chance.choice(mutation.VALUES))


def other_fields(make: Maker, chance: random.Random) -> Request:
    """Fields that do not exist, or are missing."""
    good = make.usual(chance, writing=True)
    return replace(good, body=json.dumps(mutation.branch(chance, json.loads(good.body or b"{}"))).encode())


def methods(make: Maker, chance: random.Random) -> Request:
    """Methods that an address does not have."""
    good = make.usual(chance)
    method = chance.choice(("PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "HEAD", "BREW", "GET", "POST", "CONNECT", "get", "PROPFIND"))
    known = good.route is not None and method.lower() in make.paths[good.route]
    return good if known else replace(good, method=method, route=None)


def headers(make: Maker, chance: random.Random) -> Request:
    """Headers that make no sense."""
    good = make.usual(chance)
    name = chance.choice(
        (
            "If-Match",
            "If-None-Match",
            "Range",
            "Accept",
            "Accept-Encoding",
            "Content-Encoding",
            "Cookie",
            "Authorization",
            "Expect",
            "Upgrade",
            "Connection",
            "X-HTTP-Method-Override",
            "X-Forwarded-Host",
            "Forwarded",
        )
    )
    value = chance.choice(
        (
            "",
            "*",
            '"',
            'W/"x"',
            "bytes=0-0,1-1," * 200,
            "gzip",
            "chunked",
            "-1",
            "9" * 30,
            "x" * 5000,
            "websocket",
            "100-continue",
            "=;=;",
            "é",
            "\t",
        )
    )
    return replace(good, headers=good.headers | {name: value})


def foreign(make: Maker, chance: random.Random) -> Request:
    """Pages of other origins, names that are not ours."""
    good = make.usual(chance)
    name, value = chance.choice(
        [
            ("Origin", each)
            for each in (
                "http://evil.example",
                "null",
                "http://127.0.0.1:1",
                "https://localhost",
                "file://",
                "http://127.0.0.1.evil.example",
                "x" * 3000,
            )
        ]
        + [
            ("Host", each)
            for each in ("evil.example", "", "127.0.0.1:99999", "[::1", "localhost:x", "127.0.0.1@evil.example", "0x7f.1", "a" * 3000)
        ]
        + [("Sec-Fetch-Site", each) for each in ("cross-site", "same-site", "x")]
    )
    return replace(good, headers=good.headers | {name: value})


def nowhere(make: Maker, chance: random.Random) -> Request:
    """Addresses that are none."""
    end = chance.choice(
        (
            "",
            "/",
            "//",
            "x",
            "runs/1/x",
            "runs//trace",
            "live/1/socket/x",
            "maps/a/b/c/d",
            "%",
            "%zz",
            "?",
            "#",
            ";a=b",
            "runs;v=1",
            "info/",
            "INFO",
            "openapi.json",
        )
    )
    return Request(
        chance.choice(("GET", "POST", "DELETE")), None, chance.choice(("/api/", "/api", "/api//", "/scene/", "/openapi.json/")) + end
    )


def settings(make: Maker, chance: random.Random) -> Request:
    """Changes of a scenario that nobody should make."""
    changes = {
        chance.choice(SETTINGS): chance.choice([*mutation.VALUES, *mutation.WORDS, *STRANGE]) for _ in range(chance.choice((1, 1, 2, 4)))
    }
    route = chance.choice(("/api/scenarios/{scenario}/check",) * 6 + ("/api/scene",))
    body = {"set": changes} | ({"scenario": "motorway_platoon"} if route == "/api/scene" else {})
    return Request("POST", route, make.address("POST", route), json.dumps(body).encode(), {"Content-Type": "application/json"})


def patches(make: Maker, chance: random.Random) -> Request:
    """Patches of a scenario file."""
    route = "/api/scenarios/{scenario}"
    place = "/" + chance.choice(SETTINGS).replace(".", "/")
    steps = [
        {
            "op": chance.choice(("add", "replace", "remove", "move", "copy", "test", "x")),
            "path": place,
            "from": "/vehicles/leader",
            "value": chance.choice(mutation.VALUES),
        }
        for _ in range(chance.choice((1, 1, 2, 5)))
    ]
    if chance.random() < 0.4:
        steps = mutation.branch(chance, steps)
    return Request(
        "PATCH", route, make.address("PATCH", route), json.dumps(steps).encode(), {"Content-Type": "application/json-patch+json"}
    )


KINDS: dict[str, Callable[[Maker, random.Random], Request]] = {
    "numbers beyond 64 bits": beyond,
    "numbers that are none": not_finite,
    "deep nesting": deep,
    "long texts and lists": long,
    "strange characters": strange,
    "keys that stand twice": twice,
    "other content types": wrong_type,
    "paths that lead out": outward,
    "broken forms": multipart,
    "broken JSON": broken,
    "values of other types": other_values,
    "fields that are missing or not known": other_fields,
    "methods that there are not": methods,
    "headers without sense": headers,
    "foreign origins and hosts": foreign,
    "addresses that there are not": nowhere,
    "settings of a scenario": settings,
    "patches of a scenario": patches,
}
