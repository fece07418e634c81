"""Formats of logs: a sample gives the same signals every time, and what is damaged, or is no log, is refused in words."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from studio.errors import ScenarioError
from studio.kind.log import Log
from studio.kind.registry import Kind
from studio.workshop.check import Check, tried

SHARES = (0.0, 0.1, 0.37, 0.5, 0.9, 0.99)  # of a sample that was cut off
DRAWN = 20  # files of random bytes


def checks(kind: Kind) -> Iterator[Check]:
    """All of them: on its sample where it has one, and on what is none of its files."""
    if hasattr(kind.module, "SAMPLE"):
        yield tried("reads its sample: named signals, times that rise, some values", lambda: whole(kind))
        yield tried("gives the same of the same file", lambda: repeated(kind))
        yield tried("refuses a file that was cut off, or reads what is left", lambda: damaged(kind, cut_off(kind)))
    yield tried("refuses files of random bytes, with a ScenarioError and not another", lambda: damaged(kind, random_bytes()))
    yield tried("refuses a file that does not exist", lambda: absent(kind))


def read(kind: Kind, data: bytes | None) -> Log:
    """What it makes of a file with these bytes; of none without them."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"drive{kind.module.SUFFIXES[0].removeprefix('/')}"
        if data is not None:
            path.write_bytes(data)
        return kind.module.read(path if not kind.module.SUFFIXES[0].startswith("/") else path.parent, None)


def whole(kind: Kind) -> str | None:
    """Whether its sample is a log."""
    found = read(kind, kind.module.SAMPLE)
    if not isinstance(found, Log):
        return f"read() gave {type(found).__name__}: return Log(path.name, signals), from studio.kind.log"
    strange = [name for name, each in found.signals.items() if name != each.name or not (np.diff(each.time) > 0.0).all()]
    if strange:
        return f"{', '.join(strange)}: make each with signal(name, unit, time, values), which puts its samples in order"
    return None if any(each.is_number.any() for each in found.signals.values()) else "its SAMPLE gives no values"


def repeated(kind: Kind) -> str | None:
    """No hidden memory."""
    one, other = (read(kind, kind.module.SAMPLE).signals for _ in range(2))
    same = one.keys() == other.keys() and all(np.array_equal(one[name].values, other[name].values, equal_nan=True) for name in one)
    return None if same else "read() gave other signals the second time: keep nothing between calls"


def damaged(kind: Kind, files: Iterator[bytes]) -> None:
    """Raises whatever it raises besides ScenarioError."""
    for each in files:
        try:
            read(kind, each)
        except ScenarioError:
            continue


def absent(kind: Kind) -> str | None:
    """Whether it says so."""
    try:
        read(kind, None)
    except ScenarioError:
        return None
    return "a file that is not there was read" if not kind.module.SUFFIXES[0].startswith("/") else None


def cut_off(kind: Kind) -> Iterator[bytes]:
    """Beginnings of its sample."""
    yield from (kind.module.SAMPLE[: int(share * len(kind.module.SAMPLE))] for share in SHARES)


def random_bytes() -> Iterator[bytes]:
    """Files that are none."""
    seed = np.random.default_rng(1)
    yield from (seed.bytes(int(seed.integers(1, 400))) for _ in range(DRAWN))
