"""Traces of a CAN bus, BLF and ASC of Vector's tools, with the DBC that says what the frames mean (python-can, cantools; extra `logs`)."""

from collections import defaultdict
from pathlib import Path

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.kind.log import Log, signal

KIND = "logformat"
TITLE = "Trace of a CAN bus"
SUFFIXES = (".blf", ".asc")


def read(path: Path, dbc: Path | None = None) -> Log:
    """All signals of the frames that the DBC knows, by frame and signal: `Motion.YawRate`; raises ScenarioError."""
    try:
        import can
        import cantools
    except ImportError:
        raise refused(path, "needs the packages python-can and cantools", "install the studio with its extra `logs`") from None
    if dbc is None:
        raise refused(path, "is a trace of frames, and nothing says what they mean", "name its DBC: --dbc FILE, or `dbc:` in the mapping")
    database = meaning(cantools, dbc)
    try:
        with can.LogReader(path) as frames:
            rows, strange = decoded(frames, database)
    except Exception as error:  # the readers raise whatever the bytes lead them to
        raise refused(path, f"is no whole trace: {type(error).__name__}: {error}", "record again, or save it anew") from None
    if not rows:
        seen = ", ".join(f"{each:#x}" for each in sorted(strange)[:8])
        what = f"the DBC {dbc.name} knows none of its frames ({seen or 'there is none'})"
        raise refused(path, what, "name the DBC of this bus")
    units = {f"{frame.name}.{each.name}": each.unit or "" for frame in database.messages for each in frame.signals}
    columns = {name: np.array(found).T for name, found in sorted(rows.items())}
    return Log(path.name, {name: signal(name, units[name], time, values) for name, (time, values) in columns.items()})


def meaning(cantools, dbc: Path):
    """What a DBC says; raises ScenarioError."""
    try:
        return cantools.database.load_file(dbc)
    except Exception as error:  # cantools raises errors of its parser, which quote the file, and of the file
        problem = Problem(str(dbc), f"is no DBC: {type(error).__name__}", remedy="name the file that describes the bus")
        raise ScenarioError(f"{dbc.name} cannot be read.", [problem]) from None


def decoded(frames, database) -> tuple[dict[str, list[tuple[float, float]]], set[int]]:
    """Times [s] and values by name, and the frames that the DBC does not know or that do not fit it."""
    rows: dict[str, list[tuple[float, float]]] = defaultdict(list)
    strange = set()
    for frame in frames:
        try:
            kind = database.get_message_by_frame_id(frame.arbitration_id)
            found = kind.decode(frame.data, decode_choices=False)
        except Exception:  # unknown, too short, or of another layout: it is counted among those that are strange
            strange.add(frame.arbitration_id)
            continue
        for name, value in found.items():
            rows[f"{kind.name}.{name}"].append((frame.timestamp, float(value)))
    return rows, strange


def refused(path: Path, what: str, remedy: str) -> ScenarioError:
    """What is told of a trace that is none."""
    return ScenarioError(f"{path.name} cannot be read as a CAN trace.", [Problem(str(path), what, remedy=remedy)])
