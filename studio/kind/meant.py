"""Meant: a number is a number, no text that could be read as one and no truth value; and a truth value is no number.

mistaken(value, annotation)   →  what is meant instead, "" when the value may be so
mistakes(model, values)       →  a problem for every value that a model would read as what it is not

YAML and JSON have numbers, texts and truth values. `delay: '0.1'` and `seed: true` are slips, whatever else they could be read as.
"""

from collections.abc import Iterator, Mapping
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, ValidationInfo
from pydantic_core import PydanticCustomError

NUMBER, TRUTH = "a number", "true or false"
TYPES = ((bool, "a truth value"), (str, "text"), (int, "a number"), (float, "a number"))  # in this order: a bool is an int, too


def checked(cls: type[BaseModel], value: Any, info: ValidationInfo) -> Any:
    """The validator behind it, before any other; raises PydanticCustomError."""
    field = cls.model_fields.get(str(info.field_name))
    wanted = mistaken(value, field.annotation) if field else ""
    if wanted:
        raise PydanticCustomError("mistaken", "is {given}", {"given": called(value), "expected": wanted})
    return value


def mistaken(value: Any, annotation: Any) -> str:
    """What is meant where a value is something else, "" when it may be so; of a list, what its first wrong entry should be."""
    if isinstance(value, list | tuple):
        pairs = [pair for each in members(annotation) for pair in entries(value, each)]
        return next((found for one, each in pairs if (found := mistaken(one, each))), "")
    taken = scalars(annotation)
    if isinstance(value, bool):
        return NUMBER if taken & {int, float} and bool not in taken else ""
    if isinstance(value, str):
        return "" if str in taken or not taken else NUMBER if taken & {int, float} else TRUTH
    return TRUTH if isinstance(value, int | float) and taken == {bool} else ""


def called(value: Any) -> str:
    """What a value is, in words; of a list, that something in it is wrong."""
    return next((words for kind, words in TYPES if isinstance(value, kind)), "a list with something else in it")


def members(annotation: Any) -> list[Any]:
    """The alternatives of an annotation; of one that has none itself."""
    if get_origin(annotation) is Annotated:
        return members(get_args(annotation)[0])
    if get_origin(annotation) in (Union, UnionType):
        return [found for each in get_args(annotation) for found in members(each)]
    return [annotation]


def entries(values: list | tuple, annotation: Any) -> Iterator[tuple[Any, Any]]:
    """The entries of a list with what each is to be."""
    kinds = get_args(annotation)
    if get_origin(annotation) is list:
        yield from ((value, kinds[0]) for value in values)
    elif get_origin(annotation) is tuple:
        yield from zip(values, kinds, strict=False)


def scalars(annotation: Any) -> set[type]:
    """Of numbers, texts and truth values those that an annotation takes."""
    found: set[type] = set()
    for each in members(annotation):
        found |= {type(value) for value in get_args(each)} if get_origin(each) is Literal else {each} & {int, float, str, bool}
    return found


def mistakes(model: type[BaseModel], values: Mapping[str, Any]) -> Iterator[tuple[str, Any, str, str]]:
    """Of the values for a model the wrong ones: name, value, what it is, and what is meant."""
    for name, field in model.model_fields.items():
        if name in values and (wanted := mistaken(values[name], field.annotation)):
            yield name, values[name], called(values[name]), wanted
