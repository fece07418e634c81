"""JSON patches: the standard's own examples, another implementation, and refusals that say where, what and the remedy."""

import copy

import jsonpatch
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from studio.errors import ConflictError, ScenarioError
from studio.scenario.text import patch, pointer
from tests.scenario import yaml_text

# RFC 6902, appendix A: document, patch, result.
APPENDIX = {
    "A.1 an object member": ({"foo": "bar"}, [{"op": "add", "path": "/baz", "value": "qux"}], {"baz": "qux", "foo": "bar"}),
    "A.2 an array element": (
        {"foo": ["bar", "baz"]}, [{"op": "add", "path": "/foo/1", "value": "qux"}], {"foo": ["bar", "qux", "baz"]}),
    "A.3 removing a member": ({"baz": "qux", "foo": "bar"}, [{"op": "remove", "path": "/baz"}], {"foo": "bar"}),
    "A.4 removing an element": (
        {"foo": ["bar", "qux", "baz"]}, [{"op": "remove", "path": "/foo/1"}], {"foo": ["bar", "baz"]}),
    "A.5 replacing": (
        {"baz": "qux", "foo": "bar"}, [{"op": "replace", "path": "/baz", "value": "boo"}], {"baz": "boo", "foo": "bar"}),
    "A.6 moving a member": (
        {"foo": {"bar": "baz", "waldo": "fred"}, "qux": {"corge": "grault"}},
        [{"op": "move", "from": "/foo/waldo", "path": "/qux/thud"}],
        {"foo": {"bar": "baz"}, "qux": {"corge": "grault", "thud": "fred"}}),
    "A.7 moving an element": (
        {"foo": ["all", "grass", "cows", "eat"]}, [{"op": "move", "from": "/foo/1", "path": "/foo/3"}],
        {"foo": ["all", "cows", "eat", "grass"]}),
    "A.8 a test that passes": (
        {"baz": "qux", "foo": ["a", 2, "c"]},
        [{"op": "test", "path": "/baz", "value": "qux"}, {"op": "test", "path": "/foo/1", "value": 2}],
        {"baz": "qux", "foo": ["a", 2, "c"]}),
    "A.10 a nested member": (
        {"foo": "bar"}, [{"op": "add", "path": "/child", "value": {"grandchild": {}}}],
        {"foo": "bar", "child": {"grandchild": {}}}),
    "A.11 unknown members": ({"foo": "bar"}, [{"op": "add", "path": "/baz", "value": "qux", "xyz": 123}], {"foo": "bar", "baz": "qux"}),
    "A.14 the order of ~": ({"/": 9, "~1": 10}, [{"op": "test", "path": "/~01", "value": 10}], {"/": 9, "~1": 10}),
    "A.16 an array value": ({"foo": ["bar"]}, [{"op": "add", "path": "/foo/-", "value": ["abc", "def"]}], {"foo": ["bar", ["abc", "def"]]}),
}  # fmt: skip

# RFC 6902, appendix A: document, patch, words of the refusal.
REFUSED = {
    "A.9 a test that fails": ({"baz": "qux"}, [{"op": "test", "path": "/baz", "value": "bar"}], ["/baz", "'qux'", "'bar'"]),
    "A.12 no target": ({"foo": "bar"}, [{"op": "add", "path": "/baz/bat", "value": "qux"}], ["/baz", "does not exist"]),
    "A.13 two operations in one": ({"foo": "bar"}, [{"op": "add", "path": "/baz"}], ["needs the member 'value'"]),
    "A.15 text and number": ({"/": 9, "~1": 10}, [{"op": "test", "path": "/~01", "value": "10"}], ["/~01", "10", "'10'"]),
}


@pytest.mark.parametrize("name", APPENDIX)
def test_the_standards_examples(name):
    document, operations, result = APPENDIX[name]
    kept = copy.deepcopy(document)
    assert patch.equal(patch.patched(document, patch.operations(operations)), result)
    assert document == kept


