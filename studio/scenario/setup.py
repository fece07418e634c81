"""From a document to a complete scenario: applications found, their parameters checked and filled in, changes applied.

complete(document)  →  Scenario        every default filled in, every name known
change(document, {path: value})        an exchange of an application keeps the parameters that both have, one of a kind its settings
"""

from typing import Any

from pydantic import ValidationError

from studio.errors import Problem, ScenarioError, UnknownError
from studio.kind import registry
from studio.scenario import edit, file, finding
from studio.scenario.schema import Application, Scenario, child, node_at, pointed
from studio.scenario.text.patch import Operation, operation, patched


def complete(document: dict[str, Any], where: str) -> Scenario:
    """A valid scenario with the parameters of its applications filled in; raises ScenarioError with all problems."""
    scenario = file.validate(document, where)
    found = [filled(where, f"applications.{name}", group) for name, group in scenario.applications.items()]
    wrong = [problem for _, problems in found for problem in problems]
    if wrong:
        raise ScenarioError(f"{where} is not a valid scenario.", wrong)
    groups = {name: group for name, (group, _) in zip(scenario.applications, found, strict=True)}
    return scenario.model_copy(update={"applications": groups})


def filled(where: str, path: str, group: Application) -> tuple[Application, list[Problem]]:
    """A group with all parameters of its application, or the problems."""
    try:
        application = registry.find("application", group.application)
    except UnknownError as error:
        return group, [Problem(f"{where}: {path}.application", error.message)]
    try:
        return group.model_copy(update={"parameters": application.module.Parameters.model_validate(group.parameters).model_dump()}), []
    except ValidationError as error:
        return group, finding.problems(error, where, application.module.Parameters, under=f"{path}.parameters.")


def change(document: dict[str, Any], changes: dict[str, Any], where: str) -> dict[str, Any]:
    """The document with the changes, not yet validated: fields that depend on each other can be changed together.

    Raises ScenarioError for a path that does not exist.
    """
    exchanges = {path: value for path, value in changes.items() if is_exchange(document, path)}
    for path, name in exchanges.items():
        document = patched(document, exchange(document, path.split(".")[1], name))
    for path, kept in kinds(document, changes).items():
        exchanges |= {f"{path}.kind": kept}
        document = patched(document, edit.assignment(document, complete(document, where).model_dump(mode="json"), path, kept))
    full = complete(document, where).model_dump(mode="json")
    for path, value in changes.items():
        if path not in exchanges:
            document = patched(document, edit.assignment(document, full, path, value))
    return document


def is_exchange(document: dict[str, Any], path: str) -> bool:
    """Whether a path names which application a group runs."""
    parts = path.split(".")
    return len(parts) == 3 and parts[0] == "applications" and parts[2] == "application" and edit.has(document, path)


def kinds(document: dict[str, Any], changes: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Places where the changes put another kind, each with what is kept there: the settings that both kinds have.

    Where the changes give the whole place too, what is in it counts.
    """
    schema, found = Scenario.model_json_schema(), {}
    for path, name in changes.items():
        place, _, last = path.rpartition(".")
        fields = fields_of(schema, place.split("."), name) if last == "kind" and isinstance(name, str) else []
        if fields and not any(path.startswith(f"{each}.") for each in changes):
            given = edit.get(document, place) if edit.has(document, place) else {}
            found[place] = {"kind": name} | {key: value for key, value in given.items() if key in fields and key != "kind"}
    return found


def fields_of(schema: dict[str, Any], place: list[str], kind: str) -> list[str]:
    """The fields of a kind that may stand at a place; none where no kind is chosen, or not this one."""
    choice = child(node_at(schema, place[:-1]), place[-1]).get("discriminator", {})
    if choice.get("propertyName") != "kind" or kind not in choice["mapping"]:
        return []
    return list(pointed(schema, choice["mapping"][kind])["properties"])


def exchange(document: dict[str, Any], group: str, name: Any) -> list[Operation]:
    """The patch that puts another application into a group; parameters that it does not have are dropped."""
    patch = [operation("replace", ["applications", group, "application"], value=name)]
    if isinstance(name, str) and name in registry.known("application"):
        fields = registry.find("application", name).module.Parameters.model_fields
        given = document["applications"][group].get("parameters") or {}
        kept = {key: value for key, value in given.items() if key in fields}
        patch.append(operation("add", ["applications", group, "parameters"], value=kept))
    return patch
