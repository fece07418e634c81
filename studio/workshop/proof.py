"""Proofs: what can be said about the text of an application without running it.

proof(text)   →  Slip(line, column, what, remedy), ...

The text is parsed and nothing more: whatever it would do, it does not do it here. Found are errors of syntax, names that nobody has given,
parts of the contract that are missing, ports of sensors and messages that do not exist, fields that the contract, the settings or the
memory do not have, wrong arguments, and settings whose unit or range cannot be right. What a text makes of values at run time stays
unknown, and nothing is said about it.
"""

import ast
import builtins
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from studio.application.port import DONE, MOST, SEEN
from studio.errors import nearest
from studio.kind.sort import SORTS
from studio.workshop.scope import unknown
from studio.workshop.vocabulary import KIND_OF, Word, functions, names, ports
from studio.workshop.wording import unit_slip

CONTRACT = "studio.application.contract"
LONGEST = 400_000  # letters


class Slip(NamedTuple):
    """What is wrong: in which line and column, from 1 on, what, and the remedy."""

    line: int
    column: int
    what: str
    remedy: str = ""


def at(node: ast.AST, what: str, remedy: str = "") -> Slip:
    """A slip at a node."""
    return Slip(getattr(node, "lineno", 1), getattr(node, "col_offset", 0) + 1, what, remedy)


def proof(text: str) -> list[Slip]:
    """Everything that is found wrong, in the order of the lines."""
    try:
        module = ast.parse(text)
        found = set(read(module))
    except SyntaxError as error:
        return [Slip(error.lineno or 1, error.offset or 1, error.msg)]
    except (ValueError, RecursionError, MemoryError) as error:
        return [Slip(1, 1, str(error) or type(error).__name__)]
    return sorted(found)


def read(module: ast.Module) -> Iterator[Slip]:
    """Everything about a text that Python can read."""
    for name in unknown(module):
        yield at(name, f"the name {name.id} is not known here", nearest(name.id, {*names(), *dir(builtins)}))
    yield from imported(module)
    classes = {each.name: each for each in module.body if isinstance(each, ast.ClassDef)}
    yield from parts(module)
    yield from settings(classes.get("Parameters"))
    for bundle, types in (("Sees", [each.__name__ for each in SEEN]), ("Does", [each.__name__ for each in DONE])):
        yield from bundled(classes, bundle, types)
    for function in module.body:
        if isinstance(function, ast.FunctionDef) and function.name == "decide":
            yield from Reader(classes, function).slips()


def imported(module: ast.Module) -> Iterator[Slip]:
    """Names that are taken from the contract, which does not have them."""
    for each in ast.walk(module):
        if isinstance(each, ast.ImportFrom) and each.module == CONTRACT:
            for alias in each.names:
                if alias.name not in (*names(), "*"):
                    yield at(alias, f"the contract has no {alias.name}", nearest(alias.name, names()))


# -- the parts of the file -----------------------------------------------------------------------------


def parts(module: ast.Module) -> Iterator[Slip]:
    """Parts that are missing, and functions that are called with other arguments."""
    given = set(defined(module.body))
    if not ast.get_docstring(module):
        yield Slip(1, 1, "the file has no docstring", "say in its first lines what it does and where its figures come from")
    for need in SORTS["application"].needs:
        if not need.optional and need.name not in given:
            yield Slip(1, 1, f"{need.name} is missing: {need.meaning}", f"write {need.example}")
    for each in module.body:
        if sort := another_sort(each):
            yield at(each, f"KIND says {sort!r}, and this is written as an application", 'write KIND = "application"')
        if isinstance(each, ast.FunctionDef) and each.name == "decide" and len(each.args.args) != 3:
            yield at(each, "decide is called with (parameters, memory, sees)", "give it these three arguments")


def another_sort(node: ast.stmt) -> object:
    """The sort that it says the kind is of, where it says one and not an application."""
    says = isinstance(node, ast.Assign) and any(isinstance(each, ast.Name) and each.id == "KIND" for each in node.targets)
    value = node.value if says and isinstance(node, ast.Assign) else None
    return value.value if isinstance(value, ast.Constant) and value.value != "application" else None


