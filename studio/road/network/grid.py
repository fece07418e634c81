"""A uniform grid over the plane: which things lie in a cell. Several maps can share the arrays, one column of `frame` each.

The things of cell c are item[first[c] : first[c + 1]]; the cell in row j and column i of map m is number
frame[CELLS, m] + j · frame[COLUMNS, m] + i.
"""

from collections.abc import Sequence
from math import floor
from typing import NamedTuple

import numpy as np

from studio.compiled import lean

WEST, SOUTH, SIZE, COLUMNS, ROWS, CELLS = range(6)
MARGIN = 0.01  # [m] a line this close to a cell counts as inside: no rounding may lose it
UPRIGHT = 1e-4  # [m] a line that reaches less far east than this has no slope that could be computed with


class Grid(NamedTuple):
    """Frame float64[6, map]: west and south edge [m], size of a cell [m], columns, rows, first cell; then the lists."""

    frame: np.ndarray
    first: np.ndarray
    item: np.ndarray


def frame_around(x: np.ndarray, y: np.ndarray, *, size: float, margin: float = 0.0) -> np.ndarray:
    """The frame of one map that holds all points, with cells of `size` [m]; without points it has no cells."""
    if not x.size:
        return np.array([[0.0], [0.0], [size], [0.0], [0.0], [0.0]])
    west, south = x.min() - margin - MARGIN, y.min() - margin - MARGIN
    across = [floor((far.max() + margin + MARGIN - near) / size) + 1.0 for far, near in ((x, west), (y, south))]
    return np.array([[west], [south], [size], [across[0]], [across[1]], [0.0]])


def over_lines(lines: np.ndarray, *, size: float) -> Grid:
    """The grid of straight lines float64[4, n] of x0, y0, x1, y1 [m]."""
    frame = frame_around(lines[[0, 2]].ravel(), lines[[1, 3]].ravel(), size=size)
    nowhere = np.empty(0, dtype=np.int64)
    total = trace(frame, lines, nowhere, nowhere)
    cell, item = np.empty((2, total), dtype=np.int64)
    trace(frame, lines, cell, item)
    return sorted_in(frame, cell, item)


def over_boxes(frame: np.ndarray, boxes: np.ndarray) -> Grid:
    """The grid of boxes int64[4, n] of first column, last column, first row, last row."""
    cells = [
        np.add.outer(np.arange(south, north + 1) * int(frame[COLUMNS, 0]), np.arange(west, east + 1)).ravel()
        for west, east, south, north in boxes.T.tolist()
    ]
    item = np.repeat(np.arange(len(cells)), [each.size for each in cells]).astype(np.int64)
    return sorted_in(frame, np.concatenate([np.empty(0, dtype=np.int64), *cells]), item)


def sorted_in(frame: np.ndarray, cell: np.ndarray, item: np.ndarray) -> Grid:
    """The lists of all cells from pairs of cell and item."""
    order = np.argsort(cell, kind="stable")
    first = np.searchsorted(cell[order], np.arange(int(frame[COLUMNS, 0] * frame[ROWS, 0]) + 1))
    return Grid(frame, first.astype(np.int64), item[order])


def joined(grids: Sequence[Grid], bases: Sequence[int]) -> Grid:
    """The grids of several maps in one; the items of each are counted from its base on."""
    frames, firsts, cells, items = [], [], 0, 0
    for grid in grids:
        frames.append(grid.frame.copy())
        frames[-1][CELLS] = cells
        firsts.append(grid.first[:-1] + items)
        cells, items = cells + grid.first.size - 1, items + grid.item.size
    item = np.concatenate([grid.item + base for grid, base in zip(grids, bases, strict=True)])
    return Grid(np.concatenate(frames, axis=1), np.concatenate([*firsts, [items]]).astype(np.int64), item)


@lean
def place(frame, m, x, y):
    """Column and row of a point [m]; outside the grid they are negative or too large."""
    size = frame[SIZE, m]
    return int(floor((x - frame[WEST, m]) / size)), int(floor((y - frame[SOUTH, m]) / size))


@lean
def columns_passed(frame, m, x0, x1):
    """First and last column of the grid that a line from x0 east to x1 [m] passes; first > last: none."""
    size = frame[SIZE, m]
    low = int(floor((x0 - MARGIN - frame[WEST, m]) / size))
    high = int(floor((x1 + MARGIN - frame[WEST, m]) / size))
    return max(low, 0), min(high, int(frame[COLUMNS, m]) - 1)


@lean
def rows_passed(frame, m, column, x0, y0, x1, y1):
    """First and last row of the grid that a line, x0 <= x1, passes within a column; first > last: none."""
    size = frame[SIZE, m]
    low, high = min(y0, y1), max(y0, y1)
    if x1 - x0 > UPRIGHT:
        west, slope = frame[WEST, m] + column * size, (y1 - y0) / (x1 - x0)
        a = y0 + slope * (max(west - MARGIN, x0) - x0)
        b = y0 + slope * (min(west + size + MARGIN, x1) - x0)
        low, high = max(low, min(a, b)), min(high, max(a, b))
    first = int(floor((low - MARGIN - frame[SOUTH, m]) / size))
    last = int(floor((high + MARGIN - frame[SOUTH, m]) / size))
    return max(first, 0), min(last, int(frame[ROWS, m]) - 1)


@lean
def trace(frame, lines, cell, item):
    """Writes the cells that each line passes, as far as there is room; returns how many there are."""
    found = 0
    for i in range(lines.shape[1]):
        x0, y0, x1, y1 = lines[0, i], lines[1, i], lines[2, i], lines[3, i]
        if x0 > x1:
            x0, y0, x1, y1 = x1, y1, x0, y0
        low, high = columns_passed(frame, 0, x0, x1)
        for column in range(low, high + 1):
            first, last = rows_passed(frame, 0, column, x0, y0, x1, y1)
            for row in range(first, last + 1):
                if found < cell.size:
                    cell[found], item[found] = row * int(frame[COLUMNS, 0]) + column, i
                found += 1
    return found
