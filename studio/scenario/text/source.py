"""YAML as text with places: what stands in a file, and where each value of it stands.

    read(text, "my.yaml")  →  Source        .value   plain data: mappings, lists, texts, numbers, true, false, null
                                            .root    the same as nodes, each with its span in the text

The text is kept and never written anew: comments, order, anchors, line breaks and the way numbers are written stay as
they are, because an edit (scenario/text/splice.py) replaces the span of one value and nothing else. A library's round trip
through a tree rewrites some 140 lines of each vehicle file of the catalogue. Syntax is PyYAML's part, its events have
the spans; what a plain scalar means is that of YAML 1.2 (core schema, 10.3.2), as in JSON. Where YAML 1.1 reads another
value (`on`, `012`, `1_000`, `12:30`, `2026-01-01`) nobody can know what was meant: it is refused with both ways to write it.

Limits hold before anything is laid out: aliases share nodes, so 500 bytes of nested aliases cost no more than 500 bytes.
"""

import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Protocol

import yaml

from studio.errors import Problem, ScenarioError

MOST_NODES = 100_000  # values in a file, those that aliases repeat counted each time
DEEPEST = 64  # levels of a file; the schema has 8
LONGEST_NUMBER = 400  # characters; a double ends at 1e308
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # the same events; libyaml is fifty times faster

WORDS = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}
NUMBERS = (
    (re.compile(r"[-+]?(0|[1-9][0-9]*)"), int),
    (re.compile(r"0o[0-7]+"), partial(int, base=0)),
    (re.compile(r"0x[0-9a-fA-F]+"), partial(int, base=0)),
    (re.compile(r"[-+]?(\.[0-9]+|(0|[1-9][0-9]*)(\.[0-9]*)?)([eE][-+]?[0-9]+)?"), float),
)
# What YAML 1.1 (yaml.org/type) takes for a boolean, a number or a date, and YAML 1.2 for a text or for another number.
TWOFOLD = re.compile(
    r"(?i:yes|no|on|off)|[-+]?0[0-9_]+(\.[0-9_]*)?|[-+]?0b[01_]+|[-+]0x[0-9a-fA-F_]+|0x[0-9a-fA-F]*_[0-9a-fA-F_]*"
    r"|[-+]?[0-9]+_[0-9_]*(\.[0-9_]*)?|[-+]?[1-9][0-9_]*(:[0-5]?[0-9])+(\.[0-9_]*)?|[0-9]{4}-[0-9]{1,2}-[0-9]{1,2}([Tt ].*)?"
)
TAG = "tag:yaml.org,2002:"  # written !!
KINDS = {"str": (str,), "int": (int,), "float": (float, int), "bool": (bool,), "null": (type(None),), "map": (dict,), "seq": (list,)}
MERGE = "<<"
Valued = yaml.ScalarEvent | yaml.CollectionStartEvent  # events with a value of their own


@dataclass(slots=True)
class Node:
    """A value in the text: its span, with anchor and tag; line and column where it, or its key, begins, counted from 1.

    children  of a mapping by key, of a list in order, of a scalar None
    key       span of its key; of an entry that a merge (`<<`) brought, and of a list's entry, None
    size      values in it, those that aliases repeat counted each time
    alias     name of the anchor that stands here in its place
    """

    start: int
    end: int
    line: int
    column: int
    scalar: Any = None
    children: dict[str, "Node"] | list["Node"] | None = None
    flow: bool = False
    anchor: str | None = None
    alias: str | None = None
    key: tuple[int, int] | None = None
    size: int = 1

    @property
    def value(self) -> Any:
        """Plain data, aliases laid out."""
        if isinstance(self.children, dict):
            return {key: child.value for key, child in self.children.items()}
        if isinstance(self.children, list):
            return [child.value for child in self.children]
        return self.scalar

    @property
    def entries(self) -> list["Node"]:
        """The nodes in it, in their order."""
        return list(self.children.values()) if isinstance(self.children, dict) else self.children or []

    def child(self, part: str) -> "Node | None":
        """The node under a key, or at an index."""
        if isinstance(self.children, list):
            return self.children[int(part)] if part.isdecimal() and int(part) < len(self.children) else None
        return self.children.get(part) if self.children else None


@dataclass(frozen=True)
class Source:
    """A YAML text that was read; `where` is the name that messages use."""

    text: str
    where: str
    root: Node

    @cached_property
    def value(self) -> Any:
        """Its plain data."""
        return self.root.value

    def find(self, parts: Sequence[str]) -> Node | None:
        """The node at a path."""
        node: Node | None = self.root
        for part in parts:
            node = node.child(part) if node else None
        return node

    def place(self, parts: Sequence[str]) -> tuple[int, int]:
        """Line and column of what stands at a path, or of the innermost part of it that is there."""
        node = self.root
        for part in parts:
            if (inner := node.child(part)) is None:
                break
            node = inner
        return node.line, node.column

    def told(self, path: str) -> str:
        """A dotted path with the place in the file, as messages begin."""
        line, column = self.place(path.split(".") if path else [])
        return f"{self.where}, line {line}, column {column}: {path}"


