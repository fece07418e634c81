"""The command line, from the commands themselves."""

from collections.abc import Iterator

import typer

from docs.reference.table import code, filled, table
from studio import cli

HEAD = """# Command line

`uv run studio` alone serves the page; options without a command belong to `serve`. Results go to standard output, progress and
errors to standard error. Wrong input ends with code 2, a run that failed with code 1.
"""


def page() -> str:
    """Every command with its arguments and options."""
    return "\n".join([HEAD, *sections("studio", typer.main.get_command(cli.app))])


def sections(name: str, command) -> Iterator[str]:
    """A command, or all of a group."""
    children = getattr(command, "commands", None)
    if children is None:
        yield section(name, command)
        return
    for child, each in sorted(children.items()):
        yield from sections(f"{name} {child}", each)


def section(name: str, command) -> str:
    """One command."""
    shown = [each for each in command.params if not getattr(each, "hidden", False) and each.name != "help"]
    usage = " ".join([name, *(argument(each) for each in shown if each.param_type_name == "argument"), "[options]"])
    rows = [[names(each), getattr(each, "help", "") or "", default(each)] for each in shown]
    listed = table(["", "meaning", "default"], rows) if rows else ""
    return f"## {name}\n\n{filled(command.help)}\n\n```text\n{usage}\n```\n\n{listed}"


def argument(parameter) -> str:
    """An argument in the usage line; in brackets when it may be left out."""
    name = parameter.metavar or parameter.name.upper()
    return name if parameter.required else f"[{name}]"


def names(parameter) -> str:
    """An option with all its names, or an argument."""
    if parameter.param_type_name == "argument":
        return code(argument(parameter))
    value = "" if parameter.is_flag else f" {parameter.metavar or parameter.name.strip('_').upper()}"
    return ", ".join(code(name + value) for name in (*parameter.opts, *parameter.secondary_opts))


def default(parameter) -> str:
    """What counts when it is left out."""
    value = parameter.default
    if parameter.required:
        return "must be given"
    return "" if value is None or value is False else code("on" if value is True else value)