@pytest.mark.parametrize("name", REFUSED)
def test_the_standards_examples_that_fail(name):
    document, operations, words = REFUSED[name]
    with pytest.raises(ScenarioError) as caught:
        patch.patched(document, patch.operations(operations))
    assert all(word in str(caught.value) for word in words)
    assert isinstance(caught.value, ConflictError) == (operations[0]["op"] == "test")


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.data())
def test_another_implementation_has_the_same_result(data):
    document = data.draw(yaml_text.MAPPINGS)
    operations = [data.draw(yaml_text.operations(document))]
    wanted = jsonpatch.apply_patch(document, operations)
    assert patch.equal(patch.patched(document, patch.operations(operations)), wanted)


@given(st.lists(st.text()))
def test_a_pointer_names_its_parts(path):
    assert pointer.parts(pointer.joined(path)) == tuple(path)


DOCUMENT = {"clock": {"duration": 60}, "roads": ["a", "b"], "title": "x", "a/b": {"~": 1}}


@pytest.mark.parametrize(
    ("operation", "words"),
    [
        ({"op": "replace", "path": "/clock/duraton", "value": 1}, ["/clock/duraton", "does not exist", "did you mean 'duration'"]),
        ({"op": "remove", "path": "/clok"}, ["/clok", "did you mean 'clock'"]),
        ({"op": "remove", "path": "/roads/2"}, ["/roads/2", "no entry of this list", "0 to 1"]),
        ({"op": "remove", "path": "/roads/01"}, ["/roads/01", "0 to 1"]),
        ({"op": "remove", "path": "/roads/-"}, ["/roads/-", "0 to 1"]),
        ({"op": "add", "path": "/roads/3", "value": "c"}, ["/roads/3", "0 to 2, or - for its end"]),
        ({"op": "add", "path": "/title/x", "value": 1}, ["/title/x", "leads into a text", "/title holds nothing further"]),
        ({"op": "remove", "path": ""}, ["the document", "cannot be removed", "replace it"]),
        ({"op": "replace", "path": "clock.duration", "value": 1}, ["no JSON pointer", "write /clock/duration"]),
        ({"op": "replace", "path": "/a~b", "value": 1}, ["~0 for ~ and ~1 for /"]),
        ({"op": "move", "from": "/clock", "path": "/clock/inner"}, ["/clock/inner", "lies within /clock"]),
        ({"op": "copy", "from": "/clok", "path": "/other"}, ["/clok", "did you mean 'clock'"]),
        ({"op": "move", "path": "/other"}, ["needs the member 'from'"]),
        ({"op": "add", "path": "/x", "value": {1, 2}}, ["patch: 0", "what JSON cannot say"]),
        ({"op": "add", "path": "/x", "value": "\ud800"}, ["patch: 0", "no Unicode"]),
        ({"op": "put", "path": "/clock", "value": 1}, ["patch: 0.op", "'put'", "'add'", "'replace'"]),
        ({"op": "add", "value": 1}, ["patch: 0.path", "is missing"]),
        ({"op": "test", "path": "/title", "value": "y"}, ["/title", "'x'", "allowed: 'y'", "read it again"]),
        ({"op": "test", "path": "/clock/duration", "value": True}, ["/clock/duration", "60", "True"]),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_told(operation, words):
    with pytest.raises(ScenarioError) as caught:
        patch.patched(DOCUMENT, patch.operations([operation]))
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize("raw", [{}, "x", None, [1], [[]]])
def test_what_is_no_patch(raw):
    with pytest.raises(ScenarioError, match="no JSON patch"):
        patch.operations(raw)


def test_too_many_operations():
    with pytest.raises(ScenarioError, match="too many operations"):
        patch.operations([{"op": "remove", "path": "/a"}] * (patch.MOST_OPERATIONS + 1))


def test_numbers_are_compared_by_value():
    """RFC 6902, 4.6."""
    assert patch.patched({"a": 1}, patch.operations([{"op": "test", "path": "/a", "value": 1.0}])) == {"a": 1}
