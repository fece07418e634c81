"""Trajectories of a run for other programs, sample after sample, so that a long run is never in memory as a whole.

    fcd     floating car data as SUMO writes it (fcd-export): a `timestep` for each sample, a `vehicle` for each that is on the road
    csv     the same as a table: a line for each vehicle at each sample

x and y are those of the middle of the front bumper, as SUMO has them: in metres of the map, or in degrees of longitude and latitude. Angles
are in degrees clockwise from north.
"""

import csv
import io
from collections.abc import Iterator
from math import atan, cos, degrees, isfinite, sin
from typing import Literal, NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from studio.errors import Problem, UnknownError
from studio.execution.cast import Cast
from studio.execution.record import Body
from studio.road.formats.osm import Box
from studio.store import trace
from studio.store.runs import Runs

Format = Literal["fcd", "csv"]
NEEDED = ("x", "y", "heading", "speed", "station", "acceleration", "lanes_beside")
BATCH = 512  # samples that are read at a time
MEDIA = {"fcd": "application/xml", "csv": "text/csv"}
HEAD = ("time", "vehicle", "type", "x", "y", "angle", "speed", "acceleration", "lane", "pos", "slope")


class Seen(NamedTuple):
    """A vehicle at a sample: place [m] or [deg], angle [deg] clockwise from north, speed [m/s], acceleration [m/s²], slope [deg]."""

    name: str
    model: str
    x: float
    y: float
    angle: float
    speed: float
    acceleration: float
    lane: str
    pos: float
    slope: float


def export(runs: Runs, run: int, form: Format, *, as_degrees: bool = False) -> Iterator[str]:
    """The trajectories of a run, piece by piece; raises UnknownError before the first one when something of them was not kept."""
    parquet = runs.parquet(run)
    check(run, parquet)
    samples = seen(parquet, as_degrees)
    return fcd(samples, 8 if as_degrees else 2) if form == "fcd" else table(samples, 8 if as_degrees else 3)


def check(run: int, parquet: bytes) -> None:
    """What is needed must have been recorded; raises UnknownError."""
    known, present = trace.about_of(parquet), {each["name"] for each in trace.channels(parquet)}
    if not known["cast"].ways:
        raise UnknownError(f"The record of run {run} does not say which ways its vehicles took: an older studio wrote it. Run it again.")
    lacking = [name for name in NEEDED if not {f"{vehicle}.{name}" for vehicle in known["vehicles"]} <= present]
    if lacking:
        problem = Problem("recording.channels", f"did not keep {', '.join(lacking)}", allowed=", ".join(NEEDED), remedy="keep these too")
        raise UnknownError(f"The trajectories of run {run} were not recorded.", [problem])


def seen(parquet: bytes, as_degrees: bool) -> Iterator[tuple[float, list[Seen]]]:
    """Sample after sample: the time [s], and all vehicles that are on the road."""
    known = trace.about_of(parquet)
    names, cast = known["vehicles"], known["cast"]
    columns = ["time", *(f"{name}.{channel}" for name in names for channel in NEEDED)]
    box = Box(cast.origin[0], cast.origin[1], cast.origin[0], cast.origin[1]) if as_degrees else None
    for batch in pq.ParquetFile(pa.BufferReader(parquet), pre_buffer=False).iter_batches(BATCH, columns=columns):
        values = {name: batch.column(name).to_pylist() for name in columns}
        for i, time in enumerate(values["time"]):
            rows = ((name, [values[f"{name}.{channel}"][i] for channel in NEEDED]) for name in names)
            yield time, [vehicle(name, row, known["bodies"][name], cast, box) for name, row in rows if isfinite(row[0])]


def vehicle(name: str, row: list[float], body: Body, cast: Cast, box: Box | None) -> Seen:
    """One vehicle at one sample."""
    x, y, heading, speed, station, acceleration, beside = row
    x, y = x + body.front * cos(heading), y + body.front * sin(heading)
    manned = cast.manned[name]
    lane, pos, slope = cast.ways[manned.way].place(station + body.front)
    lane = lane_beside(lane, int(beside))
    if box is not None:
        ((x, y),) = box.degrees(np.array([[x], [y]]))
    return Seen(name, manned.model, x, y, round(90.0 - degrees(heading), 2) % 360.0, speed, acceleration, lane, pos, degrees(atan(slope)))


def lane_beside(lane: str, step: int) -> str:
    """The id of the lane so many lanes beside another; within a junction there is but one."""
    road, _, index = lane.rpartition("_")
    return f"{road}_{int(index) + step}" if step and index.isdecimal() and not lane.startswith(":") else lane


def fcd(samples: Iterator[tuple[float, list[Seen]]], digits: int) -> Iterator[str]:
    """As SUMO writes floating car data."""
    schema = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://sumo.dlr.de/xsd/fcd_file.xsd"'
    yield f'<?xml version="1.0" encoding="UTF-8"?>\n<fcd-export {schema}>\n'
    for time, vehicles in samples:
        lines = "".join(f"        {element(each, digits)}\n" for each in vehicles)
        yield f'    <timestep time="{time:.2f}">\n{lines}    </timestep>\n'
    yield "</fcd-export>\n"


def element(each: Seen, digits: int) -> str:
    """A vehicle in XML."""
    place = f'x="{each.x:.{digits}f}" y="{each.y:.{digits}f}" angle="{each.angle:.2f}"'
    on = f'pos="{each.pos:.2f}" lane={quoteattr(each.lane)} slope="{each.slope:.2f}"'
    return f'<vehicle id={quoteattr(each.name)} {place} type={quoteattr(each.model)} speed="{abs(each.speed):.2f}" {on}/>'


def table(samples: Iterator[tuple[float, list[Seen]]], digits: int) -> Iterator[str]:
    """A line for each vehicle at each sample."""
    yield line(HEAD)
    for time, vehicles in samples:
        yield "".join(
            line(
                (f"{time:.3f}", each.name, each.model, f"{each.x:.{digits}f}", f"{each.y:.{digits}f}", f"{each.angle:.2f}",
                 f"{each.speed:.3f}", f"{each.acceleration:.3f}", each.lane, f"{each.pos:.3f}", f"{each.slope:.3f}")
            )
            for each in vehicles
        )  # fmt: skip


def line(values: tuple[str, ...]) -> str:
    """A line of a table."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(values)
    return text.getvalue()