def defined(body: Iterable[ast.stmt]) -> Iterator[str]:
    """The names that statements give."""
    for each in body:
        if isinstance(each, ast.FunctionDef | ast.ClassDef):
            yield each.name
        elif isinstance(each, ast.Assign | ast.AnnAssign):
            targets = each.targets if isinstance(each, ast.Assign) else [each.target]
            yield from (name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name))
        elif isinstance(each, ast.ImportFrom | ast.Import):
            yield from (alias.asname or alias.name for alias in each.names)


def annotated(of: ast.ClassDef | None) -> dict[str, ast.AnnAssign]:
    """The fields of a class."""
    body = of.body if of else []
    return {each.target.id: each for each in body if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)}


def settings(of: ast.ClassDef | None) -> Iterator[Slip]:
    """Settings without unit, and first values out of their range."""
    for name, each in annotated(of).items():
        call = each.value if isinstance(each.value, ast.Call) and called(each.value) == "number" else None
        if call:
            yield from numbered(name, call)
        elif ast.unparse(each.annotation) == "float" and isinstance(each.value, ast.Constant | None):
            yield at(each, f"{name} is a number without unit", f'write {name}: float = number(1.0, unit="m", title="...")')


def numbered(name: str, call: ast.Call) -> Iterator[Slip]:
    """One call of number()."""
    said = {each.arg: each.value for each in call.keywords if each.arg}
    for wanted in ("unit", "title"):
        if wanted not in said:
            yield at(call, f"{name} has no {wanted}", f'write {wanted}="..." into number(...)')
    unit = said.get("unit")
    if isinstance(unit, ast.Constant) and (what := unit_slip(str(unit.value))):
        yield at(unit, f"{name}: {what[0]}", what[1])
    first, low, high = (constant(each) for each in (call.args[0] if call.args else None, said.get("ge"), said.get("le")))
    if first is not None and ((low is not None and first < low) or (high is not None and first > high)):
        yield at(call, f"the first value {first:g} of {name} is out of its own range", "mend the value, or ge and le")
    for keyword in call.keywords:
        if keyword.arg and keyword.arg not in KEYWORDS:
            yield at(keyword, f"number() takes no {keyword.arg}", nearest(keyword.arg, KEYWORDS))


KEYWORDS = ("default", "unit", "title", "description", "ge", "gt", "le", "lt", "multiple_of", "examples", "min_length", "max_length")


def constant(node: ast.expr | None) -> float | None:
    """A number that stands there, also a negative one."""
    try:
        value = ast.literal_eval(node) if node is not None else None
    except (ValueError, TypeError, SyntaxError):
        return None
    return float(value) if isinstance(value, int | float) else None


def called(call: ast.Call) -> str:
    """What is called, by its last name."""
    return call.func.id if isinstance(call.func, ast.Name) else call.func.attr if isinstance(call.func, ast.Attribute) else ""


# -- ports ---------------------------------------------------------------------------------------------


def bundled(classes: dict[str, ast.ClassDef], bundle: str, types: list[str]) -> Iterator[Slip]:
    """The ports of Sees or Does."""
    for name, each in annotated(classes.get(bundle)).items():
        kind, notes = hinted(each.annotation)
        if bundle == "Does" and kind in classes:
            yield from logged(classes[kind])
        elif kind not in types:
            allowed = ", ".join(types) + (", or a NamedTuple of values to be recorded" if bundle == "Does" else "")
            yield at(each.annotation, f"{name} is {kind}, which is no port of {bundle}", f"allowed: {allowed}")
        elif sort := KIND_OF.get(kind):
            yield from about(name, each.annotation, kind, notes, sort)


