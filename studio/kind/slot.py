"""Slots: places in a scenario where a kind is chosen. What may stand there is what the registry has.

    driver: Annotated[Any, Slot("driver", usual="attentive")]     # {kind: attentive, time_headway: 1.2}
    messages: Annotated[Any, Every("message")]                     # {awareness: {period: 0.1}}
    spread: Annotated[Any, OneOf((Normal, Uniform))]               # {kind: uniform, least: 1, most: 2}; no kinds of one's own

The schema of a document is made when it is first needed, and again when a kind has come in.
"""

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, Field, GetCoreSchemaHandler, GetJsonSchemaHandler, create_model
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from studio.errors import UnknownError
from studio.kind import preset, registry
from studio.kind.registry import Kind
from studio.kind.settings import Nested, Part


def chosen(kind: Kind) -> type[BaseModel]:
    """The settings of a kind with its name in front: what stands in a document."""
    module = kind.module
    if "Chosen" not in vars(module):
        field = Field(kind.name, title="Kind", description=kind.title)
        named = create_model("Named", __base__=Part, kind=(Literal[kind.name], field), **preset.fields(module))  # pyrefly: ignore[invalid-literal]
        assert kind.settings, f"a {kind.sort} that can be chosen has settings"
        made = create_model(f"{kind.name}_{kind.sort}", __base__=(kind.settings, named), __module__=module.__name__, __doc__=kind.title)
        made.__qualname__ = made.__name__ = "Chosen"
        vars(module)["Chosen"] = made
    return vars(module)["Chosen"]


@dataclass(frozen=True)
class Slot(Nested):
    """A place for one kind of a sort. `usual` is the kind of a document that names none."""

    usual: str | None = None

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        choices = {name: handler.generate_schema(chosen(kind)) for name, kind in registry.known(self.sort).items()}
        union = core_schema.tagged_union_schema(choices, discriminator="kind", ref=None)
        return core_schema.no_info_before_validator_function(self.named, union)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """What the page makes a form of says what is chosen here."""
        return handler(schema) | {"sort": self.sort}

    def named(self, given: Any) -> Any:
        """With the usual kind where none is named, and the values of a preset; raises PydanticCustomError for a kind that there is not."""
        if not isinstance(given, dict):
            return given
        named = {"kind": self.usual} | given if self.usual else given
        if "kind" not in named:
            return named
        try:
            found = registry.find(self.sort, str(named["kind"]))
        except UnknownError as error:
            raise PydanticCustomError("unknown_kind", "{what}", {"what": error.message}) from None
        return preset.filled(found.module, named)


@dataclass(frozen=True)
class OneOf:
    """A place for one of some parts, which their `kind` tells apart and which nobody adds to."""

    parts: tuple[type[Part], ...]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        choices = {part.model_fields["kind"].default: handler.generate_schema(part) for part in self.parts}
        return core_schema.tagged_union_schema(choices, discriminator="kind")


AnyCondition = Annotated[Any, Slot("condition")]  # within another: a class that has one is declared with defer_build=True


@dataclass(frozen=True)
class Every:
    """A place for the settings of all kinds of a sort that have some, by name."""

    sort: str

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        kinds = [kind for kind in registry.known(self.sort).values() if hasattr(kind.module, "Settings")]
        fields: dict[str, Any] = {
            kind.name: (kind.module.Settings, Field(default_factory=kind.module.Settings, title=kind.title)) for kind in kinds
        }
        return handler.generate_schema(create_model(f"Every{self.sort.title()}", __base__=Part, **fields))
