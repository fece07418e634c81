"""The same function twice: as machine code and as Python, and again with the same input."""

import math
from collections.abc import Callable, Iterable, Iterator
from typing import Any

CLOSE = 1e-9  # relative; the last bits may differ, for machine code and Python take sines from different libraries


def agree(function: Any, draws: Iterable[tuple]) -> str | None:
    """Where machine code and Python do not give the same."""
    for given in draws:
        compiled, plain = function(*given), function.py_func(*given)
        if not same(compiled, plain):
            return f"compiled it gives {compiled}, as Python {plain}, of {short(given)}: look for whole numbers that are divided, or for /0"
    return None


def steady(function: Callable, draws: Iterable[tuple]) -> str | None:
    """Where the second answer is another one."""
    for given in draws:
        first, second = function(*given), function(*given)
        if not same(first, second, close=0.0):
            return f"it gives {first}, then {second}, of the same {short(given)}: keep nothing between calls"
    return None


def finite(function: Callable, draws: Iterable[tuple]) -> str | None:
    """Where it gives numbers that are none."""
    for given in draws:
        answer = function(*given)
        if not all(math.isfinite(value) for value in flat(answer)):
            return f"it gives {answer} of {short(given)}: look for a division by zero, or a root of something negative"
    return None


def same(a: Any, b: Any, close: float = CLOSE) -> bool:
    """Whether two answers hold the same numbers."""
    left, right = list(flat(a)), list(flat(b))
    return len(left) == len(right) and all(alike(one, other, close) for one, other in zip(left, right, strict=True))


def alike(one: float, other: float, close: float) -> bool:
    """Whether two numbers are the same; two that are none are."""
    return one == other or (math.isnan(one) and math.isnan(other)) or math.isclose(one, other, rel_tol=close, abs_tol=close)


def flat(answer: Any) -> Iterator[float]:
    """All numbers of an answer, one after another."""
    if isinstance(answer, tuple):
        for each in answer:
            yield from flat(each)
    else:
        yield float(answer)


def short(given: Any) -> str:
    """An input for people."""
    text = str(given)
    return text if len(text) <= 400 else f"{text[:400]} ..."