def about(name: str, node: ast.expr, kind: str, notes: list[ast.expr], sort: str) -> Iterator[Slip]:
    """Which sensor or message a port is about, and how many of it."""
    said = [each.value if isinstance(each, ast.Constant) else None for each in notes]
    if len(said) != 2 or not isinstance(said[0], str):
        yield at(node, f"{name} does not say which {sort} and how many", f'write {name}: Annotated[{kind}, "name of the {sort}", 4]')
        return
    known = {each.kind for each in ports() if each.type == kind}
    if said[0] not in known:
        yield at(notes[0], f"there is no {sort} {said[0]!r}", nearest(said[0], known))
    if said[1] is not None and (not isinstance(said[1], int) or not 1 <= said[1] <= MOST):
        yield at(notes[1], f"{name} has {said[1]} places; allowed: 1 to {MOST}")


def logged(of: ast.ClassDef) -> Iterator[Slip]:
    """Values to be recorded have units and first values."""
    for name, each in annotated(of).items():
        _, notes = hinted(each.annotation)
        if not notes and ast.unparse(each.annotation) != "bool":
            yield at(each, f"{name} has no unit", f'write {name}: Annotated[float, "m"] = 0.0')
        elif notes and isinstance(notes[0], ast.Constant) and (what := unit_slip(str(notes[0].value))):
            yield at(notes[0], f"{name}: {what[0]}", what[1])
        if each.value is None:
            yield at(each, f"{name} has no first value", f"write {name}: ... = 0.0")


def hinted(annotation: ast.expr) -> tuple[str, list[ast.expr]]:
    """The type in an annotation, and its notes."""
    if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value).endswith("Annotated"):
        inner = annotation.slice.elts if isinstance(annotation.slice, ast.Tuple) else [annotation.slice]
        return ast.unparse(inner[0]), inner[1:]
    return ast.unparse(annotation), []


# -- decide --------------------------------------------------------------------------------------------


class Thing(NamedTuple):
    """What a name stands for: how people call it, its fields, and of a row how many it has; its own class says of what."""

    called: str
    fields: dict[str, "Thing"] | None = None
    row: "Thing | None" = None
    most: int = 0


class Reader:
    """Follows the names in `decide`, as far as they stand for what the contract, the settings or the memory have."""

    def __init__(self, classes: dict[str, ast.ClassDef], decide: ast.FunctionDef) -> None:
        self.classes, self.decide = classes, decide
        self.calls = {each.name: each for each in functions() if each.name != "number"}
        arguments = [each.arg for each in decide.args.args]
        self.known: dict[str, Thing] = dict(zip(arguments, self.given(), strict=False))
        for name, value in assigned(decide):
            self.known[name] = (self.thing(value) if name not in self.known else None) or Thing(name)

    def given(self) -> list[Thing]:
        """What decide is called with."""
        sees = {name: self.port(name, each.annotation) for name, each in annotated(self.classes.get("Sees")).items()}
        return [self.plain("Parameters", "Parameters"), self.plain("Memory", "Memory"), Thing("Sees", sees)]

    def plain(self, name: str, told: str) -> Thing:
        """A class of the text with its fields; whose class it is not may have others."""
        of = self.classes.get(name)
        bases = {ast.unparse(each).rpartition(".")[2] for each in of.bases} if of else set()
        if not of or not bases <= {"NamedTuple", "Part", "BaseModel"}:
            return Thing(told)
        methods = {each.name: Thing(each.name) for each in of.body if isinstance(each, ast.FunctionDef)}
        return Thing(told, {field: Thing(field) for field in annotated(of)} | methods)

    def port(self, name: str, annotation: ast.expr) -> Thing:
        """A port with the fields of its kind."""
        kind, notes = hinted(annotation)
        about = str(notes[0].value) if notes and isinstance(notes[0], ast.Constant) else ""
        most = notes[1].value if len(notes) > 1 and isinstance(notes[1], ast.Constant) else 0
        found = next((each for each in ports() if each.type == kind and each.kind == about), None)
        return thing(name, found.words, most if isinstance(most, int) else 0) if found else Thing(name)

    def slips(self) -> Iterator[Slip]:
        """What is wrong in it."""
        for node in ast.walk(self.decide):
            if isinstance(node, ast.Attribute):
                yield from self.attribute(node)
            elif isinstance(node, ast.Subscript):
                yield from self.subscript(node)
            elif isinstance(node, ast.Call):
                yield from self.call(node)

    def attribute(self, node: ast.Attribute) -> Iterator[Slip]:
        """A field that is not there."""
        of = self.thing(node.value)
        if of and of.fields is not None and node.attr not in of.fields and node.attr not in ("_replace", "_asdict", "_fields"):
            place = ast.Constant(0, lineno=node.end_lineno or node.lineno, col_offset=(node.end_col_offset or 0) - len(node.attr))
            yield at(place, f"{of.called} has no {node.attr}", nearest(node.attr, of.fields))

    def subscript(self, node: ast.Subscript) -> Iterator[Slip]:
        """A place in a row that has fewer."""
        of, number = self.thing(node.value), constant(node.slice)
        if of and of.row and of.most and number is not None and not -of.most <= number < of.most:
            yield at(node.slice, f"{of.called} has {of.most} places: [0] to [{of.most - 1}]", "ask for more in the annotation of the port")

    def call(self, node: ast.Call) -> Iterator[Slip]:
        """Too many or too few arguments, and such as do not exist."""
        if any(isinstance(each, ast.Starred) for each in node.args) or any(each.arg is None for each in node.keywords):
            return
        name = called(node)
        if name in self.calls and isinstance(node.func, ast.Name) and name not in self.classes:
            yield from told(node, name, self.calls[name].arguments, len(self.calls[name].arguments))
        elif name in self.classes and isinstance(node.func, ast.Name) and name != "Parameters":
            fields = annotated(self.classes[name])
            if self.plain(name, name).fields is not None:
                yield from told(node, name, tuple(fields), sum(each.value is None for each in fields.values()))

    def thing(self, node: ast.expr) -> Thing | None:
        """What an expression stands for; None when nobody knows."""
        if isinstance(node, ast.Name):
            return self.known.get(node.id)
        if isinstance(node, ast.Attribute):
            of = self.thing(node.value)
            return of.fields.get(node.attr) if of and of.fields else None
        if isinstance(node, ast.Subscript):
            of = self.thing(node.value)
            return of.row if of else None
        return None


