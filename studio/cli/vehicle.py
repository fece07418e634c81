"""Commands about vehicles and tyres: show them, drive one on the rig, put one on the bench."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from studio.cli.option import AsJson, Sets, changes
from studio.cli.output import print_json, print_table
from studio.cli.progress import compile_first, progress
from studio.errors import Problem, ScenarioError

commands = typer.Typer()


@commands.command()
def vehicles(
    name: Annotated[str | None, typer.Argument(help="A vehicle of the catalogue, or a vehicle file (YAML); none: the list.")] = None,
    as_json: AsJson = False,
) -> None:
    """Lists the vehicles of the catalogue, or shows every value of one with its unit and where it comes from."""
    from studio.scenario import catalogue, listing

    if name is None:
        print_json(listing.list_json()) if as_json else print_table(list(listing.LIST_HEAD), listing.list_rows())
        return
    model = catalogue.find_vehicle(name)
    if as_json:
        print_json({"name": model.name, "values": listing.value_json(model)})
    else:
        print_table(list(listing.VALUE_HEAD), listing.value_rows(model))


@commands.command()
def drive(
    vehicle: Annotated[str, typer.Argument(help="A vehicle of the catalogue, or a vehicle file (YAML).")],
    inputs: Annotated[Path, typer.Option("--inputs", help="CSV: time_s and any of the columns that `studio drive --help` names.")],
    out: Annotated[Path, typer.Option("--out", help="CSV for every state and force; .gz packs it.")],
    speed: Annotated[float, typer.Option("--speed", help="Speed at the start [m/s].")] = 0.0,
    tyre: Annotated[
        str | None, typer.Option("--tyre", help="Tyre property file (.tir), or a name of the catalogue, for all wheels.")
    ] = None,
    set_: Sets = None,
    step: Annotated[float, typer.Option("--step", help="Integration step [s].")] = 0.005,
    period: Annotated[float, typer.Option("--period", help="Time between two rows of the result [s].")] = 0.01,
) -> None:
    """Drives one vehicle open loop on an endless plane.

    Input columns, any subset: time_s, road_wheel_angle_rad (past the steering's actuator) or steering_wheel_angle_rad, throttle
    or engine_torque_request_Nm, brake, gear, drive_torque_Nm and brake_torque_Nm (sums put on the wheels, past powertrain and
    hydraulics), speed_mps (held so). Without throttle, engine torque or gear the gearbox stays in neutral. --set changes values of
    the vehicle by path (body.mass=1200), and the road: road.friction=0.5, road.slope=0.1.
    """
    from studio.rig import drive as rig
    from studio.rig import table

    table.check_output(out, inputs, Path(vehicle))
    compile_first()
    with progress("preparing") as report:
        made = rig.drive(vehicle, inputs, speed=speed, tyre=tyre, changes=changes(set_), step=step, period=period, progress=report)
        rows = rig.write(made, out)
    print(f"{out}: {rows} rows, {made.time[-1]:g} s, {len(made.columns)} columns")
    if made.rolled_over is not None:
        print(f"{vehicle} rolled over at {made.rolled_over:g} s; nothing after it is claimed", file=sys.stderr)


@commands.command()
def tyre(
    file: Annotated[Path, typer.Argument(metavar="FILE.tir", help="A tyre property file.")],
    rows: Annotated[Path | None, typer.Option("--rows", help="CSV with kappa, alpha_rad, gamma_rad, Fz_N.")] = None,
    out: Annotated[Path | None, typer.Option("--out", help="CSV for these rows with Fx_N, Fy_N, Mz_Nm.")] = None,
    plot: Annotated[Path | None, typer.Option("--plot", help="PNG for the diagrams.")] = None,
) -> None:
    """Puts a tyre on the bench: forces for a table of slips, and diagrams."""
    from studio.rig import tyre as rig
    from studio.scenario import tir

    if (rows is None) != (out is None):
        raise ScenarioError("The bench needs both tables.", [Problem("--rows, --out", "belong together", remedy="give both")])
    properties = tir.read(file)
    print(f"{properties.name}: {properties.size}")
    for note in properties.notes:
        print(f"  {note}")
    if rows is not None and out is not None:
        print(f"{out}: {rig.bench(file, rows, out)} rows")
    if plot is not None:
        rig.plot(file, plot)
        print(f"{plot}: diagrams")
