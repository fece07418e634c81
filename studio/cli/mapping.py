"""Commands about maps: import, download, correct and draw them."""

import json
from pathlib import Path
from typing import Annotated

import typer

from studio.cli.option import AsJson
from studio.cli.output import print_json, print_table
from studio.cli.progress import told
from studio.errors import MapError, Problem

commands = typer.Typer()
generate = typer.Typer(help="Draws a map.", no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False)
MapOut = Annotated[Path, typer.Option("--out", help="The map to write (.osm).")]


@commands.command("import")
def import_(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="A map: .osm, .osm.gz, .osm.pbf, .json from an Overpass server, or OpenDRIVE (.xodr).")
    ],
    out: Annotated[Path, typer.Option("--out", help="The folder to make; an earlier import there is replaced.")],
    bbox: Annotated[
        str | None, typer.Option("--bbox", metavar="W,S,E,N", help="The part to keep [deg]; default: the mapped place.")
    ] = None,
    parking_aisles: Annotated[
        bool, typer.Option("--parking-aisles", help="Build the aisles of parking places and the driveways to them.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Imports a map into a folder that a scenario can name, and reports what was found, guessed and skipped."""
    from studio.road.library import intake

    print_import(out, intake.take(file, out, bbox=bbox, parking_aisles=parking_aisles, progress=told), as_json)


@commands.command()
def download(
    out: Annotated[Path, typer.Option("--out", help="The folder to make; an earlier import there is replaced, its corrections are kept.")],
    place: Annotated[str | None, typer.Argument(metavar="PLACE", help="Name of the place, with its city where there are several.")] = None,
    bbox: Annotated[str | None, typer.Option("--bbox", metavar="W,S,E,N", help="The place as a box [deg] instead.")] = None,
    overpass: Annotated[
        str | None, typer.Option("--overpass", metavar="URL", envvar="STUDIO_OVERPASS", help="The Overpass server to ask.")
    ] = None,
    search: Annotated[
        str | None, typer.Option("--search", metavar="URL", envvar="STUDIO_NOMINATIM", help="The Nominatim server to ask for names.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Downloads a place from OpenStreetMap and imports it, as `studio import` does."""
    from studio.road.formats import osm
    from studio.road.library import intake

    if place is not None and bbox is None:
        wanted = place
    elif bbox is not None and place is None:
        wanted = osm.bounding_box(bbox)
    else:
        raise MapError("What shall be downloaded?", [Problem("PLACE, --bbox", "are none or both given", remedy="give one of them")])
    print_import(out, intake.fetch(wanted, out, overpass=overpass, search=search, progress=told), as_json)


@commands.command()
def correct(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="The folder of an import.")],
    element: Annotated[str, typer.Argument(metavar="ELEMENT", help='An element of the map: "way 4711", "node 7", "relation 5".')],
    tags: Annotated[list[str] | None, typer.Argument(metavar="KEY=VALUE", help="Tags to set: lanes=2 maxspeed=30.")] = None,
    remove: Annotated[list[str] | None, typer.Option("--remove", metavar="KEY", help="A tag to take away; can be repeated.")] = None,
    undo: Annotated[bool, typer.Option("--undo", help="Take all corrections of this element back.")] = False,
    as_json: AsJson = False,
) -> None:
    """Corrects tags of a map element and imports the map again; the correction is kept for later imports into the folder."""
    from studio.road.library import intake, tag

    if undo and (tags or remove):
        raise MapError(
            "--undo takes all corrections of the element back.", [Problem("--undo", "stands alone", remedy="leave the tags out")]
        )
    if undo:
        network = intake.undo(folder, element, progress=told)
    else:
        network = intake.correct(folder, tag.correction(element, assigned(tags), remove or ()), progress=told)
    print_import(folder, network, as_json)


commands.add_typer(generate, name="generate")


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
def generate_deck(
    out: MapOut,
    groups: Annotated[int, typer.Option(help="Groups of spaces in each of the four rows.", min=1, max=20)] = 5,
    together: Annotated[int, typer.Option(help="Spaces between two pillars.", min=1, max=10)] = 3,
    length: Annotated[float, typer.Option(help="Length of a space [m].", min=4, max=7)] = 5.0,
    width: Annotated[float, typer.Option(help="Width of a space [m].", min=2, max=4)] = 2.5,
    aisle: Annotated[float, typer.Option(help="Width of the aisles [m].", min=4, max=10)] = 6.0,
) -> None:
    """Draws a parking deck: one level, a one-way loop, four rows of spaces, pillars and walls. Import it with --parking-aisles."""
    from studio.road.drawn.deck import Shape, deck

    shape = Shape(groups, together, length, width, aisle)
    deck(shape).write(out)
    print(f"{out}: a parking deck of {shape.spaces} spaces")


# -- input and output --------------------------------------------------------------------------------


def assigned(assignments: list[str] | None) -> dict[str, str]:
    """KEY=VALUE arguments as tags; raises MapError."""

    for each in assignments or []:
        if "=" not in each:
            raise MapError("The correction cannot be made.", [Problem("KEY=VALUE", "is not a tag", each, "such as lanes=2")])
    return dict(each.split("=", 1) for each in assignments or [])


def print_import(out: Path, network, as_json: bool) -> None:
    """The report of an import, as it stands in its folder or for people."""
    from studio.road.library import folder
    from studio.road.network.report import rows

    if as_json:
        print_json(json.loads((out / folder.REPORT).read_text(encoding="utf-8")))
        return
    print_table(["what", "how many", "remark"], rows(network.report))
    print(f"{out}: {network.name}. {network.attribution}".rstrip())
