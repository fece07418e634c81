"""Steps of a patch done in the text: one value's span is replaced, an entry's lines come or go, all else stays as it is.

    spliced(source, step)  →  the source after it, and the operations that take it back to the letter

Nothing here is believed. The text after an edit is read again and must hold what `patch.stepped` makes of the plain data,
and its inverse must give the text before. Where an edit fails this (an anchor that aliases name, the last entry of a block,
two entries on one line), the aliases are written out first, or the part around the value is written anew; in the end that
is the whole text. So a layout of a stranger's inverse can only change how a value is written, never what is read.
"""

import json
import re
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import yaml

from studio.errors import ScenarioError
from studio.scenario.text import pointer, source
from studio.scenario.text.patch import Layout, Operation, anchor, operation, stepped
from studio.scenario.text.source import MERGE, Node, Source, same

WIDTH = 110  # characters of a line that is written anew
INDENT = 2


class Edit(NamedTuple):
    """A span of the text and what takes its place."""

    start: int
    end: int
    new: str

    def done(self, text: str) -> str:
        """The text after it."""
        return text[: self.start] + self.new + text[self.end :]


Spliced = tuple[Source, list[Operation]]


def spliced(before: Source, step: Operation) -> Spliced:
    """The source after a step that fits, and the operations that undo it, in their order."""
    return direct(before, step) or alone(before, step) or wider(before, step)


def direct(before: Source, step: Operation) -> Spliced | None:
    """The first edit that does the step and can be undone; None when there is none."""
    wanted = stepped(before.value, step)
    for edit in edits(before, step):
        after = read(edit.done(before.text), before.where)
        if after and same(after.value, wanted):
            back = inverse(before, step, edit)
            if any(each.done(after.text) == before.text for each in edits(after, back)):
                return after, [back]
    return None


def alone(before: Source, step: Operation) -> Spliced | None:
    """The same after all aliases are written out that share something with the place; None when that does not help."""
    now, back = before, []
    for path in shared(before, step.parts):
        if (made := direct(now, operation("replace", path, value=pointer.get(now.value, path)))) is None:
            return None
        now, back = made[0], made[1] + back
    made = direct(now, step) if back else None
    return made and (made[0], made[1] + back)


def wider(before: Source, step: Operation) -> Spliced:
    """The same by writing the part around the place anew."""
    if not step.parts:
        raise ScenarioError(f"{before.where} cannot be written.", [pointer.misfit("", "holds what no YAML can say").problems[0]])
    around = step.parts[:-1]
    value = pointer.get(stepped(before.value, step), around)
    return spliced(before, operation("replace", around, value=value))


def read(text: str, where: str) -> Source | None:
    """A text that was edited; None when it is no YAML any more."""
    try:
        return source.read(text, where)
    except ScenarioError:
        return None


def shared(given: Source, path: Sequence[str]) -> list[tuple[str, ...]]:
    """Places of aliases on the way to a path, and of those whose anchor lies on the way to it, at it or below it."""
    anchors, found = {}, []
    for place, node in walk(given.root, ()):
        if node.anchor:
            anchors[node.anchor] = place
        if node.alias and node.alias != MERGE and (on_way(place, path) or related(anchors.get(node.alias, ()), path)):
            found.append(place)
    return found


def walk(node: Node, place: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Node]]:
    """All nodes that stand in the text, in its order."""
    yield place, node
    if node.alias or node.children is None:
        return
    for key, child in node.children.items() if isinstance(node.children, dict) else enumerate(node.children):
        yield from walk(child, (*place, str(key)))


def on_way(place: Sequence[str], path: Sequence[str]) -> bool:
    """Whether a path leads to or through a place."""
    return tuple(path[: len(place)]) == tuple(place)


def related(place: Sequence[str], path: Sequence[str]) -> bool:
    """Whether one of two places lies within the other."""
    return on_way(place, path) or on_way(path, place)


def renamed(before: Source, away: Operation, new: Operation) -> Operation:
    """The add of a move: an entry that only gets another key keeps its place, its comments and the way it is written."""
    node, span = before.find(away.parts), removed(before, away)
    if new.op != "add" or new.parts[:-1] != away.parts[:-1] or span is None or not node or not node.key:
        return new
    (start, end), (first, last) = span, node.key
    written_anew = before.text[start:first] + written(new.parts[-1], flow=True) + before.text[last:end]
    place = neighbour(before, away.parts, Edit(start, end, ""))
    return new.model_copy(update={"layout": Layout(source=written_anew, **place)})


# -- edits: where, and what -------------------------------------------------------------------------


def edits(given: Source, step: Operation) -> Iterator[Edit]:
    """Ways to do a step in the text, the best first; none when the place has no span of its own."""
    span = SPANS[step.op](given, step)
    if span is None:
        return
    for new in [""] if step.op == "remove" else texts(given, step):
        yield Edit(*span, new)


