"""Scopes: which names of a text nobody has given, found by reading alone.

unknown(module)   →  the places where such names are read

A name is known in the scope that gives it and in the functions within; those that a class gives are known in its body only. With
`from x import *` nothing can be said.
"""

import ast
import builtins
from collections.abc import Iterator

KNOWN = frozenset({*dir(builtins), "__name__", "__file__", "__doc__", "__package__", "__spec__", "__class__", "__annotations__"})
SCOPES = (
    ast.FunctionDef,
    ast.AsyncFunctionDef,
    ast.Lambda,
    ast.ClassDef,
    ast.ListComp,
    ast.SetComp,
    ast.DictComp,
    ast.GeneratorExp,
)


def unknown(module: ast.Module) -> list[ast.Name]:
    """The places where names are read that nobody has given."""
    starred = any(alias.name == "*" for each in ast.walk(module) if isinstance(each, ast.ImportFrom) for alias in each.names)
    return [] if starred else list(below(module, KNOWN | everywhere(module)))


def everywhere(module: ast.Module) -> frozenset[str]:
    """Names that functions give to the whole file."""
    return frozenset(name for each in ast.walk(module) if isinstance(each, ast.Global) for name in each.names)


def below(scope: ast.AST, known: frozenset[str]) -> Iterator[ast.Name]:
    """In a scope and those within it."""
    own = known | frozenset(given(scope))
    handed_on = known if isinstance(scope, ast.ClassDef) else own
    for each in inside(scope):
        if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Load) and each.id not in own:
            yield each
        elif isinstance(each, SCOPES):
            # what stands at the head of a function is read where the function stands
            yield from (name for outer in head(each) for name in read(outer, own))
            yield from below(each, handed_on)


def read(node: ast.AST, known: frozenset[str]) -> Iterator[ast.Name]:
    """Unknown names of an expression."""
    if isinstance(node, ast.Name) and node.id not in known:
        yield node
    for each in ast.iter_child_nodes(node):
        yield from below(each, known) if isinstance(each, SCOPES) else read(each, known)


def head(scope: ast.AST) -> list[ast.AST]:
    """Decorators, defaults, annotations and bases."""
    found: list[ast.AST | None] = [*getattr(scope, "decorator_list", ()), *getattr(scope, "bases", ())]
    found += [each.value for each in getattr(scope, "keywords", ())]
    if isinstance(scope, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
        arguments = scope.args
        every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
        found += [*arguments.defaults, *arguments.kw_defaults, getattr(scope, "returns", None)]
        found += [each.annotation for each in every if each]
    return [each for each in found if each is not None]


def body(scope: ast.AST) -> list[ast.AST]:
    """What belongs to a scope itself."""
    if isinstance(scope, ast.Lambda):
        return [scope.body]
    if isinstance(scope, ast.Module | ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return list(scope.body)
    return list(ast.iter_child_nodes(scope))


def inside(scope: ast.AST) -> Iterator[ast.AST]:
    """Every node of a scope, down to where others begin."""
    ahead = body(scope)
    while ahead:
        each = ahead.pop(0)
        yield each
        if not isinstance(each, SCOPES):
            ahead += ast.iter_child_nodes(each)


def given(scope: ast.AST) -> Iterator[str]:
    """The names that a scope gives."""
    if isinstance(scope, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
        yield from (each.arg for each in ast.walk(scope.args) if isinstance(each, ast.arg))
    for each in inside(scope):
        if isinstance(each, ast.Name) and not isinstance(each.ctx, ast.Load):
            yield each.id
        elif isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield each.name
        elif isinstance(each, ast.alias):
            yield each.asname or each.name.partition(".")[0]
        elif isinstance(each, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and each.name:
            yield each.name
        elif isinstance(each, ast.MatchMapping) and each.rest:
            yield each.rest
        elif isinstance(each, SCOPES):  # `:=` in a comprehension gives to who is around it
            yield from (name.target.id for name in ast.walk(each) if isinstance(name, ast.NamedExpr) and isinstance(name.target, ast.Name))
