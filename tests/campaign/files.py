"""Mutated files, read in a process with limits: only the studio's own errors may come out, in time and without eating memory."""

import os
import resource
import shutil
import sys
import tempfile
import time
import traceback
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path

import psutil

from studio.errors import StudioError
from studio.process import Child, Gone
from tests.campaign.mutation import mutant
from tests.campaign.table import Row

PATIENCE = 20.0  # [s] of processor time for one input: a machine may be busy
SLEEP = 300.0  # [s] that a process may take, whatever it does
READY_PATIENCE = 300.0  # [s] for a process to have its samples
MEMORY = 3_000_000_000  # [B] that a process may ask for beyond what it has when it begins
LONGEST_REFUSAL = 100_000  # characters


def read_all(line: Connection, folder: str) -> None:
    """The process: checks that the good ones of a kind are taken, and reads mutants of it."""
    os.environ["STUDIO_CACHE"] = own_cache(Path(folder))
    quiet()
    from tests.campaign.formats import FORMATS

    limit_memory()
    samples: dict[str, list[bytes]] = {}
    while True:
        name, *seeds = line.recv()
        form = FORMATS[name]
        if name not in samples:
            samples[name] = [form.unpack(each) for each in form.samples(Path(folder))]
        contents = [mutant(seed, samples[name], form.mutators) for seed in seeds] if seeds else samples[name]
        paths = (sample_file(form, folder, form.pack(each)) for each in contents)
        line.send([outcome(partial(form.read, path)) for path in paths])


def own_cache(folder: Path) -> str:
    """A cache of its own, but for machine code."""
    from studio.compiled import CACHE

    own = folder / "cache"
    own.mkdir(exist_ok=True)
    if not (own / "compiled").exists():
        (own / "compiled").symlink_to(CACHE)
    return str(own)


def quiet() -> None:
    """Nothing is printed here: what is read may want to."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)


def limit_memory() -> None:
    """Beyond this, memory is refused."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + MEMORY,) * 2)


def sample_file(form, folder: str, content: bytes) -> Path:
    """The file that is read."""
    path = Path(folder, f"mutant{form.ending}")
    path.write_bytes(content)
    return path


def outcome(read) -> tuple[str, str]:
    """What came of reading, and what is wrong about that."""
    try:
        read()
    except StudioError as error:
        text = str(error)
        return "refused", "a refusal of great length" if len(text) > LONGEST_REFUSAL else ""
    except BaseException as error:
        where = traceback.extract_tb(error.__traceback__)
        own = [f"{Path(each.filename).name}:{each.lineno}" for each in where if "studio" in each.filename]
        return "raised", f"{type(error).__name__}: {str(error)[:200]} at {' < '.join(own[-3:][::-1])}"
    return "taken", ""


class Reader:
    """A process that reads mutants; a new one when it has died or hangs."""

    def __init__(self) -> None:
        self.folder = tempfile.mkdtemp(prefix="studio-campaign-")
        self.child: Child | None = None

    def read(self, name: str, *seeds: str, patience: float = PATIENCE) -> list[tuple[str, str]]:
        """What came of mutants of one kind; without any seeds, of the good ones."""
        if self.child is None:
            self.child = Child.begin(read_all, self.folder)
            self.child.tell(name)
            assert self.child.hears_within(READY_PATIENCE) and self.child.hear(), f"{name}: no process"
        try:
            before, until = spent(self.child), time.monotonic() + SLEEP
            self.child.tell(name, *seeds)
            while spent(self.child) - before < patience and time.monotonic() < until:
                if self.child.hears_within(1.0):
                    return list(self.child.hear())
            found = "hung", f"takes more than {patience:g} s of a processor, or {SLEEP:g} s"
        except Gone as gone:
            found = "died", f"ended its process with {gone.code}"
        self.end()
        return [found]

    def end(self) -> None:
        """Ends the process."""
        if self.child is not None:
            self.child.kill()
            self.child.end(0.0)
            self.child = None

    def __enter__(self) -> "Reader":
        return self

    def __exit__(self, *_: object) -> None:
        self.end()
        shutil.rmtree(self.folder, ignore_errors=True)


def spent(child: Child) -> float:
    """Processor time of a process and its guard so far [s]."""
    with suppress(psutil.Error):
        guard = psutil.Process(child.process.pid)
        return sum(sum(each.cpu_times()[:2]) for each in (guard, *guard.children()))
    return 0.0


def campaign(reader: Reader, name: str, *, seed: int, count: int, seconds: float = 1e9) -> Row:
    """Mutants of one kind of file: so many, or as many as there is time for."""
    row = Row("files", name, seed)
    good = reader.read(name, patience=READY_PATIENCE)
    if set(good) != {("taken", "")}:
        row.blame(f"a good one is not taken: {good}")
    until = time.monotonic() + seconds
    for number in range(count):
        if time.monotonic() > until:
            break
        began = time.perf_counter()
        ((came, wrong),) = reader.read(name, own_seed(seed, name, number))
        row.add(came, time.perf_counter() - began, f"number {number}: {wrong}" if wrong else "")
    return row


def own_seed(seed: int, name: str, number: int) -> str:
    """The seed of one mutant."""
    return f"{seed}/{name}/{number}"


if __name__ == "__main__":  # one mutant again, with its traceback: python -m tests.campaign.files KIND SEED NUMBER
    from tests.campaign.formats import FORMATS

    with tempfile.TemporaryDirectory() as here:
        chosen = FORMATS[sys.argv[1]]
        good = [chosen.unpack(each) for each in chosen.samples(Path(here))]
        bad = sample_file(
            chosen, here, chosen.pack(mutant(own_seed(int(sys.argv[2]), sys.argv[1], int(sys.argv[3])), good, chosen.mutators))
        )
        shutil.copyfile(bad, bad.name)
        print(f"{bad.name} is what is read")
        print(chosen.read(bad))
