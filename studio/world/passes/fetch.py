"""Fetching: what will soon be read of a large table is asked for early, so that it is there when it is wanted.

A pass over all vehicles reads of each a few places of tables that are larger than the processor's nearer caches: what is known of the road
under it. Such a read takes as long as a hundred sums, and a processor does not look far enough ahead to begin with the next vehicle's
meanwhile. What is asked for here is brought near while others are worked on; nothing waits for it, and no number changes.
"""

from typing import Any

from llvmlite import ir
from numba import extending, types
from numba.core import cgutils

EARLY = 6  # vehicles, or sensors, that are worked on while what is fetched is on its way
READ, EVERYWHERE, DATA = 0, 3, 1  # what it is wanted for, how near, of which kind: what llvm.prefetch is given
intrinsic: Any = extending.intrinsic  # its own types are about what makes the code, not about the call


@intrinsic
def fetch(typing_context, table, row, column):
    """Asks for the line of memory in which table[row, column] is; a place beyond the table is asked for in vain."""

    def generate(context, builder, signature, arguments):
        array = context.make_array(signature.args[0])(context, builder, arguments[0])
        place = [context.cast(builder, *each, types.intp) for each in zip(arguments[1:], signature.args[1:], strict=True)]
        at = builder.bitcast(cgutils.get_item_pointer(context, builder, signature.args[0], array, place), ir.IntType(8).as_pointer())
        number = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [at.type, number, number, number])
        asked = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0")
        builder.call(asked, [at, *(number(each) for each in (READ, EVERYWHERE, DATA))])
        return context.get_dummy_value()

    return types.none(table, row, column), generate