def inverse(before: Source, step: Operation, edit: Edit) -> Operation:
    """The operation that undoes an edit."""
    if step.op == "add":
        return operation("remove", step.parts)
    layout = {"source": before.text[edit.start : edit.end]}
    if step.op == "remove":
        layout |= neighbour(before, step.parts, edit)
    value = pointer.get(before.value, step.parts)
    op = "add" if step.op == "remove" else "replace"
    return operation(op, step.parts, value=value, layout=Layout(**layout))


def neighbour(before: Source, path: Sequence[str], edit: Edit) -> dict[str, Any]:
    """The key before an entry, and the lines between them; of a first entry those to the next."""
    parent, index, entries = family(before, path)
    after = list(parent.children)[index - 1] if isinstance(parent.children, dict) and index else None
    if parent.flow:
        return {"after": after, "lines": 0}
    if index:
        return {"after": after, "lines": before.text.count("\n", line_end(before.text, entries[index - 1].end), edit.start)}
    return {"after": None, "lines": before.text.count("\n", edit.end, line_start(before.text, head(before.text, entries[1])))}


def family(given: Source, path: Sequence[str]) -> tuple[Node, int, list[Node]]:
    """The parent of a node that is there, its index among the entries, and these."""
    parent = parent_of(given, path)
    index = list(parent.children).index(path[-1]) if isinstance(parent.children, dict) else int(path[-1])
    return parent, index, parent.entries


def parent_of(given: Source, path: Sequence[str]) -> Node:
    """The collection that a step changes: a step that fits has one."""
    parent = given.find(path[:-1])
    assert parent is not None
    return parent


def has_text(parent: Node) -> bool:
    """Whether all entries of a collection stand in it, and not at an anchor or in what it merges."""
    if parent.alias or parent.children is None:
        return False
    return isinstance(parent.children, list) or all(child.key for child in parent.children.values())


def replaced(given: Source, step: Operation) -> tuple[int, int] | None:
    """Span of a value: behind the colon of its key, or from its first character on."""
    if not step.parts:
        return 0, len(given.text)
    node = given.find(step.parts)
    if node is None or not has_text(parent_of(given, step.parts)):
        return None
    if node.key:
        colon = re.compile(r"\s*:").match(given.text, node.key[1])
        return colon and (colon.end(), max(colon.end(), node.end))
    return (node.start, node.end) if node.end > node.start else None


def removed(given: Source, step: Operation) -> tuple[int, int] | None:
    """Span of an entry: of a block its lines and the comments right above, else up to the entry before or behind it."""
    parent = parent_of(given, step.parts)
    if not has_text(parent):
        return None
    _, index, entries = family(given, step.parts)
    before, node = (entries[index - 1] if index else None), entries[index]
    if parent.flow:
        if before:
            return before.end, node.end
        return head(given.text, node), head(given.text, entries[1]) if len(entries) > 1 else node.end
    if len(entries) == 1 or not begins_line(given.text, head(given.text, node)):
        return None
    end = line_end(given.text, node.end)
    if before is None:
        return line_start(given.text, head(given.text, node)), end + 1
    bound = line_end(given.text, before.end)
    return with_blank(given.text, with_comments(given.text, head(given.text, node), bound), end, bound), end


def added(given: Source, step: Operation) -> tuple[int, int] | None:
    """Where a new entry goes."""
    parent = parent_of(given, step.parts)
    if not has_text(parent):
        return None
    before, entries = predecessor(parent, step)
    if parent.flow:
        opened = given.text.index("{" if isinstance(parent.children, dict) else "[", parent.start) + 1
        place = before.end if before else head(given.text, entries[0]) if entries else opened
        return place, place
    lines = step.layout.lines if step.layout else 0
    if before:
        place = line_end(given.text, before.end)
        for _ in range(lines):
            place = line_end(given.text, place + 1)
        return place, place
    first = head(given.text, entries[0])
    place = line_start(given.text, first)
    for _ in range(lines):
        place = line_start(given.text, max(place - 1, 0))
    return (place, place) if begins_line(given.text, first) else None


SPANS = {"replace": replaced, "remove": removed, "add": added}


def predecessor(parent: Node, step: Operation) -> tuple[Node | None, list[Node]]:
    """The entry that a new one stands behind, and all entries."""
    if isinstance(parent.children, dict):
        key = anchor(parent.children, step)
        return (None if key is None else parent.children[key]), parent.entries
    index = int(step.parts[-1])
    return (parent.entries[index - 1] if index else None), parent.entries


def head(text: str, node: Node) -> int:
    """Where an entry begins: at its key, in a block's list at its dash."""
    if node.key:
        return node.key[0]
    dashed = text[: node.start].rstrip(" ")
    return len(dashed) - 1 if dashed.endswith("-") else node.start


def line_start(text: str, place: int) -> int:
    """Index of the first character of a line."""
    return text.rfind("\n", 0, place) + 1


