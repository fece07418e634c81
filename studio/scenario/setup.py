"""From a document to a complete scenario: applications found, their parameters checked and filled in, changes applied.

complete(document)  →  Scenario        every default filled in, every name known
change(document, {path: value})        an exchange of a kind keeps the settings that both have
"""

from typing import Any

from studio.errors import Problem, ScenarioError, UnknownError, short
from studio.kind import preset, registry
from studio.scenario import edit, file, finding
from studio.scenario.schema import Application, Scenario, json_schema, sort_at
from studio.scenario.text.patch import Operation, is_text, operation, patched


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
    known = preset.presets(application.module)
    if group.preset is not None and group.preset not in known:
        allowed = ", ".join(known) or f"none: {application.name!r} has no presets"
        return group, [Problem(f"{where}: {path}.preset", "is no preset of the application", repr(group.preset), allowed)]
    values = known[group.preset].values if group.preset else {}
    values, model = values | group.parameters, application.module.Parameters
    if wrong := finding.of_values(model, values, where, f"{path}.parameters."):
        return group, wrong
    return group.model_copy(update={"parameters": model.model_validate(values).model_dump()}), []


def change(document: dict[str, Any], changes: dict[str, Any], where: str) -> dict[str, Any]:
    """The document with the changes, not yet validated: fields that depend on each other can be changed together.

    Raises ScenarioError for a path that does not exist, or text that no file can hold.
    """
    return patched(document, patch_of(document, changes, where))


def patch_of(document: dict[str, Any], changes: dict[str, Any], where: str) -> list[Operation]:
    """The patch that changes come to. Raises ScenarioError as `change` does."""
    for path, value in changes.items():
        check_text(path, value, where)
    full, rest, done = laid_out(document, where), dict(changes), []
    for i, path in enumerate(changes):
        if sort := exchanged_sort(full, path):
            for around in whole([each for each in list(changes)[:i] if each in rest], path):
                done += (step := edit.assignment(document, full, around, rest.pop(around)))
                document = patched(document, step)
            done += (step := exchanged(document, full, sort, path, rest))
            document = patched(document, step)
    full = full if len(rest) == len(changes) else laid_out(document, where)
    for path, value in presets_first(rest).items():
        done += (step := edit.assignment(document, full, path, value))
        document = patched(document, step)
    return done


def presets_first(changes: dict[str, Any]) -> dict[str, Any]:
    """The changes with each preset before the settings beside it: they are set on top of it, whichever somebody has chosen first."""
    paths = list(changes)
    for path in [each for each in paths if each.rpartition(".")[2] == preset.FIELD]:
        place, now = f"{path.rpartition('.')[0]}.", paths.index(path)
        beside = next((i for i, each in enumerate(paths[:now]) if each.startswith(place)), now)
        paths.insert(beside, paths.pop(now))
    return {path: changes[path] for path in paths}


def check_text(path: str, value: Any, where: str) -> None:
    """Raises ScenarioError for half characters, which a command line may hand over."""
    try:
        is_text({path: value})
    except ValueError as error:
        raise ScenarioError(f"{where} cannot be changed so.", [Problem(short(path), str(error), short(value), "Unicode")]) from None


def whole(earlier: list[str], path: str) -> list[str]:
    """What has been set before as a whole that a path is a part of: it comes first."""
    return [each for each in earlier if path.startswith(f"{each}.")]


def laid_out(document: dict[str, Any], where: str) -> dict[str, Any]:
    """The document with all defaults."""
    return complete(document, where).model_dump(mode="json")


def exchanged_sort(full: dict[str, Any], path: str) -> str:
    """Of which sort the kind is whose name stands at a path; "" where none does."""
    *place, last = path.split(".")
    if not edit.has(full, path):
        return ""
    if last == "application" and len(place) == 2 and place[0] == "applications":
        return "application"
    return sort_at(json_schema(Scenario), place) if last == "kind" and place else ""


def exchanged(document: dict[str, Any], full: dict[str, Any], sort: str, path: str, rest: dict[str, Any]) -> list[Operation]:
    """The patch that puts another kind in a place; what both kinds have and the document gives is kept, the rest is dropped.

    What is set of the new kind at the same time is set with it, because it may need it: name and settings are taken out of `rest`.
    """
    place, name = path.rpartition(".")[0], rest.pop(path)
    at = f"{place}.parameters" if sort == "application" else place
    fields = settings_of(sort, name)
    given = edit.get(document, at) if edit.has(document, at) else None
    kept = {key: value for key, value in given.items() if key in fields} if isinstance(given, dict) else {}
    settings = kept | {key: rest.pop(f"{at}.{key}") for key in fields if f"{at}.{key}" in rest}
    if sort == "application":
        return [operation("replace", path.split("."), value=name), operation("add", at.split("."), value=settings)]
    return edit.assignment(document, full, place, {"kind": name} | settings)


def settings_of(sort: str, name: Any) -> list[str]:
    """The names of what may be set of a kind; none of one that there is not."""
    kind = registry.known(sort).get(name) if isinstance(name, str) else None
    return list(kind.settings.model_fields) if kind and kind.settings else []
