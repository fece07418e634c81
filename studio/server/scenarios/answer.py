"""What REST of scenario files takes and gives."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from studio.server.answer import ChangesByPath, Problem


class Template(BaseModel):
    """A scenario to begin with, which is laid on a way through a map."""

    name: str
    title: str
    description: str


FileName = Annotated[str, Field(description="name of its file, with or without .yaml", max_length=300, examples=["my drive"])]
Title = Annotated[str, Field(min_length=1, max_length=120)]


class NewScenario(BaseModel):
    """A scenario to make from a template."""

    model_config = ConfigDict(extra="forbid")

    name: FileName
    title: Title | None = Field(None, description="left out, that of the template")
    template: str = "one_car"
    map: str = Field(description="id of the map, as in the list of maps")


class NewCopy(BaseModel):
    """A scenario to make from another one, with changes by path."""

    model_config = ConfigDict(extra="forbid")

    name: FileName
    title: Title | None = Field(None, description="left out, that of the other one")
    set: ChangesByPath = {}


class NewName(BaseModel):
    """What a scenario is to be called from now on."""

    model_config = ConfigDict(extra="forbid")

    name: FileName
    title: Title | None = Field(None, description="left out, it stays")


class DeletedScenario(BaseModel):
    """A scenario file in the trash."""

    id: str = Field(description="its name in the trash")
    scenario: str = Field(description="what it was called")
    deleted: str = Field(description="when (ISO 8601, UTC)")
    bytes: int


class Return(BaseModel):
    """How a scenario comes back from the trash."""

    model_config = ConfigDict(extra="forbid")

    name: FileName | None = Field(None, description="left out, the one that it had")


class TextProblem(Problem):
    """A problem of a text, with its place if it has one, counted from 1."""

    line: int | None
    column: int | None


class TextCheck(BaseModel):
    """Whether a text is a scenario."""

    ok: bool
    problems: list[TextProblem]
