"""What is done to a good input to make a bad one: to its bytes, to its words and numbers, to its tree.

Every mutant comes from a generator of its own, so one can be made again without those before it.
"""

import copy
import json
import random
import re
from collections.abc import Callable
from typing import Any
from xml.etree import ElementTree

NUMBERS = """0 -0 -1 1e400 -1e400 1e308 1e-320 nan NaN inf -Infinity .inf .nan 2147483647 2147483648 -2147483649 9223372036854775807
9223372036854775808 18446744073709551616 99999999999999999999999999 0x7fffffff 1_000 012 1e5 1e9 0.1e-9 ٣ 1,5 --1 1e""".split()
LONG = "x" * 5000
WORDS = [
    "",
    " ",
    "\0",
    "\x1b[31m",
    LONG,
    "9" * 5000,
    "null",
    "true",
    "~",
    "../../../../etc/passwd",
    "/dev/zero",
    "//evil.example/share",
    "C:\\con",
    "'",
    '"',
    "\\",
    "%s%s%n",
    "{}",
    "[]",
    "&amp;",
    "<a>",
    "]]>",
    "&lt;",
    "🚗",
    "e\u0301",
    "\u202e",
    "\ufeff",
    "\ud7ff",
    "ﬀ",
    "İ",
    "*a",
    "&a",
    "!!python/object:os.system",
    "!!binary",
    "- ",
    ": ",
    "?",
    "|",
    ">",
    "\t",
    "\r\n",
    "\u2028",
    "__class__",
    "constructor",
    "-1",
    "0",
    "1e999",
]
VALUES: list[Any] = [
    None,
    True,
    False,
    0,
    -1,
    1,
    10**20,
    2**63,
    -(2**63) - 1,
    10**400,
    1e308,
    -1e308,
    1e-320,
    0.5,
    "",
    "x",
    LONG,
    "\0",
    "🚗",
    "nan",
    "../..",
    [],
    {},
    [[]],
    [None],
    {"": None},
    {"a": {"b": {"c": []}}},
    [0] * 1000,
    ["a", "a"],
    {str(i): i for i in range(100)},
]
TOKEN = re.compile(rb"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?|\w+")
BLOCKS = (
    b"\0",
    b"\xff",
    b"\x7f\xff\xff\xff",
    b"\xff\xff\xff\xff",
    b"\x80\0\0\0",
    b"\xff" * 8,
    b"\0" * 8,
    b"\r\n",
    b"\xf0\x9f",
    b"\xed\xa0\x80",
)
Mutator = Callable[[random.Random, bytes, list[bytes]], bytes]


def span(chance: random.Random, data: bytes) -> tuple[int, int]:
    """Some stretch, most often a short one."""
    start = chance.randrange(len(data) + 1)
    return start, min(len(data), start + int(2 ** chance.uniform(0, 10)))


# -- bytes -------------------------------------------------------------------------------------------


