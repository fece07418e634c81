"""The command line: the same functions as the page and REST, as commands.

Results go to standard output, progress and errors to standard error. Wrong input ends with code 2, a run that failed
with code 1.
"""

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from studio.errors import MapError, Problem, RunError, StudioError, UnknownError

app = typer.Typer(
    help="Cooperative ADAS Studio. Without a command it serves the page.",
    no_args_is_help=False,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
generate = typer.Typer(help="Makes a map.", no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False)
app.add_typer(generate, name="generate")

generate = typer.Typer(help="Draws a map.", no_args_is_help=True, rich_markup_mode=None)
app.add_typer(generate, name="generate")

MapOut = Annotated[Path, typer.Option("--out", help="The map to write (.osm).")]
Db = Annotated[Path, typer.Option("--db", help="The run database; made when there is none.")]
Applications = Annotated[
    Path | None, typer.Option("--applications", help="A folder of Python files, each an application of your own.")
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object instead of a table.")]
Sets = Annotated[list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Change a field; can be repeated.")]
ScenarioFile = Annotated[Path, typer.Argument(metavar="SCENARIO", help="A scenario file (YAML).")]
DEFAULT_DB = Path("runs.db")
PIPED_WIDTH = 160  # columns of a table that is piped


@app.command()
def serve(
    host: Annotated[str, typer.Option(help="Address to serve on; others than this machine's own open it to the network.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port to serve on.", min=0, max=65535)] = 8000,
    db: Db = DEFAULT_DB,
    scenarios: Annotated[Path | None, typer.Option(help="Folder of scenario files; default: ./scenarios, else the samples.")] = None,
    applications: Applications = None,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in a browser.")] = True,
) -> None:  # fmt: skip
    """Serves the page, the scene and the REST API."""
    from studio.server.serve import serve as start

    start(host=host, port=port, db=db, scenarios=scenarios, applications=applications, browser=browser)


@app.command()
def run(
    scenario: ScenarioFile,
    set_: Sets = None,
    seed: Annotated[int | None, typer.Option(help="Seed of every random number; default: the scenario's.")] = None,
    parent: Annotated[int | None, typer.Option(help="The run that this one refines.")] = None,
    db: Db = DEFAULT_DB,
    applications: Applications = None,
    as_json: AsJson = False,
) -> None:
    """Runs a scenario as fast as possible and saves the run."""
    with progress("starting") as report:
        from studio import job
        from studio.store.runs import open_runs

        load_applications(applications)
        loaded = job.load(scenario, changes(set_))
        result = job.run(loaded, seed=seed, runs=open_runs(db), parent=parent, progress=report)
    if as_json:
        print_json(run_json(result.row))
    else:
        print_run(result.row)
    if result.status == "failed":
        raise typer.Exit(1)


@app.command()
def runs(db: Db = DEFAULT_DB, limit: Annotated[int, typer.Option(help="How many, newest first.", min=1, max=1_000_000)] = 50, as_json: AsJson = False) -> None:  # fmt: skip
    """Lists the runs of the database."""
    rows = existing(db).select(limit=limit)
    if as_json:
        print_json([run_json(row) for row in rows])
        return
    if not rows:
        print(f"No run in {db} yet. Try: studio run scenarios/grosser_stern_platoon.yaml")
        return
    print_table(
        ["run", "scenario", "status", "parent", "seed", "set", "min TTC [s]", "worst hop gain [1]"],
        [[str(row.run), row.scenario, row.status, str(row.parent or ""), str(row.seed), settings(row.parameters),
          metric_text(row, "min_ttc"), metric_text(row, "worst_hop_gain")] for row in rows],
    )  # fmt: skip


@app.command()
def show(run: Annotated[int, typer.Argument(help="Number of the run.")], db: Db = DEFAULT_DB, as_json: AsJson = False) -> None:  # fmt: skip
    """Shows one run: what was set, and every metric."""
    row = existing(db).find(run)
    print_json(run_json(row)) if as_json else print_run(row)


@app.command()
def compare(
    a: Annotated[int, typer.Argument(help="Number of a run.")],
    b: Annotated[int, typer.Argument(help="Number of another run.")],
    db: Db = DEFAULT_DB,
    as_json: AsJson = False,
) -> None:
    """Compares two runs: the parameters that differ, and every metric."""
    from studio.store.comparison import compare as compared

    result = compared(existing(db), a, b)
    if as_json:
        print_json(result)
        return
    print_table(
        ["parameter", f"run {a}", f"run {b}"],
        [[each["path"], text(each["a"]), text(each["b"])] for each in result["parameters"]],
    )
    print_table(
        ["metric", f"run {a}", f"run {b}", "difference", "better"],
        [[f"{each['name']} [{each['unit']}]", text(each["a"]), text(each["b"]), signed(each["difference"]),
          {"a": f"run {a}", "b": f"run {b}"}.get(each["better"], each["better"] or "")] for each in result["metrics"]],
    )  # fmt: skip


@app.command()
def check(scenario: ScenarioFile, set_: Sets = None, applications: Applications = None) -> None:
    """Checks a scenario file: fields, names, map, routes and starts."""
    with progress("checking"):
        from studio import job

        load_applications(applications)
        prepared = job.prepare(job.load(scenario, changes(set_)))
    print(f"{scenario} is valid: {len(prepared.cars)} vehicles on {prepared.network.name}. {prepared.network.attribution}".rstrip())


@app.command("import")
def import_(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A map: .osm, .osm.gz, .osm.pbf, .json from an Overpass server, or OpenDRIVE (.xodr).")],
    out: Annotated[Path, typer.Option("--out", help="The folder to make; an earlier import there is replaced.")],
    bbox: Annotated[str | None, typer.Option("--bbox", metavar="W,S,E,N", help="The part to keep [deg]; default: the mapped place.")] = None,
    parking_aisles: Annotated[bool, typer.Option("--parking-aisles", help="Build the aisles of parking places and the driveways to them.")] = False,
    as_json: AsJson = False,
) -> None:
    """Imports a map into a folder that a scenario can name, and reports what was found, guessed and skipped."""
    from studio.road.library import intake

    print_import(out, intake.take(file, out, bbox=bbox, parking_aisles=parking_aisles, progress=told), as_json)


@app.command()
def download(
    out: Annotated[Path, typer.Option("--out", help="The folder to make; an earlier import there is replaced, its corrections are kept.")],
    place: Annotated[str | None, typer.Argument(metavar="PLACE", help="Name of the place, with its city where there are several.")] = None,
    bbox: Annotated[str | None, typer.Option("--bbox", metavar="W,S,E,N", help="The place as a box [deg] instead.")] = None,
    overpass: Annotated[str | None, typer.Option("--overpass", metavar="URL", envvar="STUDIO_OVERPASS", help="The Overpass server to ask.")] = None,
    search: Annotated[str | None, typer.Option("--search", metavar="URL", envvar="STUDIO_NOMINATIM", help="The Nominatim server to ask for names.")] = None,
    as_json: AsJson = False,
) -> None:  # fmt: skip
    """Downloads a place from OpenStreetMap and imports it, as `studio import` does."""
    from studio.errors import MapError
    from studio.road.formats import osm
    from studio.road.library import intake

    if (place is None) == (bbox is None):
        raise MapError("What shall be downloaded?", [Problem("PLACE, --bbox", "are none or both given", remedy="give one of them")])
    wanted = osm.bounding_box(bbox) if bbox else place
    print_import(out, intake.fetch(wanted, out, overpass=overpass, search=search, progress=told), as_json)


@app.command()
def correct(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="The folder of an import.")],
    element: Annotated[str, typer.Argument(metavar="ELEMENT", help='An element of the map: "way 4711", "node 7", "relation 5".')],
    tags: Annotated[list[str] | None, typer.Argument(metavar="KEY=VALUE", help="Tags to set: lanes=2 maxspeed=30.")] = None,
    remove: Annotated[list[str] | None, typer.Option("--remove", metavar="KEY", help="A tag to take away; can be repeated.")] = None,
    undo: Annotated[bool, typer.Option("--undo", help="Take all corrections of this element back.")] = False,
    as_json: AsJson = False,
) -> None:
    """Corrects tags of a map element and imports the map again; the correction is kept for later imports into the folder."""
    from studio.errors import MapError
    from studio.road.library import intake, tag

    if undo and (tags or remove):
        raise MapError("--undo takes all corrections of the element back.", [Problem("--undo", "stands alone", remedy="leave the tags out")])
    if undo:
        network = intake.undo(folder, element, progress=told)
    else:
        network = intake.correct(folder, tag.correction(element, assigned(tags), remove or ()), progress=told)
    print_import(folder, network, as_json)


@generate.command()
def motorway(
    out: Annotated[Path, typer.Option("--out", help="The OpenDRIVE file to write; one that is there is replaced.")],
    length: Annotated[float, typer.Option(help="Length [m].")] = 6000.0,
    lanes: Annotated[int, typer.Option(help="Lanes of each direction.")] = 3,
    radius: Annotated[float, typer.Option(help="Radius of its bends [m].")] = 1000.0,
    grade: Annotated[float, typer.Option(help="Steepest slope of its hills [1]; 0 is level.")] = 0.0,
) -> None:
    """Writes a motorway with straights, clothoids and bends as OpenDRIVE."""
    from studio.road.drawn.motorway import motorway as written

    text = written(length=length, lanes=lanes, radius=radius, grade=grade)
    try:
        out.write_text(text, encoding="utf-8")
    except OSError as error:
        problem = Problem("--out", "cannot be written", str(out), remedy="name a file in a folder that exists")
        raise MapError(f"{out}: {error.strerror or error}", [problem]) from None
    print(f"{out}: a motorway of {length:g} m with {lanes} lanes each way")


@generate.command("grid")
def generate_grid(out: MapOut) -> None:
    """Draws a town of 5 by 5 blocks: main streets with signals, quiet streets, a one-way pair, a roundabout, houses, parking."""
    from studio.road.drawn.town import town

    town().write(out)
    print(f"{out}: a town of 5 by 5 blocks")


@generate.command("deck")
def generate_deck(out: MapOut) -> None:
    """Draws a parking deck: one level, a one-way loop, sixty spaces, pillars and walls. Import it with --parking-aisles."""
    from studio.road.drawn.deck import deck

    deck().write(out)
    print(f"{out}: a parking deck of 60 spaces")


@app.command()
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


@app.command()
def drive(
    vehicle: Annotated[str, typer.Argument(help="A vehicle of the catalogue, or a vehicle file (YAML).")],
    inputs: Annotated[Path, typer.Option("--inputs", help="CSV: time_s and any of the columns that `studio drive --help` names.")],
    out: Annotated[Path, typer.Option("--out", help="CSV for every state and force; .gz packs it.")],
    speed: Annotated[float, typer.Option("--speed", help="Speed at the start [m/s].")] = 0.0,
    tyre: Annotated[str | None, typer.Option("--tyre", help="Tyre property file (.tir), or a name of the catalogue, for all wheels.")] = None,
    set_: Sets = None,
    step: Annotated[float, typer.Option("--step", help="Integration step [s].")] = 0.005,
    period: Annotated[float, typer.Option("--period", help="Time between two rows of the result [s].")] = 0.01,
) -> None:
    """Drives one vehicle open loop on an endless plane.

    Input columns, any subset: time_s, road_wheel_angle_rad (past the steering's actuator) or steering_wheel_angle_rad, throttle
    or engine_torque_request_Nm, brake, gear, drive_torque_Nm and brake_torque_Nm (sums put on the wheels, past powertrain and
    hydraulics). Without throttle, engine torque or gear the gearbox stays in neutral. --set changes values of the vehicle by
    path (body.mass=1200), and the road: road.friction=0.5, road.slope=0.1.
    """
    with progress("preparing") as report:
        from studio.rig import drive as rig
        from studio.rig import table

        table.check_output(out, inputs, Path(vehicle))
        made = rig.drive(vehicle, inputs, speed=speed, tyre=tyre, changes=changes(set_), step=step, period=period, progress=report)
        rows = rig.write(made, out)
    print(f"{out}: {rows} rows, {made.time[-1]:g} s, {len(made.columns)} columns")
    if made.rolled_over is not None:
        print(f"{vehicle} rolled over at {made.rolled_over:g} s; nothing after it is claimed", file=sys.stderr)


@app.command()
def tyre(
    file: Annotated[Path, typer.Argument(metavar="FILE.tir", help="A tyre property file.")],
    rows: Annotated[Path | None, typer.Option("--rows", help="CSV with kappa, alpha_rad, gamma_rad, Fz_N.")] = None,
    out: Annotated[Path | None, typer.Option("--out", help="CSV for these rows with Fx_N, Fy_N, Mz_Nm.")] = None,
    plot: Annotated[Path | None, typer.Option("--plot", help="PNG for the diagrams.")] = None,
) -> None:
    """Puts a tyre on the bench: forces for a table of slips, and diagrams."""
    from studio.errors import ScenarioError
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


@app.command()
def bench(
    device: Annotated[str, typer.Option(help="cpu, or cuda for a GPU.")] = "cpu",
    as_json: AsJson = False,
) -> None:
    """Measures vehicle steps and ticks a second on this machine, an import and the picture; takes about half a minute."""
    if device not in ("cpu", "cuda"):
        raise UnknownError(f"There is no device {device!r}.", [Problem("--device", "is not known", device, "cpu, cuda")])
    with progress("measuring") as report:
        from studio import bench as measure
        from studio.server.serve import SAMPLES

        figures = measure.run_device(report) if device == "cuda" else measure.run(SAMPLES / "grosser_stern_platoon.yaml", report)
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
    if "difference" in figures:
        rows.append(["distance to the CPU's result after 10 s", f"{figures['difference']:.1e}", "m"])
    return rows


@app.command()
def schema() -> None:
    """Prints the JSON schema of scenario files."""
    from studio.scenario.schema import Scenario

    print_json(Scenario.model_json_schema())


@app.command()
def openapi() -> None:
    """Prints the description of the REST API."""
    from studio.server.app import description

    print_json(description())


def main(arguments: list[str] | None = None) -> None:
    """Entry point: `studio` alone, or with options only, serves."""
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    if not arguments or (arguments[0].startswith("-") and arguments[0] not in ("--help", "--version")):
        arguments = ["serve", *arguments]
    if arguments == ["--version"]:
        from studio.job import code_version

        print(code_version())
        return
    try:
        app(arguments, standalone_mode=True)
    except StudioError as error:
        print(error, file=sys.stderr)
        sys.exit(1 if isinstance(error, RunError) else 2)


# --- input -------------------------------------------------------------------------------------------------------------


def changes(assignments: list[str] | None) -> dict[str, Any]:
    """The --set options as {path: value}."""
    from studio.scenario.edit import parse_assignment

    return dict(parse_assignment(each) for each in assignments or [])


def assigned(assignments: list[str] | None) -> dict[str, str]:
    """KEY=VALUE arguments as tags; raises MapError."""
    from studio.errors import MapError

    for each in assignments or []:
        if "=" not in each:
            raise MapError("The correction cannot be made.", [Problem("KEY=VALUE", "is not a tag", each, "such as lanes=2")])
    return dict(each.split("=", 1) for each in assignments or [])


def load_applications(folder: Path | None) -> None:
    """Registers the user's own applications."""
    if folder:
        from studio.application.registry import load_folder

        load_folder(folder)


def existing(db: Path):
    """The runs of a database that must exist; reading makes no file."""
    from studio.store.runs import open_runs

    if not db.exists():
        raise UnknownError(
            f"There is no run database {db}.",
            [Problem("--db", "does not exist", str(db), remedy="run a scenario first, or name another file")],
        )
    return open_runs(db)


# --- output ------------------------------------------------------------------------------------------------------------


@contextmanager
def progress(title: str) -> Iterator[Callable[[float], None]]:
    """A bar on standard error once something takes longer than a second; none when nobody watches."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(first_start(title), total=None)
        yield lambda share: bar.update(task, description="running", total=1.0, completed=share)


def first_start(title: str) -> str:
    """What the bar says before there is progress."""
    from studio.compiled import is_warm

    return title if is_warm() else f"{title} (compiling once, about half a minute)"


def told(text: str) -> None:
    """Progress of an import, a line for every step."""
    print(text, file=sys.stderr)


def print_import(out: Path, network, as_json: bool) -> None:
    """The report of an import, as it stands in its folder or for people."""
    from studio.road.library import folder
    from studio.road.network.report import rows

    if as_json:
        print_json(json.loads((out / folder.REPORT).read_text(encoding="utf-8")))
        return
    print_table(["what", "how many", "remark"], rows(network.report))
    print(f"{out}: {network.name}. {network.attribution}".rstrip())


def run_json(row) -> dict[str, Any]:
    """A run as the one object that scripts read."""
    plain = asdict(row)
    plain["metrics"] = {name: asdict(each) for name, each in row.metrics.items()}
    return plain


def print_json(value: Any) -> None:
    """JSON on standard output."""
    print(json.dumps(value, ensure_ascii=False, indent=2))


def print_run(row) -> None:
    """A run for people."""
    lines = {
        "run": f"{row.run} ({row.status})",
        "scenario": f"{row.scenario}  {row.scenario_hash[:12]}",
        "set": settings(row.parameters) or "nothing, as in the file",
        "parent": str(row.parent or "none"),
        "seed": str(row.seed),
        "time": f"{text(row.sim_time_s)} s simulated in {text(row.wall_time_s)} s",
        "state": (row.state_hash or "none")[:16],
        "code": row.code_version,
    }
    for name, value in lines.items():
        print(f"{name:9} {value}")
    if row.error:
        print(f"\n{row.error}")
    for each in row.unmet:
        print(f"goal not met: {each}")
    if row.metrics:
        print_table(
            ["metric", "value", "better"],
            [[f"{name} [{each.unit}]", text(each.value), each.goal or ""] for name, each in row.metrics.items()],
        )


def print_table(header: list[str], rows: list[list[str]]) -> None:
    """A table that survives being piped."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console(markup=False, highlight=False, width=None if sys.stdout.isatty() else PIPED_WIDTH)
    table = Table(box=SIMPLE_HEAD)
    for column in header:
        table.add_column(Text(column), overflow="fold")
    for row in rows:
        table.add_row(*map(Text, row))
    console.print(table)


def settings(parameters: dict[str, Any]) -> str:
    """What was set, in one line."""
    return ", ".join(f"{path}={value}" for path, value in parameters.items())


def metric_text(row, name: str) -> str:
    """A metric of a row."""
    return text(row.metrics[name].value) if name in row.metrics else ""


def text(value: Any) -> str:
    """A value for people."""
    if value is None:
        return "–"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def signed(value: float | None) -> str:
    """A difference for people."""
    return "–" if value is None else f"{value:+.4g}"


if __name__ == "__main__":
    main()