def thing(name: str, words: tuple[Word, ...], most: int) -> Thing:
    """A thing of the vocabulary."""
    return Thing(name, {each.name: row(each, most) if each.is_row else inner(each) for each in words})


def row(word: Word, most: int) -> Thing:
    """A row of such."""
    return Thing(word.name, row=inner(word), most=most)


def inner(word: Word) -> Thing:
    """One of them."""
    return Thing(word.name, {each.name: row(each, 0) if each.is_row else inner(each) for each in word.words} if word.words else None)


def told(node: ast.Call, name: str, allowed: tuple[str, ...], least: int) -> Iterator[Slip]:
    """The arguments of a call, of those that are allowed."""
    given = len(node.args) + len(node.keywords)
    for keyword in node.keywords:
        if keyword.arg not in allowed:
            yield at(keyword, f"{name} has no {keyword.arg}", nearest(str(keyword.arg), allowed))
    if not least <= given <= len(allowed):
        yield at(
            node, f"{name}({', '.join(allowed)}) is given {given} of {len(allowed)}", "give every field: compiled code knows no defaults"
        )


def assigned(function: ast.FunctionDef) -> Iterator[tuple[str, ast.expr]]:
    """Names that a function gives, with what stands for them; one that is given in another way stands for itself."""
    for each in ast.walk(function):
        if isinstance(each, ast.Assign):
            for target in each.targets:
                yield from paired(target, each.value)
    plain = {
        id(name) for each in ast.walk(function) if isinstance(each, ast.Assign) for target in each.targets for name in ast.walk(target)
    }
    for each in ast.walk(function):
        if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store) and id(each) not in plain:
            yield each.id, ast.Constant(0)


def paired(target: ast.expr, value: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    """Targets with their values."""
    if isinstance(target, ast.Name):
        yield target.id, value
    elif isinstance(target, ast.Tuple | ast.List):
        values = (
            value.elts if isinstance(value, ast.Tuple) and len(value.elts) == len(target.elts) else [ast.Constant(0)] * len(target.elts)
        )
        for inner_target, inner_value in zip(target.elts, values, strict=True):
            yield from paired(inner_target, inner_value)