def flip(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """Some bits are others."""
    changed = bytearray(data or b"\0")
    for _ in range(chance.choice((1, 1, 2, 8, 64))):
        changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def overwrite(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """A block stands where others stood."""
    block = chance.choice(BLOCKS)
    start, _ = span(chance, data)
    return data[:start] + block + data[start + len(block) :]


def cut(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """A stretch is missing."""
    start, end = span(chance, data)
    return data[:start] + data[end:]


def break_off(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """The rest is missing."""
    return data[: chance.randrange(len(data) + 1)]


def repeat(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """A stretch stands there more than once."""
    start, end = span(chance, data)
    return data[:end] + data[start:end] * chance.choice((1, 2, 50)) + data[end:]


def insert(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """Noise stands between."""
    start, _ = span(chance, data)
    return data[:start] + chance.randbytes(int(2 ** chance.uniform(0, 8))) + data[start:]


def splice(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """The head of one, the tail of another."""
    other = chance.choice(others)
    return data[: chance.randrange(len(data) + 1)] + other[chance.randrange(len(other) + 1) :]


# -- text --------------------------------------------------------------------------------------------


def token(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """Numbers and words are others."""
    found = list(TOKEN.finditer(data))
    for each in sorted(chance.sample(found, min(len(found), chance.choice((1, 1, 2, 5)))), key=lambda each: -each.start()):
        is_number = each.group()[:1].isdigit() and chance.random() < 0.8
        new = chance.choice(NUMBERS if is_number else WORDS).encode("utf-8", "surrogatepass")
        data = data[: each.start()] + new + data[each.end() :]
    return data


def exchange(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """A word stands where another of the same file stood."""
    found = list(TOKEN.finditer(data))
    if len(found) < 2:
        return data
    here, there = chance.sample(found, 2)
    return data[: here.start()] + there.group() + data[here.end() :]


def lines(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """A line is missing, stands twice, or elsewhere."""
    found = data.splitlines(keepends=True) or [b""]
    at, to = chance.randrange(len(found)), chance.randrange(len(found))
    line = found.pop(at) if chance.random() < 0.6 else found[at]
    if chance.random() < 0.6:
        found[to:to] = [line] * chance.choice((1, 1, 100))
    return b"".join(found)


def nest(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """A word stands within many brackets."""
    found = list(TOKEN.finditer(data))
    deep = chance.choice((10, 200, 5000, 100_000))
    opening, closing = chance.choice(((b"[", b"]"), (b"(", b")"), (b'{"a":', b"}"), (b"<a>", b"</a>"), (b"- ", b""), (b"&a [*a,", b"]")))
    at = chance.choice(found).start() if found else 0
    return data[:at] + opening * deep + closing * chance.choice((deep, deep, 0)) + data[at:]


# -- trees -------------------------------------------------------------------------------------------


def places(value: Any, path: tuple = ()) -> list[tuple]:
    """Paths of everything in plain data."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(each for key, part in inner for each in places(part, (*path, key)))]


def branch(chance: random.Random, value: Any) -> Any:
    """Plain data in which something is another value, is gone, is called otherwise, or stands elsewhere."""
    value = copy.deepcopy(value)
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        known = places(value)
        *way, last = chance.choice(known) or (None,)
        if last is None:
            continue
        holder = value
        for key in way:
            holder = holder[key]
        how = chance.random()
        if how < 0.6:
            holder[last] = copy.deepcopy(chance.choice(VALUES))
        elif how < 0.75:
            del holder[last]
        elif how < 0.9 and isinstance(holder, dict):
            holder[chance.choice(WORDS)] = holder.pop(last)
        else:
            found = value
            for key in chance.choice(known):
                found = found[key]
            holder[last] = copy.deepcopy(found)
    return value


def tree(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """Of plain data, as JSON, which is YAML too."""
    import yaml

    known = json.loads(data) if data[:1] in b"[{" else yaml.safe_load(data)
    return json.dumps(branch(chance, known)).encode()


def elements(chance: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """Of XML: elements that are gone, stand twice or elsewhere; attributes of other values, or gone."""
    root = ElementTree.fromstring(data)
    for _ in range(chance.choice((1, 1, 2, 5))):
        known = list(root.iter())
        holder, other = chance.choice(known), chance.choice(known)
        if chance.random() < 0.4 and len(holder):
            part = chance.choice(list(holder))
            if chance.random() < 0.7:
                holder.remove(part)
            if chance.random() < 0.6:
                other.append(copy.deepcopy(part))
        elif holder.attrib:
            name = chance.choice(sorted(holder.attrib))
            if chance.random() < 0.2:
                del holder.attrib[name]
            else:
                holder.set(name, chance.choice([*NUMBERS, *WORDS[3:10], other.get(name, "")]))
    return ElementTree.tostring(root)


BYTES: tuple[Mutator, ...] = (flip, overwrite, cut, break_off, repeat, insert, splice)
TEXT: tuple[Mutator, ...] = (*BYTES, token, token, token, token, exchange, exchange, lines, lines, nest)
TREE: tuple[Mutator, ...] = (*TEXT, *(tree,) * 12)
XML: tuple[Mutator, ...] = (*TEXT, *(elements,) * 12)


def mutant(seed: str, samples: list[bytes], mutators: tuple[Mutator, ...]) -> bytes:
    """The bad input of a seed."""
    chance = random.Random(seed)
    data = chance.choice(samples)
    steps = chance.choice((1, 1, 1, 2, 3))
    how = [chance.choice(mutators) for _ in range(steps)]
    for each in sorted(how, key=lambda each: each not in (tree, elements)):  # a tree can be read only as long as it is one
        try:
            data = each(chance, data, samples)
        except (ValueError, RecursionError, LookupError, ElementTree.ParseError):
            data = flip(chance, data, samples)
    return data