def line_end(text: str, place: int) -> int:
    """Index of the line break at the end of a line, or of the end of the text."""
    found = text.find("\n", place)
    return len(text) if found < 0 else found


def begins_line(text: str, place: int) -> bool:
    """Whether there is only space before a place in its line."""
    return not text[line_start(text, place) : place].strip(" ")


def with_comments(text: str, place: int, bound: int) -> int:
    """Index of the line break before an entry and the comments right above it that are indented like it, not above `bound`."""
    start = line_start(text, place)
    mark = " " * (place - start) + "#"
    while (above := line_start(text, max(start - 1, 0))) > bound and text.startswith(mark, above):
        start = above
    return start - 1


def with_blank(text: str, start: int, end: int, bound: int) -> int:
    """The same with the blank line above, when another one follows: two would be left."""
    above = line_start(text, start)
    alone = above > bound and not text[above:start].strip() and not text[end : line_end(text, end + 1)].strip()
    return above - 1 if alone else start


# -- what is written anew ---------------------------------------------------------------------------


class Writer(getattr(yaml, "CSafeDumper", yaml.SafeDumper)):
    """YAML that both its versions read alike, without anchors."""

    def ignore_aliases(self, data: Any) -> bool:
        """What stands in two places is written twice."""
        return True


def text_of(writer: Writer, value: str) -> yaml.Node:
    """A text of several lines as a block where it can be."""
    return writer.represent_scalar("tag:yaml.org,2002:str", value, style="|" if "\n" in value else None)


Writer.add_representer(str, text_of)
Writer.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"[-+.0-9]+([eE][-+]?[0-9]+)?$|0o[0-7]+$"), list("-+.0123456789"))


def texts(given: Source, step: Operation) -> Iterator[str]:
    """Ways to write what a step brings: as its layout says, as people write it, as JSON."""
    if step.layout:
        yield step.layout.source
    for value in forms(given, step):
        yield placed(given, step, value)


def forms(given: Source, step: Operation) -> Iterator[str]:
    """The value as YAML with lines from column 0 on, then as JSON."""
    parent, old = parent_of(given, step.parts), given.find(step.parts)
    if not step.parts:
        yield written(step.value, flow=None)
    elif parent.flow or (old and old.flow):
        yield written(step.value, flow=True)
    else:
        yield written(step.value, flow=False if old and old.children else None)
    yield json.dumps(step.value, ensure_ascii=False)
    yield json.dumps(step.value)


def written(value: Any, *, flow: bool | None) -> str:
    """A value as YAML; `flow` None sets what holds single values in a line of its own."""
    width = 10**9 if flow else WIDTH
    text = yaml.dump(value, Dumper=Writer, default_flow_style=flow, allow_unicode=True, sort_keys=False, width=width)
    return text.removesuffix("...\n").removesuffix("\n")


def placed(given: Source, step: Operation, value: str) -> str:
    """A value's text as it goes into the span of a step."""
    if not step.parts:
        return value + "\n"
    parent = parent_of(given, step.parts)
    key = f"{written(step.parts[-1], flow=True)}:" if isinstance(parent.children, dict) else "-"
    if parent.flow:
        return in_line(parent, step, key, value)
    column = column_of(given, parent)
    nested = hanging(value, isinstance(step.value, (dict, list)), column, key)
    if step.op == "replace":
        return as_lines(given, nested if key != "-" else nested.lstrip(" "))
    entry = " " * column + key + nested
    is_first = predecessor(parent, step)[0] is None
    return as_lines(given, f"{entry}\n") if is_first else "\n" + as_lines(given, entry) + ("\r" if "\r\n" in given.text else "")


def in_line(parent: Node, step: Operation, key: str, value: str) -> str:
    """An entry of a collection in a line, with its comma, or the value alone."""
    if step.op == "replace":
        return value if key == "-" else f" {value}"
    entry = value if key == "-" else f"{key} {value}"
    before, entries = predecessor(parent, step)
    return f", {entry}" if before else f"{entry}, " if entries else entry


def column_of(given: Source, parent: Node) -> int:
    """The column of the entries of a block."""
    place = head(given.text, parent.entries[0])
    return place - line_start(given.text, place)


def hanging(value: str, is_collection: bool, column: int, key: str) -> str:
    """A value behind a key or a dash: its lines below are indented; a block of a mapping begins in a line of its own."""
    is_block = is_collection and value[:1] not in "{["
    deeper = "\n" + " " * (column + INDENT if is_collection else column)  # lines of a text are indented already
    lines = re.sub(r"\n(?=[^\n])", deeper, value)
    return deeper + lines if is_block and key != "-" else f" {lines}"


def as_lines(given: Source, text: str) -> str:
    """Text with the line breaks of the file."""
    return text.replace("\n", "\r\n") if "\r\n" in given.text else text
