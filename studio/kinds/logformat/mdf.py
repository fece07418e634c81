"""ASAM MDF 3 and 4 (.mf4, .mdf, .dat of INCA is not read), by the package asammdf, which the extra `logs` brings along."""

from pathlib import Path

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.kind.log import Log, Signal, signal

KIND = "logformat"
TITLE = "ASAM MDF"
SUFFIXES = (".mf4", ".mdf")


def read(path: Path, dbc: Path | None = None) -> Log:
    """All channels that are numbers; raises ScenarioError for a file that is damaged or cut off."""
    try:
        from asammdf import MDF
    except ImportError:
        raise refused(path, "needs the package asammdf", "install the studio with its extra `logs`") from None
    try:
        with MDF(path) as file:
            whole(file, path)
            found = [each for group in range(len(file.groups)) for each in channels(file, group)]
    except ScenarioError:
        raise
    except Exception as error:  # asammdf raises whatever the bytes lead it to
        raise refused(path, f"is no whole MDF: {type(error).__name__}: {error}", "record again, or save it anew") from None
    return Log(path.name, {each.name: each for each in found})


def whole(file, path: Path) -> None:
    """Refuses a file whose data end before its head says."""
    size = path.stat().st_size
    for group in file.groups:
        last = max((block.address + block.compressed_size for block in group.get_data_blocks()), default=0)
        if last > size:
            raise refused(path, f"is cut off: data until byte {last}, the file has {size}", "copy it again, or record again")


def channels(file, group: int) -> list[Signal]:
    """The channels of a group, but for its clock."""
    count = len(file.groups[group].channels)
    found = [file.get(group=group, index=i) for i in range(count) if file.masters_db.get(group) != i]
    numbers = [each for each in found if each.samples.ndim == 1 and each.samples.dtype.kind in "fiub"]
    return [signal(each.name, each.unit or "", each.timestamps, each.samples.astype(np.float64)) for each in numbers]


def refused(path: Path, what: str, remedy: str) -> ScenarioError:
    """What is told of a file that is none."""
    return ScenarioError(f"{path.name} cannot be read as MDF.", [Problem(str(path), what, remedy=remedy)])
