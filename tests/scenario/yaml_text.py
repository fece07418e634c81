"""YAML texts as people write them, drawn by lot: blocks and lines, comments, blank lines, anchors, quotes, a file's last line break."""

import json

from hypothesis import strategies as st

KEYS = st.text("abcxyz_ é~/-:#'", min_size=1, max_size=4)
TEXTS = st.one_of(
    st.text(max_size=6), st.sampled_from(["on", "012", "1e3", "null", "- a", "a: b", "# a", "two\nlines\n", " a ", "1_000", "é", "<<"])
)
NUMBERS = st.one_of(st.integers(-(2**70), 2**70), st.floats(allow_nan=False))
SCALARS = st.one_of(st.none(), st.booleans(), NUMBERS, TEXTS)
VALUES = st.recursive(SCALARS, lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(KEYS, inner, max_size=3)), max_leaves=8)
MAPPINGS = st.dictionaries(KEYS, VALUES, min_size=1, max_size=4)
REMARKS = st.sampled_from(["", "", "", "  # why", " # ä: {[", "   "])
GAPS = st.sampled_from(["", "", "", "\n", "\n\n", "# over\n", "# over\n# it\n", "\n# loose\n\n", "  # askew\n"])


@st.composite
def texts(draw) -> str:
    """A mapping as YAML."""
    text = draw(GAPS) + block(draw, draw(MAPPINGS), 0)
    if draw(st.booleans()):
        text += (
            f"{draw(GAPS)}first: &part {flow(draw, draw(VALUES))}\n{draw(GAPS)}second: *part{draw(REMARKS)}\nlist: [*part, {{x: *part}}]\n"
        )
    text += draw(GAPS)
    text = text.removesuffix("\n") if draw(st.booleans()) else text
    return text.replace("\n", "\r\n") if draw(st.integers(0, 4)) == 0 else text


def block(draw, value, column: int) -> str:
    """Entries in lines of their own."""
    lines = ""
    for key, each in value.items() if isinstance(value, dict) else enumerate(value):
        head = f"{quoted(key)}:" if isinstance(value, dict) else "-"
        gap = "".join(" " * column + line if line.startswith("#") else line for line in draw(GAPS).splitlines(keepends=True))
        lines += gap + " " * column + head + behind(draw, each, column + draw(st.integers(1, 3)))
    return lines


def behind(draw, value, column: int) -> str:
    """What stands behind a key or a dash."""
    if isinstance(value, (dict, list)) and value and draw(st.booleans()):
        return f"{draw(REMARKS)}\n{block(draw, value, column)}"
    return f" {flow(draw, value)}{draw(REMARKS)}\n"


def flow(draw, value) -> str:
    """A value in a line."""
    space, comma = draw(st.sampled_from(["", " "])), draw(st.sampled_from([", ", ",", " , "]))
    if isinstance(value, dict):
        return "{" + space + comma.join(f"{quoted(key)}: {flow(draw, each)}" for key, each in value.items()) + space + "}"
    if isinstance(value, list):
        return "[" + space + comma.join(flow(draw, each) for each in value) + space + "]"
    if isinstance(value, str):
        return quoted(value)
    return json.dumps(value).replace("-Infinity", "-.inf").replace("Infinity", ".inf")


def quoted(text: str) -> str:
    """A text in quotes; beyond the first plane YAML has no escapes of two halves, as JSON has."""
    return f'"{"".join(each if ord(each) > 0xFFFF else json.dumps(each)[1:-1] for each in text)}"'


@st.composite
def operations(draw, document) -> dict:
    """An operation of a JSON patch that fits a document."""
    places = list(paths(document, ""))
    op = draw(st.sampled_from(["add", "add", "remove", "replace", "move", "copy", "test"]))
    path = draw(st.sampled_from(places[1:] or places))
    if op == "remove" or not path:
        return {"op": "remove", "path": path} if path else {"op": "replace", "path": "", "value": draw(MAPPINGS)}
    if op == "replace":
        return {"op": op, "path": path, "value": draw(VALUES)}
    if op == "test":
        return {"op": op, "path": path, "value": found(document, path)}
    away = draw(st.sampled_from(places[1:]))
    target = draw(st.sampled_from(list(openings(document, "", draw(KEYS)))))
    if op == "add" or target.startswith(f"{away}/"):
        return {"op": "add", "path": target, "value": draw(VALUES)}
    if op == "move":
        return {"op": "move", "from": away, "path": draw(st.sampled_from([away, sibling(document, away, draw(KEYS))]))}
    return {"op": op, "from": away, "path": target}


def escaped(key) -> str:
    """A key within a pointer."""
    return str(key).replace("~", "~0").replace("/", "~1")


def entries(value):
    """Keys and values of a collection; nothing of a scalar."""
    return value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()


def paths(value, place):
    """Pointers of everything in a document."""
    yield place
    for key, each in entries(value):
        yield from paths(each, f"{place}/{escaped(key)}")


def openings(value, place, key):
    """Pointers at which something can be added."""
    if isinstance(value, dict):
        yield f"{place}/{escaped(key)}"
    if isinstance(value, list):
        yield from (f"{place}/-", f"{place}/0", f"{place}/{len(value)}")
    for name, each in entries(value):
        yield from openings(each, f"{place}/{escaped(name)}", key)


def sibling(document, path: str, key: str) -> str:
    """Another place in the same collection."""
    place, _, _ = path.rpartition("/")
    return f"{place}/0" if isinstance(found(document, place), list) else f"{place}/{escaped(key)}"


def found(document, path: str):
    """What stands at a pointer."""
    for part in path.split("/")[1:]:
        key = part.replace("~1", "/").replace("~0", "~")
        document = document[int(key)] if isinstance(document, list) else document[key]
    return document