def decoded(data: bytes, where: str) -> str:
    """The text of a file, line breaks as they are; raises ScenarioError."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        problem = Problem(
            f"{where}, line {line}", "holds a byte that is no UTF-8", f"0x{data[error.start]:02x}", "UTF-8", "save the file as UTF-8"
        )
        raise ScenarioError(f"{where} is not a text file.", [problem]) from None


def read(text: str, where: str) -> Source:
    """The values in a YAML text. Raises ScenarioError with the line: no YAML, a key that stands twice, too much or too deep."""
    try:
        return Source(text, where, Composer(text, where).document())
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        place = f"line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        begun = f", {error.context} that begins in line {error.context_mark.line + 1}" if error.context_mark else ""
        if mark and indented_by_tab(text, mark.line):
            raise not_yaml(where, place, "a line begins with a tab", "indent with spaces") from None
        raise not_yaml(where, place, f"{error.problem}{begun}") from None
    except (yaml.YAMLError, UnicodeError) as error:
        raise not_yaml(where, "", str(error).splitlines()[0]) from None


def indented_by_tab(text: str, line: int) -> bool:
    """Whether a line, counted from 0, is indented by a tab, which YAML does not allow."""
    lines = text.splitlines()
    indent = lines[line][: -len(lines[line].lstrip())] if line < len(lines) else ""
    return "\t" in indent


def not_yaml(where: str, place: str, what: str, remedy: str = "mend the syntax there") -> ScenarioError:
    """A refusal of a text that cannot be read."""
    problem = Problem(f"{where}, {place}" if place else where, what, remedy=remedy)
    return ScenarioError(f"{where} is not YAML.", [problem])


class Mark(Protocol):
    """A place in the text, counted from 0, whichever of the two parsers tells of it."""

    index: int
    line: int
    column: int


def marks(event: yaml.Event) -> tuple[Mark, Mark]:
    """Where an event begins and ends; every event of a text has both."""
    assert event.start_mark and event.end_mark
    return event.start_mark, event.end_mark


class Composer:
    """Nodes from the events of a text."""

    def __init__(self, text: str, where: str) -> None:
        self.text, self.where = text, where
        self.shift = 1 if text.startswith("\ufeff") else 0  # a byte order mark is no character of the events
        self.events: Iterator[yaml.Event] = yaml.parse(text, Loader=LOADER)
        self.anchors: dict[str, Node | None] = {}
        self.nodes = 0

    def document(self) -> Node:
        """The root of the only document; an empty text is null."""
        next(self.events)  # the stream
        event = next(self.events)
        if isinstance(event, yaml.StreamEndEvent):
            return Node(0, 0, 1, 1)
        root = self.node(next(self.events), 0)
        root.line = root.column = 1  # comments before it are part of the document
        next(self.events)  # the document's end
        if not isinstance(event := next(self.events), yaml.StreamEndEvent):
            raise self.refused(event, "a second document begins", remedy="put it into a file of its own")
        return root

    def node(self, event: yaml.Event, level: int) -> Node:
        """A node and all below it."""
        if level > DEEPEST:
            raise self.refused(event, "is nested too deep", allowed=f"{DEEPEST} levels")
        start, end = marks(event)
        node = Node(start.index + self.shift, end.index + self.shift, start.line + 1, start.column + 1)
        self.fill(node, event, level)
        self.nodes += 1
        if max(node.size, self.nodes) > MOST_NODES:
            raise self.refused(event, "holds too many values, aliases laid out", allowed=f"{MOST_NODES} values")
        return node

    def fill(self, node: Node, event: yaml.Event, level: int) -> None:
        """Takes what an event begins."""
        if isinstance(event, yaml.AliasEvent):
            self.repeat(node, event)
            return
        assert isinstance(event, Valued)  # nothing else begins a node
        node.anchor = event.anchor
        if event.anchor:
            self.anchors[event.anchor] = None  # it cannot hold itself
        if isinstance(event, yaml.ScalarEvent):
            node.scalar = self.scalar(event)
            node.end = self.last_character(node, event)
        else:
            self.collection(node, event, level)
        if event.anchor:
            self.anchors[event.anchor] = node

    def repeat(self, node: Node, event: yaml.AliasEvent) -> None:
        """An alias shares what its anchor has."""
        name = str(event.anchor)
        target = self.anchors.get(name)
        if target is None:
            what = "holds itself" if name in self.anchors else "stands before its anchor, or has none"
            raise self.refused(event, f"the alias *{name} {what}", remedy="write the value out")
        node.alias, node.flow, node.size = name, target.flow, target.size
        node.scalar, node.children = target.scalar, target.children

    def last_character(self, node: Node, event: yaml.ScalarEvent) -> int:
        """Where a scalar ends: a text in a block has line breaks behind it, which belong to it when its head says keep (`+`)."""
        span = self.text[node.start : node.end]
        if event.style not in ("|", ">"):
            return node.end
        keeps = "+" in span.partition("\n")[0].partition("#")[0]
        return node.start + len(span.removesuffix("\n").removesuffix("\r") if keeps else span.rstrip())

    def collection(self, node: Node, event: yaml.CollectionStartEvent, level: int) -> None:
        """A mapping or a list, up to its end."""
        node.flow = bool(event.flow_style)
        is_mapping = isinstance(event, yaml.MappingStartEvent)
        self.tagged(event, {} if is_mapping else [])
        node.children = self.mapping(node, level) if is_mapping else self.sequence(node, level)
        node.size += sum(child.size for child in node.entries)

    def entry(self, node: Node, event: yaml.Event, level: int) -> Node:
        """A node within a collection in block style, which ends where its last entry ends; one in flow style ends with its bracket."""
        child = self.node(event, level + 1)
        node.end = child.end
        return child

    def closed(self, node: Node, event: yaml.Event) -> None:
        """The end of a collection."""
        if node.flow:
            node.end = marks(event)[1].index + self.shift

    def sequence(self, node: Node, level: int) -> list[Node]:
        """Entries up to the end of a list."""
        found = []
        while not isinstance(event := next(self.events), yaml.SequenceEndEvent):
            found.append(self.entry(node, event, level))
        self.closed(node, event)
        return found

    def mapping(self, node: Node, level: int) -> dict[str, Node]:
        """Entries up to the end of a mapping; those that a merge brings stand before its own."""
        merged, found = {}, {}
        while not isinstance(event := next(self.events), yaml.MappingEndEvent):
            key = self.key(event, found)
            child = self.entry(node, next(self.events), level)
            if key.value == MERGE and key.implicit[0]:
                merged |= self.merged(key, child)
                continue
            start, end = marks(key)
            child.line, child.column = start.line + 1, start.column + 1
            child.key = start.index + self.shift, end.index + self.shift
            found[key.value] = child
        self.closed(node, event)
        return merged | found

    def key(self, event: yaml.Event, found: dict[str, Node]) -> yaml.ScalarEvent:
        """A key, which is a text as in JSON, whatever it looks like; it stands once."""
        if not isinstance(event, yaml.ScalarEvent):
            raise self.refused(event, "is no key", remedy="a key is a text on one line, without * and &")
        if event.value in found:
            first = found[event.value].line
            raise self.refused(event, f"the key {event.value!r} stands twice", remedy=f"it stands in line {first} already")
        return event

    def merged(self, event: yaml.Event, child: Node) -> dict[str, Node]:
        """What a merge (`<<`) brings: of several the first that has a key."""
        found = {}
        for each in reversed(child.children if isinstance(child.children, list) else [child]):
            if not isinstance(each.children, dict):
                raise self.refused(event, "merges what is no mapping", remedy="name the alias of a mapping, or a list of such")
            found |= {key: Node(each.start, each.end, each.line, each.column, node.scalar, node.children, node.flow,
                                alias=MERGE, size=node.size) for key, node in each.children.items()}  # fmt: skip
        return found

    def scalar(self, event: yaml.ScalarEvent) -> Any:
        """The value of a scalar: a text in quotes or in a block, else what it looks like."""
        is_plain = event.implicit[0] or (event.tag or "!!str").removeprefix(TAG) in KINDS.keys() - {"str"}
        return self.tagged(event, self.plain(event) if is_plain else event.value)

    def plain(self, event: yaml.ScalarEvent) -> Any:
        """The value of a plain scalar after YAML 1.2; raises ScenarioError where YAML 1.1 has another."""
        text = event.value
        if text in WORDS:
            return WORDS[text]
        if TWOFOLD.fullmatch(text):
            raise self.refused(event, "means different things in YAML 1.1 and 1.2", text, remedy=unmistakable(text))
        for pattern, number in NUMBERS:
            if pattern.fullmatch(text):
                if len(text) > LONGEST_NUMBER:
                    raise self.refused(event, "is too long a number", allowed=f"{LONGEST_NUMBER} characters")
                return number(text)
        return text

    def tagged(self, event: Valued, value: Any) -> Any:
        """The value, if its tag is one of JSON's kinds and says the same."""
        if event.tag is None or type(value) in KINDS.get(event.tag.removeprefix(TAG), ()):
            return float(value) if event.tag == f"{TAG}float" else value
        allowed = ", ".join(f"!!{name}" for name in KINDS)
        raise self.refused(event, "has a tag that does not fit, or is not taken", event.tag, allowed, "leave it out")

    def refused(self, event: yaml.Event, what: str, value: str = "", allowed: str = "", remedy: str = "") -> ScenarioError:
        """A refusal with the place."""
        mark, _ = marks(event)
        place = f"{self.where}, line {mark.line + 1}, column {mark.column + 1}"
        return ScenarioError(f"{self.where} cannot be read.", [Problem(place, what, value, allowed, remedy)])


def unmistakable(text: str) -> str:
    """How to write what is meant."""
    lower = text.lower()
    if lower in ("yes", "on"):
        return f"write true, or '{text}' in quotes"
    if lower in ("no", "off"):
        return f"write false, or '{text}' in quotes"
    return f"write the number as in JSON, or '{text}' in quotes"


def same(a: Any, b: Any) -> bool:
    """Whether two values are equal with the kinds of their numbers and the order of their keys."""
    return json.dumps(a) == json.dumps(b)
