"""The record of a run whose process has gone, from the folder into which it was written meanwhile.

lay_down(simulation, folder)    before the first tick: what is needed to read the rest without the simulation
salvaged(folder)             →  Record of all samples, events and messages that came so far; but for the ages of links
"""

from typing import Any

import numpy as np

from studio.execution import trail
from studio.execution.about import about, of_about
from studio.execution.happening import Happening, Number
from studio.execution.message import Messages, joined, of_book
from studio.execution.record import Record, Traced, renumber
from studio.execution.shelf import FileRoll, Folder
from studio.execution.simulation import Simulation
from studio.world.board.log import Logged, book_of
from studio.world.channel import CHANNELS


def lay_down(of: Simulation, folder: Folder) -> None:
    """What the files mean. Raises NoRoom."""
    parts, posts = of.recorder.trail.parts, of.world.units.posts
    known = about(of.record()) | {
        "room": of.recorder.room,
        "channels": [each.name for each in CHANNELS],
        "numbers": list(of.numbers(0).items()),
        "probes": [(each.name, each.unit, each.label) for each in of.recorder.trail.reader.probes],
        "trail": (parts.places.shape, parts.numbers.shape),
        "kinds": [post.kind.name for post in posts],
        "units": of.world.units.names[0],
    }
    folder.write("about", [known])
    folder.append("probes", parts.piece, parts.within, parts.slot)
    folder.append("links", *(post.link_receiver for post in posts))


def salvaged(folder: Folder) -> Record | None:
    """The record so far; nothing when the run had not begun."""
    lines = folder.lines("about")
    count = recorded(folder, lines)
    if not lines or not count or not (folder.path / "links.jsonl").exists():
        return None
    known = lines[0]
    time, values = sampled(folder, known, count)
    return Record(
        time=time,
        values=renumber(values, {int(new): int(old) for new, old in known["numbers"]}),
        happenings=tuple(map(happening_of, folder.lines("events"))),
        probes=probes(folder, known, count),
        messages=messages(folder, known),
        **of_about(known),
    )


def recorded(folder: Folder, lines: list[Any]) -> int:
    """How many samples there are: so many as are told, but no more than there are times of."""
    room = lines[0]["room"] if lines else 1
    return min(int(folder.progress()[0]), room * folder.roll("times", (room,)).count)


def sampled(folder: Folder, known: dict[str, Any], count: int) -> tuple[np.ndarray, np.ndarray]:
    """Times [s], and values [channel, vehicle, sample]."""
    room, shape = known["room"], (len(known["channels"]), len(known["vehicles"]))
    times, samples = folder.roll("times", (room,)), folder.roll("values", (room, *shape))
    time, values = np.empty(count), np.full((len(CHANNELS), shape[1], count), np.nan)
    place = [known["channels"].index(each.name) if each.name in known["channels"] else -1 for each in CHANNELS]
    for first in range(0, count, room):
        time[first : first + room] = times[first // room][: count - first]
        found = samples[first // room][: count - first]
        for row, at in enumerate(place):
            if at >= 0:
                values[row, :, first : first + room] = found[:, at].T
    return time, values


def probes(folder: Folder, known: dict[str, Any], count: int) -> dict[str, Traced]:
    """What probes had read."""
    ((piece, within, slot),) = folder.appended("probes")
    places, numbers = known["trail"]
    rolls = folder.roll("places", tuple(places), np.int32), folder.roll("numbers", tuple(numbers))
    beginnings = folder.roll("beginnings", (1,), np.int64)
    parts = trail.Parts(piece, within, slot, *rolls, beginnings, begun(beginnings))
    found = parts.series(np.arange(count), slice(None), folder)
    return {name: Traced(found[i], unit, label) for i, (name, unit, label) in enumerate(known["probes"])}


def begun(beginnings: FileRoll) -> list[int]:
    """The first samples of all parts; of one that is about to begin it is not put down yet, and it has none."""
    found = [int(beginnings[i][0]) for i in range(beginnings.count)]
    return [first for i, first in enumerate(found) if first or not i]


def messages(folder: Folder, known: dict[str, Any]) -> Messages:
    """The messages that had been put down."""
    (links,) = folder.appended("links")
    logs = [[Logged(*part) for part in folder.appended(f"log_{i}")] for i in range(len(links))]
    parts = [of_book(book_of(log), link, 0, i) for i, (log, link) in enumerate(zip(logs, links, strict=True)) if log]
    return joined(parts, tuple(known["kinds"]), tuple(known["units"]))


def happening_of(plain: dict[str, Any]) -> Happening:
    """An event as it was written."""
    numbers = {name: Number(**each) for name, each in plain["numbers"].items()}
    return Happening(**plain | {"units": tuple(plain["units"]), "numbers": numbers})
