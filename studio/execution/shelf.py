"""Where what is recorded lies: in memory, or in files, which stay when the process ends before the run does.

roll = shelf.roll("values", (270, 176))   blocks of one shape, one after another: roll.begin() is the next, roll[3] the fourth
shelf.room("ages", (links, samples))      room for what is made of it when the run is over
shelf.write("event", [...])               lines of JSON, for what is told and not counted
shelf.append("cam", message, link)        arrays of any length; what is returned reads them again

A block of a file is filled with zeros before it is written to, so that a disk without room says so where a run can end in order; then it is
mapped, and what compiled code writes into it is in the file at once, whatever becomes of the process. Only the last block of a roll is
mapped, so a run of any length needs the memory of one of each. Nothing is flushed to the disk itself: a machine that fails is not meant.
"""

import json
import mmap
from collections.abc import Callable, Iterable
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from studio.errors import StudioError

ZEROS = bytes(1 << 20)
END = "end"  # a file that tells the run to end
LARGE = 2 << 20  # [B] of a large page
SMALL = 32 << 20  # [B] below which room is memory in any case: a mapped file costs a descriptor
Arrays = tuple[np.ndarray, ...]


class NoRoom(StudioError):
    """Nothing more can be recorded."""


class Roll:
    """Blocks in memory."""

    def __init__(self, shape: tuple[int, ...], dtype: DTypeLike) -> None:
        self.shape, self.dtype = shape, np.dtype(dtype)
        self.blocks: list[np.ndarray] = []

    def begin(self) -> np.ndarray:
        """The next block, to be written to."""
        self.blocks.append(on_large_pages(self.shape, self.dtype))
        return self.blocks[-1]

    def __getitem__(self, number: int) -> np.ndarray:
        """A block that has begun."""
        return self.blocks[number]


def on_large_pages(shape: tuple[int, ...], dtype: np.dtype) -> np.ndarray:
    """Room in memory, from the beginning of a large page on where it needs one.

    numpy asks for large pages, but where a block begins or ends within one the system hands out small ones, each at the first
    write to it.
    """
    size = prod(shape) * dtype.itemsize
    if size < LARGE:
        return np.empty(shape, dtype)
    whole = np.empty(size + LARGE, np.uint8)
    first = -whole.ctypes.data % LARGE
    return whole[first : first + size].view(dtype).reshape(shape)


class Shelf:
    """Memory, of which nothing is left when the process has ended."""

    def roll(self, name: str, shape: tuple[int, ...], dtype: DTypeLike = np.float64) -> Roll:
        """A roll, empty still."""
        return Roll(shape, dtype)

    def room(self, name: str, shape: tuple[int, ...]) -> np.ndarray:
        """Room for numbers."""
        return np.empty(shape)

    def write(self, name: str, lines: Iterable[Any]) -> None:
        """Nobody could read it."""

    def append(self, name: str, *arrays: np.ndarray) -> Callable[[], Arrays]:
        """Arrays, as they are."""
        return lambda: arrays

    def is_to_end(self) -> bool:
        """Whether somebody wants the run to end; nobody can say so."""
        return False


class FileRoll(Roll):
    """Blocks in a file, one after another, each from the beginning of a page on."""

    def __init__(self, shelf: "Folder", name: str, shape: tuple[int, ...], dtype: DTypeLike) -> None:
        super().__init__(shape, dtype)
        self.shelf, self.file = shelf, shelf.path / f"{name}.roll"
        self.size = pages(prod(shape) * self.dtype.itemsize)
        self.now = np.empty(0)
        self.count = self.file.stat().st_size // self.size if self.size and self.file.exists() else 0

    def begin(self) -> np.ndarray:
        """The next block. Raises NoRoom."""
        self.shelf.take(self.file, self.count * self.size, self.size)
        self.count += 1
        self.now = self.mapped(self.count - 1, mmap.ACCESS_WRITE)
        return self.now

    def __getitem__(self, number: int) -> np.ndarray:
        """A block that has begun; those before the last can be read only."""
        return self.now if number == self.count - 1 and self.now.shape == self.shape else self.mapped(number, mmap.ACCESS_READ)

    def mapped(self, number: int, access: int) -> np.ndarray:
        """A block as it lies in the file."""
        if not self.size:
            return np.empty(self.shape, self.dtype)
        with self.file.open("r+b" if access == mmap.ACCESS_WRITE else "rb") as file:
            block = mmap.mmap(file.fileno(), self.size, access=access, offset=number * self.size)
        return np.frombuffer(block, self.dtype, prod(self.shape)).reshape(self.shape)


