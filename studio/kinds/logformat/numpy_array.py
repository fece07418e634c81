"""NumPy: an archive with an array for each signal, or a folder of arrays, or of text files with one column each.

    drive.npz                    time, yaw_rate, ...          one clock, called t or time
    folder/yaw__t.npy            with yaw__value.npy          a clock for each signal
    folder/pose_times.npy        with pose_positions.npy      a clock for all that begin alike
    folder/t.txt                 with yawRate.txt             one clock

A signal with several columns becomes several: positions[0], positions[1] ...
"""

import gzip
import zipfile
import zlib
from pathlib import Path

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.kind.log import Log, Signal, signal

KIND = "logformat"
TITLE = "Arrays of NumPy"
SUFFIXES = (".npz", "/.npy", "/.txt")
CLOCKS = ("t", "time", "time_s", "t_s")


def read(path: Path, dbc: Path | None = None) -> Log:
    """All arrays that have a clock; raises ScenarioError."""
    arrays = inside(path) if path.is_dir() else archive(path)
    found = [each for name in arrays for each in signals(name, arrays, path)]
    return Log(path.name, {each.name: each for each in found})


def archive(path: Path) -> dict[str, np.ndarray]:
    """Arrays of an .npz; nothing in it is executed."""
    try:
        with np.load(path, allow_pickle=False) as found:
            return {name: found[name] for name in found.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise refused(path, f"is no archive of arrays: {error}") from None


def inside(folder: Path) -> dict[str, np.ndarray]:
    """Arrays of the files of a folder by the names of these."""
    files = sorted(each for each in folder.iterdir() if each.name.endswith((".npy", ".txt", ".txt.gz")))
    return {each.name.partition(".")[0]: loaded(each) for each in files if "licen" not in each.name.lower()}


def loaded(path: Path) -> np.ndarray:
    """One array, of bytes or of text."""
    try:
        if path.suffix == ".npy":
            return np.load(path, allow_pickle=False)
        with (gzip.open if path.suffix == ".gz" else open)(path, "rt") as file:
            return np.loadtxt(file)
    except (OSError, ValueError, EOFError, zlib.error) as error:
        raise refused(path, f"is no array of numbers: {error}") from None


def signals(name: str, arrays: dict[str, np.ndarray], path: Path) -> list[Signal]:
    """The signals of an array; none of one that is a clock, or has none."""
    clock, values = clock_of(name, arrays), arrays[name]
    if clock is None or clock == name or values.dtype.kind not in "fiub" or values.ndim > 2:
        return []
    time = arrays[clock].ravel()
    if len(values) != time.size:
        raise refused(path, f"{name} has {len(values)} values, its clock {clock} {time.size} times")
    title, table = name.removesuffix("__value"), values.reshape(time.size, -1)
    names = [title] if table.shape[1] == 1 else [f"{title}[{i}]" for i in range(table.shape[1])]
    return [signal(each, "", time, table[:, i]) for i, each in enumerate(names)]


def clock_of(name: str, arrays: dict[str, np.ndarray]) -> str | None:
    """Which array holds the times of another."""
    own = name.removesuffix("__value") + "__t"
    if own in arrays:
        return own
    alike = [each for each in arrays if each.endswith("_times") and arrays[each].ndim == 1 and name.startswith(each.removesuffix("times"))]
    return next((each for each in (*alike, *CLOCKS) if each in arrays and not name.endswith("__t")), None)


def refused(path: Path, what: str) -> ScenarioError:
    """What is told of arrays that are none."""
    return ScenarioError(f"{path.name} cannot be read as NumPy.", [Problem(str(path), what, remedy="save numbers with numpy.savez")])
