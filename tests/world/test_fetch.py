"""Fetching asks for memory early and does nothing else: no number changes, and what does not exist is asked for in vain."""

from typing import Any

import numba
import numpy as np
import pytest

from studio.compiled import lean
from studio.world.passes.fetch import fetch


@lean
def ask(table, row, column):
    """Asks for one place."""
    fetch(table, row, column)


@pytest.mark.parametrize("order", ["C", "F"])
def test_a_table_stays_as_it_is(order):
    """Wherever it is asked for, and far beyond both ends."""
    table = np.array(np.arange(700.0).reshape(7, 100), order=order)
    before = table.copy()
    for column in (0, 99, 100, -1, 10**9, -(10**9)):
        ask(table, 3, column)
    assert np.array_equal(table, before)


def test_the_processor_is_asked():
    """The instruction stands in what is compiled."""
    compiled: Any = ask
    compiled.compile((numba.float64[:, ::1], numba.int64, numba.int64))
    assert all("llvm.prefetch" in text for text in compiled.inspect_llvm().values())
