"""Reading YAML: the values of version 1.2, places, and what is refused before it costs anything."""

import math

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import ScenarioError
from studio.scenario import catalogue
from studio.scenario.text import source, splice
from tests.conftest import ROOT
from tests.scenario import yaml_text

FILES = sorted([*(ROOT / "scenarios").glob("*.yaml"), *catalogue.VEHICLES.glob("*.yaml")])


def value(text: str):
    return source.read(f"a: {text}\n", "my.yaml").value["a"]


def refusal(text: str) -> str:
    with pytest.raises(ScenarioError) as caught:
        source.read(text, "my.yaml")
    return str(caught.value)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_our_files_mean_the_same_in_both_versions_of_yaml(path):
    """PyYAML reads YAML 1.1."""
    text = path.read_text(encoding="utf-8")
    assert source.same(source.read(text, path.name).value, yaml.safe_load(text))


# YAML 1.2.2, 10.3.2: tag resolution of the core schema; and its example 10.9.
@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("null", None), ("~", None), ("", None), ("true", True), ("False", False),
        ("0", 0), ("0o7", 7), ("0x3A", 58), ("-19", -19), ("+12", 12),
        ("0.", 0.0), ("-0.0", -0.0), (".5", 0.5), ("+12e03", 12000.0), ("-2E+05", -200000.0), ("1e3", 1000.0),
        (".inf", math.inf), ("-.Inf", -math.inf), ("+.INF", math.inf),
        ("'on'", "on"), ('"012"', "012"), ("1.2.3", "1.2.3"), ("206170873#1", "206170873#1"), ("0o8", "0o8"), ("!!str 5", "5"),
        ("!!float 5", 5.0), ("y", "y"),
    ],
)  # fmt: skip
def test_scalars(text, meant):
    assert source.same(value(text), meant)


def test_not_a_number():
    assert math.isnan(value(".NaN"))


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("on", "write true"), ("Yes", "write true"), ("off", "write false"), ("NO", "write false"),
        ("012", "as in JSON"), ("-08", "as in JSON"), ("1_000", "as in JSON"), ("0b11", "as in JSON"), ("12:30", "as in JSON"),
        ("2026-01-01", "'2026-01-01' in quotes"), ("1_0.5", "as in JSON"), ("-0x1F", "as in JSON"),
    ],
)  # fmt: skip
def test_what_the_versions_of_yaml_read_differently_is_refused(text, remedy):
    told = refusal(f"a: 1\nb: {text}\n")
    assert "my.yaml, line 2, column 4" in told and "YAML 1.1 and 1.2" in told and remedy in told


def test_keys_are_texts_whatever_they_look_like():
    assert source.read("1: a\non: b\nnull: c\n", "my.yaml").value == {"1": "a", "on": "b", "null": "c"}


def test_anchors_aliases_and_merges():
    text = "a: &a {x: 1, y: 2}\nb: *a\nc: {<<: *a, y: 3}\nd: {<<: [{x: 5}, *a], z: 4}\n"
    found = source.read(text, "my.yaml").value
    assert found == {"a": {"x": 1, "y": 2}, "b": {"x": 1, "y": 2}, "c": {"x": 1, "y": 3}, "d": {"x": 5, "y": 2, "z": 4}}
    assert found == yaml.safe_load(text)
    assert found["a"] is not found["b"]


def nested_aliases(levels: int) -> str:
    """Each level holds the one below ten times."""
    lines = ["a0: &a0 [x]"] + [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, levels)]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (nested_aliases(9), ["line 6", "too many values", "100000"]),
        (nested_aliases(400), ["line 6", "too many values"]),
        ("a: &a {b: &b {<<: *a}}\n", ["line 1", "*a holds itself"]),
        ("a: *b\n", ["line 1, column 4", "*b stands before its anchor"]),
        ("[" * 5000, ["line 1, column 66", "nested too deep", "64 levels"]),
        ("- " * 5000 + "x", ["line 1", "nested too deep"]),
        ("a: [" + "x, " * 120_000 + "]", ["too many values"]),
        ("a: 1\nb: 2\na: 3\n", ["line 3, column 1", "'a' stands twice", "line 1"]),
        ("a: {b: 1, b: 2}\n", ["line 1, column 11", "'b' stands twice"]),
        ("? [a]\n: 1\n", ["line 1", "is no key"]),
        ("a: 1\n---\na: 2\n", ["line 2", "second document"]),
        ("a: !!python/object/apply:os.system [x]\n", ["line 1, column 4", "tag"]),
        ("a: !!int true\n", ["line 1, column 4", "tag"]),
        ("a: !!int x\n", ["line 1, column 4", "tag"]),
        ("a: !!timestamp 2026-01-01\n", ["line 1, column 4", "tag"]),
        ("a: !mine x\n", ["line 1, column 4", "!mine"]),
        (f"a: {'9' * 5000}\n", ["line 1, column 4", "too long a number"]),
        ("a: [1,\n  2\nb: 3\n", ["line 3", "flow sequence that begins in line 1"]),
        ("a: b: c\n", ["line 1, column 5", "mapping values"]),
        ("a:\n\tb: 1\n", ["line 2, column 1", "a line begins with a tab", "indent with spaces"]),
        ("a:\n  b: 1\n  \tc: 2\n", ["line 3", "a line begins with a tab", "indent with spaces"]),
        ("a: \x00\n", ["control characters"]),
        ("a: \ud800\n", ["not YAML"]),
    ],
)
def test_what_is_refused_is_told_with_its_place(text, words):
    told = refusal(text)
    for word in words:
        assert word in told


@pytest.mark.parametrize(
    ("path", "place"),
    [("", (1, 1)), ("a", (2, 1)), ("a.b", (3, 3)), ("c.1", (4, 9)), ("d.x", (5, 5)), ("a.nowhere", (2, 1)), ("e.0.f", (7, 3))],
)
def test_places(path, place):
    text = "# head\na:\n  b: 1\nc: [10, 20]\nd: {x: 1}\ne:\n- f: 3\n"
    assert source.read(text, "my.yaml").place(path.split(".") if path else []) == place


def test_a_byte_order_mark_counts_as_nothing():
    found = source.read("\ufeffa: &x 1\nb: *x\n", "my.yaml")
    node = found.find(["b"])
    assert found.value == {"a": 1, "b": 1} and found.text[node.start : node.end] == "*x"


@given(yaml_text.VALUES, st.sampled_from([None, True, False]))
def test_what_is_written_reads_the_same_in_both_versions(given_value, flow):
    """Whatever looks like something else is put in quotes."""
    text = splice.written({"a": given_value}, flow=flow) + "\n"
    assert source.same(source.read(text, "my.yaml").value, {"a": given_value})
    assert source.same(yaml.safe_load(text), {"a": given_value})


@pytest.mark.parametrize(
    ("data", "line", "byte"),
    [("a: 1\nb: Größe\n".encode("latin-1"), 2, "0xf6"), ("a: 1\n".encode("utf-16"), 1, "0xff"), (b"a: 1\r\n\r\n# \x80\n", 3, "0x80")],
)
def test_another_encoding_is_told_with_its_line(data, line, byte):
    with pytest.raises(ScenarioError) as told:
        source.decoded(data, "my.yaml")
    assert f"my.yaml, line {line}: holds a byte that is no UTF-8 (got {byte}); allowed: UTF-8; save the file as UTF-8" in str(told.value)
