"""A tile: a block of vehicles, copied out of the world's arrays into one buffer of fixed width, and back.

The passes of `motion` run over tiles. Rows of fixed width stand at fixed distances, so the compiler knows that they do not
overlap and puts eight vehicles at a time into its vector registers; and a tile stays in the fast cache over all passes and
steps of a tick. The number of lanes in use is filled up to whole registers with copies of the last vehicle, so every
vehicle takes the same way through the machine code: its bits do not depend on how many others there are.

On a GPU a tile is what one block of threads works on, and a lane is a thread.
"""

import numpy as np
from numba import types
from numba.core import cgutils
from numba.np import arrayobj

from studio.compiled import compiled
from studio.model.elementary import intrinsic
from studio.model.tyre import Tyre
from studio.vehicle.command import COMMAND
from studio.vehicle.contact import CONTACT, GROUND
from studio.vehicle.parameter import PARAMETER
from studio.vehicle.state import VEHICLE, WHEEL

LANES = 72  # width of a tile
REGISTER = 8  # float64 in the widest vector register; lanes are filled up to whole ones
CORNERS = 4 * LANES  # width of a row of wheels: corner · LANES + lane

# First rows of the parts, in units of LANES.
STATE_AT = 0
WHEEL_AT = STATE_AT + len(VEHICLE)
GROUND_AT = WHEEL_AT + 4 * len(WHEEL)
CONTACT_AT = GROUND_AT + 4 * len(GROUND)
PARAMETER_AT = CONTACT_AT + 4 * len(CONTACT)
COMMAND_AT = PARAMETER_AT + len(PARAMETER)
ROWS = COMMAND_AT + len(COMMAND)
SIZE = ROWS * LANES


def new_tile() -> np.ndarray:
    """An empty buffer."""
    return np.zeros(SIZE)


@intrinsic
def window(typing_context, tile, first, width):
    """Rows of a tile from row `first` on, as an array [row, column] of `width` columns whose strides are constants."""
    view_type = types.Array(tile.dtype, 2, "C")

    def generate(context, builder, signature, arguments):
        intp = context.get_value_type(types.intp)
        source = arrayobj.make_array(signature.args[0])(context, builder, arguments[0])
        start = builder.mul(arguments[1], intp(LANES))
        stride = builder.mul(arguments[2], intp(8))
        view = arrayobj.make_array(view_type)(context, builder)
        arrayobj.populate_array(
            view,
            data=cgutils.gep(builder, source.data, start),
            shape=[intp(ROWS), arguments[2]],
            strides=[stride, intp(8)],
            itemsize=intp(8),
            meminfo=None,
        )
        return view._getvalue()

    return view_type(tile, types.intp, types.intp), generate


@intrinsic
def tyre_at(typing_context, table, k):
    """The coefficients of tyre k of a table [tyre, coefficient]: as many loads, nothing else."""
    kind = types.NamedUniTuple(types.float64, len(Tyre._fields), Tyre)

    def generate(context, builder, signature, arguments):
        intp = context.get_value_type(types.intp)
        source = arrayobj.make_array(signature.args[0])(context, builder, arguments[0])
        first = builder.mul(arguments[1], intp(len(Tyre._fields)))
        places = (cgutils.gep(builder, source.data, builder.add(first, intp(j))) for j in range(len(Tyre._fields)))
        return context.make_tuple(builder, kind, [builder.load(place) for place in places])

    return kind(table, types.intp), generate


@compiled
def load(part, columns, contiguous, count, groups, rows, first, tile):
    """Copies rows of an array [row, group · n + column] of the world into a tile, and fills the last register up."""
    n = part.shape[1] // groups
    filled = filled_lanes(count)
    for row in range(rows):
        for group in range(groups):
            start = (first + row * groups + group) * LANES
            copy_in(part[row, group * n : (group + 1) * n], columns, contiguous, count, tile[start : start + LANES])
            for lane in range(count, filled):
                tile[start + lane] = tile[start + count - 1]


@compiled
def copy_in(row, columns, contiguous, count, lanes):
    """One row: a plain copy where the columns stand side by side."""
    if contiguous:
        lanes[:count] = row[columns[0] : columns[0] + count]
    else:
        for lane in range(count):
            lanes[lane] = row[columns[lane]]


@compiled
def store(part, columns, contiguous, count, groups, rows, first, tile):
    """Copies rows of a tile back into an array of the world."""
    n = part.shape[1] // groups
    for row in range(rows):
        for group in range(groups):
            start = (first + row * groups + group) * LANES
            copy_out(part[row, group * n : (group + 1) * n], columns, contiguous, count, tile[start : start + LANES])


@compiled
def store_sound(part, columns, groups, rows, first, tile, broken):
    """The same for those that are not broken."""
    n = part.shape[1] // groups
    for row in range(rows):
        for group in range(groups):
            for lane in range(columns.size):
                if broken[columns[lane]] == 0:
                    part[row, group * n + columns[lane]] = tile[(first + row * groups + group) * LANES + lane]


@compiled
def copy_out(row, columns, contiguous, count, lanes):
    """One row back."""
    if contiguous:
        row[columns[0] : columns[0] + count] = lanes[:count]
    else:
        for lane in range(count):
            row[columns[lane]] = lanes[lane]


@compiled
def filled_lanes(count):
    """Lanes in use, filled up to whole registers."""
    return (count + REGISTER - 1) // REGISTER * REGISTER


def blocks_of(tyres_of: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Columns in the order in which tiles take them, and the blocks: first place, count, tyres front and rear.

    tyres_of int64[2, n]: tyres of every vehicle, front and rear. A block holds vehicles on the same tyres only.
    """
    order = np.lexsort(tyres_of[::-1]).astype(np.int64)
    blocks, start = [], 0
    while start < order.size:
        tyres = tyres_of[:, order[start]]
        same = (tyres_of[:, order[start : start + LANES]] == tyres[:, None]).all(axis=0)
        count = int(same.size if same.all() else same.argmin())
        blocks.append((start, count, *tyres))
        start += count
    return order, np.array(blocks, dtype=np.int64).reshape(-1, 4).T.copy()