class Folder(Shelf):
    """Files of a folder, of `most` bytes at most."""

    def __init__(self, path: Path, most: float = float("inf")) -> None:
        self.path, self.most, self.used = path, most, 0

    def roll(self, name: str, shape: tuple[int, ...], dtype: DTypeLike = np.float64) -> FileRoll:
        """A roll, with the blocks that are in its file already."""
        return FileRoll(self, name, shape, dtype)

    def room(self, name: str, shape: tuple[int, ...]) -> np.ndarray:
        """Room in a file where it is worth it; in memory when the disk has none."""
        if prod(shape) * 8 <= SMALL:
            return np.empty(shape)
        try:
            return Folder(self.path).roll(f"{name}.room", shape).begin()
        except NoRoom:
            return np.empty(shape)

    def write(self, name: str, lines: Iterable[Any]) -> None:
        """Lines behind those that were written before. Raises NoRoom."""
        text = "".join(f"{json.dumps(each, ensure_ascii=False)}\n" for each in lines)
        self.add(self.path / f"{name}.jsonl", text.encode())

    def is_to_end(self) -> bool:
        """Whether somebody wants the run to end."""
        return (self.path / END).exists()

    def lines(self, name: str) -> list[Any]:
        """The lines that were written whole."""
        file = self.path / f"{name}.jsonl"
        text = file.read_text(encoding="utf-8", errors="replace") if file.exists() else ""
        return [json.loads(line) for line in text.split("\n")[:-1]]

    def append(self, name: str, *arrays: np.ndarray) -> Callable[[], Arrays]:
        """Arrays behind those that were appended before. Raises NoRoom."""
        file = self.path / f"{name}.arrays"
        start = file.stat().st_size if file.exists() else 0
        self.add(file, b"".join(each.tobytes() for each in arrays))
        self.write(name, [[start, [[each.dtype.str, list(each.shape)] for each in arrays]]])
        return lambda: self.read(name, start, [(each.dtype, each.shape) for each in arrays])

    def appended(self, name: str) -> list[Arrays]:
        """All that was appended whole."""
        return [self.read(name, start, kinds) for start, kinds in self.lines(name)]

    def progress(self) -> tuple[float, float]:
        """How many samples a recorder has put here, and up to when [s]."""
        roll = self.roll("progress", (2,))
        return tuple(roll[0].tolist()) if roll.count else (0.0, 0.0)

    def read(self, name: str, start: int, kinds: list) -> Arrays:
        """Arrays that were appended."""
        found = []
        with (self.path / f"{name}.arrays").open("rb") as file:
            file.seek(start)
            for kind, shape in kinds:
                found.append(np.fromfile(file, kind, prod(shape)).reshape(shape))
        return tuple(found)

    def add(self, file: Path, data: bytes) -> None:
        """Bytes at the end of a file. Raises NoRoom."""
        self.check(len(data))
        try:
            with file.open("ab") as open_file:
                open_file.write(data)
        except OSError as error:
            raise full(file, error) from None
        self.used += len(data)

    def take(self, file: Path, start: int, size: int) -> None:
        """Fills a part of a file with zeros. Raises NoRoom."""
        self.check(size)
        try:
            with file.open("r+b" if file.exists() else "w+b", buffering=0) as open_file:
                open_file.seek(start)
                for at in range(0, size, len(ZEROS)):
                    fill(open_file, min(len(ZEROS), size - at))
        except OSError as error:
            raise full(file, error) from None
        self.used += size

    def check(self, size: int) -> None:
        """Raises NoRoom when so many bytes more would be more than may be."""
        if self.used + size > self.most:
            raise NoRoom(f"It has recorded {self.most / 1e9:g} GB, which is as much as may be: record less often, or fewer vehicles.")


def fill(file: Any, size: int) -> None:
    """Writes zeros, all of them: a disk that is nearly full takes a part."""
    written = 0
    while written < size:
        written += file.write(memoryview(ZEROS)[: size - written])


def full(file: Path, error: OSError) -> NoRoom:
    """Why nothing goes into a file any more."""
    return NoRoom(f"There is no room left to record in {file.parent.parent}: {error.strerror or error}.")


def pages(size: int) -> int:
    """Bytes in whole pages."""
    return -(-size // mmap.ALLOCATIONGRANULARITY) * mmap.ALLOCATIONGRANULARITY
