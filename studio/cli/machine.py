"""Commands about this machine: compile everything for it, measure it."""

from pathlib import Path
from typing import Annotated, Any

import typer

from studio.cli.option import AsJson, Kinds, load_kinds
from studio.cli.output import print_json, print_table
from studio.cli.progress import compile_first, progress
from studio.errors import Problem, UnknownError

commands = typer.Typer()


@commands.command("compile")
def compile_(kinds: Kinds = None) -> None:
    """Compiles everything that has not been compiled on this machine; other commands do so when they need it.

    Kinds of your own are compiled by trying them, as `studio conform` does; a scenario compiles what connects them to it.
    """
    load_kinds(kinds)
    count = compile_first()
    print(f"{count} functions compiled." if count else "Everything is compiled.")
    if kinds:
        from studio.kind import registry
        from studio.workshop.conform import conform

        for each in [kind for kind in registry.every() if not kind.is_built_in]:
            failed = sum(bool(check.wrong) for check in conform(each))
            print(f"{each.sort} {each.name}: {f'{failed} checks failed, see studio conform' if failed else 'tried'}")


@commands.command()
def bench(
    device: Annotated[str, typer.Option(help="cpu, or cuda for a GPU.")] = "cpu",
    town: Annotated[Path | None, typer.Option(help="Map of a town for 100 cars; left out, that of a sample.", exists=True)] = None,
    traffic: Annotated[bool, typer.Option("--traffic", help="Traffic alone, with full and light dynamics; takes some minutes.")] = False,
    as_json: AsJson = False,
) -> None:
    """Measures vehicle steps and ticks a second on this machine, an import and the picture; takes about a minute."""
    if device not in ("cpu", "cuda"):
        raise UnknownError(f"There is no device {device!r}.", [Problem("--device", "is not known", device, "cpu, cuda")])
    compile_first()
    with progress("measuring") as report:
        from studio import bench as measure
        from studio import sample

        if traffic:
            figures = measure.run_traffic(report)
        else:
            figures = measure.run_device(report) if device == "cuda" else measure.run(sample.first(), town or sample.town(), report)
    if as_json:
        print_json(figures)
        return
    print(f"{figures['machine']}; {', '.join(f'{name} {number}' for name, number in figures['versions'].items())}")
    print_table(["what", "median", "unit"], bench_rows(figures))


def bench_rows(figures: dict[str, Any]) -> list[list[str]]:
    """The figures of a benchmark for people."""
    dynamics = figures["dynamics"]
    rows = [[f"dynamics, {n} vehicles, one core", f"{value:,.0f}", "vehicle steps/s"] for n, value in dynamics.get("one_core", {}).items()]
    rows += [[f"dynamics, {n} vehicles, GPU", f"{value:,.0f}", "vehicle steps/s"] for n, value in dynamics.get("cuda", {}).items()]
    if "all_cores" in dynamics:
        rows.append(["dynamics, 1000 vehicles a core, all cores", f"{dynamics['all_cores']:,.0f}", "vehicle steps/s"])
    if "tick" in figures:
        rows.append(["whole tick of the sample, one core", f"{figures['tick']['one_core']:,.0f}", "vehicle ticks/s"])
    if "place" in figures:
        rows.append(["import of the sample's map", f"{figures['place']['import']:.2f}", "s"])
        rows.append(["conflicts of the sample's ways", f"{figures['place']['conflicts']:.3f}", "s"])
    if "scene" in figures:
        rows.append(["update of the sample's vehicles in the picture", f"{figures['scene']['update']:.5f}", "s"])
    for name, words in (("advance", "whole advance"), ("equipped", "whole advance, equipped"), ("town", "whole advance, in a town")):
        for n, each in figures.get(name, {}).get("one_core", {}).items():
            rows.append([f"{words}, {n} vehicles, one core", f"{each['rate']:,.0f}", "vehicle ticks/s"])
            rows.append([f"{words} over integration, {n} vehicles", f"{each['ratio']:.2f}", "1"])
            shares = ", ".join(f"{part} {share:.2f}" for part, share in each["parts"].items())
            rows.append([f"{words}, parts over integration, {n} vehicles", shares, "1"])
    for dynamics, crowds in figures.get("traffic", {}).items():
        for n, each in crowds.items():
            rows.append([f"traffic, {dynamics}, {n} vehicles, one core", f"{each['rate']:,.0f}", "vehicle ticks/s"])
            rows.append([f"times real time, {dynamics}, {n} vehicles", f"{each['real_time']:.2f}", "1"])
            rows.append([f"preparing, {dynamics}, {n} vehicles", f"{each['prepared']:.2f}", "s"])
    if "difference" in figures:
        rows.append(["distance to the CPU's result after 10 s", f"{figures['difference']:.1e}", "m"])
    return rows
