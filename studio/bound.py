"""Functions whose first arguments are given once and for all: arrays that stay where they are.

numba looks at the types of all arguments at every call, and takes every array apart anew. For a view of the world that takes longer than
the work of a few units. So all of an array that compiled code wants of it is written down once, as words of a block, and what is called
afterwards is a small compiled function that lays these words before the real one. It depends on nothing but how many words there are.

bound(function, *arguments, then)   →  a function of what follows
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import groupby, pairwise
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba import extending, types
from numba.core import cgutils

from studio.compiled import compiled

WORD, REAL = "w", "r"  # in the layout of a block: an integer or address, a real number
OF = {WORD: types.int64, REAL: types.float64}
intrinsic: Any = extending.intrinsic  # its own types are about what makes the code, not about the call


def bound(function: Any, *arguments: Any, then: tuple = ()) -> Callable:
    """A function with its first arguments given once and for all; `then` are numbers like those that will follow, for a compiled one."""
    if not hasattr(function, "py_func"):
        return partial(function, *arguments)
    kinds = tuple(numba.typeof(each) for each in (*arguments, *then))
    if kinds not in function.overloads:
        function.compile(kinds)
    made = function.overloads[kinds]
    block = block_of(made.library.get_pointer_to_function(made.fndesc.llvm_func_name), arguments, made.signature.return_type)
    call = CALLS[len(then)]
    of_call = (block.kind, *kinds[len(arguments) :])
    return partial(call.overloads[of_call].entry_point if of_call in call.overloads else call.compile(of_call), block)


# -- a block ---------------------------------------------------------------------------------------------


class Block(int):
    """The address of words: where a function is, then its arguments. It holds what stands there."""

    kind: "BlockType"
    held: tuple


class BlockType(types.Type):
    """Blocks of one layout, for functions with one type of result."""

    def __init__(self, layout: str, result: Any) -> None:
        self.layout, self.result = layout, result
        super().__init__(f"Block({layout}, {result})")


def block_of(address: int, arguments: tuple, result: Any) -> Block:
    """The words for a function at an address."""
    found = [(WORD, address), *(word for each in arguments for word in words(each))]
    laid = np.array([value if kind == WORD else np.float64(value).view(np.int64) for kind, value in found], np.int64)
    made = Block(laid.ctypes.data)
    made.kind = BlockType("".join(f"{kind}{len(list(run))}" for kind, run in groupby(kind for kind, _ in found[1:])), result)
    made.held = (laid, arguments)
    return made


def words(value: Any) -> Iterator[tuple[str, Any]]:
    """What compiled code is given for an argument: of an array that nobody counts, its sizes, address, shape and strides."""
    if isinstance(value, tuple):
        for each in value:
            yield from words(each)
    elif isinstance(value, np.ndarray):
        for each in (0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides):
            yield WORD, each
    else:
        yield (REAL if isinstance(value, float) else WORD), value


def laid_out(layout: str) -> list[Any]:
    """The types of the words of a layout."""
    ends = [*(i for i, each in enumerate(layout) if each in OF), len(layout)]
    return [OF[layout[i]] for i, end in pairwise(ends) for _ in range(int(layout[i + 1 : end]))]


# -- for the compiler ------------------------------------------------------------------------------------


@extending.typeof_impl.register(Block)
def type_of(block, _context):
    """The type of a block."""
    return block.kind


@extending.register_model(BlockType)
class BlockModel(extending.models.PrimitiveModel):
    """An address is a whole number."""

    def __init__(self, manager, kind):
        super().__init__(manager, kind, ir.IntType(64))


@extending.unbox(BlockType)
def unboxed(_kind, block, context):
    """The address."""
    return extending.NativeValue(context.pyapi.long_as_longlong(block))


@intrinsic
def through(typing_context, block, then):
    """Calls the function of a block with its words and what follows."""

    def generate(context, builder, signature, arguments):
        at = builder.inttoptr(arguments[0], ir.IntType(64).as_pointer())
        kinds = laid_out(block.layout)
        given = [builder.load(word_at(context, builder, at, i + 1, kind)) for i, kind in enumerate(kinds)]
        kinds, given = [*kinds, *signature.args[1]], [*given, *cgutils.unpack_tuple(builder, arguments[1])]
        function = builder.inttoptr(builder.load(at), context.call_conv.get_function_type(block.result, kinds).as_pointer())
        status, result = context.call_conv.call_function(builder, function, block.result, kinds, given)
        with cgutils.if_unlikely(builder, status.is_error):
            context.call_conv.return_status_propagate(builder, status)
        return result

    return block.result(block, then), generate


def word_at(context, builder, at, i, kind):
    """The address of a word."""
    return builder.bitcast(cgutils.gep(builder, at, i), context.get_value_type(kind).as_pointer())


@compiled
def call(block):
    """Nothing follows."""
    return through(block, ())


@compiled
def call_with_one(block, a):
    """One number follows."""
    return through(block, (a,))


@compiled
def call_with_two(block, a, b):
    """Two numbers follow."""
    return through(block, (a, b))


CALLS: tuple[Any, ...] = (call, call_with_one, call_with_two)
