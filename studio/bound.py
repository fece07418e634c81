"""Functions whose first arguments are given once and for all: arrays that stay where they are.

numba looks at the types of all arguments at every call, and takes every array apart anew. For a view of the world that takes longer than
the work of a few units. So all of an array that compiled code wants of it is written down once, as words of a block, and what is called
afterwards is a small compiled function that lays these words before the real one. It depends on nothing but how many words there are.

bound(function, *arguments, then)            →  a function of what follows
Chain([Link(step(function, ...), tell), ...])   several of them, one after another, in one call

Between two calls of compiled code Python takes as long as the work of a few units, too, and longer when that work has driven it out of the
processor's caches. A chain goes from function to function by itself, and comes back only when one has something to tell.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import groupby, pairwise
from typing import Any, NamedTuple

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
    block, kinds = laid(function, arguments, then)
    return partial(compiled_for(CALLS[len(then)], (block.kind, *kinds)).entry_point, block)


def laid(function: Any, arguments: tuple, then: tuple) -> tuple["Block", tuple]:
    """The block of a function with its first arguments, and the types of what follows."""
    kinds = tuple(numba.typeof(each) for each in (*arguments, *then))
    made = compiled_for(function, kinds)
    return block_of(address_of(made), arguments, made.signature.return_type), kinds[len(arguments) :]


def compiled_for(function: Any, kinds: tuple) -> Any:
    """The machine code of a function for some types."""
    if kinds not in function.overloads:
        function.compile(kinds)
    return function.overloads[kinds]


def address_of(made: Any) -> int:
    """Where machine code is."""
    return made.library.get_pointer_to_function(made.fndesc.llvm_func_name)


# -- a chain ---------------------------------------------------------------------------------------------


class Step(NamedTuple):
    """A function with its first arguments in a chain: the machine code that goes into it, and its block."""

    entry: int
    block: "Block"


class Link(NamedTuple):
    """A step; `tell` is given what it has returned when that is not 0 or nothing, or what it has raised, and what the chain was given."""

    step: Step
    tell: Callable[..., None]


def step(function: Any, *arguments: Any, takes: tuple[str, ...] = ()) -> Step:
    """A compiled function that is given, behind its arguments, what it takes of "k" and "time", the two numbers of a chain."""
    block, _ = laid(function, arguments, tuple(NUMBERS[name] for name in takes))
    return Step(address_of(compiled_for(ENTRIES[takes], (block.kind, types.int64, types.float64))), block)


class Chain:
    """Links in a row: a function of tick k, a time [s] and what is handed to `tell` besides."""

    def __init__(self, links: Sequence[Link]) -> None:
        self.links = links
        self.at = np.zeros(1, np.int64)  # the link that had something to tell
        self.run = bound(go, np.array([each.step for each in links], np.int64).reshape(-1, 2), self.at, then=(0, 0, 0.0))

    def __call__(self, k: int, time: float, *told: Any) -> None:
        """All of them; who tells something is heard before the next one."""
        first = 0
        while first < len(self.links):
            try:
                found = self.run(first, k, time)
            except (Exception, SystemExit) as error:
                self.heard(error, told)
            else:
                if not found:
                    return
                self.heard(found, told)
            first = int(self.at[0]) + 1

    def heard(self, what: Any, told: tuple) -> None:
        """Hands on what the last link has to tell."""
        self.links[int(self.at[0])].tell(what, *told)


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


@intrinsic
def number(typing_context, value):
    """What a function has returned as a whole number; 0 for nothing."""

    def generate(context, builder, signature, arguments):
        if value == types.none:
            return context.get_constant(types.int64, 0)
        return context.cast(builder, arguments[0], value, types.int64)

    return types.int64(value), generate


@intrinsic
def entered(typing_context, entry, block, k, time):
    """Goes into a step."""
    kinds = [types.int64, types.int64, types.float64]

    def generate(context, builder, signature, arguments):
        function = builder.inttoptr(arguments[0], context.call_conv.get_function_type(types.int64, kinds).as_pointer())
        status, result = context.call_conv.call_function(builder, function, types.int64, kinds, arguments[1:])
        with cgutils.if_unlikely(builder, status.is_error):
            context.call_conv.return_status_propagate(builder, status)
        return result

    return types.int64(types.int64, *kinds), generate


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


@compiled
def call_with_three(block, a, b, c):
    """Three numbers follow."""
    return through(block, (a, b, c))


@compiled
def enter(block, k, time):
    """A step that takes nothing."""
    return number(through(block, ()))


@compiled
def enter_at_tick(block, k, time):
    """A step that takes the tick."""
    return number(through(block, (k,)))


@compiled
def enter_at_time(block, k, time):
    """A step that takes the time."""
    return number(through(block, (time,)))


@compiled
def enter_at_both(block, k, time):
    """A step that takes both."""
    return number(through(block, (k, time)))


@compiled
def go(steps, at, first, k, time):
    """Steps from one on, until one has something to tell, which is returned; it is number at[0]."""
    for i in range(first, steps.shape[0]):
        at[0] = i
        found = entered(steps[i, 0], steps[i, 1], k, time)
        if found != 0:
            return found
    return 0


CALLS: tuple[Any, ...] = (call, call_with_one, call_with_two, call_with_three)
NUMBERS = {"k": 0, "time": 0.0}
ENTRIES: dict[tuple[str, ...], Any] = {(): enter, ("k",): enter_at_tick, ("time",): enter_at_time, ("k", "time"): enter_at_both}
